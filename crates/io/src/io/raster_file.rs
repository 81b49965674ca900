use std::fmt;
use std::path::{Path, PathBuf};

use super::coordinate_system::{CoordinateKind, CoordinateSystem};
use super::png::Behind;
use super::{DocumentPlane, FileCoordinates, Meter, RASTER_FORMATS, ReadError, ValueFacts};
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// A file format of rasters: one of [`Self::all`].
#[derive(Clone, Copy)]
pub struct RasterFormat(&'static RasterFormatSpec);

/// A file format of rasters, as its module describes it.
pub struct RasterFormatSpec {
    /// The file name extensions, in lower case and without the dot; the default one first.
    pub endings: &'static [&'static str],
    /// Whether a file has several variables or bands, of which one is named as in `FILE.nc#VARIABLE`.
    pub has_parts: bool,
    /// Reads a file, and counts its bytes.
    pub read: ReadRaster,
}

/// Reads a raster, and counts the bytes of its file. Pixels without a value are NaN.
#[derive(Clone, Copy)]
pub enum ReadRaster {
    /// Reads a grid that says which rectangle it covers.
    Grid(fn(&Path, &GridPlace, &Meter) -> Result<FileGrid, ReadError>),
    /// Reads a grid that does not say which rectangle it covers, over the given one, in world units.
    Array(fn(&Path, Rect, &Meter) -> Result<FileGrid, ReadError>),
    /// Reads an image over the given rectangle, in world units, as values from 0 (black) to 1 (white).
    Image(fn(&Path, Rect, Behind, &Meter) -> Result<Raster, ReadError>),
}

/// Where a grid lies, and which part of it is wanted.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridPlace {
    /// The rectangle that it covers, in world units, in place of the one that its file says.
    pub over: Option<Rect>,
    /// The part that is wanted. A reader may return more.
    pub window: Option<GridWindow>,
}

/// A part of a grid.
#[derive(Clone, Copy, Debug)]
pub struct GridWindow {
    /// The part, in world units.
    pub area: Rect,
    /// The plane of the document, if it has one.
    pub plane: Option<DocumentPlane>,
}

/// A grid as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct FileGrid {
    /// The values, where the file or [`GridPlace::over`] says.
    pub raster: Raster,
    /// What the file says about its coordinates.
    pub system: Option<CoordinateSystem>,
    /// What it says about its values.
    pub facts: ValueFacts,
}

/// What follows the name of a file before the name of a variable or the number of a band in it.
const BEFORE_PART: char = '#';

/// Returns the file that a path means, and the variable or band in it that follows its name, as in
/// `a.nc#depth` and `a.tif#2`.
pub(super) fn file_and_part(path: &Path) -> (PathBuf, Option<String>) {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let named = name.rsplit_once(BEFORE_PART).filter(|_| !super::exists(path)).and_then(|(file, part)| {
        let ending = Path::new(file).extension()?;
        let has = |format: &&RasterFormatSpec| {
            format.has_parts && format.endings.iter().any(|known| ending.eq_ignore_ascii_case(known))
        };
        let is_known = RASTER_FORMATS.iter().any(has);
        is_known.then(|| (path.with_file_name(file), Some(part.to_owned())))
    });
    named.unwrap_or_else(|| (path.to_owned(), None))
}

impl FileGrid {
    /// Returns a grid in other longitudes and latitudes in degrees from Greenwich, and another one as it is.
    pub(super) fn in_degrees(mut self) -> Self {
        let stated = self.system.as_ref().map(CoordinateSystem::stated);
        self.facts.notes.extend(stated.and_then(|stated| stated.note()));
        let Some((FileCoordinates::Known(known), factor, summand)) =
            stated.and_then(FileCoordinates::in_degrees)
        else {
            return self;
        };
        let Rect { min, max } = self.raster.bounds();
        let bounds = Rect::new(factor * min + summand, factor * max + summand);
        let raster = Raster::from_values(bounds, self.raster.size(), self.raster.values().to_vec());
        let system = self.system.map(|system| CoordinateSystem {
            on_earth: Some(known),
            unit: LengthUnit::Degree,
            ..system
        });
        Self { raster, system, ..self }
    }

    /// Returns what the coordinates are. Longitudes may be from 0 to 360.
    pub fn coordinates(&self) -> FileCoordinates {
        let Rect { min, max } = self.raster.bounds();
        let pixel = self.raster.pixel_size();
        let can_be_degrees = min.y >= -90.0 - pixel.y
            && max.y <= 90.0 + pixel.y
            && min.x >= -180.0 - pixel.x
            && max.x <= 360.0 + pixel.x;
        match &self.system {
            Some(system) if system.kind != CoordinateKind::Other => system.stated(),
            _ => FileCoordinates::Unstated { can_be_degrees },
        }
    }
}

impl RasterFormat {
    /// Returns all formats.
    pub fn all() -> impl Iterator<Item = Self> {
        RASTER_FORMATS.into_iter().map(Self)
    }

    /// Returns the format that the ending of a file name says.
    ///
    /// # Errors
    /// Fails with a sentence when it is the ending of no raster.
    pub fn from_path(path: &Path) -> Result<Self, String> {
        let (path, _) = file_and_part(path);
        let ending = path.extension().unwrap_or_default();
        let has = |format: &Self| format.endings().iter().any(|known| ending.eq_ignore_ascii_case(known));
        Self::all().find(has).ok_or_else(|| {
            let endings = Self::all().flat_map(|format| format.endings()).map(|ending| format!(".{ending}"));
            let mut endings: Vec<String> = endings.collect();
            let last = endings.pop().unwrap_or_default();
            format!("a raster ends in {} or {last}.", endings.join(", "))
        })
    }

    /// The default file name extension, in lower case and without the dot.
    pub fn ending(self) -> &'static str {
        self.0.endings[0]
    }

    /// All file name extensions, in lower case and without the dot.
    pub fn endings(self) -> &'static [&'static str] {
        self.0.endings
    }

    /// Returns whether a file has any values. The others are images, with values from 0 to 1.
    pub fn is_grid(self) -> bool {
        !matches!(self.0.read, ReadRaster::Image(_))
    }

    /// Returns whether a file says itself which rectangle it covers.
    pub fn has_place(self) -> bool {
        matches!(self.0.read, ReadRaster::Grid(_))
    }

    /// Returns what reads its files.
    pub(super) fn read(self) -> ReadRaster {
        self.0.read
    }
}

impl fmt::Debug for RasterFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RasterFormat(.{})", self.ending())
    }
}

impl PartialEq for RasterFormat {
    fn eq(&self, other: &Self) -> bool {
        self.ending() == other.ending()
    }
}

use std::fmt;
use std::path::Path;

use super::png::Behind;
use super::{Meter, RASTER_FORMATS, ReadError};
use meshbrush_core::raster::Raster;
use meshbrush_mesh::geometry::Rect;

/// A file format of rasters: one of [`Self::all`].
#[derive(Clone, Copy)]
pub struct RasterFormat(&'static RasterFormatSpec);

/// A file format of rasters, as its module describes it.
pub struct RasterFormatSpec {
    /// The file name extensions, in lower case and without the dot; the usual one first.
    pub endings: &'static [&'static str],
    /// Reads a file, and counts its bytes.
    pub read: ReadRaster,
}

/// Reads a raster, and counts the bytes of its file. Pixels without a value are NaN.
#[derive(Clone, Copy)]
pub enum ReadRaster {
    /// Reads a grid over the given rectangle, in world units; without one, over the rectangle that the file
    /// says.
    Grid(fn(&Path, Option<Rect>, &Meter) -> Result<Raster, ReadError>),
    /// Reads a grid that does not say which rectangle it covers, over the given one, in world units.
    Array(fn(&Path, Rect, &Meter) -> Result<Raster, ReadError>),
    /// Reads an image over the given rectangle, in world units, as values from 0 (black) to 1 (white).
    Image(fn(&Path, Rect, Behind, &Meter) -> Result<Raster, ReadError>),
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
    pub fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default();
        let has = |format: &Self| format.endings().iter().any(|known| ending.eq_ignore_ascii_case(known));
        Self::all().find(has).ok_or_else(|| {
            let endings = Self::all().flat_map(|format| format.endings()).map(|ending| format!(".{ending}"));
            let mut endings: Vec<String> = endings.collect();
            let last = endings.pop().unwrap_or_default();
            format!("a raster ends in {} or {last}.", endings.join(", "))
        })
    }

    /// The usual file name extension, in lower case and without the dot.
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

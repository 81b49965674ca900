//! The rasters of layers, from pictures and grids: for the window, recipes and options alike.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::png::Behind;
use super::super::raster_file::file_and_part;
use super::super::{
    DocumentPlane, FileCoordinates, FileGrid, Given, GivenGrid, GridPlace, GridWindow, Meter, RasterFormat,
    ReadError, ReadRaster, ValueFacts,
};
use meshbrush_core::field::{Transfer, f32_not_below};
use meshbrush_core::raster::{
    Raster, RasterPyramid, RasterValues, Resampling, check_values, resampled_raster,
};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Why a raster cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RasterError {
    /// The file is of no use.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A value is not valid; the sentence names the file, the value and its place.
    #[error("{0}")]
    Value(String),
}

/// The pixels of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterFile {
    /// The file.
    pub path: PathBuf,
    /// The format of the raster.
    pub format: RasterFormat,
    /// The rectangle of the raster. Without one, a grid lies where its file says; an image, and a grid whose
    /// format has no place, cover the bounds of the domain.
    pub bounds: Option<Rect>,
}

impl RasterFile {
    /// Returns a file by its name; it lies where the format says.
    ///
    /// # Errors
    /// Fails with a sentence when the ending of the name is that of no raster.
    pub fn named(path: &Path) -> Result<Self, String> {
        Ok(Self { path: path.to_owned(), format: RasterFormat::from_path(path)?, bounds: None })
    }

    /// Returns the file in the folder, without the variable or band that its name may end with.
    pub fn on_disk(&self) -> PathBuf {
        file_and_part(&self.path).0
    }
}

/// The raster of a layer, and what its file says about its values. Clones share the pixels.
#[derive(Clone, Debug)]
pub struct LoadedRaster {
    /// The pixels.
    pub raster: Arc<RasterPyramid>,
    /// What the file says.
    pub facts: ValueFacts,
    /// What the coordinates in the file are; `None` where it has none, or they do not count.
    pub coordinates: Option<FileCoordinates>,
}

impl LoadedRaster {
    fn new(raster: Raster, facts: ValueFacts) -> Self {
        Self { facts, ..Arc::new(RasterPyramid::new(raster)).into() }
    }
}

impl From<Arc<RasterPyramid>> for LoadedRaster {
    fn from(raster: Arc<RasterPyramid>) -> Self {
        Self { raster, facts: ValueFacts::default(), coordinates: None }
    }
}

impl From<FileGrid> for LoadedRaster {
    fn from(grid: FileGrid) -> Self {
        let coordinates = Some(grid.coordinates());
        Self { coordinates, ..Self::new(grid.raster, grid.facts) }
    }
}

/// Where a document wants rasters, and the place and the scale of those that have none of their own.
#[derive(Clone, Copy, Debug)]
pub struct RasterFrame {
    /// The rectangle of a raster whose format has no place, in world units.
    pub domain: Rect,
    /// The part of a grid that is wanted, in world units; `None` for all of it.
    pub wanted: Option<Rect>,
    /// The plane of the document, if it has one: grids are projected to it.
    pub plane: Option<DocumentPlane>,
    /// The scale of images of diameters.
    pub transfer: Transfer,
    /// What pixels get from those of a file in other coordinates.
    pub resampling: Resampling,
}

impl RasterFrame {
    /// Returns the part of a grid that a document wants.
    fn window(&self) -> Option<GridWindow> {
        Some(GridWindow { area: self.wanted?, plane: self.plane })
    }
}

/// Where a file itself says that it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnPlace {
    /// The rectangle that it covers.
    pub rect: Rect,
    /// What its coordinates are.
    pub coordinates: Option<FileCoordinates>,
}

impl OwnPlace {
    /// Returns the unit that the file states.
    pub fn unit(&self) -> LengthUnit {
        self.coordinates.map_or(LengthUnit::None, |coordinates| coordinates.stated_unit())
    }
}

/// Reads rasters and checks their values. Layers that read the same file share its pixels.
#[derive(Debug)]
pub struct RasterLoader {
    /// Files that say no place of their own, and whether transparent pixels are black.
    known: BTreeMap<(PathBuf, bool), LoadedRaster>,
    given: Given,
    meter: Meter,
}

impl RasterLoader {
    /// Returns a loader that has read nothing yet. The meter counts the bytes of each file.
    pub fn new(meter: &Meter) -> Self {
        Self::with_given(Given::default(), meter)
    }

    /// Returns a loader that takes data in memory in place of files of their names.
    pub fn with_given(given: Given, meter: &Meter) -> Self {
        Self { known: BTreeMap::new(), given, meter: meter.clone() }
    }

    /// Returns the rectangle that a file itself says it covers, in world units: that of a grid without
    /// `bounds`.
    ///
    /// # Errors
    /// Fails when the file is of no use.
    pub fn own_place(&mut self, file: &RasterFile) -> Result<Option<OwnPlace>, ReadError> {
        if let Some(grid) = self.given.grid(&file.path) {
            let place =
                || OwnPlace { rect: grid.raster.raster().bounds(), coordinates: Some(grid.coordinates) };
            return Ok(file.bounds.is_none().then(place));
        }
        match (file.format.read(), file.bounds) {
            (ReadRaster::Grid(read), None) => {
                let read = |meter: &Meter| Ok(read(&file.path, &GridPlace::default(), meter)?.into());
                let loaded = self.read_once::<ReadError>((file.path.clone(), false), read)?;
                Ok(Some(OwnPlace { rect: loaded.raster.raster().bounds(), coordinates: loaded.coordinates }))
            }
            (ReadRaster::Grid(_), Some(_)) | (ReadRaster::Array(_) | ReadRaster::Image(_), _) => Ok(None),
        }
    }

    /// Returns the raster of a file, in which risks are from 0 to 1 and diameters are positive. Pixels
    /// without a value are NaN.
    ///
    /// # Errors
    /// Fails when the file cannot be read, or a value is not valid.
    pub fn load(
        &mut self,
        file: &RasterFile,
        values: RasterValues,
        frame: &RasterFrame,
    ) -> Result<LoadedRaster, RasterError> {
        let LoadedRaster { raster, facts, coordinates } = self.pixels(file, values, frame)?;
        if values == RasterValues::Diameter && !file.format.is_grid() {
            return Ok(LoadedRaster::new(diameters(raster.raster(), &frame.transfer), facts));
        }
        let named = |problem| RasterError::Value(format!("{}: {problem}", file.path.display()));
        check_values(&raster, values).map_err(named)?;
        Ok(LoadedRaster { raster, facts, coordinates })
    }

    /// Returns the values of a file, before the layer interprets them.
    fn pixels(
        &mut self,
        RasterFile { path, format, bounds }: &RasterFile,
        values: RasterValues,
        frame: &RasterFrame,
    ) -> Result<LoadedRaster, RasterError> {
        if let Some(grid) = self.given.grid(path) {
            return Ok(LoadedRaster {
                raster: placed(grid, *bounds, frame, path)?,
                facts: grid.facts.clone(),
                coordinates: bounds.is_none().then_some(grid.coordinates),
            });
        }
        match (format.read(), bounds) {
            (ReadRaster::Grid(read), None) => self.read_once((path.clone(), false), |meter| {
                let place = GridPlace { over: None, window: frame.window() };
                let mut grid = read(path, &place, meter)?;
                let Some(plane) = &frame.plane else { return Ok(grid.into()) };
                let (facts, coordinates) = (std::mem::take(&mut grid.facts), grid.coordinates());
                let raster = grid_in_plane(grid, plane, frame, path)?;
                Ok(LoadedRaster { coordinates: Some(coordinates), ..LoadedRaster::new(raster, facts) })
            }),
            (ReadRaster::Grid(read), over @ Some(_)) => {
                let place = GridPlace { over: *over, window: None };
                let FileGrid { raster, facts, .. } = read(path, &place, &self.meter)?;
                Ok(LoadedRaster::new(raster, facts))
            }
            (ReadRaster::Array(read), Some(place)) => {
                let FileGrid { raster, facts, .. } = read(path, *place, &self.meter)?;
                Ok(LoadedRaster::new(raster, facts))
            }
            (ReadRaster::Array(read), None) => self.read_once((path.clone(), false), |meter| {
                let FileGrid { raster, facts, .. } = read(path, frame.domain, meter)?;
                Ok(LoadedRaster::new(raster, facts))
            }),
            (ReadRaster::Image(read), _) => {
                let behind = if values == RasterValues::Risk { Behind::Black } else { Behind::White };
                let place = bounds.unwrap_or(frame.domain);
                let read = |meter: &Meter| {
                    let raster = read(path, place, behind, meter)?;
                    Ok(LoadedRaster::new(raster, ValueFacts::default()))
                };
                match bounds {
                    Some(_) => read(&self.meter),
                    None => self.read_once((path.clone(), behind == Behind::Black), read),
                }
            }
        }
    }

    fn read_once<E>(
        &mut self,
        key: (PathBuf, bool),
        read: impl FnOnce(&Meter) -> Result<LoadedRaster, E>,
    ) -> Result<LoadedRaster, E> {
        if let Some(raster) = self.known.get(&key) {
            return Ok(raster.clone());
        }
        let loaded = read(&self.meter)?;
        self.known.insert(key, loaded.clone());
        Ok(loaded)
    }
}

/// Returns a grid in memory where a document wants it.
fn placed(
    GivenGrid { raster, coordinates, .. }: &GivenGrid,
    bounds: Option<Rect>,
    frame: &RasterFrame,
    path: &Path,
) -> Result<Arc<RasterPyramid>, RasterError> {
    let grid = raster.raster();
    let moved = match (bounds, &frame.plane) {
        (Some(bounds), _) => Raster::from_values(bounds, grid.size(), grid.values().to_vec()),
        (None, None) => return Ok(raster.clone()),
        (None, Some(plane)) => match in_plane(grid, coordinates, None, plane, frame, path)? {
            Some(projected) => projected,
            None => return Ok(raster.clone()),
        },
    };
    Ok(Arc::new(RasterPyramid::new(moved)))
}

/// Returns the grid of a file in the plane of a document, as far as it covers the wanted area there.
fn grid_in_plane(
    grid: FileGrid,
    plane: &DocumentPlane,
    frame: &RasterFrame,
    path: &Path,
) -> Result<Raster, RasterError> {
    let coordinates = grid.coordinates();
    let system = grid.system.as_ref().and_then(|system| system.name.as_deref());
    Ok(in_plane(&grid.raster, &coordinates, system, plane, frame, path)?.unwrap_or(grid.raster))
}

/// Returns a grid in the plane of a document, as far as it covers the wanted area there; `None` where it is
/// in that plane. `system` is the name of its coordinate system, if it has one.
fn in_plane(
    grid: &Raster,
    coordinates: &FileCoordinates,
    system: Option<&str>,
    plane: &DocumentPlane,
    frame: &RasterFrame,
    path: &Path,
) -> Result<Option<Raster>, RasterError> {
    let area = frame.wanted.unwrap_or(frame.domain);
    let named = |problem: &dyn Display| RasterError::Value(format!("{}: {problem}", path.display()));
    if let Some(reprojection) = plane.reprojection(coordinates) {
        if reprojection.is_identity() {
            return Ok(None);
        }
        let projected = resampled_raster(grid, &reprojection, area, frame.resampling);
        return projected.map(Some).map_err(|error| named(&error));
    }
    let system =
        system.map_or("no coordinate system that is known here".to_owned(), |name| format!("“{name}”"));
    Err(named(&format_args!(
        "its coordinates are in {system}, and the document is in the plane {}. Say what they are with a .prj file \
         beside it, or convert it to longitudes and latitudes first, for example with gdalwarp -t_srs EPSG:4326.",
        plane.projection
    )))
}

/// Grey as length: linear from `h_min` (black) to `h_max` (white).
fn diameters(grey: &Raster, transfer: &Transfer) -> Raster {
    let Transfer { h_min, h_max, .. } = *transfer;
    let length = |&value: &f32| f32_not_below(h_min + f64::from(value) * (h_max - h_min));
    Raster::from_values(grey.bounds(), grey.size(), grey.values().iter().map(length).collect())
}

//! Data in memory, in place of files: settings name them as they name files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{FileCoordinates, ValueFacts};
use meshbrush_core::raster::RasterPyramid;

/// Data in memory by the names that settings give them. Copies share the data.
#[derive(Clone, Debug, Default)]
pub struct Given {
    shapes: BTreeMap<PathBuf, Arc<[u8]>>,
    grids: BTreeMap<PathBuf, GivenGrid>,
}

/// A grid in memory.
#[derive(Clone, Debug)]
pub struct GivenGrid {
    /// The values, where they lie. Pixels without a value are NaN.
    pub raster: Arc<RasterPyramid>,
    /// What the coordinates of its place are.
    pub coordinates: FileCoordinates,
    /// What is known about its values.
    pub facts: ValueFacts,
}

impl Given {
    /// Adds polygons, lines or points, as the text of a GeoJSON file.
    pub fn add_shapes(&mut self, name: PathBuf, geojson: Vec<u8>) {
        self.shapes.insert(name, geojson.into());
    }

    /// Adds a grid. Its name ends as that of a raster that has any values, as in `depth.npy`.
    pub fn add_grid(&mut self, name: PathBuf, grid: GivenGrid) {
        self.grids.insert(name, grid);
    }

    /// Returns whether there are data of this name.
    pub fn has(&self, name: &Path) -> bool {
        self.shapes.contains_key(name) || self.grids.contains_key(name)
    }

    /// Returns the text of a GeoJSON file.
    pub fn shapes(&self, name: &Path) -> Option<&[u8]> {
        self.shapes.get(name).map(|text| &**text)
    }

    /// Returns a grid.
    pub fn grid(&self, name: &Path) -> Option<&GivenGrid> {
        self.grids.get(name)
    }
}

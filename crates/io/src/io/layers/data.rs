//! The data that layers name, from files or from the parts of a project.

use std::path::Path;

use super::{GridKeys, LoadedRaster};
use crate::io::{KeyFault, ValueFacts};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{Mask, RasterSource, ShapeList, Shapes, Threat, Threats};
use meshbrush_core::raster::RasterValues;
use meshbrush_mesh::text::abridged;

/// A sentence that says why the data of a layer cannot be used, with the name of the layer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", abridged(_0))]
pub struct TextError(pub String);

/// Where the data of a layer are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// In files, or in place.
    InFiles,
    /// In the project that the layer belongs to: pixels and paint in parts, everything else in place. `file`
    /// is only a name for a person.
    InProject,
}

/// The source of the data that layers name: files, or the parts of a project.
pub trait LayerData {
    /// Why data could not be read, or a value cannot be used.
    type Error: From<KeyFault> + From<TextError>;

    /// Which of the two it is.
    const STORED: Stored;

    /// Returns the pixels of a layer, as it reads them: risks are from 0 to 1, and diameters positive.
    ///
    /// # Errors
    /// Fails when they cannot be read, or a value is not valid.
    fn raster(
        &mut self,
        origin: &LayerOrigin,
        grid: &GridKeys,
        values: RasterValues,
    ) -> Result<LoadedRaster, Self::Error>;

    /// Takes a sentence for a person about data that were read.
    fn note(&mut self, sentence: String) {
        let _ = sentence;
    }

    /// Returns the threats of a layer whose threats are not in place.
    ///
    /// # Errors
    /// Fails when they cannot be read, or one cannot be used.
    fn threats(&mut self, origin: &LayerOrigin) -> Result<Threats, Self::Error>;

    /// Returns the points, lines and polygons of a layer whose shapes are not in place.
    ///
    /// # Errors
    /// Fails when they cannot be read, or there is no distance to them.
    fn shapes(&mut self, origin: &LayerOrigin) -> Result<Shapes, Self::Error>;

    /// Returns the mask of a layer whose mask is not in place: that of `file`, where masks are in files.
    ///
    /// # Errors
    /// Fails when it cannot be read, or masks nothing.
    fn mask(&mut self, origin: &LayerOrigin, file: &Path) -> Result<Mask, Self::Error>;
}

/// Which layer data belong to.
#[derive(Clone, Copy, Debug)]
pub struct LayerOrigin<'l> {
    /// The name of the layer.
    pub name: &'l str,
    /// The file with its data; empty without one.
    pub file: &'l Path,
}

impl LayerOrigin<'_> {
    /// Returns the name of the file without folders, for a person; empty where there is none.
    pub fn file_name(&self) -> String {
        self.file.file_name().unwrap_or(self.file.as_os_str()).to_string_lossy().into_owned()
    }

    /// Returns the raster of the layer, and what the file says about its values.
    pub(super) fn raster<D: LayerData>(
        &self,
        grid: &GridKeys,
        values: RasterValues,
        data: &mut D,
    ) -> Result<(RasterSource, ValueFacts), D::Error> {
        let LoadedRaster { raster, facts, .. } = data.raster(self, grid, values)?;
        facts.notes.iter().for_each(|note| data.note(format!("{}: {note}", self.file_name())));
        Ok((RasterSource { name: self.file_name(), raster }, facts))
    }

    /// Returns threats with an index.
    ///
    /// # Errors
    /// Fails with the first threat that cannot be used.
    pub fn indexed_threats(&self, list: Vec<Threat>) -> Result<Threats, TextError> {
        Threats::new(list).map_err(|(number, error)| {
            self.error(format_args!("threat {} cannot be used. {error}", number + 1))
        })
    }

    /// Returns shapes with an index. Polygons are filled: the distance within them is 0.
    ///
    /// # Errors
    /// Fails when there is no distance to them.
    pub fn indexed_shapes(&self, list: ShapeList) -> Result<Shapes, TextError> {
        Shapes::new(list, true).map_err(|error| self.error(error))
    }

    /// Returns the mask of polygons.
    ///
    /// # Errors
    /// Fails when they are no mask.
    pub fn mask_of_polygons(&self, polygons: &[Polygon]) -> Result<Mask, TextError> {
        Mask::new(polygons).map_err(|error| self.error(format_args!("its mask cannot be used. {error}")))
    }

    /// Returns an error with the name of the layer.
    pub fn error(&self, problem: impl std::fmt::Display) -> TextError {
        TextError(format!("The layer “{}”: {problem}", self.name))
    }
}

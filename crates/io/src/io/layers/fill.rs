//! From the keys of a layer to a layer of a stack, with the data that they name.

use std::path::Path;
use std::sync::Arc;

use super::{LoadedRaster, SavedLayer, SharedKeys};
use crate::io::{KeyFault, ValueFacts};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{
    DepthSizes, Layer, LayerId, LayerKind, Mask, PositiveDepth, RasterSource, ShapeList, Shapes, Surface,
    SurfaceSource, Threat, Threats,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::text::abridged;

/// Returns a layer of depths whose values grow in this direction, and a surface of heights, where the file of
/// either says the direction; other layers as they are.
pub fn in_direction(kind: LayerKind, positive: Option<PositiveDepth>) -> LayerKind {
    match (kind, positive) {
        (LayerKind::Depth(depths), Some(positive)) => {
            let sizes = DepthSizes { positive, ..*depths.sizes() };
            LayerKind::Depth(depths.with_sizes(sizes))
        }
        (LayerKind::Surface(surface), Some(PositiveDepth::Down)) => {
            let source = match surface.source {
                SurfaceSource::Raster(source) => SurfaceSource::Raster(heights(source)),
                formula @ SurfaceSource::Formula(_) => formula,
            };
            LayerKind::Surface(Surface { source, ..surface })
        }
        (kind, _) => kind,
    }
}

/// Returns depths as heights.
fn heights(source: RasterSource) -> RasterSource {
    let depths = source.raster.raster();
    let heights = depths.values().iter().map(|&depth| 0.0 - depth).collect();
    let raster = Raster::from_values(depths.bounds(), depths.size(), heights);
    RasterSource { raster: Arc::new(RasterPyramid::new(raster)), ..source }
}

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
    fn raster(&mut self, layer: &SavedLayer) -> Result<LoadedRaster, Self::Error>;

    /// Takes a sentence for a person about data that were read.
    fn note(&mut self, sentence: String) {
        let _ = sentence;
    }

    /// Returns the threats of a layer whose threats are not in place.
    ///
    /// # Errors
    /// Fails when they cannot be read, or one cannot be used.
    fn threats(&mut self, layer: &SavedLayer) -> Result<Threats, Self::Error>;

    /// Returns the points, lines and polygons of a layer whose shapes are not in place.
    ///
    /// # Errors
    /// Fails when they cannot be read, or there is no distance to them.
    fn shapes(&mut self, layer: &SavedLayer) -> Result<Shapes, Self::Error>;

    /// Returns the mask of a layer whose mask is not in place: that of `file`, where masks are in files.
    ///
    /// # Errors
    /// Fails when it cannot be read, or masks nothing.
    fn mask(&mut self, layer: &SavedLayer, file: &Path) -> Result<Mask, Self::Error>;
}

impl SavedLayer {
    /// Returns the layer, with its data. Polygons are filled: the distance within them is 0. What is painted
    /// is not part of a layer.
    ///
    /// # Errors
    /// Fails with the errors of `data`; when a value cannot be used; and a sentence that names the layer when
    /// its data cannot be used.
    pub fn load<D: LayerData>(&self, id: LayerId, data: &mut D) -> Result<Layer, D::Error> {
        self.check(D::STORED)?;
        let kind = self.keys.load(self, data)?;
        let SharedKeys { visible, locked, combine, .. } = self.shared;
        let mask = self.loaded_mask(data)?;
        let (name, combine) = (self.shown_name().to_owned(), combine.into());
        Ok(Layer { id, name, visible, locked, combine, mask, kind })
    }

    /// Returns its raster, and what the file says about its values.
    pub(super) fn raster_source<D: LayerData>(
        &self,
        data: &mut D,
    ) -> Result<(RasterSource, ValueFacts), D::Error> {
        let LoadedRaster { raster, facts, .. } = data.raster(self)?;
        facts.notes.iter().for_each(|note| data.note(format!("{}: {note}", self.file_name())));
        Ok((RasterSource { name: self.file_name(), raster }, facts))
    }

    fn loaded_mask<D: LayerData>(&self, data: &mut D) -> Result<Option<Mask>, D::Error> {
        match (self.mask_in_place()?, &self.shared.mask_file) {
            (Some(polygons), _) => Ok(Some(self.mask_of_polygons(&polygons)?)),
            (None, Some(file)) => data.mask(self, file).map(Some),
            (None, None) => Ok(None),
        }
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

    /// Returns shapes with an index.
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
        TextError(format!("The layer “{}”: {problem}", self.shown_name()))
    }
}

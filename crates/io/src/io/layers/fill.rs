//! From the keys of a layer to a layer of a stack, with the data that they name.

use std::path::Path;
use std::sync::Arc;

use super::SavedLayer;
use super::check_layer::{CheckedKind, CheckedShapes, Growth, Stored};
use crate::io::KeyFault;
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{
    Depths, DistanceTo, Layer, LayerId, LayerKind, Mask, RasterSource, ShapeList, Shapes, Surface,
    SurfaceSource, Threat, Threats,
};
use meshbrush_core::raster::RasterPyramid;
use meshbrush_mesh::text::abridged;

/// A sentence that says why the data of a layer cannot be used, with the name of the layer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", abridged(_0))]
pub struct TextError(pub String);

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
    fn raster(&mut self, layer: &SavedLayer) -> Result<Arc<RasterPyramid>, Self::Error>;

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
        let kind = match self.checked(D::STORED)? {
            CheckedKind::Complete(kind) => kind,
            CheckedKind::Raster(reading) => LayerKind::Raster { source: self.source(data)?, reading },
            CheckedKind::Threats(Some(list)) => LayerKind::Threats(self.indexed_threats(list)?),
            CheckedKind::Threats(None) => LayerKind::Threats(data.threats(self)?),
            CheckedKind::Distance(to, Growth { at_zero, slope, range }) => {
                let to = match self.target_of(to, data)? {
                    Ok(shapes) => DistanceTo::Shapes { name: self.file_name(), shapes },
                    Err(boundary) => boundary,
                };
                LayerKind::Distance { to, at_zero, slope, range }
            }
            CheckedKind::Corridor(along, Growth { at_zero, slope, range }, width) => {
                let to = match self.target_of(along, data)? {
                    Ok(lines) => DistanceTo::Corridor { lines, width },
                    Err(boundary) => boundary,
                };
                LayerKind::Distance { to, at_zero, slope, range }
            }
            CheckedKind::Band(between, diameter) => {
                LayerKind::Band { source: self.source(data)?, between, diameter }
            }
            CheckedKind::Surface(goal, norm) => {
                let source = SurfaceSource::Raster(self.source(data)?);
                LayerKind::Surface(Surface { source, goal, norm })
            }
            CheckedKind::Depth(sizes) => LayerKind::Depth(Depths::new(self.source(data)?, sizes)),
        };
        let (visible, locked, combine) = (self.visible, self.locked, self.combine.into());
        let mask = self.loaded_mask(data)?;
        Ok(Layer { id, name: self.shown_name().to_owned(), visible, locked, combine, mask, kind })
    }

    /// Returns the file with its data; empty without one.
    pub fn path(&self) -> &Path {
        self.file.as_deref().unwrap_or(Path::new(""))
    }

    fn source<D: LayerData>(&self, data: &mut D) -> Result<RasterSource, D::Error> {
        Ok(RasterSource { name: self.file_name(), raster: data.raster(self)? })
    }

    /// Returns the shapes of a distance, or the boundary of the domain that it is to.
    fn target_of<D: LayerData>(
        &self,
        to: CheckedShapes,
        data: &mut D,
    ) -> Result<Result<Shapes, DistanceTo>, D::Error> {
        match to {
            CheckedShapes::Boundary(to) => Ok(Err(to)),
            CheckedShapes::File => data.shapes(self).map(Ok),
            CheckedShapes::InPlace(list) => Ok(Ok(self.indexed_shapes(list)?)),
        }
    }

    fn loaded_mask<D: LayerData>(&self, data: &mut D) -> Result<Option<Mask>, D::Error> {
        match (self.mask_in_place()?, &self.mask_file) {
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

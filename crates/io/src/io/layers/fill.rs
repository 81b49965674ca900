//! From the keys of a layer to a layer of a stack, with the data that they name.

use std::path::Path;
use std::sync::Arc;

use super::check_layer::{CheckedKind, CheckedShapes, Growth, Stored};
use super::{LoadedRaster, SavedLayer};
use crate::io::{KeyFault, ValueFacts, ValueUnit};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{
    BandLayer, DepthSizes, Depths, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, Mask, PositiveDepth,
    RasterLayer, RasterSource, ShapeList, Shapes, Surface, SurfaceSource, Threat, Threats,
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
        let kind = match self.checked(D::STORED)? {
            CheckedKind::Complete(kind) => kind,
            CheckedKind::Raster(reading) => {
                LayerKind::Raster(RasterLayer { source: self.source(data)?.0, reading })
            }
            CheckedKind::Threats(Some(list)) => LayerKind::Threats(self.indexed_threats(list)?),
            CheckedKind::Threats(None) => LayerKind::Threats(data.threats(self)?),
            CheckedKind::Distance(to, Growth { at_zero, slope, range }) => {
                let to = match self.target_of(to, data)? {
                    Ok(shapes) => DistanceTo::Shapes { name: self.file_name(), shapes },
                    Err(boundary) => boundary,
                };
                LayerKind::Distance(DistanceLayer { to, at_zero, slope, range })
            }
            CheckedKind::Corridor(along, Growth { at_zero, slope, range }, width) => {
                let to = match self.target_of(along, data)? {
                    Ok(lines) => DistanceTo::Corridor { lines, width },
                    Err(boundary) => boundary,
                };
                LayerKind::Distance(DistanceLayer { to, at_zero, slope, range })
            }
            CheckedKind::Band(between, diameter) => {
                LayerKind::Band(BandLayer { source: self.source(data)?.0, between, diameter })
            }
            CheckedKind::Surface(goal, norm) => {
                let (source, facts) = self.source(data)?;
                let source = SurfaceSource::Raster(source);
                in_direction(LayerKind::Surface(Surface { source, goal, norm }), facts.positive)
            }
            CheckedKind::Depth(sizes) => {
                let (source, facts) = self.source(data)?;
                let positive = self.direction(&facts, data).unwrap_or(sizes.positive);
                LayerKind::Depth(Depths::new(source, DepthSizes { positive, ..sizes }))
            }
        };
        let (visible, locked, combine) = (self.visible, self.locked, self.combine.into());
        let mask = self.loaded_mask(data)?;
        Ok(Layer { id, name: self.shown_name().to_owned(), visible, locked, combine, mask, kind })
    }

    /// Returns the file with its data; empty without one.
    pub fn path(&self) -> &Path {
        self.file.as_deref().unwrap_or(Path::new(""))
    }

    fn source<D: LayerData>(&self, data: &mut D) -> Result<(RasterSource, ValueFacts), D::Error> {
        let LoadedRaster { raster, facts, .. } = data.raster(self)?;
        facts.notes.iter().for_each(|note| data.note(format!("{}: {note}", self.file_name())));
        Ok((RasterSource { name: self.file_name(), raster }, facts))
    }

    /// Returns the direction in which depths grow, as the file says it where the layer does not, and tells a
    /// person what does not suit depths.
    fn direction<D: LayerData>(&self, facts: &ValueFacts, data: &mut D) -> Option<PositiveDepth> {
        if let ValueUnit::Other(unit) = &facts.unit {
            let problem = "its values are taken as metres, and it says that their unit is";
            data.note(format!("{}: {problem} “{unit}”.", self.file_name()));
        }
        let own = facts.positive?;
        let given = self.positive.map(PositiveDepth::from);
        if given.is_some_and(|given| given != own) {
            let [said, other] = match own {
                PositiveDepth::Down => ["depths, positive downwards", "heights"],
                PositiveDepth::Up => ["heights, positive upwards", "depths"],
            };
            data.note(format!(
                "{}: its values are taken as {other}, as `positive` says; the file says that they are {said}.",
                self.file_name()
            ));
        }
        given.or(Some(own))
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

//! From a checked text to a layer of a stack, with the data that the text names.

use std::path::Path;
use std::sync::Arc;

use super::RasterReading as ReadAs;
use super::spec::{DistanceTo as To, KindSpec, LayerSpec, MaskSpec, RasterFile, ShapeSpec, ThreatsSpec};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{
    DistanceTo, Layer, LayerId, LayerKind, Mask, RasterReading, RasterSource, ShapeList, Shapes, Threat,
    Threats, ValueCurve,
};
use meshbrush_core::raster::RasterPyramid;
use meshbrush_mesh::text::abridged;

/// A sentence that says why the data of a layer cannot be used, with the name of the layer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", abridged(_0))]
pub struct TextError(pub String);

/// Where the data are that layers name: files, or the parts of a project.
pub trait LayerData {
    /// Why data could not be read.
    type Error: From<TextError>;

    /// The pixels of a raster, as the layer reads them: risks are from 0 to 1, and diameters positive.
    ///
    /// # Errors
    /// When they cannot be read, or a value is not valid.
    fn raster(&mut self, layer: &LayerSpec, file: &RasterFile) -> Result<Arc<RasterPyramid>, Self::Error>;

    /// The threats of a table.
    ///
    /// # Errors
    /// When they cannot be read.
    fn threats(&mut self, file: &Path) -> Result<Vec<Threat>, Self::Error>;

    /// Points, lines and polygons.
    ///
    /// # Errors
    /// When they cannot be read.
    fn shapes(&mut self, file: &Path) -> Result<ShapeList, Self::Error>;

    /// Polygons alone.
    ///
    /// # Errors
    /// When they cannot be read.
    fn polygons(&mut self, file: &Path) -> Result<Vec<Polygon>, Self::Error>;
}

impl LayerSpec {
    /// The layer, with its data. Polygons are filled: the distance within them is 0. What is painted is not
    /// part of a layer.
    ///
    /// # Errors
    /// Errors of `data`, and a sentence that names the layer when its data cannot be used.
    pub fn load<D: LayerData>(&self, id: LayerId, data: &mut D) -> Result<Layer, D::Error> {
        let kind = match &self.kind {
            KindSpec::Paint { quantity, .. } => LayerKind::Paint(*quantity),
            KindSpec::Formula { quantity, formula } => {
                LayerKind::Formula { quantity: *quantity, formula: formula.clone() }
            }
            KindSpec::Raster { raster, reading } => {
                LayerKind::Raster { source: self.source(raster, data)?, reading: self.reading(reading)? }
            }
            KindSpec::Threats(threats) => {
                let list = match threats {
                    ThreatsSpec::File(file) => data.threats(file)?,
                    ThreatsSpec::List(list) => list.clone(),
                };
                let threats = Threats::new(list);
                LayerKind::Threats(threats.map_err(|(number, error)| {
                    self.error(format_args!("threat {} cannot be used. {error}", number + 1))
                })?)
            }
            KindSpec::Distance { to, at_zero, slope, range } => LayerKind::Distance {
                to: self.distance_to(to, data)?,
                at_zero: *at_zero,
                slope: *slope,
                range: range.unwrap_or(f64::INFINITY),
            },
            KindSpec::Band { raster, between, diameter } => {
                let source = self.source(raster, data)?;
                LayerKind::Band { source, between: *between, diameter: *diameter }
            }
        };
        let (visible, locked, combine) = (self.visible, self.locked, self.combine);
        let mask = self.mask(data)?;
        Ok(Layer { id, name: self.name.clone(), visible, locked, combine, mask, kind })
    }

    fn source<D: LayerData>(&self, file: &RasterFile, data: &mut D) -> Result<RasterSource, D::Error> {
        let name = file.path.file_name().unwrap_or(file.path.as_os_str());
        let name = name.to_string_lossy().into_owned();
        Ok(RasterSource { name, raster: data.raster(self, file)? })
    }

    fn reading(&self, reading: &ReadAs) -> Result<RasterReading, TextError> {
        Ok(match reading {
            ReadAs::Risk => RasterReading::Risk,
            ReadAs::Diameter => RasterReading::Diameter,
            ReadAs::Curve(knots) => {
                let curve = ValueCurve::new(knots.clone()).map_err(|error| self.error(error))?;
                RasterReading::Curve(Arc::new(curve))
            }
        })
    }

    fn distance_to<D: LayerData>(&self, to: &To, data: &mut D) -> Result<DistanceTo, D::Error> {
        let (name, list) = match to {
            To::Outline => return Ok(DistanceTo::Outline),
            To::Corridor { along, width } => {
                return Ok(match self.distance_to(along, data)? {
                    DistanceTo::Shapes { shapes: lines, .. } => DistanceTo::Corridor { lines, width: *width },
                    other => other,
                });
            }
            To::File(file) => {
                let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
                (name, data.shapes(file)?)
            }
            To::Shapes { name, shapes } => (name.clone(), list_of(shapes)),
        };
        let shapes = Shapes::new(list, true).map_err(|error| self.error(error))?;
        Ok(DistanceTo::Shapes { name, shapes })
    }

    fn mask<D: LayerData>(&self, data: &mut D) -> Result<Option<Mask>, D::Error> {
        let polygons = match &self.mask {
            None => return Ok(None),
            Some(MaskSpec::File(file)) => data.polygons(file)?,
            Some(MaskSpec::Polygons(polygons)) => polygons.clone(),
        };
        let mask = Mask::new(&polygons);
        Ok(Some(mask.map_err(|error| self.error(format_args!("its mask cannot be used. {error}")))?))
    }

    /// An error with the name of the layer.
    pub fn error(&self, problem: impl std::fmt::Display) -> TextError {
        TextError(format!("The layer “{}”: {problem}", self.name))
    }
}

fn list_of(shapes: &[ShapeSpec]) -> ShapeList {
    let mut list = ShapeList::default();
    for shape in shapes {
        match shape {
            ShapeSpec::Point(point) => list.points.push(*point),
            ShapeSpec::Line(line) => list.lines.push(line.clone()),
            ShapeSpec::Polygon(polygon) => list.polygons.push(polygon.clone()),
        }
    }
    list
}

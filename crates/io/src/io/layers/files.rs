//! The data of layers in files, as recipes and options name them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::png::Behind;
use super::super::{Meter, ReadError, asc, geojson, png, project, shapes, threats};
use super::{
    KindSpec, LayerData, LayerSpec, RasterFile, RasterFormat, RasterReading as ReadAs, TextError,
    check_values,
};
use meshbrush_core::document::Document;
use meshbrush_core::domain::Polygon;
use meshbrush_core::field::{Transfer, f32_not_below};
use meshbrush_core::layers::{LayerId, PaintLayers, ShapeList, Threat};
use meshbrush_core::raster::{Raster, RasterPyramid, TiledRaster};
use meshbrush_mesh::geometry::Rect;

/// Why the data of a layer cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LayerError {
    /// A file is of no use.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The data do not suit the layer.
    #[error(transparent)]
    Unsuited(#[from] TextError),
}

/// The rasters that say which rectangle they cover; the domain may depend on them.
#[derive(Debug)]
pub struct GridFiles(BTreeMap<PathBuf, Arc<RasterPyramid>>);

impl GridFiles {
    /// Reads those that layers name. The meter counts the bytes of each file.
    ///
    /// # Errors
    /// When a file is of no use, and when the work was cancelled.
    pub fn read<'a>(layers: impl Iterator<Item = &'a LayerSpec>, meter: &Meter) -> Result<Self, ReadError> {
        let mut grids = BTreeMap::new();
        for RasterFile { path, format, bounds } in layers.filter_map(LayerSpec::raster_file) {
            if *format == RasterFormat::Asc && bounds.is_none() && !grids.contains_key(path) {
                grids.insert(path.clone(), Arc::new(RasterPyramid::new(asc::read_metered(path, meter)?)));
            }
        }
        Ok(Self(grids))
    }

    /// The smallest rectangle that holds those of some layers, if they have any.
    pub fn extent<'a>(&self, layers: impl Iterator<Item = &'a LayerSpec>) -> Option<Rect> {
        let without_place = layers.filter_map(LayerSpec::raster_file).filter(|file| file.bounds.is_none());
        let grids = without_place.filter_map(|file| self.0.get(&file.path));
        grids.map(|grid| grid.raster().bounds()).reduce(|a, b| a.union(&b))
    }
}

/// Reads the files that layers name, each once.
#[derive(Debug)]
pub struct LayerFiles {
    grids: GridFiles,
    /// By file and whether transparent pixels are black, where the image covers the domain.
    images: BTreeMap<(PathBuf, bool), Arc<RasterPyramid>>,
    projects: BTreeMap<PathBuf, Document>,
    /// What an image without a place covers, in world units.
    domain: Rect,
    /// The scale of images that are diameters.
    transfer: Transfer,
    meter: Meter,
}

impl LayerFiles {
    /// Images without a place cover `domain`, in world units; those of diameters have the scale of
    /// `transfer`. The meter counts the bytes of each file.
    pub fn new(grids: GridFiles, domain: Rect, transfer: Transfer, meter: &Meter) -> Self {
        let (images, projects) = (BTreeMap::new(), BTreeMap::new());
        Self { grids, images, projects, domain, transfer, meter: meter.clone() }
    }

    /// Adds the paint of a layer, if that is a paint layer, to `paint`.
    ///
    /// # Errors
    /// When the project cannot be read, or has no such layer.
    pub fn add_paint(
        &mut self,
        layer: &LayerSpec,
        id: LayerId,
        paint: &mut PaintLayers,
    ) -> Result<(), LayerError> {
        let KindSpec::Paint { quantity, from: Some((path, name)) } = &layer.kind else { return Ok(()) };
        if !self.projects.contains_key(path) {
            self.projects.insert(path.clone(), project::read_metered(path, &self.meter)?);
        }
        let document = &self.projects[path];
        let layers = &document.settings().layers;
        let is_meant =
            |other: &&meshbrush_core::layers::Layer| other.name == *name && other.paints().is_some();
        let Some(stored) = layers.iter().find(is_meant) else {
            let known: Vec<String> =
                layers.iter().filter(|l| l.paints().is_some()).map(|l| format!("“{}”", l.name)).collect();
            let there = match known.is_empty() {
                true => "has none".to_owned(),
                false => format!("has {}", known.join(", ")),
            };
            let file = path.display();
            return Err(layer.error(format_args!("{file} has no paint layer “{name}”; it {there}.")).into());
        };
        if stored.paints() != Some(*quantity) {
            let file = path.display();
            let problem = format_args!("what is painted on “{name}” in {file} is not of this `quantity`.");
            return Err(layer.error(problem).into());
        }
        let raster: Option<TiledRaster> = document.paint().get(stored.id).cloned();
        raster.into_iter().for_each(|raster| paint.insert(id, raster));
        Ok(())
    }

    /// The values of a file, before the layer interprets them.
    fn values(
        &mut self,
        RasterFile { path, format, bounds }: &RasterFile,
        behind: Behind,
    ) -> Result<Arc<RasterPyramid>, LayerError> {
        let key = (path.clone(), behind == Behind::Black);
        let known = self.grids.0.get(path).or_else(|| self.images.get(&key));
        if bounds.is_none()
            && let Some(raster) = known
        {
            return Ok(raster.clone());
        }
        let place = bounds.unwrap_or(self.domain);
        let raster = match format {
            RasterFormat::Asc => {
                let grid = asc::read_metered(path, &self.meter)?;
                Raster::from_values(place, grid.size(), grid.values().to_vec())
            }
            _ => png::read_metered(path, place, behind, &self.meter)?,
        };
        let raster = Arc::new(RasterPyramid::new(raster));
        if bounds.is_none() {
            self.images.insert(key, raster.clone());
        }
        Ok(raster)
    }
}

impl LayerData for LayerFiles {
    type Error = LayerError;

    fn raster(&mut self, layer: &LayerSpec, file: &RasterFile) -> Result<Arc<RasterPyramid>, LayerError> {
        let behind = if layer.is_risk() { Behind::Black } else { Behind::White };
        let values = self.values(file, behind)?;
        if let KindSpec::Raster { reading: ReadAs::Diameter, .. } = layer.kind
            && file.format == RasterFormat::Png
        {
            return Ok(Arc::new(RasterPyramid::new(diameters(values.raster(), &self.transfer))));
        }
        if let KindSpec::Raster { reading, .. } = &layer.kind {
            let problem = check_values(&values, reading);
            problem.map_err(|problem| layer.error(format_args!("{}: {problem}", file.path.display())))?;
        }
        Ok(values)
    }

    fn threats(&mut self, file: &Path) -> Result<Vec<Threat>, LayerError> {
        Ok(threats::read(file, &self.meter)?)
    }

    fn shapes(&mut self, file: &Path) -> Result<ShapeList, LayerError> {
        Ok(shapes::read(file, &self.meter)?.shapes)
    }

    fn polygons(&mut self, file: &Path) -> Result<Vec<Polygon>, LayerError> {
        Ok(geojson::without_names(geojson::read_named_metered(file, &self.meter)?))
    }
}

/// Grey as length: linear from `h_min` (black) to `h_max` (white).
fn diameters(grey: &Raster, transfer: &Transfer) -> Raster {
    let Transfer { h_min, h_max, .. } = *transfer;
    let length = |&value: &f32| f32_not_below(h_min + f64::from(value) * (h_max - h_min));
    Raster::from_values(grey.bounds(), grey.size(), grey.values().iter().map(length).collect())
}

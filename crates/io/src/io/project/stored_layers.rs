//! The layers of a document in `settings.json`, in the vocabulary of recipes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::super::error::PlacedFlaw;
use super::super::layers::{LayerData, SavedLayer, Stored, TextError};
use super::super::{Flaw, KeyFault};
use super::part_names::PartNames;
use super::settings::{Parts, checked_size, corners, rect};
use meshbrush_core::document::MOST_RASTER_PIXELS;
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{Layer, LayerId, ShapeList, Threat};
use meshbrush_core::raster::{RasterPyramid, check_values};
use meshbrush_mesh::text::Grouped;

/// A layer with its identifier, and the place of its pixels if it reads a raster.
///
/// Threats, shapes and masks are in place. `file` is the name of the file that the data come from, for a
/// person.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredLayer {
    /// Paint is in the part `paint.ID`.
    id: u32,
    layer: SavedLayer,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    raster: Option<StoredRaster>,
}

/// A raster without its pixels.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredRaster {
    /// The part with the pixels. Layers that share a raster name the same part.
    part: String,
    bounds: [f64; 4],
    columns: u32,
    rows: u32,
}

/// Checks the sizes that are declared for all rasters together, before any of them is unpacked.
pub(super) fn check_raster_sizes(layers: &[StoredLayer]) -> Result<(), Flaw> {
    let rasters = layers.iter().filter_map(|layer| layer.raster.as_ref());
    let size = |raster: &StoredRaster| u64::from(raster.columns) * u64::from(raster.rows);
    let pixels: BTreeMap<&str, u64> = rasters.map(|raster| (&raster.part[..], size(raster))).collect();
    let pixels: u64 = pixels.values().fold(0, |sum, pixels| sum.saturating_add(*pixels));
    if pixels > MOST_RASTER_PIXELS {
        return Err(Flaw::Syntax(format!(
            "the rasters of all layers would have {} pixels, and {} are possible in a project. Use another copy.",
            Grouped(pixels as usize),
            Grouped(MOST_RASTER_PIXELS as usize)
        )));
    }
    Ok(())
}

impl StoredLayer {
    pub(super) fn of(layer: &Layer, names: &PartNames) -> Self {
        let raster = layer.kind.raster_source().map(|source| {
            let raster = source.raster.raster();
            let [columns, rows] = raster.size();
            let part = names.of_raster(&source.raster).to_owned();
            StoredRaster { part, bounds: corners(raster.bounds()), columns, rows }
        });
        let file = layer.kind.file_name().map(PathBuf::from);
        Self { id: layer.id.0, layer: SavedLayer::of(layer, file), raster }
    }

    pub(super) fn into_layer(self, parts: &mut impl Parts) -> Result<Layer, PlacedFlaw> {
        let Self { id, layer, raster } = self;
        let checked = layer.checked(Stored::InProject);
        checked.map_err(|fault| {
            let problem = format!("the layer “{}” is not valid. {fault}", layer.shown_name());
            PlacedFlaw::from(Flaw::Syntax(problem))
        })?;
        layer.load(LayerId(id), &mut InProject { parts, raster })
    }
}

/// The data of a layer of a project. Only rasters are parts of their own.
struct InProject<'a, P> {
    parts: &'a mut P,
    raster: Option<StoredRaster>,
}

impl<P: Parts> LayerData for InProject<'_, P> {
    type Error = PlacedFlaw;

    const STORED: Stored = Stored::InProject;

    fn raster(&mut self, layer: &SavedLayer) -> Result<Arc<RasterPyramid>, PlacedFlaw> {
        let stored = self.raster.as_ref();
        let stored = stored.ok_or_else(|| layer.error("its pixels are not part of the project."))?;
        let (bounds, size) = (rect("raster", stored.bounds)?, checked_size([stored.columns, stored.rows])?);
        let raster =
            self.parts.raster(&stored.part, bounds, size).map_err(|PlacedFlaw { place, flaw }| {
                let flaw = match flaw {
                    Flaw::Io(error) => Flaw::Io(error),
                    flaw => Flaw::Syntax(format!(
                        "the pixels of the layer “{}” cannot be read: {flaw}",
                        layer.shown_name()
                    )),
                };
                PlacedFlaw { place, flaw }
            })?;
        if let Some(values) = layer.raster_values() {
            check_values(&raster, values).map_err(|problem| layer.error(problem))?;
        }
        Ok(raster)
    }

    fn threats(&mut self, file: &Path) -> Result<Vec<Threat>, PlacedFlaw> {
        Err(not_in_place(file))
    }

    fn shapes(&mut self, file: &Path) -> Result<ShapeList, PlacedFlaw> {
        Err(not_in_place(file))
    }

    fn polygons(&mut self, file: &Path) -> Result<Vec<Polygon>, PlacedFlaw> {
        Err(not_in_place(file))
    }
}

fn not_in_place(file: &Path) -> PlacedFlaw {
    let problem = "a layer names the file";
    Flaw::Syntax(format!("{problem} {}, and a project holds the data of its layers itself.", file.display()))
        .into()
}

impl From<KeyFault> for PlacedFlaw {
    fn from(fault: KeyFault) -> Self {
        Flaw::Syntax(format!("the settings are not valid: {fault}")).into()
    }
}

impl From<TextError> for PlacedFlaw {
    fn from(TextError(sentence): TextError) -> Self {
        Flaw::Syntax(sentence).into()
    }
}

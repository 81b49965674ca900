//! The layers of a document in `settings.json`, in the vocabulary of recipes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::super::error::PlacedFlaw;
use super::super::layers::{
    GridKeys, LayerData, LayerOrigin, ListsInPlace, LoadedRaster, SavedLayer, Stored, TextError,
};
use super::super::{Flaw, KeyFault};
use super::part_names::{PartData, PartNames};
use super::part_reader::PartReader;
use super::settings::{checked_size, corners, rect};
use meshbrush_core::document::MOST_RASTER_PIXELS;
use meshbrush_core::layers::{Layer, LayerId, Mask, Shapes, Threats};
use meshbrush_core::raster::{RasterValues, check_values};
use meshbrush_mesh::text::Grouped;

/// A layer with its identifier, and the parts with its data.
///
/// `file` is the name of the file that the data come from, for a person.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredLayer {
    /// Paint is in the part `paint.ID`.
    id: u32,
    layer: SavedLayer,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    raster: Option<StoredRaster>,
    /// The parts of shapes, threats and masks that are too long for the layer itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shapes: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    threats: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mask: Option<String>,
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
        let id = layer.id.0;
        let name_of = |data: Option<PartData>| names.of(&data?).map(str::to_owned);
        let raster = layer.kind.raster_source().map(|source| {
            let raster = source.raster.raster();
            let [columns, rows] = raster.size();
            let part = name_of(PartData::raster_of(layer)).unwrap_or_default();
            StoredRaster { part, bounds: corners(raster.bounds()), columns, rows }
        });
        let [shapes, threats] = [PartData::shapes_of(layer), PartData::threats_of(layer)].map(name_of);
        let mask = name_of(layer.mask.as_ref().and_then(PartData::of_mask));
        let file = layer.kind.file_name().map(PathBuf::from);
        let in_place = ListsInPlace { data: shapes.is_none() && threats.is_none(), mask: mask.is_none() };
        let layer = SavedLayer::of(layer, file, in_place);
        Self { id, layer, raster, shapes, threats, mask }
    }

    pub(super) fn into_layer(self, parts: &mut PartReader) -> Result<Layer, PlacedFlaw> {
        let Self { id, mut layer, raster, shapes, threats, mask } = self;
        // As in a recipe, a file stands for data that is elsewhere.
        if shapes.is_some() || threats.is_some() {
            layer.keys.file_key().map(Option::get_or_insert_default);
        }
        if mask.is_some() {
            layer.shared.mask_file.get_or_insert_default();
        }
        let checked = layer.check(Stored::InProject);
        checked.map_err(|fault| {
            let problem = format!("the layer “{}” is not valid. {fault}", layer.shown_name());
            PlacedFlaw::from(Flaw::Syntax(problem))
        })?;
        layer.load(LayerId(id), &mut InProject { parts, raster, shapes, threats, mask })
    }
}

/// The data of a layer of a project, by the names of their parts.
struct InProject<'p, 'b, 'a> {
    parts: &'p mut PartReader<'b, 'a>,
    raster: Option<StoredRaster>,
    shapes: Option<String>,
    threats: Option<String>,
    mask: Option<String>,
}

impl LayerData for InProject<'_, '_, '_> {
    type Error = PlacedFlaw;

    const STORED: Stored = Stored::InProject;

    fn raster(
        &mut self,
        origin: &LayerOrigin,
        _: &GridKeys,
        values: RasterValues,
    ) -> Result<LoadedRaster, PlacedFlaw> {
        let stored = self.raster.as_ref();
        let stored = stored.ok_or_else(|| origin.error("its pixels are not part of the project."))?;
        let (bounds, size) = (rect("raster", stored.bounds)?, checked_size([stored.columns, stored.rows])?);
        let raster = self.parts.raster(&stored.part, bounds, size);
        let raster = raster.map_err(|flaw| of_layer(flaw, origin, "pixels"))?;
        check_values(&raster, values).map_err(|problem| origin.error(problem))?;
        Ok(raster.into())
    }

    fn threats(&mut self, origin: &LayerOrigin) -> Result<Threats, PlacedFlaw> {
        let threats = self.parts.threats(named(self.threats.as_ref(), origin)?);
        threats.map_err(|flaw| of_layer(flaw, origin, "threats"))
    }

    fn shapes(&mut self, origin: &LayerOrigin) -> Result<Shapes, PlacedFlaw> {
        let shapes = self.parts.shapes(named(self.shapes.as_ref(), origin)?);
        shapes.map_err(|flaw| of_layer(flaw, origin, "shapes"))
    }

    fn mask(&mut self, origin: &LayerOrigin, _: &Path) -> Result<Mask, PlacedFlaw> {
        let mask = self.parts.mask(named(self.mask.as_ref(), origin)?);
        mask.map_err(|flaw| of_layer(flaw, origin, "mask"))
    }
}

/// Returns the part with the data of a layer.
fn named<'n>(part: Option<&'n String>, origin: &LayerOrigin) -> Result<&'n str, PlacedFlaw> {
    let missing = || {
        Flaw::Syntax(format!(
            "the layer “{}” names a file, and a project holds the data of its layers itself.",
            origin.name
        ))
    };
    Ok(part.ok_or_else(missing)?)
}

/// Returns the flaw of a part as one of the data of a layer.
fn of_layer(PlacedFlaw { place, flaw }: PlacedFlaw, origin: &LayerOrigin, what: &str) -> PlacedFlaw {
    let flaw = match flaw {
        Flaw::Io(error) => Flaw::Io(error),
        flaw => Flaw::Syntax(format!("the {what} of the layer “{}” cannot be read: {flaw}", origin.name)),
    };
    PlacedFlaw { place, flaw }
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

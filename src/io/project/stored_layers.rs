//! The layers of a document in `settings.json`, in the vocabulary of recipes.

use serde::{Deserialize, Serialize};

use super::super::Flaw;
use super::super::error::PlacedFlaw;
use super::super::layers::{SavedKind, SavedLayer, SavedQuantity};
use super::settings::{Parts, SavedRaster, formula};
use crate::layers::{Combine, Layer, LayerId, LayerKind, Quantity, RasterReading, RasterSource};

/// A layer with its identifier, and the place of its pixels if it is a raster.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredLayer {
    /// Paint is in the part `paint.ID`, the pixels of a raster in the part `raster.ID`.
    id: u32,
    layer: SavedLayer,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    raster: Option<SavedRaster>,
}

impl StoredLayer {
    pub(super) fn of(layer: &Layer) -> Self {
        let raster = match &layer.kind {
            LayerKind::Raster { source, .. } | LayerKind::Band { source, .. } => {
                Some(SavedRaster::of(&source.name, source.raster.raster()))
            }
            _ => None,
        };
        Self { id: layer.id.0, layer: SavedLayer::of(layer, None), raster }
    }

    pub(super) fn into_layer(self, parts: &mut impl Parts) -> Result<Layer, PlacedFlaw> {
        let Self { id, layer: saved, raster } = self;
        let id = LayerId(id);
        let kind = match saved.kind {
            SavedKind::Paint => LayerKind::Paint(quantity(&saved, saved.quantity)?),
            SavedKind::Formula => LayerKind::Formula {
                quantity: quantity(&saved, saved.quantity)?,
                formula: formula("layers", saved.formula.as_deref().unwrap_or_default())?,
            },
            SavedKind::Raster => {
                let stored = raster.ok_or_else(|| missing(&saved, "raster"))?;
                let (bounds, size) = stored.checked()?;
                let reading = match quantity(&saved, saved.read_as)? {
                    Quantity::Risk => RasterReading::Risk,
                    Quantity::Diameter => RasterReading::Diameter,
                };
                let raster = parts.raster(id, bounds, size, &reading)?;
                LayerKind::Raster { source: RasterSource { name: stored.name, raster }, reading }
            }
            SavedKind::Threats | SavedKind::Distance | SavedKind::Band => {
                return Err(missing(&saved, "known kind"));
            }
        };
        let combine = Combine::from(saved.combine);
        let name = saved.name.unwrap_or_else(|| kind.label().into());
        Ok(Layer { id, name, visible: saved.visible, locked: saved.locked, combine, mask: None, kind })
    }
}

fn quantity(layer: &SavedLayer, saved: Option<SavedQuantity>) -> Result<Quantity, PlacedFlaw> {
    saved.map(Quantity::from).ok_or_else(|| missing(layer, "quantity"))
}

fn missing(layer: &SavedLayer, what: &str) -> PlacedFlaw {
    let name = layer.name.as_deref().unwrap_or(layer.kind.word());
    Flaw::Syntax(format!("the layer \"{name}\" has no {what}.")).into()
}

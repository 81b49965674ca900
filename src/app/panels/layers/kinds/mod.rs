//! The kinds of layers: a table with a file for each.

mod band;
mod corridor;
mod curve;
mod distance;
mod formula;
mod paint;
mod raster;

use crate::app::features::threats::THREATS_KIND;
use crate::app::kit::LayerKindRow;
use meshbrush_core::layers::{LayerKind, Quantity};

/// All kinds, as menus list them.
pub static LAYER_KINDS: [LayerKindRow; 7] = [
    paint::PAINT,
    formula::FORMULA,
    raster::RASTER,
    THREATS_KIND,
    distance::DISTANCE,
    corridor::CORRIDOR,
    band::BAND,
];

/// The kind of a layer.
pub fn kind_of(kind: &LayerKind) -> &'static LayerKindRow {
    LAYER_KINDS.iter().find(|panel| (panel.is_of)(kind)).unwrap_or(&LAYER_KINDS[0])
}

/// The name of a quantity.
const fn quantity_name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Risk => "Risk",
        Quantity::Diameter => "Diameter",
    }
}

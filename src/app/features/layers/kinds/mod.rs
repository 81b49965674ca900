//! The kinds of layers that belong to no other feature: a file for each.

mod band;
mod curve;
mod depth;
mod distance;
mod feature_size;
mod formula;
mod paint;
mod raster;
mod straits;
mod surface;
mod water;

use meshbrush_core::layers::{LayerKind, Quantity};
use meshbrush_kit::kit::{LayerKindRow, LayerKinds};

/// The kinds of layers of this feature.
pub static KINDS: &[&LayerKindRow] = &[
    &paint::PAINT,
    &formula::FORMULA,
    &raster::RASTER,
    &distance::DISTANCE,
    &band::BAND,
    &depth::DEPTH,
    &straits::STRAITS,
    &feature_size::FEATURE_SIZE,
    &surface::SURFACE,
];

/// Returns the kind of a layer.
///
/// # Panics
/// Panics for a kind that no feature has a row of.
pub fn kind_of(all: LayerKinds, kind: &LayerKind) -> &'static LayerKindRow {
    all.iter().find(|row| (row.is_of)(kind)).expect("each kind of layer has a row")
}

/// The name of a quantity.
const fn quantity_name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Risk => "Risk",
        Quantity::Diameter => "Diameter",
        Quantity::Error => "Error",
    }
}

//! Painted layers.

use glam::DVec2;

use crate::layers::engine::{CompiledPlane, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::risk_source::RiskSource;
use crate::layers::{LayerSlot, LayerSource, Quantity};
use crate::raster::{TiledRaster, ValueRanges};

/// Paint, whose pixels are in the document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaintLayer {
    /// The meaning of the pixels.
    pub quantity: Quantity,
}

impl LayerSource for PaintLayer {
    fn label(&self) -> &'static str {
        match self.quantity {
            Quantity::Risk => "Painted risk",
            Quantity::Diameter => "Painted diameter",
            Quantity::Error => "Painted error",
        }
    }

    fn change_title(&self) -> &'static str {
        "paint layer"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        (plane.reading(self.quantity, 0.0), Values::paint())
    }

    fn quantity(&self) -> Quantity {
        self.quantity
    }

    fn risk_at(&self, point: DVec2, pixels: Option<&TiledRaster>) -> Option<f64> {
        let risk = || pixels.map_or(0.0, |raster| f64::from(raster.sample(point)));
        (self.quantity == Quantity::Risk).then(risk)
    }

    fn risks(&self, pixels: Option<&TiledRaster>) -> Option<RiskSource> {
        pixels.filter(|_| self.quantity == Quantity::Risk).cloned().map(RiskSource::Paint)
    }

    fn error_at(&self, point: DVec2, pixels: Option<&TiledRaster>) -> Option<f64> {
        let error = pixels.filter(|_| self.quantity == Quantity::Error)?.sample(point);
        Some(f64::from(if error == Quantity::Error.blank() { f32::INFINITY } else { error }))
    }

    fn extent(&self, slot: LayerSlot, context: &ExtentContext) -> Extent {
        let raster = context.paint.get(slot.id).into_iter();
        Extent::of(raster.flat_map(|raster| raster.tiles().map(|(place, _)| place.area(raster.grid()))))
    }
}

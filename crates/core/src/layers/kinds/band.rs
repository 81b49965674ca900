//! Bands of the values of a raster.

use super::raster::pixels_of;
use crate::layers::RasterSource;
use crate::layers::engine::{CompiledPlane, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::value_change::{LayerEdit, ValueChange, direction};
use crate::layers::{LayerSlot, LayerSource};
use crate::mesh::TargetChange;

/// One diameter where a raster's value lies between two numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct BandLayer {
    /// The raster.
    pub source: RasterSource,
    /// The least and the greatest of these values.
    pub between: [f64; 2],
    /// The target diameter there, in world units.
    pub diameter: f64,
}

impl LayerSource for BandLayer {
    fn label(&self) -> &'static str {
        "Band"
    }

    fn change_title(&self) -> &'static str {
        "band"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let Self { source, between, diameter } = self;
        let lengths = plane.lengths().clone();
        let reading = Reading::Band { between: *between, diameter: *diameter, lengths };
        (reading, Values::of_raster(&source.raster, f32::INFINITY, plane.lattice))
    }

    fn raster_source(&self) -> Option<&RasterSource> {
        Some(&self.source)
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        pixels_of(&self.source)
    }

    fn change_since(&self, old: &dyn LayerSource, _: &LayerEdit) -> ValueChange {
        let Self { source, between, diameter } = self;
        match old.get::<Self>() {
            Some(old) if *source == old.source && *between == old.between => {
                let are_lengths = [*diameter, old.diameter].iter().all(|d| *d > 0.0 && d.is_finite());
                let change = direction([*diameter], [old.diameter]);
                ValueChange::of(change.map(|change| if are_lengths { change } else { TargetChange::Any }))
            }
            _ => ValueChange::Anywhere(TargetChange::Any),
        }
    }
}

//! Layers of depths.

use std::sync::Arc;

use super::raster::pixels_of;
use crate::domain::{BoundaryMarks, Domain};
use crate::layers::RasterSource;
use crate::layers::engine::{CompiledPlane, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::{DepthRule, Depths, LayerSlot, LayerSource};

impl LayerSource for Depths {
    fn label(&self) -> &'static str {
        "Depth"
    }

    fn change_title(&self) -> &'static str {
        "depth"
    }

    fn compile(&self, slot: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let values = Values::of_raster(self.deciding(), f32::INFINITY, plane.lattice);
        (Reading::of_depths(self, slot.combine, plane.lengths()), values)
    }

    fn asks_for_diameters(&self) -> bool {
        self.sizes().rule != DepthRule::Nothing
    }

    fn needs_metres(&self) -> bool {
        self.asks_for_diameters()
    }

    fn raster_source(&self) -> Option<&RasterSource> {
        Some(self.source())
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        let computed = self.computed().map(|raster| (Arc::as_ptr(raster).addr(), raster.bytes()));
        [self.source().shared_data()].into_iter().chain(computed).collect()
    }

    /// Finds the slopes of the ground where they are asked for.
    fn follow_domain(&mut self, domain: &Domain, _: &BoundaryMarks) {
        *self = self.in_plane(domain.projection);
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        if self.asks_for_diameters() { pixels_of(self.source()) } else { Extent::NOTHING }
    }
}

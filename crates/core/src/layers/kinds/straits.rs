//! Layers of straits.

use crate::domain::{BoundaryMarks, Domain};
use crate::layers::engine::{CompiledPlane, Function, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::{LayerSlot, LayerSource, Straits};

impl LayerSource for Straits {
    fn label(&self) -> &'static str {
        "Straits"
    }

    fn change_title(&self) -> &'static str {
        "straits"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let function = Function::Straits(self.clone(), plane.edge_lengths.greatest_scale());
        (plane.diameters(), Values::of_diameters(function))
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        vec![self.found.shared_data()]
    }

    fn follows_outline(&self) -> bool {
        true
    }

    fn follow_domain(&mut self, domain: &Domain, marks: &BoundaryMarks) {
        *self = self.for_domain(domain, marks);
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        Extent::of(self.found.extent())
    }
}

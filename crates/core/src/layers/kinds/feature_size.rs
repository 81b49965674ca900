//! Layers of the feature size.

use crate::domain::{BoundaryMarks, Domain};
use crate::layers::engine::{CompiledPlane, Function, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::{FeatureSize, LayerSlot, LayerSource};

impl LayerSource for FeatureSize {
    fn label(&self) -> &'static str {
        "Feature size"
    }

    fn change_title(&self) -> &'static str {
        "feature size"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let function = Function::FeatureSize(self.clone(), plane.edge_lengths.greatest_scale());
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

    /// It grows with the way from the middle of the water.
    fn extent(&self, slot: LayerSlot, context: &ExtentContext) -> Extent {
        let ceiling = context.ceiling_of(slot.combine);
        match self.found.extent() {
            Some(_) if ceiling == f64::INFINITY => Extent::Everywhere,
            Some(middle) => {
                let reach = self.farthest(context.greatest_scale * ceiling);
                Extent::of([middle.expanded(reach)])
            }
            None => Extent::NOTHING,
        }
    }
}

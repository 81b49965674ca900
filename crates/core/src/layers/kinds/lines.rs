//! Layers that ask for what lines need.

use std::sync::Arc;

use crate::domain::{Domain, Line};
use crate::layers::engine::{CompiledPlane, Function, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::value_change::{LayerEdit, ValueChange, direction};
use crate::layers::{LayerSlot, LayerSource, LineGaps, LineSizes};
use crate::mesh::TargetChange::Any;

impl LayerSource for LineSizes {
    fn label(&self) -> &'static str {
        "Lines"
    }

    fn change_title(&self) -> &'static str {
        "sizes for lines"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let function = Function::Lines(self.clone(), plane.edge_lengths.greatest_scale());
        (plane.diameters(), Values::of_diameters(function))
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        vec![self.gaps.shared_data()]
    }

    fn follows_lines(&self) -> bool {
        true
    }

    fn follow_lines(&mut self, lines: &Arc<Vec<Line>>, domain: &Domain) {
        if !self.gaps.is_of(lines, domain) {
            self.gaps = LineGaps::of(lines, domain);
        }
    }

    /// The gap at a point is at least the distance to the lines.
    fn extent(&self, slot: LayerSlot, context: &ExtentContext) -> Extent {
        let ceiling = context.ceiling_of(slot.combine);
        match self.gaps.extent() {
            Some(_) if ceiling == f64::INFINITY => Extent::Everywhere,
            Some(lines) => Extent::of([lines.expanded(self.farthest(context.greatest_scale * ceiling))]),
            None => Extent::NOTHING,
        }
    }

    fn change_since(&self, old: &dyn LayerSource, edit: &LayerEdit) -> ValueChange {
        let Some(old) = old.get::<Self>() else { return ValueChange::Anywhere(Any) };
        if self.gaps == old.gaps {
            return ValueChange::of(direction([-self.across], [-old.across]));
        }
        let farthest = |of: &Self, context: &ExtentContext| {
            of.farthest(context.greatest_scale * context.ceiling_of(edit.combine))
        };
        let reach = farthest(self, edit.new).max(farthest(old, edit.old));
        if self.across != old.across || !reach.is_finite() {
            return ValueChange::Anywhere(Any);
        }
        let areas = self.gaps.areas_that_differ(&old.gaps);
        ValueChange::Within(vec![(areas.iter().map(|rect| rect.expanded(reach)).collect(), Any)])
    }
}

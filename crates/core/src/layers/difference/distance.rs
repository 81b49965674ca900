//! What changes with the shapes that a distance is measured to.

use glam::DVec2;

use super::Steps;
use crate::geometry::{NumberSet, Rect};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::{Combine, DistanceTo, Layer, LayerKind, Shapes};
use crate::mesh::TargetChange::{Any, Coarser, Finer};

impl Steps<'_> {
    /// A layer of the distance to the outline, where the outline differs, and perhaps the layer besides.
    ///
    /// Where a distance differs, the nearest edge before or after is one that the other outline does not
    /// have.
    pub(super) fn add_distance_to_outline(&mut self, new: &Layer, old: &Layer) {
        let farthest = |layer: &Layer, context: &ExtentContext| match &layer.kind {
            LayerKind::Distance { to: DistanceTo::Outline, at_zero, slope, range } => {
                layer.farthest_in_plane([*at_zero, *slope, *range], context)
            }
            _ => f64::INFINITY,
        };
        let reach = farthest(new, &self.new).max(farthest(old, &self.old));
        let both_have_outlines = [self.new, self.old].iter().all(|context| context.spec.outline.is_some());
        match self.outline_areas {
            Some(edges) if new.kind == old.kind && both_have_outlines && reach.is_finite() => {
                let area = Extent::of(edges.iter().map(|edge| edge.expanded(reach.max(0.0))));
                self.add(new, new.combine, area.within_mask(new.mask.as_ref()), Any);
            }
            _ => self.add_both(new, old, Any),
        }
    }

    /// A layer of the distance to lines, of which some differ: those of the pieces of a boundary. Returns
    /// whether it is that, and nothing else differs.
    ///
    /// Where a line is left out, the distance grows, and only where that line was the nearest; where one
    /// joins, the distance shrinks, and only where it is the nearest now.
    pub(super) fn add_other_lines(&mut self, new: &Layer, old: &Layer) -> bool {
        let (Some((lines, numbers)), Some((old_lines, old_numbers))) = (of_lines(new), of_lines(old)) else {
            return false;
        };
        let reach = new.farthest_in_plane(numbers, &self.new).max(old.farthest_in_plane(numbers, &self.old));
        if numbers != old_numbers || !reach.is_finite() {
            return false;
        }
        let [now, before] = [lines, old_lines].map(segments);
        let is_finest = new.combine == Combine::Finest;
        for (left, of, change) in [(&before, &now, Coarser), (&now, &before, Finer)] {
            let changed = left.difference(of).map(|&ends| area(ends).expanded(reach.max(0.0)));
            let area = Extent::of(changed).within_mask(new.mask.as_ref());
            self.add(new, new.combine, area, if is_finest { change } else { Any });
        }
        true
    }
}

/// The ends of a segment, as bits.
type Ends = [[u64; 2]; 2];

/// Returns the lines of a layer of the distance, if there is nothing but lines, and its numbers.
fn of_lines(layer: &Layer) -> Option<(&Shapes, [f64; 3])> {
    let LayerKind::Distance { to: DistanceTo::Shapes { shapes, .. }, at_zero, slope, range } = &layer.kind
    else {
        return None;
    };
    let list = shapes.list();
    let is_increasing = *at_zero > 0.0 && *slope >= 0.0;
    let has_lines_only = list.points.is_empty() && list.polygons.is_empty();
    (has_lines_only && is_increasing).then_some((shapes, [*at_zero, *slope, *range]))
}

fn segments(shapes: &Shapes) -> NumberSet<Ends> {
    let bits = |point: DVec2| point.to_array().map(f64::to_bits);
    let lines = shapes.list().lines.iter();
    lines.flat_map(|line| line.windows(2).map(move |ends| [bits(ends[0]), bits(ends[1])])).collect()
}

fn area(ends: Ends) -> Rect {
    let [a, b] = ends.map(|end| DVec2::from(end.map(f64::from_bits)));
    Rect::spanning(a, b)
}

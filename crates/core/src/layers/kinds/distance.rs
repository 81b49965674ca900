//! Layers of a distance.

use glam::DVec2;

use crate::domain::{BoundaryMarks, Domain, PieceChoice};
use crate::geometry::{NumberSet, Rect};
use crate::layers::engine::{CompiledPlane, Profile, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::value_change::{LayerEdit, ValueChange, direction};
use crate::layers::{Combine, LayerSlot, LayerSource, Shapes, ShapesError};
use crate::mesh::TargetChange::{self, Any, Coarser, Finer};

/// h̄ grows with the distance.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceLayer {
    /// The target of the distance.
    pub to: DistanceTo,
    /// The target diameter at distance 0, in world units.
    pub at_zero: f64,
    /// How much the target diameter grows with the distance, by unit of length.
    pub slope: f64,
    /// The distance beyond which nothing is asked for, in world units; infinite without a limit.
    pub range: f64,
}

/// The target of a distance.
#[derive(Clone, Debug, PartialEq)]
pub enum DistanceTo {
    /// The boundary of the domain, on both sides.
    Outline,
    /// The coasts: the boundary of the domain without its open parts, on both sides. A layer of a document
    /// has it; in the description of a size field, shapes take its place, or nothing without a coast.
    Coasts,
    /// Some pieces of the boundary, on both sides. A layer of a document has it; in the description of a size
    /// field, shapes take its place, or nothing where no piece is chosen.
    Pieces(PieceChoice),
    /// Points, lines and polygons.
    Shapes {
        /// The name of their file, for a person; empty where there is none.
        name: String,
        /// The shapes.
        shapes: Shapes,
    },
    /// A strip along lines that were taken from paths. Within it the distance is 0.
    Corridor {
        /// The lines.
        lines: Shapes,
        /// The width of the strip, in world units.
        width: f64,
    },
}

impl DistanceTo {
    /// Returns the shapes, unless it is the outline or a part of it.
    pub fn shapes(&self) -> Option<&Shapes> {
        match self {
            Self::Outline | Self::Coasts | Self::Pieces(_) => None,
            Self::Shapes { shapes, .. } | Self::Corridor { lines: shapes, .. } => Some(shapes),
        }
    }

    /// Returns how far from the shapes the distance begins, in world units.
    pub fn reach(&self) -> f64 {
        if let Self::Corridor { width, .. } = self { 0.5 * width } else { 0.0 }
    }

    /// Returns whether it is a strip along lines.
    pub fn is_corridor(&self) -> bool {
        matches!(self, Self::Corridor { .. })
    }
}

impl LayerSource for DistanceLayer {
    fn label(&self) -> &'static str {
        if self.to.is_corridor() { "Corridor" } else { "Distance" }
    }

    fn change_title(&self) -> &'static str {
        if self.to.is_corridor() { "corridor" } else { "distance" }
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let greatest_scale = plane.edge_lengths.greatest_scale();
        let growth = Profile::on_earth(self.to.reach(), self.numbers(), greatest_scale);
        (plane.diameters(), Values::of_distance(self.shapes(plane.outline), growth))
    }

    fn file_name(&self) -> Option<&str> {
        match &self.to {
            DistanceTo::Shapes { name, .. } if !name.is_empty() => Some(name),
            _ => None,
        }
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        self.to.shapes().map(Shapes::shared_data).into_iter().collect()
    }

    fn follows_outline(&self) -> bool {
        self.to.shapes().is_none()
    }

    fn follows_pieces(&self) -> bool {
        matches!(self.to, DistanceTo::Pieces(_) | DistanceTo::Coasts)
    }

    fn is_of_outline(&self) -> bool {
        self.to == DistanceTo::Outline
    }

    /// Shapes take the place of coasts and pieces of the boundary.
    fn enter_field(&mut self, domain: &Domain, marks: &BoundaryMarks) {
        let shapes = match &self.to {
            DistanceTo::Coasts => Shapes::coasts(domain, marks),
            DistanceTo::Pieces(chosen) => Shapes::lines(chosen.lines(domain, marks)),
            _ => Err(ShapesError::Empty),
        };
        if let Ok(shapes) = shapes {
            self.to = DistanceTo::Shapes { name: String::new(), shapes };
        }
    }

    fn extent(&self, slot: LayerSlot, context: &ExtentContext) -> Extent {
        let farthest = self.farthest_in_plane(slot.combine, context);
        match self.shapes(context.outline) {
            None => Extent::NOTHING,
            Some(_) if farthest < 0.0 => Extent::NOTHING,
            Some(shapes) if farthest.is_finite() => {
                let reach = context.greatest_scale * self.to.reach();
                Extent::of([shapes.extent().expanded(reach + farthest)])
            }
            Some(_) => Extent::Everywhere,
        }
    }

    fn change_since(&self, old: &dyn LayerSource, edit: &LayerEdit) -> ValueChange {
        match old.get::<Self>() {
            None => ValueChange::Anywhere(Any),
            Some(old) if edit.has_new_outline && (self.is_of_outline() || old.is_of_outline()) => {
                self.with_other_outline(old, edit)
            }
            Some(old) => {
                self.with_other_lines(old, edit).unwrap_or_else(|| self.with_other_numbers(old, edit.combine))
            }
        }
    }
}

impl DistanceLayer {
    fn numbers(&self) -> [f64; 3] {
        [self.at_zero, self.slope, self.range]
    }

    /// Returns what the distance is measured to, where the boundary of the domain is `outline`.
    fn shapes<'a>(&'a self, outline: Option<&'a Shapes>) -> Option<&'a Shapes> {
        if self.is_of_outline() { outline } else { self.to.shapes() }
    }

    /// Returns the distance from which on the layer asks for nothing, or for too large a diameter to matter,
    /// in world units: below zero where it never matters, infinite where it always can.
    fn farthest_in_plane(&self, combine: Combine, context: &ExtentContext) -> f64 {
        let [at_zero, slope, range] = self.numbers();
        let ceiling = context.ceiling_of(combine);
        let has_end = ceiling != f64::INFINITY && slope > 0.0;
        // A little more, because the value at a distance is rounded.
        let below_ceiling = if has_end { (ceiling * (1.0 + 1e-9) - at_zero) / slope } else { f64::INFINITY };
        context.greatest_scale * (1.0 + 1e-9) * range.min(below_ceiling)
    }

    /// Where both before and after the layer matters, in the plane.
    fn farthest_of_both(&self, old: &Self, edit: &LayerEdit) -> f64 {
        let before = old.farthest_in_plane(edit.combine, edit.old);
        self.farthest_in_plane(edit.combine, edit.new).max(before)
    }

    /// The outline differs, and perhaps the layer besides.
    ///
    /// Where a distance differs, the nearest edge before or after is one that the other outline does not
    /// have.
    fn with_other_outline(&self, old: &Self, edit: &LayerEdit) -> ValueChange {
        let reach = self.farthest_of_both(old, edit);
        let both_have_outlines = [edit.new, edit.old].iter().all(|context| context.outline.is_some());
        match edit.outline_areas {
            Some(edges) if self == old && both_have_outlines && reach.is_finite() => {
                let areas = edges.iter().map(|edge| edge.expanded(reach.max(0.0)));
                ValueChange::Within(vec![(areas.collect(), Any)])
            }
            _ => ValueChange::Anywhere(Any),
        }
    }

    /// Some of the lines differ, as those of the pieces of a boundary do; `None` if anything else differs.
    ///
    /// Where a line is left out, the distance grows, and only where that line was the nearest; where one
    /// joins, the distance shrinks, and only where it is the nearest now.
    fn with_other_lines(&self, old: &Self, edit: &LayerEdit) -> Option<ValueChange> {
        let (lines, old_lines) = (self.lines()?, old.lines()?);
        let reach = self.farthest_of_both(old, edit);
        if self.numbers() != old.numbers() || !reach.is_finite() {
            return None;
        }
        let [now, before] = [lines, old_lines].map(segments);
        let steps = [(&before, &now, Coarser), (&now, &before, Finer)].map(|(left, of, change)| {
            let changed = left.difference(of).map(|&ends| area(ends).expanded(reach.max(0.0)));
            (changed.collect(), change)
        });
        Some(ValueChange::Within(steps.into()))
    }

    fn with_other_numbers(&self, old: &Self, combine: Combine) -> ValueChange {
        if self.to != old.to || (self.range != old.range && combine != Combine::Finest) {
            return ValueChange::Anywhere(Any);
        }
        let is_increasing = |layer: &Self| layer.at_zero > 0.0 && layer.slope >= 0.0;
        let is_known = is_increasing(self) && is_increasing(old);
        // Beyond the range the diameter is infinite.
        let sizes = |layer: &Self| [layer.at_zero, layer.slope, -layer.range];
        let change: Option<TargetChange> = direction(sizes(self), sizes(old));
        ValueChange::of(change.map(|change| if is_known { change } else { Any }))
    }

    /// Returns what the distance is measured to, if that is nothing but lines, and the diameter grows.
    fn lines(&self) -> Option<&Shapes> {
        let DistanceTo::Shapes { shapes, .. } = &self.to else { return None };
        let list = shapes.list();
        let is_increasing = self.at_zero > 0.0 && self.slope >= 0.0;
        let has_lines_only = list.points.is_empty() && list.polygons.is_empty();
        (has_lines_only && is_increasing).then_some(shapes)
    }
}

/// The ends of a segment, as bits.
type Ends = [[u64; 2]; 2];

fn segments(shapes: &Shapes) -> NumberSet<Ends> {
    let bits = |point: DVec2| point.to_array().map(f64::to_bits);
    let lines = shapes.list().lines.iter();
    lines.flat_map(|line| line.windows(2).map(move |ends| [bits(ends[0]), bits(ends[1])])).collect()
}

fn area(ends: Ends) -> Rect {
    let [a, b] = ends.map(|end| DVec2::from(end.map(f64::from_bits)));
    Rect::spanning(a, b)
}

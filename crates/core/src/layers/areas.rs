//! The areas of the lattice in which the mesh must be checked again after an edit.

use super::difference::Circumstances;
use super::engine::asked::Ternary;
use super::engine::cells::Cells;
use super::engine::counting::Counting;
use super::extent::joined;
use super::paint_reach::RepaintedField;
use super::reach::Reach;
use super::{Combine, Layer, LayerId, LevelCache, PaintLayers, Quantity, SizeField};
use crate::geometry::{LatticeRect, Rect};
use crate::mesh::{ChangedArea, Falloff, TargetChange};
use crate::raster::ValueRange;

/// How often a rectangle is divided in quarters to leave out parts that other layers decide.
const DEEPEST: u32 = 2;

/// A part of a paint layer that was painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaintChange {
    /// The layer.
    pub layer: LayerId,
    /// The rectangle in which the pixels changed, in world units.
    pub area: Rect,
    /// The range of the values of the pixels before, there and perhaps around it.
    pub before: ValueRange,
    /// The change of the target diameters of the pixels.
    pub change: TargetChange,
}

/// How rectangles are joined.
#[derive(Clone, Copy)]
struct Joining {
    /// One takes the place of all where it is at most so many times as large as they are together.
    most_empty: f64,
    /// The most rectangles that are left.
    most: usize,
}

/// Without gradation, only rectangles that overlap are joined.
const OVERLAPPING: Joining = Joining { most_empty: 1.0 + 1e-9, most: usize::MAX };

/// With gradation, the reaches of near rectangles overlap, and would be searched several times.
const NEAR: Joining = Joining { most_empty: 2.0, most: 8 };

impl Joining {
    /// Returns few rectangles that cover others.
    fn of(self, rects: Vec<Rect>) -> Vec<Rect> {
        let area = |rect: &Rect| rect.size().element_product();
        let covered: f64 = rects.iter().map(area).sum();
        match rects.iter().copied().reduce(|a, b| a.union(&b)) {
            Some(around) if area(&around) <= self.most_empty * covered => vec![around],
            _ => joined(rects, self.most),
        }
    }

    /// Returns few changes that cover others, each of one layer and in one direction.
    fn of_changes(self, painted: &[PaintChange]) -> Vec<PaintChange> {
        let mut groups: Vec<Vec<PaintChange>> = Vec::new();
        for one in painted {
            let is_alike = |group: &&mut Vec<PaintChange>| {
                group.first().is_some_and(|first| first.layer == one.layer && first.change == one.change)
            };
            match groups.iter_mut().find(is_alike) {
                Some(group) => group.push(*one),
                None => groups.push(vec![*one]),
            }
        }
        let of_group = |group: Vec<PaintChange>| {
            let all =
                group.iter().copied().reduce(|a, b| PaintChange { before: a.before.union(b.before), ..a });
            let rects = self.of(group.iter().map(|one| one.area).collect());
            all.into_iter()
                .flat_map(move |all| rects.clone().into_iter().map(move |area| PaintChange { area, ..all }))
        };
        groups.into_iter().flat_map(of_group).collect()
    }
}

/// Returns whether diameters follow from what is painted on a layer.
fn asks_for_diameters(layer: &Layer) -> bool {
    layer.paints().is_some_and(|quantity| quantity != Quantity::Error)
}

impl SizeField {
    /// Returns where and how h̄ can have changed since it was that of an earlier field on the same lattice,
    /// with the same paint.
    ///
    /// `outline_areas` are rectangles in world units that hold every edge that only one of the two outlines
    /// has, if they are known.
    pub fn changes_since(
        &self,
        old: &Self,
        paint: &PaintLayers,
        outline_areas: Option<&[Rect]>,
    ) -> Vec<ChangedArea> {
        let circumstances = self.circumstances(paint, outline_areas);
        let mut changes = Vec::new();
        for step in self.spec().difference(old.spec(), &circumstances) {
            let rects = step.area.rects_within(self.lattice().bounds());
            let rects = if old.stack.slope().is_some() { NEAR.of(rects) } else { rects };
            for core in rects.iter().filter_map(|rect| self.core(rect)) {
                let asked = [old, self].map(|field| field.least_asked(step.layer, core, paint));
                let least = self.least_diameter(asked[0].min(asked[1]), old);
                // Another limit of the slope is a step of its own, which changes h̄ everywhere.
                changes.extend(old.reached(core, least, [old, self], paint, step.change));
            }
        }
        changes.dedup();
        changes
    }

    fn circumstances<'a>(
        &self,
        paint: &'a PaintLayers,
        outline_areas: Option<&'a [Rect]>,
    ) -> Circumstances<'a> {
        let greatest_scale = self.edge_lengths().greatest_scale();
        Circumstances { paint, longest: self.longest(), greatest_scale, outline_areas }
    }

    /// Returns the layers that ask for smaller diameters than in an earlier field, if nothing else differs;
    /// see [`Self::of_layers_alone`].
    pub fn finer_layers_since(
        &self,
        old: &Self,
        paint: &PaintLayers,
        outline_areas: Option<&[Rect]>,
    ) -> Option<Vec<LayerId>> {
        let circumstances = self.circumstances(paint, outline_areas);
        let steps = self.spec().difference(old.spec(), &circumstances);
        steps.iter().map(|step| step.layer.filter(|_| step.change == TargetChange::Finer)).collect()
    }

    /// Returns where and how h̄ can have changed after pixels changed. `paint` has the pixels as they are
    /// now; `squares` must have been used for this field and these pixels only.
    pub fn changes_by_paint(
        &self,
        squares: &mut LevelCache,
        painted: &[PaintChange],
        paint: &PaintLayers,
    ) -> Vec<ChangedArea> {
        let joining = if self.stack.slope().is_some() { NEAR } else { OVERLAPPING };
        let changes = joining.of_changes(painted);
        squares.make_room();
        let cores: Vec<Cells> = changes.iter().filter_map(|painted| self.core(&painted.area)).collect();
        let others = self.all_but(changes.iter().map(|painted| painted.layer));
        let known = &mut squares.known;
        let mut areas = Vec::new();
        for painted in &changes {
            let Some((core, least, change)) = self.changed_core(painted, paint) else { continue };
            let cells = match self.stack.slope() {
                _ if least >= self.longest() => Vec::new(),
                None => self.parts_above(core, least, (others, paint)),
                Some(slope) => RepaintedField { field: self, paint, slope, cores: &cores, others, known }
                    .reach(core, least),
            };
            areas.extend(self.changed_areas(cells, (core, least), change));
        }
        areas
    }

    /// Returns the layers without some; `None` if h̄ can be greater than with the others alone, or they
    /// cannot be counted.
    fn all_but(&self, layers: impl Iterator<Item = LayerId>) -> Option<Counting> {
        let mut others = Counting::ALL;
        for id in layers {
            let number = self.stack.layers().iter().position(|compiled| compiled.id == id);
            // A hidden layer never counts.
            let Some(number) = number else { continue };
            others = others.without(number);
            if others.has(number) || !self.stack.layers()[number].is_plain() {
                return None;
            }
        }
        self.spec().is_ordered(self.longest()).then_some(others)
    }

    /// Returns some cells without the parts in which the layers that have not changed ask for at most a
    /// diameter: there it has no effect if another layer asks for this diameter or a larger one.
    fn parts_above(
        &self,
        cells: Cells,
        diameter: f64,
        (others, paint): (Option<Counting>, &PaintLayers),
    ) -> Vec<Cells> {
        let Some(others) = others.filter(|&others| self.stack.counting(others).next().is_some()) else {
            return vec![cells];
        };
        let mut parts = Vec::new();
        let above = |cells: &Cells| match self.stack.diameters(paint, cells, others).0 {
            [_, greatest] if greatest <= diameter => Ternary::Never,
            [least, _] if least > diameter => Ternary::Always,
            _ => Ternary::Maybe,
        };
        cells.add_parts(DEEPEST, &above, &mut parts);
        parts
    }

    /// Returns the cells in which pixels have changed, the least diameter before and after, and how diameters
    /// have changed; `None` if the field has no such layer.
    ///
    /// A change to smaller diameters ends, and one to larger diameters begins, with what is asked for now and
    /// before.
    fn changed_core(&self, painted: &PaintChange, paint: &PaintLayers) -> Option<(Cells, f64, TargetChange)> {
        let PaintChange { layer, area, before, change } = painted;
        let stack = self.spec().layers.iter();
        let layer =
            stack.filter(|other| other.visible && asks_for_diameters(other)).find(|l| l.id == *layer)?;
        let area = match &layer.mask {
            Some(mask) => area.intersection(&mask.bounds()),
            None => Some(*area),
        };
        let core = self.core(&area?)?;
        let is_ordered = layer.combine == Combine::Finest && self.spec().is_ordered(self.longest());
        let (asked, change) = match change {
            _ if !is_ordered => (0.0, TargetChange::Any),
            change => {
                let compiled = self.stack.layers().iter().find(|compiled| compiled.id == layer.id);
                let before = compiled.map_or(0.0, |compiled| compiled.diameters_of(*before).least);
                let now = || self.least_asked(Some(layer.id), core, paint);
                let asked = match change {
                    TargetChange::Finer => now(),
                    TargetChange::Coarser => before,
                    TargetChange::Any => before.min(now()),
                };
                (asked, *change)
            }
        };
        Some((core, self.least_diameter(asked, self), change))
    }

    /// Returns the least diameter that a layer asks for in some cells, in world units; 0 without a layer, and
    /// infinite where it is hidden.
    fn least_asked(&self, layer: Option<LayerId>, core: Cells, paint: &PaintLayers) -> f64 {
        let Some(id) = layer else { return 0.0 };
        let compiled = self.stack.layers().iter().find(|compiled| compiled.id == id);
        compiled.map_or(f64::INFINITY, |layer| layer.diameters(paint, &core, self.lattice()).0.least)
    }

    /// Returns a diameter that a layer asks for, no less than the limits of two fields, in world units.
    fn least_diameter(&self, asked: f64, other: &Self) -> f64 {
        let limits = [self.spec(), other.spec()].map(|spec| spec.transfer.h_min);
        asked.max(limits[0].min(limits[1]))
    }

    /// Returns the rectangles that an edit of some cells affects, before and after which no layer that
    /// changed asks for less than `least` there.
    fn reached(
        &self,
        core: Cells,
        least: f64,
        fields: [&Self; 2],
        paint: &PaintLayers,
        change: TargetChange,
    ) -> impl Iterator<Item = ChangedArea> + use<> {
        let cells = match self.stack.slope() {
            _ if least >= self.longest() => Vec::new(),
            None => vec![core],
            Some(slope) => Reach { fields, paint, slope }.of(core, least),
        };
        self.changed_areas(cells, (core, least), change)
    }

    /// Returns cells that a change of a core affects, as areas of the mesh.
    fn changed_areas(
        &self,
        cells: Vec<Cells>,
        (core, least): (Cells, f64),
        change: TargetChange,
    ) -> impl Iterator<Item = ChangedArea> + use<> {
        let extent = self.lattice().extent();
        let closed = move |cells: Cells| LatticeRect::from(cells).expanded(1, extent);
        // The updater compares it with diameters in the plane.
        let scale = self.edge_lengths().least_scale();
        let slope = scale * self.stack.slope().unwrap_or(0.0);
        let falloff = Some(Falloff { core: closed(core), least: scale * least, slope });
        cells.into_iter().map(move |cells| ChangedArea { rect: closed(cells), change, falloff })
    }

    /// Returns the cells that are told what is at some point of a rectangle in world units.
    ///
    /// A function counts in a whole cell with its value at the centre, and lines between pixels are moved to
    /// lattice lines.
    pub(super) fn core(&self, area: &Rect) -> Option<Cells> {
        let lattice = self.lattice();
        let around = Rect::new(area.min - lattice.step(), area.max + lattice.step());
        Some(Cells::of(&lattice.rect_around(&around)?))
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::{RefinementRule, Transfer};
    use crate::geometry::Lattice;
    use crate::layers::extent::{Extent, ExtentContext};
    use crate::layers::{DistanceLayer, DistanceTo, Layer, LayerKind, ShapeList, Shapes, SizeFieldSpec};

    #[test]
    fn a_corridor_asks_for_nothing_beyond_its_extent() {
        let lines = vec![vec![dvec2(0.3, 0.4), dvec2(0.6, 0.5)]];
        let lines = Shapes::new(ShapeList { lines, ..ShapeList::default() }, false).unwrap();
        let to = DistanceTo::Corridor { lines, width: 0.1 };
        let layer = Layer::stack([DistanceLayer { to, at_zero: 0.01, slope: 0.1, range: 0.15 }]).remove(0);
        let paint = PaintLayers::default();
        let spec = SizeFieldSpec {
            layers: vec![layer.clone()],
            transfer: Transfer::between(0.01, 1.0),
            unasked: 1.0,
            outline: None,
            gradation: None,
            projection: None,
        };
        let context = ExtentContext {
            ceiling: 1.0,
            is_ordered: true,
            outline: None,
            paint: &paint,
            greatest_scale: 1.0,
        };
        let Extent::Within(rects) = layer.kind.extent(layer.slot(), &context) else {
            panic!("it has an end")
        };
        let [extent] = rects[..] else { panic!("{rects:?}") };
        let field = SizeField::new(spec, &Lattice::covering(Rect::UNIT, 0.05, 1000).unwrap());
        let points = (0..10_000).map(|n| dvec2(f64::from(n % 100), f64::from(n / 100)) / 99.0);
        let asked: Vec<_> =
            points.filter(|&p| field.target_by_rule(RefinementRule::Area, &paint, p) < 1.0).collect();
        assert!(asked.iter().all(|&p| extent.contains(p)), "{extent:?}");
        assert!(asked.len() > 1000 && extent.size().x < 0.9, "{} in {extent:?}", asked.len());
    }

    #[test]
    fn gradation_carries_an_edit_as_far_as_the_diameters_around_it_let_it() {
        let lattice = Lattice::covering(Rect::UNIT, 0.05, 1000).unwrap();
        let transfer = Transfer::between(0.01, 5.0);
        let paint = PaintLayers::default();
        let edited = Rect::around(dvec2(0.5, 0.5), 0.01);
        let side = |base: f64, gradation| {
            let layers = Layer::stack([LayerKind::constant(base)]);
            let spec =
                SizeFieldSpec { layers, transfer, unasked: 0.07, outline: None, gradation, projection: None };
            let field = SizeField::new(spec, &lattice);
            let (core, change) = (field.core(&edited).unwrap(), TargetChange::Any);
            let areas: Vec<_> = field.reached(core, 0.01, [&field, &field], &paint, change).collect();
            let least = areas.iter().map(|area| area.rect.min.x).min();
            let most = areas.iter().map(|area| area.rect.max.x).max();
            f64::from(most.unwrap() - least.unwrap()) * lattice.step().x
        };
        // A cell on both sides, and (0.03 − 0.01) / 0.2 beyond the edit with gradation; no
        // farther for a larger h_max than triangles need.
        let longest = lattice.spacing() * 2f64.sqrt();
        assert!((side(0.03, None) - 0.02).abs() < 1e-4);
        assert!((side(0.03, Some(0.2)) - 0.22).abs() < 1e-4);
        let farthest = 0.02 + 10.0 * (longest - 0.01);
        assert!((side(5.0, Some(0.2)) - farthest).abs() < 1e-4, "{} {farthest}", side(5.0, Some(0.2)));
    }
}

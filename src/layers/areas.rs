//! Where h̄ can differ after an edit.

use super::engine::cells::Cells;
use super::{Combine, DistanceTo, Layer, LayerKind, PaintLayers, SizeField, SizeFieldSpec, Threat, Threats};
use crate::geometry::{LatticeRect, Rect};
use crate::raster::ValueRanges;

/// How often the reach of an edit is made smaller.
const MOST_ROUNDS: usize = 8;

impl SizeField {
    /// The part of the lattice in which triangles can get another answer after the paint changed within a
    /// rectangle in world units; `None` where it lies outside.
    pub fn area_affected_by(&self, repainted: &Rect, paint: &PaintLayers) -> Option<LatticeRect> {
        self.affected(&repainted.expanded(self.reach(repainted, paint)))
    }

    /// How far beyond an edit gradation can carry its effect, in world units.
    ///
    /// At distance d it can only lower what is above h_min + g d. So the greatest diameter that the layers
    /// ask for around the edit bounds the distance, which bounds what is around the edit, and so on.
    fn reach(&self, edited: &Rect, paint: &PaintLayers) -> f64 {
        let SizeFieldSpec { transfer, unasked, gradation, .. } = self.spec();
        let Some(slope) = gradation else { return 0.0 };
        let reach = |greatest: f64| (greatest - transfer.h_min).max(0.0) / slope;
        // No triangle is larger than a coarse one, so more than `unasked` is never needed.
        let most = transfer.h_max.min(*unasked);
        let mut distance = reach(most);
        for _ in 0..MOST_ROUNDS {
            let Some(around) = self.affected(&edited.expanded(distance)) else { break };
            let ([_, greatest], _) = self.diameters(paint, &Cells::of(&around));
            let next = reach(greatest.min(most));
            if next > 0.9 * distance {
                break;
            }
            distance = next;
        }
        distance
    }

    /// The lattice rectangle around one in world units, with one step to spare for rounding.
    fn affected(&self, area: &Rect) -> Option<LatticeRect> {
        let extent = self.lattice().extent();
        Some(self.lattice().rect_around(area)?.expanded(1, extent))
    }

    /// The rectangles in which h̄ of this field can differ from that of another one on the same lattice, with
    /// the same paint.
    pub fn areas_that_differ(&self, other: &Self, paint: &PaintLayers) -> Vec<LatticeRect> {
        let (new, old) = (self.spec(), other.spec());
        let same_limits = new.unasked == old.unasked
            && new.gradation == old.gradation
            && new.transfer.h_min == old.transfer.h_min
            && new.transfer.h_max == old.transfer.h_max;
        if !same_limits || has_new_order(&new.layers, &old.layers) {
            return vec![Cells::all(self.lattice().extent()).into()];
        }
        let new_curve = new.transfer != old.transfer;
        let new_outline = new.outline != old.outline;
        let mut changed = Vec::new();
        for layer in new.layers.iter().chain(&old.layers) {
            let [before, after] = [&old.layers, &new.layers]
                .map(|layers| layers.iter().find(|other| other.id == layer.id && other.visible));
            let differs = match (before, after) {
                (None, None) => false,
                (Some(before), Some(after)) => {
                    !asks_alike(before, after)
                        || (new_curve && layer.is_of_risk())
                        || (new_outline && layer.is_of_outline())
                }
                _ => true,
            };
            if let (Some(before), Some(after)) = (before, after)
                && let Some(area) = dragged_threat(before, after)
            {
                changed.extend(area);
            } else if differs && layer.visible {
                let bounds = self.lattice().bounds();
                let area = layer.extent(paint).map_or(Some(bounds), |area| area.intersection(&bounds));
                changed.extend(area.filter(|area| area.min.cmple(area.max).all()));
            }
        }
        changed.dedup();
        changed.iter().filter_map(|area| self.area_affected_by(area, paint)).collect()
    }
}

/// Whether layers that both stacks have lie in another order. Where only the finest counts, order does not
/// matter.
fn has_new_order(new: &[Layer], old: &[Layer]) -> bool {
    let common = |layers: &[Layer], others: &[Layer]| {
        let is_common =
            |layer: &&Layer| layer.visible && others.iter().any(|o| o.id == layer.id && o.visible);
        layers.iter().filter(is_common).map(|layer| layer.id).collect::<Vec<_>>()
    };
    let plain = new.iter().chain(old).all(|layer| layer.combine == Combine::Finest || !layer.visible);
    !plain && common(new, old) != common(old, new)
}

/// Where two states of a layer of threats differ, if they differ in nothing but the threats.
fn dragged_threat(before: &Layer, after: &Layer) -> Option<Option<Rect>> {
    match (&before.kind, &after.kind) {
        (LayerKind::Threats(old), LayerKind::Threats(new)) if old != new => {
            let alike = before.combine == after.combine && before.mask == after.mask;
            alike.then(|| Threats::changed_area(old, new))
        }
        _ => None,
    }
}

/// Whether two states of a layer ask for the same.
fn asks_alike(a: &Layer, b: &Layer) -> bool {
    a.combine == b.combine && a.mask == b.mask && a.kind == b.kind
}

/// An area that no layer reaches.
const NOWHERE: Rect = Rect::new(glam::DVec2::INFINITY, glam::DVec2::INFINITY);

impl Layer {
    /// Whether its values are risks, so that the transfer curve matters.
    fn is_of_risk(&self) -> bool {
        use super::{Quantity, RasterReading};
        match &self.kind {
            LayerKind::Paint(quantity) | LayerKind::Formula { quantity, .. } => *quantity == Quantity::Risk,
            LayerKind::Raster { reading, .. } => *reading == RasterReading::Risk,
            LayerKind::Threats(_) => true,
            LayerKind::Distance { .. } | LayerKind::Band { .. } => false,
        }
    }

    /// Whether it asks for the distance to the boundary of the domain.
    pub fn is_of_outline(&self) -> bool {
        matches!(self.kind, LayerKind::Distance { to: DistanceTo::Outline, .. })
    }

    /// The rectangle in world units beyond which the layer asks for nothing; `None` where there is none.
    pub fn extent(&self, paint: &PaintLayers) -> Option<Rect> {
        let extent = self.extent_of_kind(paint);
        match (&self.mask, extent) {
            (Some(mask), Some(extent)) => Some(extent.intersection(&mask.bounds()).unwrap_or(NOWHERE)),
            (Some(mask), None) => Some(mask.bounds()),
            (None, extent) => extent,
        }
    }

    fn extent_of_kind(&self, paint: &PaintLayers) -> Option<Rect> {
        match &self.kind {
            LayerKind::Paint(_) => {
                let raster = paint.get(self.id);
                let tiles = raster
                    .into_iter()
                    .flat_map(|raster| raster.tiles().map(|(place, _)| place.area(raster.grid())));
                Some(tiles.reduce(|a, b| a.union(&b)).unwrap_or(NOWHERE))
            }
            LayerKind::Formula { .. } => None,
            LayerKind::Raster { source, .. } | LayerKind::Band { source, .. } => {
                Some(source.raster.raster().bounds())
            }
            LayerKind::Threats(threats) => {
                Some(threats.list().iter().map(Threat::reach).reduce(|a, b| a.union(&b)).unwrap_or(NOWHERE))
            }
            LayerKind::Distance { to, range, .. } if range.is_finite() => {
                Some(to.shapes()?.extent().expanded(to.reach() + *range))
            }
            LayerKind::Distance { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::field::{RefinementRule, Transfer};
    use crate::geometry::Lattice;
    use crate::layers::{ShapeList, Shapes};

    #[test]
    fn a_corridor_asks_for_nothing_beyond_its_extent() {
        let lines = vec![vec![dvec2(0.3, 0.4), dvec2(0.6, 0.5)]];
        let lines = Shapes::new(ShapeList { lines, ..ShapeList::default() }, false).unwrap();
        let to = DistanceTo::Corridor { lines, width: 0.1 };
        let layer =
            Layer::stack([LayerKind::Distance { to, at_zero: 0.01, slope: 0.1, range: 0.15 }]).remove(0);
        let paint = PaintLayers::default();
        let extent = layer.extent(&paint).unwrap();
        let spec = SizeFieldSpec {
            layers: vec![layer],
            transfer: Transfer { h_min: 0.01, h_max: 1.0, shape: 1.0 },
            unasked: 1.0,
            outline: None,
            gradation: None,
        };
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
        let transfer = Transfer { h_min: 0.01, h_max: 5.0, shape: 1.0 };
        let paint = PaintLayers::default();
        let edited = Rect::around(dvec2(0.5, 0.5), 0.01);
        let side = |base: f64, gradation| {
            let layers = Layer::stack([LayerKind::constant(base)]);
            let spec = SizeFieldSpec { layers, transfer, unasked: 0.07, outline: None, gradation };
            let area = SizeField::new(spec, &lattice).area_affected_by(&edited, &paint).unwrap();
            f64::from(area.max.x - area.min.x) * lattice.step().x
        };
        assert!((side(0.03, None) - 0.02).abs() < 1e-6);
        // (0.03 − 0.01) / 0.2 beyond the edit on both sides, and no farther for a larger h_max.
        assert!((side(0.03, Some(0.2)) - 0.22).abs() < 1e-6);
        assert!((side(5.0, Some(0.2)) - 0.62).abs() < 1e-6, "no more than triangles can need");
    }
}

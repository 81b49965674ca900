//! h̄ at points and over rectangles, and which layer decides it.

use glam::DVec2;

use super::engine::asked::Share;
use super::engine::cells::{Cells, Cut};
use super::engine::counting::Counting;
use super::engine::gradation::Accuracy;
use super::engine::reading::Diameters;
use super::engine::{CompiledLayer, KnownParts, gradation};
use super::{Combine, LayerId, PaintLayers, SettledSquares, SizeField};
use crate::earth::LEVELS;
use crate::field::{RefinementRule, Transfer};
use crate::geometry::LatticePoint;

/// h̄ at a point, with the layer that decides it.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// h̄ in world units.
    pub target: f64,
    /// The layer that decides; `None` where no layer asks for anything.
    pub layer: Option<LayerId>,
    /// The limit that counts in place of what the layer asks for, if one does.
    pub limit: Option<DiameterLimit>,
    /// The place, in world units, whose diameter limits h̄ here through gradation; the point itself where the
    /// layers decide directly.
    pub from: DVec2,
    /// The target diameter of each visible layer at the point, in world units, from the bottom to the top;
    /// `None` for a layer without a target there.
    pub asked: Vec<(LayerId, Option<f64>)>,
}

/// A limit of h̄ that a layer asks to pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiameterLimit {
    /// The smallest target diameter: a layer asks for less.
    Smallest,
    /// The largest target diameter: a layer asks for more.
    Largest,
}

/// h̄ at a point before gradation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ungraded {
    /// h̄ in world units.
    pub target: f64,
    /// The layer that decides.
    pub layer: Option<LayerId>,
    /// The limit that counts in place of what the layer asks for.
    pub limit: Option<DiameterLimit>,
}

/// Returns whether a mesh can meet a diameter, or infinity stands for none.
fn is_valid(diameter: f64) -> bool {
    diameter > 0.0
}

fn is_asked(diameter: f64) -> bool {
    is_valid(diameter) && diameter < f64::INFINITY
}

impl SizeField {
    /// h̄ at a point in world units.
    pub fn target_at(&self, paint: &PaintLayers, point: DVec2) -> f64 {
        let before = self.ungraded_at(paint, point).target;
        match self.slope() {
            None => before,
            Some(slope) => {
                let how = (slope, Accuracy::Close);
                self.graded(&mut self.known_for_points(), paint, point, how, before).0
            }
        }
    }

    /// Returns what is known of h̄ in parts of the lattice, for searches for h̄ at points: nothing yet.
    ///
    /// Where the finest of all layers counts, the layers of which a closed form says what gradation carries
    /// need no search. They are what takes long to bound over a rectangle: distances to many segments.
    /// Without them, `unasked` must not ask for more than they do.
    pub(super) fn known_for_points(&self) -> KnownParts {
        let is_background = self.spec().unasked >= self.spec().transfer.h_max;
        let closed = self.compiled().iter().enumerate().filter(|(_, layer)| layer.has_closed_form());
        let counting = closed.fold(Counting::ALL, |counting, (number, _)| counting.without(number));
        KnownParts::of(if is_background { counting } else { Counting::ALL })
    }

    /// h̄ at a point with gradation, and the place that it is carried from, both in world units. `how` is the
    /// largest slope and the accuracy; `before` is a value that h̄ is known not to exceed.
    pub(super) fn graded(
        &self,
        known: &mut KnownParts,
        paint: &PaintLayers,
        point: DVec2,
        how: (f64, Accuracy),
        before: f64,
    ) -> (f64, DVec2) {
        let mut start = (before, point);
        for layer in self.compiled() {
            start = layer.carried_to(point, start.0).unwrap_or(start);
        }
        gradation::least(self, paint, known, point, how, start)
    }

    /// h̄ at a node, in world units, for the vertex rule.
    ///
    /// A value that no mesh can meet (NaN, zero or less) is returned as it is, for the rule to refuse.
    pub fn target_at_node(&self, paint: &PaintLayers, point: DVec2) -> f64 {
        self.invalid_at(paint, point).unwrap_or_else(|| self.target_at(paint, point))
    }

    /// Returns a diameter that a layer asks for at a point in world units and that no mesh can meet.
    pub(super) fn invalid_at(&self, paint: &PaintLayers, point: DVec2) -> Option<f64> {
        let asked = self.compiled().iter().map(|layer| layer.diameter_at(paint, point));
        asked.into_iter().find(|diameter| !is_valid(*diameter))
    }

    /// h̄ at a point in world units, as `rule` sees it: what files and the inspector show.
    pub fn target_by_rule(&self, rule: RefinementRule, paint: &PaintLayers, point: DVec2) -> f64 {
        match rule {
            RefinementRule::Area => self.target_at(paint, point),
            RefinementRule::Vertex => self.target_at_node(paint, point),
        }
    }

    /// Returns the level at which triangles around a point are no longer than a diameter; `None` where no
    /// level is fine enough. In the plane of a projection the diameter is one on the Earth.
    pub fn level_of_diameter(&self, diameter: f64, point: DVec2) -> Option<u32> {
        let (place, extent) = (self.lattice().nearest(point), self.lattice().extent());
        // A place on the upper or right side belongs to the last square.
        let within = LatticePoint::new(place.x.min(extent.x - 1), place.y.min(extent.y - 1));
        let level = self.edge_lengths().first_level_at(within, diameter);
        Some(level).filter(|&level| diameter > 0.0 && (level as usize) < LEVELS)
    }

    /// Returns h̄ at a point in world units, with the layer that decides it.
    pub fn decision_at(&self, paint: &PaintLayers, point: DVec2) -> Decision {
        self.decision(&mut self.known_for_points(), paint, point, Accuracy::Close)
    }

    /// Returns the decision of [`Self::decision_at`] fast enough for a pointer. With gradation, the diameter
    /// may exceed h̄ by 10⁻³ of it where an exact search would take too long. `squares` must have been used
    /// for this field and these pixels only.
    pub fn quick_decision_at(
        &self,
        squares: &mut SettledSquares,
        paint: &PaintLayers,
        point: DVec2,
    ) -> Decision {
        squares.make_room();
        self.decision(&mut squares.known, paint, point, Accuracy::Quick)
    }

    fn decision(
        &self,
        known: &mut KnownParts,
        paint: &PaintLayers,
        point: DVec2,
        accuracy: Accuracy,
    ) -> Decision {
        let asked = self.compiled().iter().map(|layer| {
            let diameter = layer.diameter_at(paint, point);
            (layer.id, is_asked(diameter).then_some(diameter))
        });
        let asked = asked.collect();
        let before = self.ungraded_at(paint, point);
        let Ungraded { target, layer, limit } = before;
        let graded = self.slope().map(|slope| self.graded(known, paint, point, (slope, accuracy), target));
        match graded {
            Some((carried, from)) if carried < target => {
                let source = self.ungraded_at(paint, from);
                let Ungraded { layer, limit, .. } = if source.layer.is_some() { source } else { before };
                Decision { target: carried, layer, limit, from, asked }
            }
            _ => Decision { target, layer, limit, from: point, asked },
        }
    }

    /// h̄ before gradation, and what decides it.
    pub(super) fn ungraded_at(&self, paint: &PaintLayers, point: DVec2) -> Ungraded {
        self.ungraded_by(Counting::ALL, paint, point)
    }

    /// The same of some layers only.
    pub(super) fn ungraded_by(&self, counting: Counting, paint: &PaintLayers, point: DVec2) -> Ungraded {
        let (mut target, mut decides) = (f64::INFINITY, None);
        for (_, layer) in self.counting(counting) {
            let diameter = layer.diameter_at(paint, point);
            if !is_asked(diameter) {
                continue;
            }
            let counts = match layer.combine {
                Combine::Finest => diameter < target,
                Combine::Floor => diameter > target,
                Combine::Replace => true,
            };
            if counts {
                (target, decides) = (diameter, Some(layer.id));
            }
        }
        Ungraded { target: self.limited(target), layer: decides, limit: self.limit_of(target) }
    }

    /// Returns the limit that a diameter which the layers ask for passes.
    fn limit_of(&self, asked: f64) -> Option<DiameterLimit> {
        let Transfer { h_min, h_max, .. } = self.spec().transfer;
        match asked {
            _ if asked < h_min => Some(DiameterLimit::Smallest),
            _ if asked > h_max && asked < f64::INFINITY => Some(DiameterLimit::Largest),
            _ => None,
        }
    }

    /// Returns a diameter that the layers ask for, within the limits; infinity means that none does.
    fn limited(&self, asked: f64) -> f64 {
        let Transfer { h_min, h_max, .. } = self.spec().transfer;
        if asked == f64::INFINITY { self.spec().unasked } else { asked.clamp(h_min, h_max) }
    }

    /// Returns the least and the greatest h̄ of some cells before gradation, and where to divide them to know
    /// more. No other layers than those `counting` can count there.
    pub(super) fn diameters(
        &self,
        paint: &PaintLayers,
        cells: &Cells,
        counting: Counting,
    ) -> ([f64; 2], Option<Cut>) {
        let (asked, cut) = self.asked_by(counting, paint, cells);
        let [low, high] = self.limited_diameters(asked);
        ([low, high], cut.filter(|_| low < high))
    }

    /// Returns the least and the greatest h̄ before gradation, from the least and the greatest diameter asked
    /// for.
    pub(super) fn limited_diameters(&self, [least, greatest]: [f64; 2]) -> [f64; 2] {
        let (low, high) = (self.limited(least), self.limited(greatest));
        if greatest == f64::INFINITY && least < f64::INFINITY {
            // Somewhere perhaps nothing is asked for, and there h̄ may be less or more than what is asked.
            let unasked = self.spec().unasked;
            return [low.min(unasked), self.spec().transfer.h_max.max(unasked)];
        }
        [low, high]
    }

    /// Returns the visible layers that can count, from the bottom to the top, with their numbers.
    pub(super) fn counting(&self, counting: Counting) -> impl Iterator<Item = (usize, &CompiledLayer)> {
        self.compiled().iter().enumerate().filter(move |&(number, _)| counting.has(number))
    }

    /// Returns the least and the greatest diameter that the layers ask for in some cells, infinite where
    /// nothing is asked for, and where to divide them to know more.
    pub(super) fn asked_diameters(&self, paint: &PaintLayers, cells: &Cells) -> ([f64; 2], Option<Cut>) {
        self.asked_by(Counting::ALL, paint, cells)
    }

    /// Returns the result of [`Self::asked_diameters`] if only the layers of `counting` can count.
    fn asked_by(&self, counting: Counting, paint: &PaintLayers, cells: &Cells) -> ([f64; 2], Option<Cut>) {
        let (mut least, mut greatest, mut cut) = (f64::INFINITY, f64::INFINITY, None);
        for (_, layer) in self.counting(counting) {
            let (diameters, layer_cut) = layer.diameters(paint, cells, self.lattice());
            let Diameters { least: low, greatest: high, present } = diameters;
            match (layer.combine, present) {
                (_, Share::None) => {}
                (Combine::Finest, _) => (least, greatest) = (least.min(low), greatest.min(high)),
                (Combine::Floor, Share::All) => (least, greatest) = (least.max(low), greatest.max(high)),
                (Combine::Floor, Share::Some) => greatest = greatest.max(high),
                (Combine::Replace, Share::All) => (least, greatest, cut) = (low, high, None),
                (Combine::Replace, Share::Some) => {
                    (least, greatest) = (least.min(low), greatest.max(high));
                }
            }
            // A cut between pixels makes diameters exact; one in the middle of a function does not.
            cut = if layer.has_pixels() { layer_cut.or(cut) } else { cut.or(layer_cut) };
        }
        ([least, greatest], cut)
    }
}

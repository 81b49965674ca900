//! h̄ at points and over rectangles before gradation, and at points with it.

use glam::DVec2;

use super::asked::Ternary;
use super::cells::{Cells, Cut};
use super::compiled::CompiledLayer;
use super::counting::Counting;
use super::gradation::{self, Accuracy};
use super::parts::KnownParts;
use super::reading::Diameters;
use super::stack::{Stack, StackLimits};
use crate::layers::{Combine, LayerId, PaintLayers};

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
pub struct Ungraded {
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

/// Returns whether a layer asks for a diameter that a mesh can meet.
pub fn is_asked(diameter: f64) -> bool {
    is_valid(diameter) && diameter < f64::INFINITY
}

impl Stack {
    /// Returns what is known of h̄ in parts of the lattice, for searches for h̄ at points: nothing yet.
    ///
    /// Where the finest of all layers counts, the layers of which a closed form says what gradation carries
    /// need no search. They are what takes long to bound over a rectangle: distances to many segments.
    /// Without them, `unasked` must not ask for more than they do.
    pub fn known_for_points(&self) -> KnownParts {
        let is_background = self.limits().unasked >= self.limits().h_max;
        let closed = self.layers().iter().enumerate().filter(|(_, layer)| layer.has_closed_form());
        let counting = closed.fold(Counting::ALL, |counting, (number, _)| counting.without(number));
        KnownParts::of(if is_background { counting } else { Counting::ALL })
    }

    /// h̄ at a point with gradation, and the place that it is carried from, both in world units. `how` is the
    /// largest slope and the accuracy; `before` is a value that h̄ is known not to exceed.
    pub fn graded(
        &self,
        known: &mut KnownParts,
        paint: &PaintLayers,
        point: DVec2,
        how: (f64, Accuracy),
        before: f64,
    ) -> (f64, DVec2) {
        let mut start = (before, point);
        for layer in self.layers() {
            start = layer.carried_to(point, start.0).unwrap_or(start);
        }
        gradation::least(self, paint, known, point, how, start)
    }

    /// Returns a diameter that a layer asks for at a point in world units and that no mesh can meet.
    pub fn invalid_at(&self, paint: &PaintLayers, point: DVec2) -> Option<f64> {
        let asked = self.layers().iter().map(|layer| layer.diameter_at(paint, point));
        asked.into_iter().find(|diameter| !is_valid(*diameter))
    }

    /// h̄ before gradation, and what decides it.
    pub fn ungraded_at(&self, paint: &PaintLayers, point: DVec2) -> Ungraded {
        self.ungraded_by(Counting::ALL, paint, point)
    }

    /// The same of some layers only.
    pub fn ungraded_by(&self, counting: Counting, paint: &PaintLayers, point: DVec2) -> Ungraded {
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
        let StackLimits { h_min, h_max, .. } = *self.limits();
        match asked {
            _ if asked < h_min => Some(DiameterLimit::Smallest),
            _ if asked > h_max && asked < f64::INFINITY => Some(DiameterLimit::Largest),
            _ => None,
        }
    }

    /// Returns a diameter that the layers ask for, within the limits; infinity means that none does.
    fn limited(&self, asked: f64) -> f64 {
        let StackLimits { h_min, h_max, .. } = *self.limits();
        if asked == f64::INFINITY { self.limits().unasked } else { asked.clamp(h_min, h_max) }
    }

    /// Returns the least and the greatest h̄ of some cells before gradation, and where to divide them to know
    /// more. No other layers than those `counting` can count there.
    pub fn diameters(
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
    pub fn limited_diameters(&self, [least, greatest]: [f64; 2]) -> [f64; 2] {
        let (low, high) = (self.limited(least), self.limited(greatest));
        if greatest == f64::INFINITY && least < f64::INFINITY {
            // Somewhere perhaps nothing is asked for, and there h̄ may be less or more than what is asked.
            let unasked = self.limits().unasked;
            return [low.min(unasked), self.limits().h_max.max(unasked)];
        }
        [low, high]
    }

    /// Returns the visible layers that can count, from the bottom to the top, with their numbers.
    pub fn counting(&self, counting: Counting) -> impl Iterator<Item = (usize, &CompiledLayer)> {
        self.layers().iter().enumerate().filter(move |&(number, _)| counting.has(number))
    }

    /// Returns the least and the greatest diameter that the layers ask for in some cells, infinite where
    /// nothing is asked for, and where to divide them to know more.
    pub fn asked_diameters(&self, paint: &PaintLayers, cells: &Cells) -> ([f64; 2], Option<Cut>) {
        self.asked_by(Counting::ALL, paint, cells)
    }

    /// Returns the result of [`Self::asked_diameters`] if only the layers of `counting` can count.
    fn asked_by(&self, counting: Counting, paint: &PaintLayers, cells: &Cells) -> ([f64; 2], Option<Cut>) {
        let (mut least, mut greatest, mut cut) = (f64::INFINITY, f64::INFINITY, None);
        for (_, layer) in self.counting(counting) {
            let (diameters, layer_cut) = layer.diameters(paint, cells, self.lattice());
            let Diameters { least: low, greatest: high, present } = diameters;
            match (layer.combine, present) {
                (_, Ternary::Never) => {}
                (Combine::Finest, _) => (least, greatest) = (least.min(low), greatest.min(high)),
                (Combine::Floor, Ternary::Always) => (least, greatest) = (least.max(low), greatest.max(high)),
                (Combine::Floor, Ternary::Maybe) => greatest = greatest.max(high),
                (Combine::Replace, Ternary::Always) => (least, greatest, cut) = (low, high, None),
                (Combine::Replace, Ternary::Maybe) => {
                    (least, greatest) = (least.min(low), greatest.max(high));
                }
            }
            // A cut between pixels makes diameters exact; one in the middle of a function does not.
            cut = if layer.has_pixels() { layer_cut.or(cut) } else { cut.or(layer_cut) };
        }
        ([least, greatest], cut)
    }
}

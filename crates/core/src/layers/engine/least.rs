//! The least h̄ in a closed triangle, by a search through rectangles of cells, best first.

use glam::DVec2;

use crate::geometry::{BestFirst, LatticePoint, Octagon, Rect};
use crate::layers::PaintLayers;

use super::gradation::{GradationSearch, SearchedPart, quarter_bits};
use super::parts::KnownParts;
use super::place::{ConvexSet, TriangleInWorld};
use super::reading::largest_below;
use super::stack::Stack;

/// The least h̄ in a closed triangle.
pub struct Least {
    /// The target diameter in world units.
    pub target: f64,
    /// A point of the triangle that has it.
    pub at: DVec2,
    /// The nearest point whose diameter makes it so: the same point, or one from which gradation carries it.
    pub from: DVec2,
}

/// A search stops at values that exceed the least value by less than this share of it.
const TOLERANCE: f64 = 1e-9;

/// The value is the least that was found in so many rectangles.
const MOST: usize = 1 << 16;

/// How often [`nearest_pair`] projects from one shape to the other. Each projection brings the points nearer.
const PROJECTIONS: usize = 60;

/// A slope with which no other cells count than those that touch the triangle.
const NO_GRADATION: f64 = f64::MAX;

/// Returns the least h̄ in the closed triangle with these corners.
pub fn least_within(stack: &Stack, paint: &PaintLayers, corners: [LatticePoint; 3]) -> Least {
    let lattice = stack.lattice();
    let place = TriangleInWorld::new(corners, lattice);
    let slope = stack.slope().unwrap_or(NO_GRADATION);
    let finest = quarter_bits(Octagon::triangle(corners).bounds()).max(stack.pixel_bits(paint));
    let search = GradationSearch { stack, paint, place, slope, finest };
    let origin = lattice.bounds().min;
    let all = Rect::new(DVec2::ZERO, lattice.bounds().max - origin);
    let (target, rect) = search.least(&mut KnownParts::default()).unwrap_or((stack.limits().unasked, all));
    let (at, from) = nearest_pair(&search.place, &rect);
    Least { target, at: origin + at, from: origin + from }
}

/// Returns whether h̄ is below a length at some point of the closed triangle with these corners, which need
/// not be one of a mesh. Where a search ends without an answer, it is.
///
/// A triangle of a mesh that meets the area rule has no such point, and nor has any triangle within it.
pub fn any_below(
    stack: &Stack,
    paint: &PaintLayers,
    known: &mut KnownParts,
    corners: [LatticePoint; 3],
    length: f64,
) -> bool {
    let limits = stack.limits();
    if length <= limits.h_min || length > limits.h_max {
        return length > limits.h_min;
    }
    let whole = known.whole(stack);
    if known.diameters(stack, paint, whole)[0] >= length {
        return false;
    }
    let place = TriangleInWorld::new(corners, stack.lattice());
    // What is carried is rounded, as in the area rule.
    let (slope, length) = match stack.slope() {
        Some(slope) => (slope, f64::from(largest_below(length)).next_up()),
        None => (NO_GRADATION, length * (1.0 - 0.5 * TOLERANCE)),
    };
    let finest = quarter_bits(Octagon::triangle(corners).bounds()).max(stack.pixel_bits(paint));
    GradationSearch { stack, paint, place, slope, finest }.any_below_in_triangle(known, length)
}

impl GradationSearch<'_, TriangleInWorld> {
    /// Returns whether a cell, at distance d from the triangle, has h + g d < `length`.
    fn any_below_in_triangle(&self, known: &mut KnownParts, length: f64) -> bool {
        let mut parts = BestFirst::default();
        let is_below = |known: &mut KnownParts, id, parts: &mut BestFirst<SearchedPart>| {
            let Some((bound, part)) = self.part(known, id, length) else { return false };
            parts.push(bound, part);
            part.greatest + self.slope * part.distance < length
        };
        if self.start(known, self.stack.limits().h_min, length).any(|id| is_below(known, id, &mut parts)) {
            return true;
        }
        for _ in 0..MOST {
            let Some((_, part)) = parts.pop() else { return false };
            // At the triangle itself, all cells count.
            if part.distance > 0.0 && !self.is_steep(known, part.id) {
                continue;
            }
            if self.divided(known, part.id).any(|id| is_below(known, id, &mut parts)) {
                return true;
            }
        }
        true
    }

    /// Returns the least value of a cell, carried to the triangle, and a rectangle that has it.
    fn least(&self, known: &mut KnownParts) -> Option<(f64, Rect)> {
        let mut parts = BestFirst::default();
        let mut best = (f64::INFINITY, Rect::UNIT);
        let offer = |known: &KnownParts,
                     (bound, part): (f64, SearchedPart),
                     parts: &mut BestFirst<SearchedPart>,
                     best: &mut (f64, Rect)| {
            let sure = part.greatest + self.slope * part.distance;
            if sure < best.0 {
                *best = (sure, self.rect(known, part.id));
            }
            if part.least < part.greatest {
                parts.push(bound, part);
            }
        };
        let most = self.stack.limits().h_max.max(self.stack.limits().unasked);
        for id in self.start(known, self.stack.limits().h_min, most) {
            let found = self.part(known, id, f64::INFINITY);
            found.into_iter().for_each(|found| offer(known, found, &mut parts, &mut best));
        }
        for _ in 0..MOST {
            let limit = best.0 * (1.0 - TOLERANCE);
            let Some((bound, part)) = parts.pop().filter(|(bound, _)| *bound < limit) else { break };
            debug_assert!(bound <= part.greatest + self.slope * part.distance);
            // At the triangle itself, all cells count.
            if part.distance > 0.0 && !self.is_steep(known, part.id) {
                continue;
            }
            for id in self.divided(known, part.id) {
                let found = self.part(known, id, limit);
                found.into_iter().for_each(|found| offer(known, found, &mut parts, &mut best));
            }
        }
        best.0.is_finite().then_some(best)
    }
}

/// Returns a point of the triangle and a point of the rectangle that are as near to each other as any; the
/// same point where the shapes meet. By alternating projections between convex sets.
fn nearest_pair(triangle: &TriangleInWorld, rect: &Rect) -> (DVec2, DVec2) {
    let mut at = triangle.centroid();
    let mut from = at.clamp(rect.min, rect.max);
    for _ in 0..PROJECTIONS {
        at = triangle.nearest(from);
        from = at.clamp(rect.min, rect.max);
    }
    (at, from)
}

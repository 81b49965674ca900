//! The least h̄ in a closed triangle, by a search through rectangles of cells, best first.

use glam::DVec2;

use crate::geometry::{BestFirst, LatticePoint, Octagon, Rect};
use crate::layers::PaintLayers;

use super::gradation::{GradationSearch, SearchedPart, quarter_bits};
use super::parts::KnownParts;
use super::place::{ConvexSet, TriangleInWorld};
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

impl GradationSearch<'_, TriangleInWorld> {
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

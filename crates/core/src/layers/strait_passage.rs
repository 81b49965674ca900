//! The narrowest passage of the water: where a growing disc parts it first.
//!
//! Water wider than w is parted at a place where a disc of this width touches two shores at opposite points,
//! and on both sides of which the water is wider. A corner between two coasts has no such place: its discs
//! become smaller without end. Nor has a dead end, on one side of which the water only ends.
//!
//! The search starts at the discs of straits that touch their shores nearly at opposite points, moves both
//! points along their shores while they come nearer to each other, and follows the middle of the water from
//! there both ways.

use std::collections::BTreeSet;

use glam::DVec2;

use super::straits::MedialBall;
use crate::domain::{BoundaryMarks, Coasts, Domain, corners};
use crate::geometry::{BoxTree, Rect, nearest_on_segment};

/// The length of a crossing, at least, as a share of the width of the disc that touches its ends.
const OPPOSITE: f64 = 0.98;
/// Discs are at most this much wider than the narrowest place of the passage that they are in.
const NEAR: f64 = 1.1;
/// Water on both sides of a passage is wider than it by this factor.
const WIDER: f64 = 1.1;
/// The middle of the water is followed while it is not narrower than the passage by more than this factor.
const NARROWER: f64 = 0.99;
/// A step along the middle of the water, in half widths of the passage.
const STEP: f64 = 0.25;
/// Steps after which water that has not become narrower goes on.
const MOST_STEPS: usize = 400;
/// The middle of the water is looked for up to so many half widths to the side of a step.
const ASIDE: f64 = 0.5;
/// An open boundary is farther from the middle of a passage than this share of the half width.
const OPEN: f64 = 0.5;
/// Distances that differ by a smaller share are the same.
const SAME: f64 = 1e-9;
/// A disc has no coast within it if none is nearer to its middle than this share of its radius.
const EMPTY: f64 = 1.0 - 1e-6;

/// Returns the narrowest passage, if there is one, of those in the straits of a domain. `discs` are the
/// places of its straits, the narrowest first.
pub(super) fn narrowest_passage(
    domain: &Domain,
    marks: &BoundaryMarks,
    discs: &[MedialBall],
) -> Option<MedialBall> {
    if discs.is_empty() {
        return None;
    }
    let water = Water::new(domain, marks);
    let mut seen = BTreeSet::new();
    let mut narrowest: Option<MedialBall> = None;
    for disc in discs {
        if narrowest.is_some_and(|narrowest| disc.width > NEAR * narrowest.width) {
            break;
        }
        let [from, to] = disc.shores;
        if from.distance(to) < OPPOSITE * disc.width {
            continue;
        }
        let Some((edges, passage)) = water.narrowed(disc) else { continue };
        let is_narrower = narrowest.is_none_or(|narrowest| passage.width < narrowest.width);
        if is_narrower && seen.insert(edges) && water.is_passage(&passage) {
            narrowest = Some(passage);
        }
    }
    narrowest
}

/// The coasts of a domain and its whole boundary, with indices.
struct Water {
    coasts: Coasts,
    before: Vec<Option<u32>>,
    coast_tree: BoxTree,
    boundary: Vec<[DVec2; 2]>,
    boundary_tree: BoxTree,
}

impl Water {
    fn new(domain: &Domain, marks: &BoundaryMarks) -> Self {
        let coasts = Coasts::new(domain, marks);
        let mut before = vec![None; coasts.edges.len()];
        for (number, edge) in coasts.edges.iter().enumerate() {
            if let Some(next) = edge.next {
                before[next as usize] = Some(number as u32);
            }
        }
        let boundary: Vec<[DVec2; 2]> = match domain.region() {
            Some(region) => region.edges().collect(),
            None => {
                let corners = corners(&domain.bounds);
                corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]).collect()
            }
        };
        let coast_tree = tree_of(coasts.edges.iter().map(|edge| edge.ends));
        let boundary_tree = tree_of(boundary.iter().copied());
        Self { coasts, before, coast_tree, boundary, boundary_tree }
    }

    fn ends(&self, edge: u32) -> [DVec2; 2] {
        self.coasts.edges[edge as usize].ends
    }

    fn nearest_edge(&self, point: DVec2) -> Option<(u32, f64)> {
        let on = |edge: u32| nearest_on_segment(point, self.ends(edge));
        self.coast_tree.nearest(point, |edge| point.distance_squared(on(edge)))
    }

    /// Returns the distance to the nearest coast.
    fn room(&self, point: DVec2) -> f64 {
        self.nearest_edge(point).map_or(f64::INFINITY, |(_, squared)| squared.sqrt())
    }

    /// Returns the distance to the nearest part of the boundary, also where water flows through.
    fn to_boundary(&self, point: DVec2) -> f64 {
        let on = |edge: u32| nearest_on_segment(point, self.boundary[edge as usize]);
        let nearest = self.boundary_tree.nearest(point, |edge| point.distance_squared(on(edge)));
        nearest.map_or(f64::INFINITY, |(_, squared)| squared.sqrt())
    }

    fn beside(&self, edge: u32) -> [Option<u32>; 2] {
        [self.before[edge as usize], self.coasts.edges[edge as usize].next]
    }

    /// Moves the ends of a crossing along their shores while they come nearer to each other. Returns the two
    /// edges that they come to, and the disc between them; nothing if they meet.
    fn narrowed(&self, disc: &MedialBall) -> Option<([u32; 2], MedialBall)> {
        let [from, to] = disc.shores;
        let (mut a, mut b) = (self.nearest_edge(from)?.0, self.nearest_edge(to)?.0);
        let mut shores = closest(self.ends(a), self.ends(b));
        loop {
            let width = length(shores);
            let moved =
                self.beside(a).map(|a| (a, Some(b))).into_iter().chain(self.beside(b).map(|b| (Some(a), b)));
            let moved = moved.filter_map(|(a, b)| Some((a?, b?)));
            let nearer = moved.map(|(a, b)| (a, b, closest(self.ends(a), self.ends(b))));
            let nearest = nearer.min_by(|x, y| length(x.2).total_cmp(&length(y.2)));
            match nearest.filter(|nearest| length(nearest.2) < width * (1.0 - SAME)) {
                Some(nearest) => (a, b, shores) = nearest,
                None => break,
            }
        }
        let [from, to] = shores;
        let width = length(shores);
        let is_apart = width > SAME * disc.width;
        is_apart.then_some(([a.min(b), a.max(b)], MedialBall { center: from.midpoint(to), shores, width }))
    }

    /// Returns whether no coast is within the disc between two shores, and the water on both sides is wider.
    fn is_passage(&self, place: &MedialBall) -> bool {
        let half = 0.5 * place.width;
        let [from, to] = place.shores;
        let along = (to - from).perp().normalize_or_zero();
        self.room(place.center) >= EMPTY * half
            && self.to_boundary(place.center) >= OPEN * half
            && [along, -along].into_iter().all(|heading| self.widens(place, heading))
    }

    /// Follows the middle of the water. Returns whether it becomes wider, or goes on.
    fn widens(&self, place: &MedialBall, start: DVec2) -> bool {
        let half = 0.5 * place.width;
        let (mut at, mut heading) = (place.center, start);
        for _ in 0..MOST_STEPS {
            let next = self.centred(at + STEP * half * heading, heading.perp(), half);
            let room = self.room(next);
            if room >= WIDER * half {
                return true;
            }
            if room < NARROWER * half {
                return false;
            }
            if self.to_boundary(next) < OPEN * half {
                return true;
            }
            // Back at the start: from the other side, around an island, or from this one, out of a dead end.
            let [before, after] = [at, next].map(|point| (point - place.center).dot(start));
            if next.distance(place.center) < half && (before > 0.0) != (after > 0.0) && at != place.center {
                return before < 0.0;
            }
            (at, heading) = (next, (next - at).normalize_or(heading));
        }
        true
    }

    /// Returns the point with the most room on the line through a point.
    fn centred(&self, point: DVec2, direction: DVec2, half: f64) -> DVec2 {
        let mut best = (self.room(point), point);
        let mut reach = ASIDE * half;
        for _ in 0..6 {
            let middle = best.1;
            for n in [-2.0, -1.0, 1.0, 2.0] {
                let other = middle + 0.5 * n * reach * direction;
                let room = self.room(other);
                if room > best.0 && (other - point).length() <= ASIDE * half {
                    best = (room, other);
                }
            }
            reach *= 0.5;
        }
        best.1
    }
}

fn tree_of(edges: impl Iterator<Item = [DVec2; 2]>) -> BoxTree {
    BoxTree::new(&edges.map(|[a, b]| Rect::spanning(a, b)).collect::<Vec<Rect>>())
}

fn length([from, to]: [DVec2; 2]) -> f64 {
    from.distance(to)
}

/// Returns the points of two segments that do not cross that are nearest to each other: in the middle where
/// there are many.
fn closest(a: [DVec2; 2], b: [DVec2; 2]) -> [DVec2; 2] {
    let from_a = a.map(|end| [end, nearest_on_segment(end, b)]);
    let from_b = b.map(|end| [nearest_on_segment(end, a), end]);
    let pairs = || from_a.into_iter().chain(from_b);
    let least = pairs().map(length).fold(f64::INFINITY, f64::min);
    let nearest = pairs().filter(|&pair| length(pair) <= least * (1.0 + SAME));
    let (sum, count) = nearest.fold(([DVec2::ZERO; 2], 0.0), |([from, to], count), pair| {
        ([from + pair[0], to + pair[1]], count + 1.0)
    });
    sum.map(|sum| sum / count)
}

#[cfg(test)]
mod tests;

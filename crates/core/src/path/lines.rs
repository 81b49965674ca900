//! Paths along lines on which the cost is smaller than in the triangles around them.
//!
//! The mean of a triangle hides a line such as that of `if(abs(x - 0.5) < 1e-11, 1, 10)`. Its least cost does
//! not: a march with least costs goes along the triangles that the line passes. Beside each piece of its path
//! there, a place is searched that costs about as little, and then the best chords between all these points.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec2, dvec2};

use super::march::March;
use super::path_mesh::PathMesh;
use super::place::MeshPlace;
use super::refine::{Effort, refine};
use super::trace::trace;
use super::triangle_costs::TriangleCosts;
use super::walls::Walls;
use super::{CostDensity, Passage};
use crate::geometry::{GAUSS, Rect};

/// A triangle hides a line if its least cost is below this part of its mean.
const HIDDEN: f64 = 0.6;
/// A place costs about the least of its triangle if it costs less than this times as much.
const ABOUT: f64 = 1.05;
/// The most rectangles in which one place is searched.
const MOST_RECTANGLES: usize = 600;
/// A chord leaves out fewer points than this.
const LONGEST_CHORD: usize = 96;
/// The most places that are tried on a line beyond the one where a path comes to it.
const MOST_FARTHER: usize = 24;
/// The distance of the first of them, as a part of the longer side of the mesh.
const NEXT: f64 = 2e-4;
/// The distance of each of the others, as a multiple of the one before.
const STRETCH: f64 = 1.3;
/// The least and the largest number of pieces in which the cost of a chord is summed.
const SUMMED: [f64; 2] = [2.0, 32.0];
/// The number of pieces of a chord that is as long as the longer side of the mesh.
const SUMMED_LENGTH: f64 = 500.0;
/// The part of a chord over which the upper bound of a path takes bounds of the cost.
const SHORT: f64 = 1.0 / 4096.0;
/// A march with least costs promises at least this part less than the known path.
const LEAST_PROMISE: f64 = 1e-3;

/// The data with which a path is searched.
pub(super) struct LineSearch<'a> {
    pub mesh: &'a PathMesh,
    pub costs: &'a TriangleCosts,
    pub walls: &'a Walls,
    pub density: &'a dyn CostDensity,
    /// The longer side of the rectangle around the mesh.
    pub size: f64,
}

/// A point of a path, and whether it was moved to a line.
#[derive(Clone, Copy)]
struct ChordPoint {
    at: DVec2,
    is_on_line: bool,
}

impl LineSearch<'_> {
    /// Returns a path that the walls admit, where lines may lead to one that costs less than `known`.
    pub(super) fn path(&self, ends: [MeshPlace; 2], known: f64, effort: Effort) -> Option<Vec<DVec2>> {
        let has_any = (0..self.mesh.triangle_count() as u32).any(|t| self.hides_line(t));
        if !has_any {
            return None;
        }
        let [start, goal] = ends;
        let (mut march, least) = (March::default(), &self.costs.least);
        let until = Some(goal.corner_nodes(self.mesh));
        march.run(self.mesh, least, Passage::Open, &start.seeds(self.mesh, least), until);
        let at_goal = goal.seeds(self.mesh, least).into_iter().map(|(node, rest)| march.value(node) + rest);
        if at_goal.fold(f64::INFINITY, f64::min) > known * (1.0 - LEAST_PROMISE) {
            return None;
        }
        let traced = trace(self.mesh, least, &march, ends).filter(|traced| self.walls.admit_all(traced))?;
        let chords = self.chords(&self.beside_lines(&traced))?;
        if !self.has_bounds_along(&chords) {
            return None;
        }
        Some(self.refined(&chords, effort))
    }

    /// Returns whether the cost has close bounds on the chords along lines. It has none on an oblique line,
    /// whose every rectangle reaches beyond it, and then an upper bound of the path is as if there was no
    /// line.
    fn has_bounds_along(&self, points: &[ChordPoint]) -> bool {
        points.windows(2).filter(|pair| pair[0].is_on_line && pair[1].is_on_line).all(|pair| {
            let [p, q] = [pair[0].at, pair[1].at];
            let range = self.density.range(&Rect::spanning(p.midpoint(q), p.lerp(q, 0.5 + SHORT)));
            HIDDEN * range.greatest <= range.least
        })
    }

    fn hides_line(&self, t: u32) -> bool {
        let (least, mean) = (self.costs.least[t as usize], self.costs.mean[t as usize]);
        self.mesh.passage(t) == Passage::Open && least < HIDDEN * mean
    }

    /// Returns the points of a path, and between them the nearest places on lines. Where the path comes to a
    /// line or leaves it, so do places before and after: the march tells only roughly where that is best.
    fn beside_lines(&self, traced: &[DVec2]) -> Vec<ChordPoint> {
        let middle = |piece: usize| traced[piece].midpoint(traced[piece + 1]);
        let places: Vec<Option<DVec2>> =
            (0..traced.len() - 1).map(|piece| self.place_on_line(middle(piece))).collect();
        let mut points = vec![ChordPoint { at: traced[0], is_on_line: false }];
        let on_line = |at: DVec2| ChordPoint { at, is_on_line: true };
        for (piece, place) in places.iter().enumerate() {
            if let Some(at) = *place {
                let before = piece.checked_sub(1).and_then(|before| places[before]);
                let after = places.get(piece + 1).copied().flatten();
                if let (None, Some(after)) = (before, after) {
                    let mut farther = self.places_farther(after, at);
                    farther.reverse();
                    points.extend(farther.into_iter().map(on_line));
                }
                points.push(on_line(at));
                if let (Some(before), None) = (before, after) {
                    points.extend(self.places_farther(before, at).into_iter().map(on_line));
                }
            }
            points.push(ChordPoint { at: traced[piece + 1], is_on_line: false });
        }
        points
    }

    /// Returns the places on a line beyond one of two that lie on it, farther and farther.
    fn places_farther(&self, from: DVec2, beyond: DVec2) -> Vec<DVec2> {
        let direction = (beyond - from).normalize_or_zero();
        let distances = std::iter::successors(Some(NEXT * self.size), |distance| Some(STRETCH * distance));
        let along = distances.take(MOST_FARTHER).map(|distance| beyond + distance * direction);
        along.map_while(|place| self.place_on_line(place)).collect()
    }

    /// Returns a place on a line near a point in an open triangle that hides one.
    fn place_on_line(&self, near: DVec2) -> Option<DVec2> {
        // A path along the line often follows edges, and then the line is in the triangles on one side only.
        let triangles = self.mesh.open_triangles_at(near);
        triangles.into_iter().filter(|&t| self.hides_line(t)).find_map(|t| self.cheap_place(t, near))
    }

    /// Returns a place in the rectangle around a triangle that costs about the triangle's least: of the
    /// smallest bounds one near a point.
    fn cheap_place(&self, t: u32, near: DVec2) -> Option<DVec2> {
        let enough = ABOUT * self.costs.least[t as usize];
        let mut open = BinaryHeap::new();
        open.push(CheapRectangle::new(self.density, self.mesh.rectangle(t), near, 0));
        let mut looked_at = 0;
        while let Some(CheapRectangle { least, greatest, rectangle, depth, .. }) = open.pop() {
            if least > enough || looked_at > MOST_RECTANGLES {
                return None;
            }
            let place = near.clamp(rectangle.min, rectangle.max);
            let middle = rectangle.center();
            if greatest <= enough || self.density.at(place) <= enough {
                return Some(place);
            }
            if self.density.at(middle) <= enough {
                return Some(middle);
            }
            let Rect { min, max } = rectangle;
            // Numbers are no finer: no place of the rectangle is known to cost so little.
            if middle == min || middle == max {
                continue;
            }
            for corner in [min, max, dvec2(min.x, max.y), dvec2(max.x, min.y)] {
                open.push(CheapRectangle::new(self.density, Rect::spanning(corner, middle), near, depth + 1));
                looked_at += 1;
            }
        }
        None
    }

    /// Returns the points of the polyline of least cost among those that leave out some of the given points.
    /// `None` where the walls admit none.
    fn chords(&self, points: &[ChordPoint]) -> Option<Vec<ChordPoint>> {
        let mut best = vec![(f64::INFINITY, 0); points.len()];
        best[0].0 = 0.0;
        for end in 1..points.len() {
            for start in end.saturating_sub(LONGEST_CHORD)..end {
                let [p, q] = [points[start].at, points[end].at];
                let before = best[start].0;
                // The cost of the chord is asked for last: it is the most work.
                if before < best[end].0 && self.walls.admit(p, q) {
                    let cost = before + self.chord(p, q);
                    if cost < best[end].0 {
                        best[end] = (cost, start);
                    }
                }
            }
        }
        let mut at = points.len() - 1;
        if best[at].0 == f64::INFINITY {
            return None;
        }
        let mut kept = vec![points[at]];
        // Ends: each point comes from one before it.
        while at > 0 {
            at = best[at].1;
            kept.push(points[at]);
        }
        kept.reverse();
        Some(kept)
    }

    /// About what a segment costs.
    fn chord(&self, p: DVec2, q: DVec2) -> f64 {
        let range = self.density.range(&Rect::spanning(p, q));
        let length = p.distance(q);
        if range.least == range.greatest {
            return length * range.least;
        }
        let count = (SUMMED_LENGTH * length / self.size).ceil().clamp(SUMMED[0], SUMMED[1]) as u32;
        let share = |n: u32, part: f64| (f64::from(n) + part) / f64::from(count);
        let places = (0..count).flat_map(|n| GAUSS.map(|part| share(n, part)));
        let sum: f64 = places.map(|share| self.density.at(p.lerp(q, share))).sum();
        length * sum / f64::from(2 * count)
    }

    /// Returns this path with the parts between lines moved to where they cost less.
    fn refined(&self, points: &[ChordPoint], effort: Effort) -> Vec<DVec2> {
        let mut refined = vec![points[0].at];
        let mut first = 0;
        for last in 1..points.len() {
            if !points[last].is_on_line && last + 1 < points.len() {
                continue;
            }
            let part: Vec<DVec2> = points[first..=last].iter().map(|point| point.at).collect();
            let is_along = part.len() == 2 && points[first].is_on_line && points[last].is_on_line;
            let moved = if is_along { part.clone() } else { refine(&part, self.density, self.walls, effort) };
            let sum = |points: &[DVec2]| points.windows(2).map(|p| self.chord(p[0], p[1])).sum::<f64>();
            let better = if sum(&moved) < sum(&part) { moved } else { part };
            refined.extend(&better[1..]);
            first = last;
        }
        refined
    }
}

/// A rectangle in which a cheap place may lie.
struct CheapRectangle {
    least: f64,
    greatest: f64,
    /// How often it was quartered.
    depth: u32,
    /// The square of the distance from where the place should be.
    distance: f64,
    rectangle: Rect,
}

impl CheapRectangle {
    fn new(density: &dyn CostDensity, rectangle: Rect, near: DVec2, depth: u32) -> Self {
        let range = density.range(&rectangle);
        let distance = near.distance_squared(near.clamp(rectangle.min, rectangle.max));
        Self { least: range.least, greatest: range.greatest, depth, distance, rectangle }
    }
}

impl Ord for CheapRectangle {
    /// The greatest comes first: that of the least cost, of these the smallest, and then the nearest. With
    /// the nearest before the smallest, all rectangles that a line passes near the place would be divided.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = other.least.total_cmp(&self.least);
        by_cost.then(self.depth.cmp(&other.depth)).then(other.distance.total_cmp(&self.distance))
    }
}
impl PartialOrd for CheapRectangle {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for CheapRectangle {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for CheapRectangle {}

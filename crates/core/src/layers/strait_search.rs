//! How straits are found: by medial balls, discs that touch two coasts.
//!
//! The discs are the medial balls of the water, found from their contact points by the shrinking ball of
//! [MaBaeChoi2012]: a disc touches the coast at the point, keeps its centre on the normal there, and shrinks
//! until no coast is within it.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::straits::{CENTERS, MedialBall, MedialBalls, POINTS};
use crate::domain::{BoundaryMarks, CoastEdge, Coasts, Domain, Region};
use crate::geometry::{BoxTree, NumberMap, Rect, nearest_on_segment};
use crate::mesh::Progress;

/// The way along a ring from one side of a crossing to the other, at least, as a multiple of its length.
/// Corners wider than 53°, and coves wider than deep, have none.
const LAMBDA: f64 = 2.0;
/// Steps of a disc that shrinks, at most.
const MOST_STEPS: u32 = 60;
/// A disc has shrunk enough where the nearest coast is nearer than its radius by less than this share.
const TOLERANCE: f64 = 1e-7;
/// Straits narrower than this share of the least width are none.
const NARROWEST: f64 = 1e-6;
/// Points along an edge, at most.
const MOST_POINTS: usize = 100_000;

/// The work of [`MedialBalls::of`], in slices.
#[derive(Debug)]
pub(crate) struct StraitSearch {
    region: Option<Arc<Region>>,
    marks: BoundaryMarks,
    between: [f64; 2],
    finder: Finder,
    /// The first edge of the coasts that was not looked at.
    next: usize,
    found: Vec<MedialBall>,
}

impl StraitSearch {
    /// Begins to look for the straits of a domain, between the coasts that marks leave.
    pub(crate) fn new(domain: &Domain, marks: &BoundaryMarks, between: [f64; 2]) -> Self {
        let in_plane = [between[0] * domain.least_scale(), between[1] * domain.greatest_scale()];
        let finder = Finder::new(Coasts::new(domain, marks), domain.bounds, in_plane);
        let (region, marks) = (domain.region().cloned(), marks.of_coasts());
        Self { region, marks, between, finder, next: 0, found: Vec::new() }
    }

    /// Looks along `edges` edges of the coasts.
    pub(crate) fn advance(&mut self, edges: usize) -> Progress {
        let all = self.finder.coasts.edges.len();
        let end = self.next.saturating_add(edges).min(all);
        let found: Vec<Vec<MedialBall>> =
            (self.next..end).into_par_iter().map(|edge| self.finder.along(edge)).collect();
        self.found.extend(found.into_iter().flatten());
        self.next = end;
        if end == all { Progress::Done } else { Progress::More }
    }

    /// Returns the straits, once all edges were looked at.
    pub(crate) fn finish(self) -> MedialBalls {
        let of = (self.region, self.marks);
        MedialBalls::new(of, thinned(self.found), self.between, self.finder.between)
    }
}

/// Finds the discs that touch two coasts.
#[derive(Debug)]
struct Finder {
    coasts: Coasts,
    tree: BoxTree,
    frame: Rect,
    between: [f64; 2],
}

/// A point of a coast.
#[derive(Clone, Copy)]
struct Shore {
    at: DVec2,
    edge: u32,
    ring: u32,
    /// The length of the ring up to the point.
    along: f64,
}

impl Finder {
    fn new(coasts: Coasts, frame: Rect, between: [f64; 2]) -> Self {
        let boxes: Vec<Rect> =
            coasts.edges.iter().map(|edge| Rect::spanning(edge.ends[0], edge.ends[1])).collect();
        Self { coasts, tree: BoxTree::new(&boxes), frame, between }
    }

    /// Returns the discs that touch an edge, or the corner at its end.
    fn along(&self, edge: usize) -> Vec<MedialBall> {
        let CoastEdge { ends: [from, to], ring, along, next } = self.coasts.edges[edge];
        let length = from.distance(to);
        let direction = (to - from) / length;
        let normal = direction.perp();
        let mut found = Vec::new();
        let mut place = 0.0;
        for _ in 0..MOST_POINTS {
            let shore = Shore { at: from + place * direction, edge: edge as u32, ring, along: along + place };
            let disc = self.disc(shore, normal);
            found.extend(disc);
            if place >= length {
                break;
            }
            let step = disc.map_or(0.0, |disc| 0.5 * CENTERS * disc.width).max(POINTS * self.between[0]);
            place = (place + step).min(length);
        }
        if let Some(next) = next {
            let [start, end] = self.coasts.edges[next as usize].ends;
            let next_direction = end - start;
            let turn = libm::atan2(direction.perp_dot(next_direction), direction.dot(next_direction));
            // The water is on the left: at a right turn, the land is a corner that points into it.
            let steps = (-turn / CENTERS).ceil().max(0.0) as u32;
            let shore = Shore { at: to, edge: edge as u32, ring, along: along + length };
            let angles = (1..steps).map(|n| turn * f64::from(n) / f64::from(steps));
            let normals = angles.map(|angle| DVec2::new(libm::cos(angle), libm::sin(angle)).rotate(normal));
            found.extend(normals.filter_map(|normal| self.disc(shore, normal)));
        }
        found
    }

    /// Returns the largest disc that touches the coast at a point and has no coast within it, if the two
    /// points that it touches are the ends of a crossing.
    fn disc(&self, shore: Shore, normal: DVec2) -> Option<MedialBall> {
        let mut radius = 0.5 * self.between[1];
        let mut other = None;
        for _ in 0..MOST_STEPS {
            let center = shore.at + radius * normal;
            let (nearest, distance) = self.nearest(center)?;
            if distance >= radius * (1.0 - TOLERANCE) {
                break;
            }
            let across = nearest.at - shore.at;
            let smaller = across.length_squared() / (2.0 * across.dot(normal));
            if !(smaller > 0.0 && smaller < radius) {
                return None;
            }
            (radius, other) = (smaller, Some(nearest));
        }
        let other = other?;
        let center = shore.at + radius * normal;
        let is_strait = self.is_crossing(shore, other) && self.frame.contains(center);
        is_strait.then_some(MedialBall { center, shores: [shore.at, other.at], width: 2.0 * radius })
    }

    fn nearest(&self, point: DVec2) -> Option<(Shore, f64)> {
        let on = |edge: u32| nearest_on_segment(point, self.coasts.edges[edge as usize].ends);
        let (edge, _) = self.tree.nearest(point, |edge| point.distance_squared(on(edge)))?;
        let (CoastEdge { ends, ring, along, .. }, at) = (self.coasts.edges[edge as usize], on(edge));
        Some((Shore { at, edge, ring, along: along + at.distance(ends[0]) }, at.distance(point)))
    }

    fn is_crossing(&self, a: Shore, b: Shore) -> bool {
        let length = a.at.distance(b.at);
        // Closer points are one point, but for rounding.
        if length <= NARROWEST * self.between[0] || self.is_corner(a.edge, b.edge) {
            return false;
        }
        let whole = self.coasts.lengths[a.ring as usize];
        let apart = (a.along - b.along).rem_euclid(whole);
        a.ring != b.ring || apart.min(whole - apart) >= LAMBDA * length
    }

    /// Returns whether two edges meet: the water between them is that of a corner.
    fn is_corner(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|edge| self.coasts.edges[edge as usize].ends);
        a.iter().any(|end| b.contains(end))
    }
}

/// Returns the discs, the narrowest first, without those whose centre is close to that of a narrower one.
fn thinned(mut discs: Vec<MedialBall>) -> Vec<MedialBall> {
    discs.sort_by(|a, b| {
        let by_place = || a.center.x.total_cmp(&b.center.x).then(a.center.y.total_cmp(&b.center.y));
        a.width.total_cmp(&b.width).then_with(by_place)
    });
    let mut grids: Vec<CenterGrid> = Vec::new();
    let mut kept: Vec<MedialBall> = Vec::new();
    for disc in discs {
        let is_length = disc.width > 0.0 && disc.width.is_finite();
        if !is_length || grids.iter().any(|grid| grid.has_near(disc.center)) {
            continue;
        }
        let cell = CENTERS * libm::exp2(libm::log2(disc.width).floor());
        if grids.last().is_none_or(|last| last.cell != cell) {
            grids.push(CenterGrid { cell, centers: NumberMap::default() });
        }
        if let Some(grid) = grids.last_mut() {
            grid.centers.entry(grid.place(disc.center)).or_default().push(disc.center);
        }
        kept.push(disc);
    }
    kept
}

/// The centres of discs that are as wide as others, but for a factor of two, by the cells that they are in.
struct CenterGrid {
    /// The side of a cell: at most `CENTERS` times the width of each disc.
    cell: f64,
    centers: NumberMap<[i64; 2], Vec<DVec2>>,
}

impl CenterGrid {
    fn place(&self, center: DVec2) -> [i64; 2] {
        (center / self.cell).floor().to_array().map(|at| at as i64)
    }

    /// Returns whether a centre is nearer than half of `CENTERS` times the radius of its disc.
    fn has_near(&self, point: DVec2) -> bool {
        let [x, y] = self.place(point);
        let cells = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        let centers = cells.filter_map(|cell| self.centers.get(&cell)).flatten();
        centers.into_iter().any(|center| center.distance(point) < 0.25 * self.cell)
    }
}

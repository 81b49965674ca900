//! Divides the rings of an outline into stretches: parts along one side of the frame, and coasts.

use std::cmp::Ordering;

use glam::DVec2;

use super::super::{Domain, Ring, signed_area};
use crate::geometry::Rect;

/// The kind of a piece of the boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum BoundaryKind {
    /// A part along the frame, the rectangle of the coarse grid, where the domain is cut off from its
    /// surroundings.
    Open,
    /// A part of an outer ring.
    Mainland,
    /// A part of the ring of a hole.
    Island,
}

impl BoundaryKind {
    /// Returns the word for it: `open`, `mainland` or `island`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Mainland => "mainland",
            Self::Island => "island",
        }
    }
}

/// A side of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FrameSide {
    /// Lowest y.
    South,
    /// Highest x.
    East,
    /// Highest y.
    North,
    /// Lowest x.
    West,
}

impl FrameSide {
    /// Returns the side of a frame along which an edge runs.
    pub(super) fn of([a, b]: [DVec2; 2], frame: &Rect) -> Option<Self> {
        let along = |axis: usize, value: f64| a[axis] == value && b[axis] == value;
        let Rect { min, max } = *frame;
        let sides = [
            (along(1, min.y), Self::South),
            (along(0, max.x), Self::East),
            (along(1, max.y), Self::North),
            (along(0, min.x), Self::West),
        ];
        sides.into_iter().find_map(|(holds, side)| holds.then_some(side))
    }

    /// Returns the coordinate that changes along the side: 0 for x, 1 for y.
    pub(super) fn axis(self) -> usize {
        match self {
            Self::South | Self::North => 0,
            Self::East | Self::West => 1,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::South => "open south",
            Self::East => "open east",
            Self::North => "open north",
            Self::West => "open west",
        }
    }
}

/// A maximal part of a ring along one side of the frame, or along none.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub(super) kind: BoundaryKind,
    pub(super) side: Option<FrameSide>,
    /// The points, with the domain on the left. A whole ring ends with its first point, the lowest one.
    pub(super) points: Vec<DVec2>,
    /// Unless a person chooses another name.
    pub(super) name: String,
    /// The number that decides the order: position along the side, length of the coast, or area of the hole.
    measure: f64,
}

impl Stretch {
    pub(super) fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }

    /// Open ones by side and position, then mainlands by length, then islands by area; the largest first.
    fn order(&self, other: &Self) -> Ordering {
        let by_measure = match self.kind {
            BoundaryKind::Open => self.measure.total_cmp(&other.measure),
            BoundaryKind::Mainland | BoundaryKind::Island => other.measure.total_cmp(&self.measure),
        };
        let kinds = (self.kind, self.side).cmp(&(other.kind, other.side));
        kinds.then(by_measure).then_with(|| compare(self.points[0], other.points[0]))
    }
}

/// Compares points by y, then by x.
pub(super) fn compare(a: DVec2, b: DVec2) -> Ordering {
    a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x))
}

/// Returns the stretches of rings that have the domain on their left, in their order: along the sides of a
/// frame that cuts the rings, and elsewhere. Names do not depend on the order of the rings or on where a ring
/// begins.
pub(super) fn stretches<'a>(rings: impl Iterator<Item = &'a Ring>, cutting: Option<&Rect>) -> Vec<Stretch> {
    let mut found = Vec::new();
    for ring in rings.filter(|ring| ring.len() > 2) {
        push_stretches(ring, cutting, &mut found);
    }
    found.sort_by(Stretch::order);
    number(&mut found);
    found
}

/// Returns the coasts of a domain as polylines: its boundary without the open parts. None for a domain that
/// is given by a formula.
pub fn coasts(domain: &Domain) -> Vec<Vec<DVec2>> {
    let mut coasts = Vec::new();
    let (rings, frame) = rings_and_frame(domain);
    rings.into_iter().for_each(|ring| push_stretches(ring, frame, &mut coasts));
    coasts.retain(|stretch| stretch.kind != BoundaryKind::Open);
    coasts.into_iter().map(|stretch| stretch.points).collect()
}

/// Returns the rings of a domain, none where a formula gives it, and the frame if it cuts them.
fn rings_and_frame(domain: &Domain) -> (Vec<&Ring>, Option<&Rect>) {
    let rings: Vec<&Ring> = domain.region().into_iter().flat_map(|region| region.rings()).collect();
    let frame = is_cut(&rings, &domain.bounds).then_some(&domain.bounds);
    (rings, frame)
}

/// An edge of a coast, with the water on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoastEdge {
    /// Its ends, in the order of the ring.
    pub ends: [DVec2; 2],
    /// The number of its ring.
    pub ring: u32,
    /// The length of the ring up to the first end, in world units.
    pub along: f64,
    /// The number of the next edge, if the coast goes on.
    pub next: Option<u32>,
}

/// The coasts of a domain: its boundary without the open parts.
#[derive(Clone, Debug, Default)]
pub struct Coasts {
    /// The edges, ring by ring.
    pub edges: Vec<CoastEdge>,
    /// The length of each ring, with its open parts, in world units.
    pub lengths: Vec<f64>,
}

impl Coasts {
    /// Returns the coasts of a domain; none of a domain that is given by a formula.
    pub fn of(domain: &Domain) -> Self {
        let mut coasts = Self::default();
        let (rings, frame) = rings_and_frame(domain);
        rings.into_iter().for_each(|ring| coasts.push(ring, frame));
        coasts
    }

    fn push(&mut self, ring: &Ring, frame: Option<&Rect>) {
        let (number, first) = (self.lengths.len() as u32, self.edges.len());
        let edge = |n: usize| [ring[n], ring[(n + 1) % ring.len()]];
        let is_coast = |n: usize| frame.is_none_or(|frame| FrameSide::of(edge(n), frame).is_none());
        let mut along = 0.0;
        let mut begins_ring = None;
        for n in 0..ring.len() {
            let ends = edge(n);
            if is_coast(n) && ends[0] != ends[1] {
                let place = self.edges.len();
                begins_ring = begins_ring.or((n == 0).then_some(place));
                self.edges.push(CoastEdge { ends, ring: number, along, next: None });
                if place > first && self.edges[place - 1].ends[1] == ends[0] {
                    self.edges[place - 1].next = Some(place as u32);
                }
            }
            along += ends[0].distance(ends[1]);
        }
        if let (Some(start), Some(last)) = (begins_ring, self.edges.last_mut())
            && last.ends[1] == ring[0]
        {
            last.next = Some(start as u32);
        }
        self.lengths.push(along);
    }
}

fn push_stretches(ring: &Ring, cutting: Option<&Rect>, found: &mut Vec<Stretch>) {
    let count = ring.len();
    let area = signed_area(ring);
    let side = |n: usize| {
        let edge = [ring[n % count], ring[(n + 1) % count]];
        cutting.and_then(|frame| FrameSide::of(edge, frame))
    };
    for (start, end) in alike(ring, side) {
        let points: Vec<DVec2> = (start..=end).map(|n| ring[n % count]).collect();
        let (side, length) = (side(start), length(&points));
        let (kind, measure) = match side {
            Some(side) => {
                let along = side.axis();
                (BoundaryKind::Open, points[0][along].min(points[points.len() - 1][along]))
            }
            None if area > 0.0 => (BoundaryKind::Mainland, length),
            None => (BoundaryKind::Island, -area),
        };
        found.push(Stretch { kind, side, points, name: String::new(), measure });
    }
}

/// Returns the ranges of edges that are alike, from the number of the first edge to that after the last. A
/// range can continue from the last edge of the ring to the first. Where all are alike, the range begins at
/// the lowest point.
fn alike<T: PartialEq>(ring: &Ring, of_edge: impl Fn(usize) -> T) -> Vec<(usize, usize)> {
    let count = ring.len();
    let starts: Vec<usize> = (0..count).filter(|&n| of_edge(n) != of_edge(n + count - 1)).collect();
    let Some(first) = starts.first() else {
        let lowest = (0..count).min_by(|&a, &b| compare(ring[a], ring[b])).expect("a ring has points");
        return vec![(lowest, lowest + count)];
    };
    let ends = starts.iter().skip(1).copied().chain([first + count]);
    starts.iter().copied().zip(ends).collect()
}

/// Returns whether a frame cuts an outline off, so that edges along it are open.
///
/// Any outline touches its own bounding rectangle, by chance also along an edge. That rectangle cuts it only
/// if a corner of the rectangle is on the outline between two sides, or a straight part along the rectangle
/// is longer than all others. Any other frame was chosen, and cuts everything that reaches it.
pub(super) fn is_cut(rings: &[&Ring], frame: &Rect) -> bool {
    let points = rings.iter().flat_map(|ring| ring.iter());
    let bounds = points.map(|&p| Rect::new(p, p)).reduce(|a, b| a.union(&b));
    if bounds != Some(*frame) {
        return true;
    }
    let (mut longest_along, mut longest_elsewhere) = (0.0_f64, 0.0_f64);
    for ring in rings {
        let count = ring.len();
        let edge = |n: usize| [ring[n % count], ring[(n + 1) % count]];
        let side = |n: usize| FrameSide::of(edge(n), frame);
        if (0..count).any(|n| matches!((side(n), side(n + 1)), (Some(a), Some(b)) if a != b)) {
            return true;
        }
        for (start, end) in alike(ring, |n| straight(n % count, edge(n))) {
            let run = (start..end).map(|n| length(&edge(n))).sum();
            let longest = if side(start).is_some() { &mut longest_along } else { &mut longest_elsewhere };
            *longest = longest.max(run);
        }
    }
    longest_along > longest_elsewhere
}

/// Returns the line parallel to an axis that contains an edge, by axis and coordinate; otherwise the number
/// of the edge as the error.
fn straight(number: usize, [a, b]: [DVec2; 2]) -> Result<(usize, f64), usize> {
    (0..2).find(|&axis| a[axis] == b[axis]).map(|axis| (axis, a[axis])).ok_or(number)
}

/// Names stretches by kind and number. Islands always have a number, others from the second on.
fn number(stretches: &mut [Stretch]) {
    let mut count = 0;
    let mut last = None;
    for stretch in stretches {
        let group = (stretch.kind, stretch.side);
        count = if last.replace(group) == Some(group) { count + 1 } else { 1 };
        let name = stretch.side.map_or(stretch.kind.name(), FrameSide::name);
        stretch.name = match stretch.kind {
            BoundaryKind::Open | BoundaryKind::Mainland if count == 1 => name.to_owned(),
            _ => format!("{name} {count}"),
        };
    }
}

/// Returns the length of a polyline.
pub(super) fn length(points: &[DVec2]) -> f64 {
    points.windows(2).map(|ends| ends[0].distance(ends[1])).sum()
}

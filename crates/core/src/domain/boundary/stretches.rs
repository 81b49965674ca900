//! Divides the rings of an outline into stretches: parts along one side of a rectangle that cuts it, and
//! coasts.

use std::cmp::Ordering;

use glam::DVec2;

use super::super::{FrameSide, Ring, signed_area};

/// The kind of a piece of the boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum BoundaryKind {
    /// A part along the rectangle that cuts the domain off from its surroundings: the rectangle of the coarse
    /// grid, or the box in which a file has its polygons.
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

impl FrameSide {
    fn name(self) -> &'static str {
        match self {
            Self::South => "open south",
            Self::East => "open east",
            Self::North => "open north",
            Self::West => "open west",
        }
    }
}

/// A ring that has the domain on its left, and the side that each edge is on: number n is the edge from
/// corner n.
#[derive(Clone, Debug)]
pub(super) struct SidedRing<'a> {
    pub(super) corners: &'a Ring,
    pub(super) sides: Vec<Option<FrameSide>>,
}

/// A maximal part of a ring along one side, or along none.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub(super) kind: BoundaryKind,
    pub(super) side: Option<FrameSide>,
    pub(super) place: PlaceOnRing,
    /// The points, with the domain on the left. A whole ring ends with its first point, the lowest one.
    pub(super) points: Vec<DVec2>,
    /// Unless a person chooses another name.
    pub(super) name: String,
    /// The number that decides the order: position along the side, length of the coast, or area of the hole.
    measure: f64,
}

/// Where a part of a ring begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlaceOnRing {
    /// The number of the ring.
    pub(super) ring: u32,
    /// The length of the ring up to there, in world units.
    pub(super) along: f64,
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

/// Returns the stretches of rings, in their order. Names do not depend on the order of the rings or on where
/// a ring begins.
pub(super) fn stretches(rings: &[SidedRing]) -> Vec<Stretch> {
    let mut found = Vec::new();
    for (number, ring) in (0..).zip(rings).filter(|(_, ring)| ring.corners.len() > 2) {
        push_stretches(number, ring, &mut found);
    }
    found.sort_by(Stretch::order);
    number(&mut found);
    found
}

fn push_stretches(number: u32, SidedRing { corners: ring, sides }: &SidedRing, found: &mut Vec<Stretch>) {
    let count = ring.len();
    let area = signed_area(ring);
    let side = |n: usize| sides[n % count];
    let mut along = vec![0.0; count];
    for n in 1..count {
        along[n] = along[n - 1] + ring[n - 1].distance(ring[n]);
    }
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
        let place = PlaceOnRing { ring: number, along: along[start % count] };
        found.push(Stretch { kind, side, place, points, name: String::new(), measure });
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

//! The rectangle by which an outline was cut off from its surroundings.
//!
//! Coasts come as a box of longitudes and latitudes, or as a box in some plane: the sides of the box are not
//! coasts, as the sea continues there. In the plane of another projection these sides are curves, or straight
//! lines that are not parallel to an axis. So the rectangle is kept in the coordinates where its sides are
//! straight, and an edge of the outline is on a side if it is so there.

use glam::DVec2;
use rayon::prelude::*;

use super::Ring;
use crate::earth::{Coordinates, wrapped};
use crate::geometry::Rect;

/// How far a corner may be from a side that is a curve, as a share of the longer side of the region's frame:
/// edges follow a curve to a millionth.
const ON_CURVE: f64 = 2e-6;
/// The same for a rectangle that is turned: files round its corners.
const ON_TURNED: f64 = 1e-5;
/// The same for sides along the axes of the world: the corners of a region are on a grid.
const ON_STRAIGHT: f64 = 4e-9;
/// Points along a side that is a curve, to tell quickly which corners are far from it.
const POINTS_OF_SIDE: u32 = 64;
/// Corners that a thread takes at a time.
const GRAIN: usize = 1024;

/// A side of a frame.
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
    pub(super) const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];

    /// Returns the side of a rectangle along which an edge runs.
    pub(super) fn of([a, b]: [DVec2; 2], frame: &Rect) -> Option<Self> {
        Self::ALL.into_iter().find(|side| {
            let (axis, value) = side.line(frame);
            a[axis] == value && b[axis] == value
        })
    }

    /// Returns the coordinate that changes along the side: 0 for x, 1 for y.
    pub(super) fn axis(self) -> usize {
        match self {
            Self::South | Self::North => 0,
            Self::East | Self::West => 1,
        }
    }

    /// Returns the coordinate that is the same along the side of a rectangle, and its value.
    fn line(self, frame: &Rect) -> (usize, f64) {
        let corner = match self {
            Self::South | Self::West => frame.min,
            Self::North | Self::East => frame.max,
        };
        (1 - self.axis(), corner[1 - self.axis()])
    }
}

/// The rectangle by which an outline was cut off from its surroundings, in the coordinates in which its
/// sides are straight.
#[derive(Clone, Debug, PartialEq)]
pub struct CutFrame {
    /// What world coordinates are and what those of the rectangle are, where they differ.
    pub coordinates: Option<[Coordinates; 2]>,
    /// The direction of the southern side in these coordinates, a unit vector: x, unless the rectangle is
    /// turned.
    pub eastward: DVec2,
    /// The rectangle, in coordinates along its sides: x along `eastward`.
    pub rect: Rect,
}

impl CutFrame {
    /// Returns a rectangle in world coordinates with sides along the axes.
    pub(super) fn from_world(rect: Rect) -> Self {
        Self { coordinates: None, eastward: DVec2::X, rect }
    }

    /// Returns the coordinates along the sides of a point in world coordinates.
    pub(super) fn local(&self, world: DVec2) -> DVec2 {
        let at = match self.coordinates {
            Some([of_world, own]) => own.from_geographic(of_world.to_geographic(world)),
            None => world,
        };
        let at = self.eastward.conjugate_rotate(at);
        if self.is_geographic() {
            // The turn of longitudes that the rectangle has.
            let middle = self.rect.center().x;
            return DVec2::new(middle + wrapped(at.x - middle), at.y);
        }
        at
    }

    /// Returns the world coordinates of a point in coordinates along the sides.
    fn world(&self, local: DVec2) -> DVec2 {
        let at = self.eastward.rotate(local);
        match self.coordinates {
            Some([of_world, own]) => of_world.from_geographic(own.to_geographic(at)),
            None => at,
        }
    }

    fn is_geographic(&self) -> bool {
        self.coordinates.is_some_and(|[_, own]| own == Coordinates::Geographic)
    }

    fn is_turned(&self) -> bool {
        self.eastward != DVec2::X
    }

    /// Returns the side along which each edge of rings runs, ring by ring: number n is the edge from corner
    /// n. `size` is the longer side of the region's frame.
    pub(super) fn sides(&self, rings: &[&Ring], size: f64) -> Vec<Vec<Option<FrameSide>>> {
        let finder = SideFinder::new(self, size);
        rings.iter().map(|ring| finder.of_ring(ring)).collect()
    }
}

/// Rotations by the angle of a unit vector, and back.
trait Turned {
    fn conjugate_rotate(self, at: DVec2) -> DVec2;
}

impl Turned for DVec2 {
    fn conjugate_rotate(self, at: DVec2) -> DVec2 {
        Self::new(self.x, -self.y).rotate(at)
    }
}

/// Finds the sides of a frame that points are on.
struct SideFinder<'a> {
    frame: &'a CutFrame,
    /// How far a point may be from a side, in world units.
    tolerance: f64,
    /// A rectangle in world coordinates that no side meets.
    inner: Option<Rect>,
}

impl<'a> SideFinder<'a> {
    fn new(frame: &'a CutFrame, size: f64) -> Self {
        let share = match (frame.is_turned(), frame.coordinates) {
            (true, _) => ON_TURNED,
            (false, Some(_)) => ON_CURVE,
            (false, None) => ON_STRAIGHT,
        };
        let inner = frame.coordinates.and_then(|_| inner(frame));
        Self { frame, tolerance: share * size, inner }
    }

    fn of_ring(&self, ring: &Ring) -> Vec<Option<FrameSide>> {
        let on: Vec<[bool; 4]> = ring.par_iter().with_min_len(GRAIN).map(|&at| self.on(at)).collect();
        let side = |n: usize| {
            let next = (n + 1) % ring.len();
            let both = |number: usize| on[n][number] && on[next][number];
            let middle = || self.on(0.5 * (ring[n] + ring[next]));
            // An edge across a side that bulges has both ends on it.
            FrameSide::ALL.into_iter().find(|&side| both(side as usize) && middle()[side as usize])
        };
        (0..ring.len()).map(side).collect()
    }

    /// Returns for each side whether a point is on the line along it.
    fn on(&self, at: DVec2) -> [bool; 4] {
        if self.inner.is_some_and(|inner| inner.contains(at)) {
            return [false; 4];
        }
        let (local, rect) = (self.frame.local(at), &self.frame.rect);
        FrameSide::ALL.map(|side| {
            let (axis, value) = side.line(rect);
            let distance = (local[axis] - value).abs();
            if self.frame.coordinates.is_none() {
                return distance <= self.tolerance;
            }
            let mut foot = local;
            foot[axis] = value;
            distance <= 1e-2 * rect.size()[axis] && self.frame.world(foot).distance(at) <= self.tolerance
        })
    }
}

/// Returns a rectangle in world coordinates that no side of a frame meets, if there is one.
fn inner(frame: &CutFrame) -> Option<Rect> {
    let Rect { min, max } = frame.rect;
    let along = |from: DVec2, to: DVec2| {
        let share = |n: u32| f64::from(n) / f64::from(POINTS_OF_SIDE);
        let places = (0..=POINTS_OF_SIDE).map(move |n| frame.world(from.lerp(to, share(n))));
        Rect::holding(places).expect("a side has points")
    };
    let [low, high] = [DVec2::new(max.x, min.y), DVec2::new(min.x, max.y)];
    let [south, east, north, west] = [along(min, low), along(low, max), along(high, max), along(min, high)];
    let all = south.union(&north).union(&east).union(&west).size().max_element();
    // Sides bulge between their points.
    let margin = DVec2::splat(all / f64::from(POINTS_OF_SIDE));
    let inner =
        Rect::new(DVec2::new(west.max.x, south.max.y) + margin, DVec2::new(east.min.x, north.min.y) - margin);
    inner.is_proper().then_some(inner)
}

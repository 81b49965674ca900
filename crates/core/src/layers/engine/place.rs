//! Sets from which gradation measures distances.

use glam::DVec2;

use crate::geometry::{Lattice, LatticePoint, Octagon, Rect, nearest_on_segment};

use super::cells::Cells;

/// A closed convex set, in world units with the corner of the lattice as origin.
pub trait ConvexSet {
    /// Returns the smallest rectangle around the set.
    fn bounds(&self) -> Rect;

    /// Returns the point of the set that is nearest to `p`.
    fn nearest(&self, p: DVec2) -> DVec2;

    /// Returns the distance to the closed rectangle of some cells, which covers `rect`.
    fn distance(&self, cells: &Cells, rect: &Rect) -> f64;
}

/// Returns the rectangle of some cells, in world units with the corner of the lattice as origin.
#[inline]
pub fn rect_of(cells: &Cells, lattice: &Lattice) -> Rect {
    let corner = |[x, y]: [i64; 2]| DVec2::new(x as f64, y as f64) * lattice.step();
    Rect::new(corner(cells.min), corner(cells.max))
}

/// Returns the distance between two closed rectangles.
#[inline]
pub fn gap(a: &Rect, b: &Rect) -> f64 {
    (a.min - b.max).max(b.min - a.max).max(DVec2::ZERO).length()
}

/// A single point.
pub struct Point(pub DVec2);

impl ConvexSet for Point {
    fn bounds(&self) -> Rect {
        Rect::new(self.0, self.0)
    }

    fn nearest(&self, _: DVec2) -> DVec2 {
        self.0
    }

    #[inline]
    fn distance(&self, _: &Cells, rect: &Rect) -> f64 {
        self.0.distance(self.0.clamp(rect.min, rect.max))
    }
}

/// A rectangle.
impl ConvexSet for Rect {
    fn bounds(&self) -> Rect {
        *self
    }

    fn nearest(&self, p: DVec2) -> DVec2 {
        p.clamp(self.min, self.max)
    }

    #[inline]
    fn distance(&self, _: &Cells, rect: &Rect) -> f64 {
        gap(self, rect)
    }
}

/// A triangle of a mesh.
pub struct TriangleInWorld {
    corners: [DVec2; 3],
    octagon: Octagon,
}

impl TriangleInWorld {
    pub fn new(corners: [LatticePoint; 3], lattice: &Lattice) -> Self {
        let octagon = Octagon::triangle(corners);
        Self { octagon, corners: corners.map(|c| c.as_dvec2() * lattice.step()) }
    }

    pub fn centroid(&self) -> DVec2 {
        self.corners.iter().sum::<DVec2>() / 3.0
    }
}

impl ConvexSet for TriangleInWorld {
    fn bounds(&self) -> Rect {
        let [a, b, c] = self.corners;
        Rect::new(a.min(b).min(c), a.max(b).max(c))
    }

    fn nearest(&self, p: DVec2) -> DVec2 {
        let [a, b, c] = self.corners;
        let edges = [[a, b], [b, c], [c, a]];
        let sides = edges.map(|[from, to]| (to - from).perp_dot(p - from));
        if sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0) {
            return p;
        }
        let nearest = edges.map(|edge| nearest_on_segment(p, edge));
        let closer = |a: DVec2, b: DVec2| if b.distance_squared(p) < a.distance_squared(p) { b } else { a };
        nearest.into_iter().fold(nearest[0], closer)
    }

    fn distance(&self, cells: &Cells, rect: &Rect) -> f64 {
        if self.octagon.meets(&cells.octagon()) {
            return 0.0;
        }
        let Rect { min, max } = *rect;
        let [a, b, c] = self.corners;
        // Of two convex polygons without a common point, a corner of one is nearest to the other.
        let to_rect = |p: DVec2| p.distance_squared(p.clamp(min, max));
        let mut least = to_rect(a).min(to_rect(b)).min(to_rect(c));
        for p in [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)] {
            for edge in [[a, b], [b, c], [c, a]] {
                least = least.min(p.distance_squared(nearest_on_segment(p, edge)));
            }
        }
        least.sqrt()
    }
}

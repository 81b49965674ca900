use super::{LatticePoint, LatticeRect};

/// A closed interval of lattice coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    low: i64,
    high: i64,
}

impl Span {
    #[inline]
    fn of([a, b, c]: [i64; 3]) -> Self {
        Self { low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    #[inline]
    fn intersects(&self, other: &Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    #[inline]
    fn contains(&self, other: &Self) -> bool {
        self.low <= other.low && other.high <= self.high
    }
}

/// A closed convex shape by its extents along x, y, x + y and x − y, in lattice steps.
///
/// A triangle of a mesh is exactly the set of points within its four extents, and so is a rectangle. Two such
/// shapes meet exactly when their extents meet along all four directions: if a line separates them, one along
/// these directions does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Octagon {
    x: Span,
    y: Span,
    sum: Span,
    difference: Span,
}

impl Octagon {
    /// Returns a triangle of a mesh.
    #[inline]
    pub fn triangle(corners: [LatticePoint; 3]) -> Self {
        let x = corners.map(|c| i64::from(c.x));
        let y = corners.map(|c| i64::from(c.y));
        Self {
            x: Span::of(x),
            y: Span::of(y),
            sum: Span::of([x[0] + y[0], x[1] + y[1], x[2] + y[2]]),
            difference: Span::of([x[0] - y[0], x[1] - y[1], x[2] - y[2]]),
        }
    }

    /// Returns the closed rectangle between two corners, which may lie beyond the lattice.
    #[inline]
    pub fn rect([x0, y0]: [i64; 2], [x1, y1]: [i64; 2]) -> Self {
        Self {
            x: Span { low: x0, high: x1 },
            y: Span { low: y0, high: y1 },
            sum: Span { low: x0 + y0, high: x1 + y1 },
            difference: Span { low: x0 - y1, high: x1 - y0 },
        }
    }

    /// Returns whether the shapes have a point in common.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        self.x.intersects(&other.x)
            && self.y.intersects(&other.y)
            && self.sum.intersects(&other.sum)
            && self.difference.intersects(&other.difference)
    }

    /// Returns whether `other` lies within this shape.
    #[inline]
    pub fn contains(&self, other: &Self) -> bool {
        self.x.contains(&other.x)
            && self.y.contains(&other.y)
            && self.sum.contains(&other.sum)
            && self.difference.contains(&other.difference)
    }

    /// Returns numbers x₀ and x₁ for the rows from `low` to `high`: a rectangle from one to the other meets
    /// the shape if its right side is at x₀ or beyond, and its left side at x₁ or before. The rows must meet
    /// the shape along y.
    #[inline]
    pub fn span_between(&self, low: i64, high: i64) -> [i64; 2] {
        let left = self.x.low.max(self.sum.low - high).max(self.difference.low + low);
        let right = self.x.high.min(self.sum.high - low).min(self.difference.high + high);
        [left, right]
    }

    /// Returns the extents along x + y and x − y, each as [minimum, maximum].
    #[inline]
    pub fn diagonals(&self) -> [[i64; 2]; 2] {
        [[self.sum.low, self.sum.high], [self.difference.low, self.difference.high]]
    }

    /// Returns the lower left and the upper right corner of the smallest rectangle around the shape.
    #[inline]
    pub fn bounds(&self) -> [[i64; 2]; 2] {
        [[self.x.low, self.y.low], [self.x.high, self.y.high]]
    }
}

impl From<LatticeRect> for Octagon {
    fn from(rect: LatticeRect) -> Self {
        let [min, max] = [rect.min, rect.max].map(|p| [i64::from(p.x), i64::from(p.y)]);
        Self::rect(min, max)
    }
}

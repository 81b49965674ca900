//! A grid over a rectangle whose nodes are inside where a formula is neither zero nor NaN.

use glam::DVec2;

use super::super::marching::{GridEdge, GridNode, MarchingGrid};
use super::TOLERANCE;
use crate::field::Formula;
use crate::geometry::Rect;

/// Squares along the longer side of the rectangle: at first, and at the end.
const COUNTS: [u32; 2] = [16, 4096];
/// Halvings that find where the line crosses an edge, to far less than the tolerance.
const BISECTIONS: u32 = 28;

/// A square by column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct GridSquare(pub GridNode);

impl GridSquare {
    /// Returns the lower left node.
    pub(super) fn node(self) -> GridNode {
        self.0
    }
}

/// The grid. Its squares are halved again and again.
#[derive(Clone, Debug)]
pub(super) struct FormulaGrid {
    formula: Formula,
    bounds: Rect,
    /// Squares along x and y. They are nearly square, except in a rectangle that is very long.
    counts: [u32; 2],
    tolerance: f64,
}

impl FormulaGrid {
    pub(super) fn new(formula: Formula, bounds: Rect) -> Self {
        let (size, longest) = (bounds.size(), bounds.size().max_element());
        let count = |side: f64| (f64::from(COUNTS[0]) * side / longest).ceil().max(1.0) as u32;
        Self { formula, bounds, counts: [count(size.x), count(size.y)], tolerance: TOLERANCE * longest }
    }

    pub(super) fn bounds(&self) -> &Rect {
        &self.bounds
    }

    /// Returns how far the line may be beside a chord, in world units.
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns all squares.
    pub(super) fn roots(&self) -> Vec<GridSquare> {
        let [columns, rows] = self.counts.map(i64::from);
        (0..rows).flat_map(|row| (0..columns).map(move |column| GridSquare([column, row]))).collect()
    }

    /// Halves the sides of all squares.
    pub(super) fn halve(&mut self) {
        self.counts = self.counts.map(|count| 2 * count);
    }

    /// Returns whether the squares are as small as they get.
    pub(super) fn is_smallest(&self) -> bool {
        self.counts.into_iter().max() >= Some(COUNTS[1])
    }

    /// Returns the quarters of a square, in the numbers of the next smaller squares.
    pub(super) fn quarters(&self, GridSquare([column, row]): &GridSquare) -> Vec<GridSquare> {
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| GridSquare([2 * column + x, 2 * row + y])).to_vec()
    }

    /// Returns the squares outside the rectangle that touch it: the line runs along its sides.
    pub(super) fn squares_around(&self) -> impl Iterator<Item = GridSquare> + use<> {
        let [columns, rows] = self.counts.map(i64::from);
        let lines = (-1..=columns).flat_map(move |column| [[column, -1], [column, rows]]);
        let sides = (0..rows).flat_map(move |row| [[-1, row], [columns, row]]);
        lines.chain(sides).map(GridSquare)
    }

    /// Returns whether both sides of the line may occur in a square, by interval arithmetic.
    pub(super) fn may_be_crossed(&self, &GridSquare([column, row]): &GridSquare) -> bool {
        let rect = Rect { min: self.place([column, row]), max: self.place([column + 1, row + 1]) };
        let bounds = self.formula.bounds(&rect);
        let is_false = bounds.least == 0.0 && bounds.greatest == 0.0;
        let is_true = bounds.valid && (bounds.least > 0.0 || bounds.greatest < 0.0);
        !is_false && !is_true
    }

    /// Returns whether the corners of a square lie on different sides.
    pub(super) fn is_crossed(&self, &GridSquare([column, row]): &GridSquare) -> bool {
        let corners = [[column, row], [column + 1, row], [column + 1, row + 1], [column, row + 1]];
        let inside = corners.map(|node| self.is_inside(node));
        inside != [inside[0]; 4]
    }

    /// Returns whether a point is in the rectangle, and the formula neither zero nor NaN there.
    pub(super) fn holds(&self, at: DVec2) -> bool {
        let value = self.formula.eval(at.x, at.y);
        value != 0.0 && !value.is_nan() && self.bounds.contains(at)
    }

    /// Returns the place of a node; of one outside the rectangle, the nearest place of it.
    fn place(&self, node: GridNode) -> DVec2 {
        let Rect { min, max } = self.bounds;
        let along = |axis: usize| match node[axis] {
            n if n <= 0 => min[axis],
            n if n >= i64::from(self.counts[axis]) => max[axis],
            n => min[axis] + (max[axis] - min[axis]) * (n as f64 / f64::from(self.counts[axis])),
        };
        DVec2::new(along(0), along(1))
    }

    /// Returns where the line crosses an edge between two sides.
    pub(super) fn crossing(&self, edge: GridEdge) -> DVec2 {
        let [a, b] = edge.ends();
        let (inside, outside) = if self.is_inside(a) { (a, b) } else { (b, a) };
        // Equal where the outside is beyond a side of the rectangle.
        bisected(self, [inside, outside].map(|node| self.place(node)), BISECTIONS)
    }
}

impl MarchingGrid for FormulaGrid {
    fn is_inside(&self, node: GridNode) -> bool {
        let is_node = |axis: usize| (0..=i64::from(self.counts[axis])).contains(&node[axis]);
        is_node(0) && is_node(1) && self.holds(self.place(node))
    }

    fn is_joined(&self, [low, _, high, _]: [GridNode; 4]) -> bool {
        self.holds(0.5 * (self.place(low) + self.place(high)))
    }
}

/// Returns a place on the line between a point inside and one outside.
pub(super) fn bisected(grid: &FormulaGrid, [mut inside, mut outside]: [DVec2; 2], halvings: u32) -> DVec2 {
    for _ in 0..halvings {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            break;
        }
        if grid.holds(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    0.5 * (inside + outside)
}

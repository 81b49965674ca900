//! The order of triangles along the curve of the bisection tree.
//!
//! Each bisection has a first and a second half, so the tree puts all triangles in an order: that of
//! Sierpiński's curve, which enters a triangle at one end of its bisection edge, leaves it at the other one,
//! and never jumps. Triangles that are near each other in this order are near each other in the plane.
//!
//! ```text
//!        apex
//!       /  |  \          from a to b: first the half at a, from a to the apex,
//!     /  1 | 2  \        then the half at b, from the apex to b
//!   a ---- m ---- b
//! ```
//!
//! The position of a triangle follows from its middle alone: which half of each larger triangle has it. So it
//! does not depend on the history of a mesh nor on the other triangles, and triangles at an outline have one,
//! too. The largest triangle is half of a square around the grid; from level 1 on, those of the mesh are of
//! this tree.

use super::Extract;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::kernel::Triangle;

/// Coordinates are multiplied by this, so that middles of triangles and of the smallest edges are whole.
const FACTOR: i64 = 12;
/// Bisections of the large triangle: one for each bit of a position, but for the half of the square.
const BISECTIONS: u32 = 63;

impl Extract<'_> {
    /// Returns the position of each triangle along the curve of the bisection tree: triangles in ascending
    /// order of it follow the curve. Only triangles at an outline can share one.
    pub fn curve_positions(&self) -> Vec<u64> {
        let size = FACTOR * side(&self.lattice);
        let position = |triangle: &Triangle| {
            let corners = triangle.vertices.map(|vertex| self.nodes[vertex.index()]);
            let sum = |of: fn(LatticePoint) -> u32| {
                corners.iter().map(|&corner| i64::from(of(corner))).sum::<i64>()
            };
            position(size, [FACTOR / 3 * sum(|p| p.x), FACTOR / 3 * sum(|p| p.y)])
        };
        self.triangles.iter().map(position).collect()
    }
}

/// Returns the side of the square around the grid: as many cells as a power of two, in lattice units.
fn side(lattice: &Lattice) -> i64 {
    let [columns, rows] = lattice.cells();
    i64::from(columns.max(rows).next_power_of_two()) * i64::from(lattice.cell_steps())
}

/// Returns the position of a point in a square of this side.
fn position(size: i64, point: [i64; 2]) -> u64 {
    let is_above = point[1] > point[0];
    // From the lower left to the upper right, and back above the diagonal.
    let (mut from, mut to, mut apex) = match is_above {
        false => ([0, 0], [size, size], [size, 0]),
        true => ([size, size], [0, 0], [0, size]),
    };
    let mut position = u64::from(is_above);
    for _ in 0..BISECTIONS {
        let middle = [0, 1].map(|axis| (from[axis] + to[axis]) / 2);
        // The edge runs along an axis or a diagonal: its direction is that of its signs.
        let ahead: i64 =
            (0..2).map(|axis| (point[axis] - middle[axis]) * (to[axis] - from[axis]).signum()).sum();
        let is_second = ahead > 0;
        position = 2 * position + u64::from(is_second);
        if is_second {
            (from, apex) = (apex, middle);
        } else {
            (to, apex) = (apex, middle);
        }
    }
    position
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;
    use crate::mesh::kernel::{Limits, Mesh};

    #[test]
    fn triangles_in_a_row_along_the_curve_touch() {
        let limits = Limits::default();
        let lattice = Lattice::covering(Rect::UNIT, 0.25, limits.max_triangles).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &limits).unwrap();
        let fine = mesh.extract().refined().unwrap().refined().unwrap();
        let positions = fine.curve_positions();
        let mut order: Vec<usize> = (0..positions.len()).collect();
        order.sort_by_key(|&triangle| positions[triangle]);
        let corners = |triangle: usize| fine.triangles()[triangle].vertices;
        for pair in order.windows(2) {
            assert!(positions[pair[0]] < positions[pair[1]], "no two share a position");
            let (before, after) = (corners(pair[0]), corners(pair[1]));
            let common = before.iter().filter(|node| after.contains(node)).count();
            assert_eq!(common, 2, "neighbours across an edge");
        }
    }
}

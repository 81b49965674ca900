//! The function that proves a lower bound, as numbers that others can check.

use glam::DVec2;

use super::conic_program::ConicSolution;
use super::minorant::Minorant;
use super::quadratic::QuadraticSpace;

/// A continuous, piecewise quadratic function v on triangles, and an affine function ℓ in each, below the
/// cost density. With λ = [`scale`](Self::scale), |∇(λ v)| ≤ ℓ at all corners, and so everywhere: no path
/// costs less than λ (v(goal) − v(start)).
///
/// ```text
///          2
///          | \           value 3 of a triangle belongs to the middle of its edge from 1 to 2,
///          4   3         4 to that of the edge from 2 to 0, 5 to that of the edge from 0 to 1
///          |     \
///          0---5---1
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DualFunction {
    /// Positions of nodes, in world units.
    pub nodes: Vec<DVec2>,
    /// Values of v, in units of the cost: those at the nodes in their order, then those at middles of edges.
    pub values: Vec<f64>,
    /// For each triangle the numbers of its values: first those of its corners, anticlockwise, which are also
    /// the numbers of its nodes, then those of its edges, in the order of the drawing.
    pub triangles: Vec<[u32; 6]>,
    /// ℓ at the three corners of each triangle.
    pub minorants: Vec<[f64; 3]>,
    /// λ.
    pub scale: f64,
}

impl DualFunction {
    pub(super) fn new(
        space: &QuadraticSpace,
        minorants: &[Minorant],
        solution: &ConicSolution,
        scale: f64,
    ) -> Self {
        let mut nodes = vec![DVec2::ZERO; space.nodes];
        for element in &space.elements {
            for (&number, corner) in element.values.iter().zip(element.flat.corners) {
                nodes[number as usize] = corner;
            }
        }
        let (mut triangles, mut at_corners) = (Vec::new(), Vec::new());
        for (element, minorant) in space.elements.iter().zip(minorants) {
            let ([a, b, c], [at_a, at_b, at_c]) = (element.flat.corners, minorant.at_corners);
            let [to_a, to_b, to_c, bc, ca, ab] = element.values;
            let is_anticlockwise = (b - a).perp_dot(c - a) > 0.0;
            triangles.push(if is_anticlockwise { element.values } else { [to_a, to_c, to_b, bc, ab, ca] });
            at_corners.push(if is_anticlockwise { minorant.at_corners } else { [at_a, at_c, at_b] });
        }
        Self { nodes, values: solution.function.clone(), triangles, minorants: at_corners, scale }
    }
}

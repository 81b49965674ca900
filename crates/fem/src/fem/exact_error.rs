//! The energy error where the solution is known.

use glam::DVec2;

use super::element::ElementShape;
use super::fem_error::FemError;
use super::fem_mesh::FemMesh;
use super::matrix::sum_of;
use super::problem::{FemProblem, Values};
use super::solution::FemSolution;
use crate::field::Formula;

impl FemSolution {
    /// Returns the energy error by a formula of the solution: the root of the integral of a |∇e|² + c e², and
    /// of α e² along the boundary, by a rule that is exact for polynomials of degree 5.
    ///
    /// # Errors
    /// Fails where the formula is not finite.
    pub fn error_from(&self, mesh: &FemMesh, problem: &FemProblem, exact: &Formula) -> Result<f64, FemError> {
        let values = Values::of(exact);
        let [diffusion, reaction] = [&problem.diffusion, &problem.reaction].map(Values::of);
        let of_triangle = |triangle: usize| {
            let shape = ElementShape::of(mesh, triangle);
            let (corners, at_corners) = (mesh.triangle(triangle), self.at_corners(mesh, triangle));
            let gradient = shape.gradient(at_corners);
            let square = |(shares, weight): ([f64; 3], f64)| {
                let at = shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2];
                let u: f64 = shares.iter().zip(at_corners).map(|(share, value)| share * value).sum();
                let slope = slope_at(exact, at, shape.diameter(corners)) - gradient;
                let value = values.at(at) - u;
                weight
                    * (diffusion.at(at) * shape.energy(slope, slope)
                        + reaction.at(at) * shape.measure() * value * value)
            };
            rule_of_degree_5().map(square).sum::<f64>()
        };
        let along = mesh.edges.iter().zip(&self.boundary.edges).filter(|(_, data)| data.transfer > 0.0);
        let along = along.map(|(edge, data)| {
            let [a, b] = edge.ends.map(|node| node as usize);
            let middle = mesh.points[a].midpoint(mesh.points[b]);
            let [first, last] = [a, b].map(|node| values.at(mesh.points[node]) - self.values[node]);
            let between = values.at(middle) - 0.5 * (self.values[a] + self.values[b]);
            data.transfer * edge.length / 6.0 * (first * first + 4.0 * between * between + last * last)
        });
        let square = sum_of(mesh.triangle_count(), of_triangle) + along.sum::<f64>();
        if square.is_finite() {
            return Ok(square.sqrt());
        }
        let fault = (0..mesh.triangle_count()).map(|triangle| mesh.middle(triangle));
        let fault = fault.map(|at| (at, values.at(at))).find(|(_, value)| !value.is_finite());
        let (place, value) = fault.unwrap_or((mesh.points[0], f64::INFINITY));
        Err(FemError::NotFinite { what: "exact solution", place, value })
    }
}

/// Returns the gradient of a formula at a point, by differences of order 4 over a share of the size of a
/// triangle that is less than the way from the point to its edges.
fn slope_at(formula: &Formula, at: DVec2, size: f64) -> DVec2 {
    let step = 2e-3 * size;
    let along = |axis: DVec2| {
        let difference = |step: f64| {
            let [before, after] = [at - step * axis, at + step * axis].map(|at| formula.eval(at.x, at.y));
            after - before
        };
        (8.0 * difference(step) - difference(2.0 * step)) / (12.0 * step)
    };
    DVec2::new(along(DVec2::X), along(DVec2::Y))
}

/// Shares of the corners and weights of the seven points of a rule of degree 5.
pub(crate) fn rule_of_degree_5() -> impl Iterator<Item = ([f64; 3], f64)> {
    let root = 15.0_f64.sqrt();
    let sides = [-1.0, 1.0].map(|sign| ((6.0 + sign * root) / 21.0, (155.0 + sign * root) / 1200.0));
    let beside = sides.into_iter().flat_map(|(near, weight)| {
        (0..3).map(move |k| {
            let mut shares = [near; 3];
            shares[k] = 1.0 - 2.0 * near;
            (shares, weight)
        })
    });
    std::iter::once(([1.0 / 3.0; 3], 0.225)).chain(beside)
}

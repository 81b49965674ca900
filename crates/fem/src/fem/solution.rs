//! Solving a problem on a mesh.

use glam::DVec2;
use rayon::prelude::*;

use super::assembly::Equations;
use super::boundary_data::{BoundaryData, EdgeData};
use super::cycle::Cycle;
use super::element::{ElementData, ElementShape, element_data};
use super::fem_error::FemError;
use super::fem_mesh::{FemEdge, FemMesh, NONE};
use super::hierarchy::Hierarchy;
use super::krylov::{conjugate_gradients, gmres};
use super::matrix::sum_of;
use super::problem::FemProblem;
use super::tree::NodeTree;

/// The solution of a problem on a mesh, by linear elements.
#[derive(Clone, Debug)]
pub struct FemSolution {
    /// u at the nodes, in their order in the [`FemMesh`]: N numbers.
    pub values: Vec<f64>,
    /// How many steps the solver did.
    pub steps: usize,
    /// The last residual as a share of the first.
    pub reduction: f64,
    /// Whether nothing but its mean, which is set to 0, determines u.
    pub has_mean_zero: bool,
    /// The greatest Péclet number |b| h / 2a of a triangle, with its middle; `None` without convection.
    /// Above 1 the solution can oscillate.
    pub peclet: Option<(f64, DVec2)>,
    pub(crate) data: Vec<ElementData>,
    pub(crate) boundary: BoundaryData,
}

/// The residual at which a solver stops, as a share of the right side.
pub const ACCURACY: f64 = 1e-11;
/// Most triangles.
const MOST_TRIANGLES: usize = 500_000_000;
/// Sources and flux balance when they differ by less than this share of them.
const BALANCE: f64 = 1e-6;

impl FemSolution {
    /// Solves a problem. `condition_of_edge` says which condition each boundary edge of the mesh has
    /// ([`FemProblem::conditions_on`]).
    ///
    /// The same mesh and problem give the same bits on any number of threads.
    ///
    /// # Errors
    /// Fails when a coefficient is impossible somewhere, when conditions and source determine no solution, or
    /// when the solver does not converge.
    pub fn new(
        mesh: &FemMesh,
        problem: &FemProblem,
        condition_of_edge: &[Option<usize>],
    ) -> Result<Self, FemError> {
        if mesh.triangle_count() > MOST_TRIANGLES {
            return Err(FemError::TooLarge { triangles: mesh.triangle_count() });
        }
        let data = element_data(mesh, problem)?;
        let boundary = BoundaryData::of(mesh, problem, condition_of_edge)?;
        let has_mean_zero = Parts::of(mesh).check(mesh, &data, &boundary)?;
        let mut equations = Equations::of(mesh, &data, &boundary);
        if has_mean_zero {
            balance(&mut equations.right);
        }
        let is_free: Vec<bool> = (0..mesh.node_count()).map(|node| !boundary.is_fixed(node)).collect();
        let hierarchy = Hierarchy::of(&equations.symmetric, &NodeTree::of(mesh), &is_free);
        let mut cycle = Cycle::new(&hierarchy);
        let mut values = vec![0.0; mesh.node_count()];
        let solve = if equations.whole.is_some() { gmres } else { conjugate_gradients };
        let steps = solve(equations.matrix(), &equations.right, &mut values, &mut cycle, ACCURACY)?;
        if has_mean_zero {
            let mean = integral(mesh, &values)
                / sum_of(mesh.triangle_count(), |t| ElementShape::of(mesh, t).measure());
            values.iter_mut().for_each(|value| *value -= mean);
        }
        for (value, fixed) in values.iter_mut().zip(&boundary.fixed).filter(|(_, fixed)| !fixed.is_nan()) {
            *value = *fixed;
        }
        let peclet = peclet(mesh, &data, problem.convection.is_some());
        let (steps, reduction) = (steps.count, steps.reduction);
        Ok(Self { values, steps, reduction, has_mean_zero, peclet, data, boundary })
    }

    /// Returns the energy norm of u: the root of the integral of a |∇u|² + c u², and of α u² along the
    /// boundary.
    pub fn energy_norm(&self, mesh: &FemMesh) -> f64 {
        let inside = sum_of(mesh.triangle_count(), |triangle| {
            let (shape, data) = (ElementShape::of(mesh, triangle), &self.data[triangle]);
            let values = self.at_corners(mesh, triangle);
            let gradient = shape.gradient(values);
            let mass = shape.measure() * mean_of_square(values);
            data.diffusion * shape.energy(gradient, gradient) + data.reaction * mass
        });
        let along = |(edge, data): (&FemEdge, &EdgeData)| {
            let [a, b] = edge.ends.map(|node| self.values[node as usize]);
            data.transfer * edge.length * (a * a + a * b + b * b) / 3.0
        };
        let along: f64 = mesh.edges.iter().zip(&self.boundary.edges).map(along).sum();
        (inside + along).sqrt()
    }

    /// Returns u at the corners of a triangle.
    #[inline]
    pub(crate) fn at_corners(&self, mesh: &FemMesh, triangle: usize) -> [f64; 3] {
        mesh.corners[triangle].map(|node| self.values[node as usize])
    }
}

/// Returns the integral of a linear function.
fn integral(mesh: &FemMesh, values: &[f64]) -> f64 {
    sum_of(mesh.triangle_count(), |triangle| {
        let [a, b, c] = mesh.corners[triangle].map(|node| values[node as usize]);
        ElementShape::of(mesh, triangle).measure() * (a + b + c) / 3.0
    })
}

/// Returns the mean of the square of a linear function over a triangle.
fn mean_of_square([a, b, c]: [f64; 3]) -> f64 {
    (a * a + b * b + c * c + a * b + b * c + c * a) / 6.0
}

/// Removes what rounding leaves of the sum.
fn balance(right: &mut [f64]) {
    let excess = sum_of(right.len(), |n| right[n]) / right.len() as f64;
    right.iter_mut().for_each(|value| *value -= excess);
}

fn peclet(mesh: &FemMesh, data: &[ElementData], has_convection: bool) -> Option<(f64, DVec2)> {
    let number = |triangle: usize| {
        let diameter = ElementShape::of(mesh, triangle).diameter(mesh.triangle(triangle));
        let data = &data[triangle];
        0.5 * data.convection.length() * diameter / data.diffusion
    };
    let all = (0..mesh.triangle_count()).into_par_iter().map(|triangle| (number(triangle), triangle));
    // The first of several that are equal, for any number of threads.
    let greatest = all.reduce(|| (-1.0, usize::MAX), |a, b| if (b.0, a.1) > (a.0, b.1) { b } else { a });
    (has_convection && greatest.1 != usize::MAX).then(|| (greatest.0, mesh.middle(greatest.1)))
}

/// The parts of a mesh that hang together by edges.
struct Parts {
    /// The part of each triangle.
    of_triangle: Vec<u32>,
    count: usize,
}

impl Parts {
    fn of(mesh: &FemMesh) -> Self {
        let mut of_triangle = vec![NONE; mesh.triangle_count()];
        let (mut count, mut stack) = (0, Vec::new());
        for first in 0..of_triangle.len() {
            if of_triangle[first] != NONE {
                continue;
            }
            of_triangle[first] = count;
            stack.push(first);
            while let Some(triangle) = stack.pop() {
                for across in mesh.across[triangle].into_iter().filter(|&across| across != NONE) {
                    let part = &mut of_triangle[across as usize];
                    if *part == NONE {
                        *part = count;
                        stack.push(across as usize);
                    }
                }
            }
            count += 1;
        }
        Self { of_triangle, count: count as usize }
    }

    /// Returns whether only its mean determines u.
    ///
    /// # Errors
    /// Fails where nothing determines u in one of several parts, or where source and flux do not balance.
    fn check(&self, mesh: &FemMesh, data: &[ElementData], boundary: &BoundaryData) -> Result<bool, FemError> {
        let mut is_held = vec![false; self.count];
        for (data, &part) in data.iter().zip(&self.of_triangle) {
            is_held[part as usize] |= data.reaction > 0.0;
        }
        for (edge, data) in mesh.edges.iter().zip(&boundary.edges) {
            let part = self.of_triangle[edge.triangle as usize];
            is_held[part as usize] |= data.is_dirichlet || data.transfer > 0.0;
        }
        let Some(loose) = is_held.iter().position(|is_held| !is_held) else { return Ok(false) };
        if self.count > 1 {
            let triangle = self.of_triangle.iter().position(|&part| part as usize == loose).unwrap_or(0);
            return Err(FemError::PartWithoutCondition { parts: self.count, place: mesh.middle(triangle) });
        }
        let loads = |triangle: usize| data[triangle].loads.iter().sum::<f64>();
        let source = sum_of(data.len(), loads);
        let size = sum_of(data.len(), |triangle| loads(triangle).abs());
        let inflow: f64 = boundary.edges.iter().flat_map(|edge| edge.loads).sum();
        let through: f64 = boundary.edges.iter().flat_map(|edge| edge.loads).map(f64::abs).sum();
        if (source + inflow).abs() > BALANCE * (size + through) {
            return Err(FemError::Unbalanced { source, inflow });
        }
        Ok(true)
    }
}

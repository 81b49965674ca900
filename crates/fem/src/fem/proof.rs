//! The numbers that prove a bound.

use super::bound::{ErrorBound, ROUNDING};
use super::element::ElementShape;
use super::fem_mesh::FemMesh;
use super::matrix::sum_of;
use super::problem::FemProblem;
use super::solution::FemSolution;
use crate::geometry::Rect;

/// What proves the bound of a problem whose diffusion and source are numbers in each triangle, with u given
/// on the whole boundary: everything that a checker needs, in the order of the [`FemMesh`].
#[derive(Clone, Debug, PartialEq)]
pub struct BoundProof {
    /// x and y of each node, in world units.
    pub nodes: Vec<[f64; 2]>,
    /// Nodes of each triangle, anticlockwise.
    pub triangles: Vec<[u32; 3]>,
    /// a in each triangle.
    pub diffusion: Vec<f64>,
    /// f in each triangle.
    pub source: Vec<f64>,
    /// u at each node.
    pub values: Vec<f64>,
    /// What flows out of each triangle through the edge opposite each of its corners.
    pub fluxes: Vec<[f64; 3]>,
    /// A bound that these numbers prove with the width of the domain alone: in its last digits it can be
    /// above [`ErrorBound::total`], which carries what the solver left to the nearest edges.
    pub bound: f64,
}

/// Why a bound has no proof in numbers.
pub const WITHOUT_PROOF: &str = "A certificate is written where diffusion and source are numbers, there is neither \
    convection nor reaction, and u is given on the whole boundary, linear along its edges.";

/// Less than π, and than what a checker takes for it.
const LESS_THAN_PI: f64 = 3.13;

impl BoundProof {
    /// Returns the proof of a bound; `None` where it needs more than these numbers ([`WITHOUT_PROOF`]).
    pub fn new(
        mesh: &FemMesh,
        problem: &FemProblem,
        solution: &FemSolution,
        bound: &ErrorBound,
    ) -> Option<Self> {
        let is_known = problem.source.constant().is_some() && problem.diffusion.constant().is_some();
        let is_held = solution.boundary.edges.iter().all(|edge| edge.is_dirichlet);
        let has_reaction = solution.data.iter().any(|data| data.reaction > 0.0);
        let source = problem.source.constant().unwrap_or(0.0);
        let least = problem.diffusion.constant().unwrap_or(1.0);
        let square = |triangle: usize| bound.of_triangles[triangle] * bound.of_triangles[triangle];
        let defect = |triangle: usize| {
            let area = ElementShape::of(mesh, triangle).measure();
            let missing = source * area - bound.fluxes[triangle].iter().sum::<f64>();
            missing * missing / area
        };
        let [square, defect] =
            [sum_of(mesh.triangle_count(), square), sum_of(mesh.triangle_count(), defect)].map(f64::sqrt);
        let width = Rect::holding(mesh.points.iter().copied()).map_or(0.0, |rect| rect.size().min_element());
        let proved = (square + defect * width / LESS_THAN_PI / least.sqrt()) * (1.0 + ROUNDING);
        (bound.is_guaranteed() && is_known && is_held && !has_reaction).then(|| Self {
            nodes: mesh.points.iter().map(|point| point.to_array()).collect(),
            triangles: mesh.corners.clone(),
            diffusion: solution.data.iter().map(|data| data.diffusion).collect(),
            source: vec![source; mesh.triangle_count()],
            values: solution.values.clone(),
            fluxes: bound.fluxes.clone(),
            bound: proved.max(bound.total),
        })
    }
}

//! Conditions on the edges of the boundary, as numbers.

use glam::DVec2;

use super::fem_error::FemError;
use super::fem_mesh::{FemEdge, FemMesh};
use super::problem::{BoundaryCondition, FemProblem, Values};

/// What holds on the boundary edges of a mesh, and at its nodes.
#[derive(Clone, Debug)]
pub(crate) struct BoundaryData {
    /// For each edge of [`FemMesh::edges`].
    pub edges: Vec<EdgeData>,
    /// The value of u at each node where it is given; NaN elsewhere.
    pub fixed: Vec<f64>,
}

/// What holds on an edge: a ∂u/∂n = g − α u, or u is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeData {
    /// Whether u is given.
    pub is_dirichlet: bool,
    /// α at the middle.
    pub transfer: f64,
    /// Integrals of g times the hat functions of both ends.
    pub loads: [f64; 2],
}

/// The places of the rule with two points on an edge, as shares of its length.
const PLACES: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

impl BoundaryData {
    /// Evaluates the conditions on the edges of a mesh. `condition_of_edge` has, for each boundary edge of
    /// the extract, the place of its condition in the problem.
    ///
    /// # Errors
    /// Fails where a formula is not finite, or a transfer negative.
    pub fn of(
        mesh: &FemMesh,
        problem: &FemProblem,
        condition_of_edge: &[Option<usize>],
    ) -> Result<Self, FemError> {
        let natural = EdgeData { is_dirichlet: false, transfer: 0.0, loads: [0.0; 2] };
        let mut edges = Vec::with_capacity(mesh.edges.len());
        let mut condition_of_node = vec![usize::MAX; mesh.node_count()];
        for edge in &mesh.edges {
            let number = condition_of_edge[edge.number];
            edges.push(match number.map(|number| &problem.conditions[number].condition) {
                None => natural,
                Some(BoundaryCondition::Dirichlet(_)) => {
                    for node in edge.ends {
                        let least = &mut condition_of_node[node as usize];
                        *least = (*least).min(number.unwrap_or(usize::MAX));
                    }
                    EdgeData { is_dirichlet: true, ..natural }
                }
                Some(BoundaryCondition::Neumann(flux)) => {
                    EdgeData { loads: loads(mesh, edge, flux)?, ..natural }
                }
                Some(BoundaryCondition::Robin { transfer, flux }) => {
                    let transfer = transfer_at(mesh, edge, &Values::of(transfer))?;
                    EdgeData { transfer, loads: loads(mesh, edge, flux)?, ..natural }
                }
            });
        }
        let mut fixed = vec![f64::NAN; mesh.node_count()];
        for (node, number) in condition_of_node.into_iter().enumerate() {
            if let Some(BoundaryCondition::Dirichlet(value)) =
                problem.conditions.get(number).map(|named| &named.condition)
            {
                let place = mesh.points[node];
                fixed[node] = checked("value on the boundary", place, value.eval(place.x, place.y))?;
            } else if mesh.fan(node).is_empty() {
                fixed[node] = 0.0; // no triangle has it
            }
        }
        Ok(Self { edges, fixed })
    }

    /// Returns whether u is given at a node.
    #[inline]
    pub fn is_fixed(&self, node: usize) -> bool {
        !self.fixed[node].is_nan()
    }
}

/// Returns both ends of an edge.
pub(crate) fn ends(mesh: &FemMesh, edge: &FemEdge) -> [DVec2; 2] {
    edge.ends.map(|node| mesh.points[node as usize])
}

fn loads(mesh: &FemMesh, edge: &FemEdge, flux: &crate::field::Formula) -> Result<[f64; 2], FemError> {
    let flux = Values::of(flux);
    let [from, to] = ends(mesh, edge);
    let mut loads = [0.0; 2];
    for share in PLACES {
        let place = from.lerp(to, share);
        let value = 0.5 * edge.length * checked("flux through the boundary", place, flux.at(place))?;
        loads[0] += (1.0 - share) * value;
        loads[1] += share * value;
    }
    Ok(loads)
}

fn transfer_at(mesh: &FemMesh, edge: &FemEdge, transfer: &Values) -> Result<f64, FemError> {
    let [from, to] = ends(mesh, edge);
    let place = from.midpoint(to);
    let value = checked("transfer through the boundary", place, transfer.at(place))?;
    if value < 0.0 {
        return Err(FemError::Negative { what: "transfer through the boundary", place, value });
    }
    Ok(value)
}

fn checked(what: &'static str, place: DVec2, value: f64) -> Result<f64, FemError> {
    if value.is_finite() { Ok(value) } else { Err(FemError::NotFinite { what, place, value }) }
}

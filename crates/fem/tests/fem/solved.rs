//! A problem, solved on a mesh as the program makes it.

use glam::DVec2;
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment, Domain, Line, MeshBoundary};
use meshbrush_core::field::Formula;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_fem::fem::{
    BoundaryCondition, FemError, FemMesh, FemProblem, FemSolution, NamedCondition, PlaneMetric,
};
use meshbrush_mesh::mesh::{Cleaning, Extract, KeptParts};

use crate::formula_mesh::formula_mesh;

pub struct Solved {
    pub extract: Extract<'static>,
    pub solution: FemSolution,
    /// u at the nodes of the extract.
    pub values: Vec<f64>,
}

pub fn formula(text: &str) -> Formula {
    Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

pub fn dirichlet(piece: &str, text: &str) -> NamedCondition {
    NamedCondition { piece: piece.into(), condition: BoundaryCondition::Dirichlet(formula(text)) }
}

pub fn neumann(piece: &str, text: &str) -> NamedCondition {
    NamedCondition { piece: piece.into(), condition: BoundaryCondition::Neumann(formula(text)) }
}

pub fn robin(piece: &str, transfer: &str, flux: &str) -> NamedCondition {
    let condition = BoundaryCondition::Robin { transfer: formula(transfer), flux: formula(flux) };
    NamedCondition { piece: piece.into(), condition }
}

/// −∇·∇u = source.
pub fn poisson(source: &str, conditions: Vec<NamedCondition>) -> FemProblem {
    FemProblem { source: formula(source), conditions, ..FemProblem::default() }
}

/// The largest part of the mesh of a domain, with nodes on the outline.
pub fn mesh_of(domain: &Domain, spacing: f64, target: &str) -> MeshParts {
    mesh_keeping(KeptParts::Largest, domain, spacing, target)
}

/// A mesh, what files get of it, and its boundary.
pub type MeshParts = (FemMesh, Extract<'static>, MeshBoundary);

/// The parts of such a mesh.
pub fn mesh_keeping(parts: KeptParts, domain: &Domain, spacing: f64, target: &str) -> MeshParts {
    let boundary = BoundaryTreatment::OnOutline { diameter: spacing };
    let built = formula_mesh(domain, spacing, boundary, target);
    let cleaning = Cleaning { parts, ..Cleaning::FOR_SOLVERS };
    let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &cleaning);
    let extract = derived.extract(&built.mesh);
    let homes = built.mesh.homes_with(derived.patch());
    let mesh = FemMesh::new(&extract, &homes, &PlaneMetric::World);
    let boundary = MeshBoundary::new(&extract, domain, &BoundaryMarks::default());
    (mesh, extract.into_owned(), boundary)
}

/// Solves on a mesh of a rectangle with edges along lines.
pub fn solve_with_lines(domain: &Domain, lines: &[Line], size: f64, problem: &FemProblem) -> Solved {
    let built = formula_mesh(domain, size, BoundaryTreatment::Report, &format!("{size}"));
    let on_lattice = built.domain.clone().with_lines(lines);
    let derived = DerivedMesh::new(&built.mesh, &on_lattice, None, &Cleaning::NONE);
    assert!(derived.line_fits().iter().all(|fit| fit.unresolved.is_empty()), "lines are on edges");
    let extract = derived.extract(&built.mesh).into_owned();
    let mesh = FemMesh::new(&extract, &built.mesh.homes_with(derived.patch()), &PlaneMetric::World);
    let boundary = MeshBoundary::new(&extract, domain, &BoundaryMarks::default());
    Solved::on(&mesh, extract, &boundary, problem).unwrap_or_else(|error| panic!("{error}"))
}

pub fn try_solve(
    domain: &Domain,
    spacing: f64,
    target: &str,
    problem: &FemProblem,
) -> Result<Solved, FemError> {
    let (mesh, extract, boundary) = mesh_of(domain, spacing, target);
    Solved::on(&mesh, extract, &boundary, problem)
}

pub fn solve(domain: &Domain, spacing: f64, target: &str, problem: &FemProblem) -> Solved {
    try_solve(domain, spacing, target, problem).unwrap_or_else(|error| panic!("{error}"))
}

impl Solved {
    fn on(
        mesh: &FemMesh,
        extract: Extract<'static>,
        boundary: &MeshBoundary,
        problem: &FemProblem,
    ) -> Result<Self, FemError> {
        let conditions = problem.conditions_on(boundary)?;
        let solution = FemSolution::new(mesh, problem, &conditions)?;
        let values = mesh.values_in_extract(&solution.values);
        Ok(Self { extract, solution, values })
    }

    /// Errors of u in L² and of its gradient, by a rule of degree 5 on four parts of each triangle.
    pub fn errors(&self, exact: impl Fn(DVec2) -> f64) -> [f64; 2] {
        let nodes: Vec<DVec2> = self.extract.world_nodes().collect();
        let mut sums = [0.0; 2];
        for cell in self.extract.cells() {
            let corners = cell.corners.map(|node| nodes[node]);
            let values = cell.corners.map(|node| self.values[node]);
            let area = 0.5 * (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
            for (shares, weight) in rule() {
                let at = shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2];
                let value = shares[0] * values[0] + shares[1] * values[1] + shares[2] * values[2];
                sums[0] += area * weight * (value - exact(at)).powi(2);
                let gradient = gradient(corners, values) - slope(&exact, at);
                sums[1] += area * weight * gradient.length_squared();
            }
        }
        sums.map(f64::sqrt)
    }
}

/// The gradient of a linear function on a triangle.
fn gradient([a, b, c]: [DVec2; 3], [u, v, w]: [f64; 3]) -> DVec2 {
    let doubled = (b - a).perp_dot(c - a);
    ((v - u) * (a - c).perp() + (w - u) * (b - a).perp()) / doubled
}

/// The gradient of a function, by differences of order 4.
pub fn slope(f: impl Fn(DVec2) -> f64, at: DVec2) -> DVec2 {
    let step = 1e-3;
    let along = |axis: DVec2| {
        let difference = |h: f64| f(at + h * axis) - f(at - h * axis);
        (8.0 * difference(step) - difference(2.0 * step)) / (12.0 * step)
    };
    DVec2::new(along(DVec2::X), along(DVec2::Y))
}

/// Barycentric places and weights of the rule of degree 5 with seven points.
fn rule() -> Vec<([f64; 3], f64)> {
    let root = 15.0_f64.sqrt();
    let mut rule = vec![([1.0 / 3.0; 3], 0.225)];
    for (near, weight) in
        [((6.0 - root) / 21.0, (155.0 - root) / 1200.0), ((6.0 + root) / 21.0, (155.0 + root) / 1200.0)]
    {
        for k in 0..3 {
            let mut shares = [near; 3];
            shares[k] = 1.0 - 2.0 * near;
            rule.push((shares, weight));
        }
    }
    rule
}

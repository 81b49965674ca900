//! Meshes by the bound of the error: the rate at a corner, and what decides them.

use glam::dvec2;
use meshbrush_core::build::BuiltMesh;
use meshbrush_core::domain::{BoundaryMarks, BoundaryTreatment, Domain, MeshBoundary};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_fem::fem::{ErrorBound, FemMesh, FemProblem, FemSolution, PlaneMetric};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, Fingerprint, Limits};

use crate::formula_mesh::formula_mesh;
use crate::runs::prints_table;
use crate::solved::{dirichlet, formula, poisson};

/// A mesh of a sequence.
struct Round {
    triangles: usize,
    bound: f64,
    error: f64,
    fingerprint: Fingerprint,
}

/// Bisects the triangles with half of the square of the bound until there are so many.
fn rounds(built: &mut BuiltMesh, problem: &FemProblem, exact: &str, most: usize) -> Vec<Round> {
    let mut rounds = Vec::new();
    loop {
        let derived = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::FOR_SOLVERS);
        let (patch, extract) = (derived.patch(), derived.extract(&built.mesh));
        let mesh = FemMesh::new(&extract, &built.mesh.homes_with(patch), &PlaneMetric::World);
        let boundary = MeshBoundary::from_pieces(&extract, pieces(&extract));
        let conditions = problem.conditions_on(&boundary).unwrap();
        let solution = FemSolution::new(&mesh, problem, &conditions).unwrap();
        let bound = ErrorBound::of(&mesh, problem, &solution);
        rounds.push(Round {
            triangles: mesh.triangle_count(),
            bound: bound.total,
            error: solution.error_from(&mesh, problem, &formula(exact)).unwrap(),
            fingerprint: built.mesh.fingerprint(),
        });
        if mesh.triangle_count() >= most {
            return rounds;
        }
        let marked = bound.marked(&mesh, &built.mesh.sources_with(patch), 0.5);
        built.bisect(&marked, &Limits::default()).unwrap();
        assert!(built.mesh.violations().is_empty());
    }
}

fn pieces(extract: &meshbrush_mesh::mesh::Extract) -> meshbrush_core::domain::BoundaryPieces {
    meshbrush_core::domain::BoundaryPieces::of_mesh(extract, &BoundaryMarks::default())
}

/// r^(2/3) sin(2φ/3) on an L, whose gradient is infinite at the corner.
const CORNER: &str = "r^(2/3)*sin(2/3*if(theta<0, theta+2*pi, theta))";

fn corner() -> (BuiltMesh, FemProblem) {
    let bounds = Rect::new(dvec2(-1.0, -1.0), dvec2(1.0, 1.0));
    let domain = Domain { shape: formula("not (x>0 and y<0)").into(), ..Domain::rectangle(bounds) };
    let built = formula_mesh(&domain, 0.25, BoundaryTreatment::OnOutline { diameter: 0.4 }, "0.5");
    (built, poisson("0", vec![dirichlet("all", CORNER)]))
}

#[expect(clippy::print_stdout, reason = "a table of figures where it is asked for")]
#[test]
fn the_error_at_a_corner_falls_with_the_best_rate() {
    let (mut built, problem) = corner();
    let rounds = rounds(&mut built, &problem, CORNER, 20_000);
    if prints_table() {
        for round in &rounds {
            println!("{} triangles: error {:e}, bound {:e}", round.triangles, round.error, round.bound);
        }
    }
    let last = &rounds[rounds.len() - 1];
    let first = rounds.iter().find(|round| round.triangles > 1000).unwrap();
    let slope = |of: fn(&Round) -> f64| {
        (of(last) / of(first)).ln() / (last.triangles as f64 / first.triangles as f64).ln()
    };
    for slope in [slope(|round| round.error), slope(|round| round.bound)] {
        assert!((-0.56..-0.46).contains(&slope), "{slope}");
    }
    assert!(last.bound < 2.0 * last.error);
}

#[test]
fn threads_do_not_decide_the_mesh() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut built, problem) = corner();
            rounds(&mut built, &problem, CORNER, 3000).pop().unwrap().fingerprint
        })
    };
    assert!(on(1) == on(3));
}

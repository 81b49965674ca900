//! The same bits on any number of threads, and for any order of the mesh's entries.

use glam::dvec2;
use meshbrush_core::domain::{BoundaryMarks, Domain, MeshBoundary};
use meshbrush_fem::fem::{FemMesh, FemProblem, FemSolution, PlaneMetric};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh, MeshPatch};
use rayon::ThreadPoolBuilder;

use crate::solved::{dirichlet, formula, poisson, solve};

#[test]
fn threads_change_nothing() {
    let disc = Domain { shape: formula("hypot(x-0.5,y-0.5) < 0.45").into(), ..Domain::rectangle(Rect::UNIT) };
    let still = FemProblem {
        diffusion: formula("1 + 100*(x>y)"),
        ..poisson("1+x", vec![dirichlet("all", "sin(9*x)")])
    };
    let moving = FemProblem { convection: Some([formula("30*y"), formula("-9")]), ..still.clone() };
    for problem in [still, moving] {
        let on = |threads: usize| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| solve(&disc, 0.1, "0.005 + 0.1*abs(x-0.4)", &problem)).values
        };
        let one = on(1);
        assert!(one.len() > 5000, "{}", one.len());
        assert!(one == on(2) && one == on(3));
    }
}

/// Refines towards the points in turn.
fn refined(order: &[[f64; 2]]) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    for &[x, y] in order {
        mesh.refine(&Limits::default(), |element| {
            let near = element.world_corners().into_iter().map(|c| c.distance(dvec2(x, y)));
            element.diameter() > 0.01 + 0.3 * near.fold(f64::INFINITY, f64::min)
        })
        .unwrap();
    }
    mesh
}

#[test]
fn the_order_of_the_entries_changes_nothing() {
    let problem = poisson("1+x*y", vec![dirichlet("open south", "x"), dirichlet("open east", "1")]);
    let solution = |mesh: &Mesh| {
        let extract = mesh.extract();
        let fem = FemMesh::new(&extract, &mesh.homes_with(&MeshPatch::default()), &PlaneMetric::World);
        let domain = Domain::rectangle(Rect::UNIT);
        let boundary = MeshBoundary::new(&extract, &domain, &BoundaryMarks::default());
        let conditions = problem.conditions_on(&boundary).unwrap();
        let values = FemSolution::new(&fem, &problem, &conditions).unwrap().values;
        let values = fem.values_in_extract(&values);
        let key = |node: &LatticePoint| [node.x, node.y];
        let mut all: Vec<_> = extract.nodes().iter().map(key).zip(values).collect();
        all.sort_by_key(|(key, _)| *key);
        all
    };
    let (a, b) = (refined(&[[0.1, 0.2], [0.7, 0.6]]), refined(&[[0.7, 0.6], [0.1, 0.2]]));
    assert_ne!(a.extract().nodes(), b.extract().nodes(), "the orders differ");
    assert!(solution(&a) == solution(&b));
}

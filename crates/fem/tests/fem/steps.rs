//! How many steps the solver needs.

use meshbrush_core::domain::Domain;
use meshbrush_fem::fem::{FemProblem, FemSolution};
use meshbrush_mesh::geometry::Rect;

use crate::runs::prints_table;
use crate::solved::{dirichlet, formula, mesh_of, poisson};

/// Coarse spacings and targets: uniform by bisection, a coarse grid alone, towards a point, towards lines.
const MESHES: [(f64, &str); 5] = [
    (0.25, "0.02"),
    (0.012, "1"),
    (0.25, "0.0005+0.15*hypot(x-0.37,y-0.41)"),
    (0.25, "0.004+0.1*abs(x-0.3)"),
    (0.1, "0.006+0.1*abs(x-0.3+0.2*y)"),
];

/// Jumps along edges of the mesh and across its triangles.
const DIFFUSIONS: [&str; 4] = [
    "1",
    "if((x<0.5) != (y<0.5), 1e6, 1)",
    "if(hypot(x-0.4,y-0.45)<0.217, 1e6, 1)",
    "if(hypot(x-0.4,y-0.45)<0.217, 1e-6, 1)",
];

#[expect(clippy::print_stdout, reason = "a table of figures where it is asked for")]
#[test]
fn steps_depend_neither_on_grading_nor_on_jumps() {
    let square = Domain::rectangle(Rect::UNIT);
    let disc = Domain { shape: formula("hypot(x-0.5,y-0.5) < 0.45").into(), ..square.clone() };
    for (name, domain) in [("square", &square), ("disc", &disc)] {
        for (spacing, target) in MESHES {
            let (mesh, _, boundary) = mesh_of(domain, spacing, target);
            for diffusion in DIFFUSIONS {
                let problem = poisson("1", vec![dirichlet("all", "0")]);
                let problem = FemProblem { diffusion: formula(diffusion), ..problem };
                let conditions = problem.conditions_on(&boundary).unwrap();
                let steps = FemSolution::new(&mesh, &problem, &conditions).unwrap().steps;
                if prints_table() {
                    let nodes = mesh.node_count();
                    println!("{name}, {spacing}, {target}, a = {diffusion}: {nodes} nodes, {steps} steps");
                }
                assert!(steps <= 15, "{name}, {target}, {diffusion}: {steps}");
            }
        }
    }
}

//! Problems with known solutions: order 2 in L², 1 in H¹.

use fastrand::Rng;
use glam::DVec2;
use meshbrush_core::domain::Domain;
use meshbrush_fem::fem::FemProblem;
use meshbrush_mesh::geometry::Rect;

use crate::random_coast::random_coast;
use crate::runs::{prints_table, seeds};
use crate::solved::{dirichlet, formula, neumann, poisson, robin, solve};

#[expect(clippy::print_stdout, reason = "a table of figures where it is asked for")]
/// Checks the orders on meshes of sizes that are shares of the domain's width.
fn check_orders(
    name: &str,
    domain: &Domain,
    problem: &FemProblem,
    exact: impl Fn(DVec2) -> f64,
    shares: [f64; 3],
) {
    let errors = shares.map(|share| {
        let size = share * domain.bounds.size().max_element();
        let solved = solve(domain, size, &format!("{size}"), problem);
        let errors = solved.errors(&exact);
        if prints_table() {
            println!("{name}: {} nodes, {} steps, {errors:?}", solved.values.len(), solved.solution.steps);
        }
        errors
    });
    let halvings = (shares[0] / shares[2]).log2();
    for (axis, expected) in [2.0, 1.0].into_iter().enumerate() {
        let order = (errors[0][axis] / errors[2][axis]).log2() / halvings;
        assert!(order > expected - 0.15, "{name}: order {order} in {}", ["L²", "H¹"][axis]);
    }
}

const SINE: &str = "sin(3*x)*cos(2*y+0.3)";

fn sine(p: DVec2) -> f64 {
    (3.0 * p.x).sin() * (2.0 * p.y + 0.3).cos()
}

fn square() -> Domain {
    Domain::rectangle(Rect::UNIT)
}

#[test]
fn a_square_with_values_on_its_sides() {
    let problem = poisson(&format!("13*{SINE}"), vec![dirichlet("all", SINE)]);
    check_orders("Dirichlet", &square(), &problem, sine, [0.1, 0.05, 0.025]);
}

#[test]
fn a_square_with_all_kinds_of_conditions_and_varying_coefficients() {
    // a = 1 + x + y², so −∇·(a∇u) = −a Δu − ∂u/∂x − 2y ∂u/∂y.
    let (along_x, along_y) = ("3*cos(3*x)*cos(2*y+0.3)", "(-2)*sin(3*x)*sin(2*y+0.3)");
    let diffusion = "(1+x+y^2)";
    let bare = format!("{diffusion}*13*{SINE} - {along_x} - 2*y*{along_y}");
    let conditions = vec![
        dirichlet("open south", SINE),
        neumann("open east", &format!("{diffusion}*{along_x}")),
        robin("open north", "2+x", &format!("{diffusion}*{along_y} + (2+x)*{SINE}")),
        dirichlet("all", SINE),
    ];
    let problem = FemProblem {
        diffusion: formula(diffusion),
        reaction: formula("3+x"),
        source: formula(&format!("{bare} + (3+x)*{SINE}")),
        convection: None,
        conditions,
    };
    check_orders("all kinds", &square(), &problem, sine, [0.1, 0.05, 0.025]);
    let source = format!("{bare} + (3+x)*{SINE} + (5-y)*{along_x} + 7*x*{along_y}");
    let convection = Some([formula("5-y"), formula("7*x")]);
    let problem = FemProblem { convection, source: formula(&source), ..problem };
    check_orders("convection", &square(), &problem, sine, [0.1, 0.05, 0.025]);
}

#[test]
fn a_disc_with_each_kind_of_condition() {
    let disc = Domain { shape: formula("hypot(x-0.5,y-0.5) < 0.45").into(), ..square() };
    // u = cos(3 r) around the middle: the same flux all around.
    let exact = |p: DVec2| (3.0 * p.distance(DVec2::splat(0.5))).cos();
    let r = "hypot(x-0.5,y-0.5)";
    let source = format!("9*cos(3*{r}) + 3*sin(3*{r})/max({r},1e-9)");
    let flux = format!("-3*sin(3*{r})");
    let value = format!("cos(3*{r})");
    let shares = [0.08, 0.04, 0.02];
    let dirichlet = poisson(&source, vec![dirichlet("mainland", &value)]);
    check_orders("disc, Dirichlet", &disc, &dirichlet, exact, shares);
    let robin = poisson(&source, vec![robin("mainland", "4", &format!("{flux}+4*{value}"))]);
    check_orders("disc, Robin", &disc, &robin, exact, shares);
    let neumann = FemProblem {
        reaction: formula("1"),
        ..poisson(&format!("{source}+{value}"), vec![neumann("mainland", &flux)])
    };
    check_orders("disc, Neumann", &disc, &neumann, exact, shares);
}

#[test]
fn coasts_with_values_on_them() {
    for seed in seeds(3) {
        let domain = Domain::of_polygons(&random_coast(&mut Rng::with_seed(seed))).unwrap();
        let (Rect { min, .. }, width) = (domain.bounds, domain.bounds.size().max_element());
        let [x, y] = [format!("((x-({}))/{width})", min.x), format!("((y-({}))/{width})", min.y)];
        let value = format!("sin(3*{x})*cos(2*{y}+0.3)");
        let problem = poisson(&format!("13/{width}^2*{value}"), vec![dirichlet("all", &value)]);
        let exact = |p: DVec2| sine((p - min) / width);
        check_orders(&format!("coast {seed}"), &domain, &problem, exact, [0.04, 0.02, 0.01]);
    }
}

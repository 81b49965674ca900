//! The bound is never below the true error, and not far above it.

use std::f64::consts::PI;

use fastrand::Rng;
use meshbrush_core::domain::Domain;
use meshbrush_fem::fem::{Doubt, ErrorBound, FemProblem, FemSolution};
use meshbrush_mesh::geometry::Rect;

use crate::runs::{prints_table, seeds};
use crate::solved::{dirichlet, formula, mesh_of, neumann, poisson, robin};

/// A problem on the unit square, and its solution as a formula.
fn random_problem(random: &mut Rng) -> (FemProblem, String) {
    let [m, n] = [(); 2].map(|()| f64::from(random.u32(1..4)));
    let a = [1.0, 0.01, 300.0][random.usize(..3)];
    let c = [0.0, 0.0, a, 20.0 * a][random.usize(..4)];
    let mut conditions = vec![dirichlet("all", "0")];
    // A sine along y that is 0 in the south, and in the north 0 or even.
    let along_y = match random.usize(..3) {
        0 => n,
        1 => {
            conditions.push(neumann("open north", "0"));
            n - 0.5
        }
        _ => {
            conditions.push(robin("open north", "3", "0"));
            // Where 3 sin kπ + a kπ cos kπ = 0, by bisection.
            let value = |k: f64| 3.0 * (k * PI).sin() + a * k * PI * (k * PI).cos();
            let (mut low, mut high) = (n - 0.5, n);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if value(middle) * value(low) > 0.0 { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        }
    };
    let exact = format!("sin({m}*pi*x)*sin({along_y}*pi*y)");
    let factor = a * PI * PI * (m * m + along_y * along_y) + c;
    let problem = FemProblem {
        diffusion: formula(&format!("{a}")),
        reaction: formula(&format!("{c}")),
        ..poisson(&format!("{factor}*{exact}"), conditions)
    };
    (problem, exact)
}

/// Returns the bound and the true error.
fn bounded(problem: &FemProblem, exact: &str, spacing: f64, target: &str) -> (ErrorBound, f64) {
    let (mesh, _, boundary) = mesh_of(&Domain::rectangle(Rect::UNIT), spacing, target);
    let conditions = problem.conditions_on(&boundary).unwrap();
    let solution = FemSolution::new(&mesh, problem, &conditions).unwrap();
    let bound = ErrorBound::of(&mesh, problem, &solution);
    (bound, solution.error_from(&mesh, problem, &formula(exact)).unwrap())
}

#[expect(clippy::print_stdout, reason = "a table of figures where it is asked for")]
#[test]
fn bounds_are_never_below_the_true_error() {
    let mut shares = Vec::new();
    for seed in seeds(100) {
        let mut random = Rng::with_seed(seed);
        let (problem, exact) = random_problem(&mut random);
        let spacing = [0.1, 0.07, 0.05][random.usize(..3)];
        let target = ["0.1", "0.05", "0.03+0.1*x", "0.02+0.2*hypot(x-0.3,y-0.6)"][random.usize(..4)];
        let (bound, error) = bounded(&problem, &exact, spacing, target);
        let share = bound.total / error;
        if prints_table() {
            println!("{seed}: {exact}, a = {}: error {error:e}, times {share}", problem.diffusion);
        }
        assert!(share >= 1.0 - 1e-6, "{seed}: {error} above {}", bound.total);
        assert!(bound.is_guaranteed(), "{seed}: {:?}", bound.doubts);
        shares.push(share);
    }
    shares.sort_by(f64::total_cmp);
    let [median, most] = [shares[shares.len() / 2], shares[9 * shares.len() / 10]];
    assert!(median < 2.0 && most < 4.0, "{median}, {most}");
}

#[test]
fn coefficients_that_vary_are_bounded_too() {
    // −∇·(a∇u) with a = 1 + x: −(1+x) Δu − ∂u/∂x.
    let exact = "sin(pi*x)*sin(pi*y)";
    let source = format!("(1+x)*2*pi^2*{exact} - pi*cos(pi*x)*sin(pi*y)");
    let problem = FemProblem { diffusion: formula("1+x"), ..poisson(&source, vec![dirichlet("all", "0")]) };
    let (bound, error) = bounded(&problem, exact, 0.1, "0.05");
    assert!(bound.total >= error && bound.total < 3.0 * error, "{error}, {}", bound.total);
    assert!(bound.is_guaranteed(), "{:?}", bound.doubts);
}

#[test]
fn what_cannot_be_proved_is_an_estimate() {
    let zero = || vec![dirichlet("all", "0")];
    let doubts = |problem: &FemProblem| bounded(problem, "0", 0.2, "0.1").0.doubts;
    let still = poisson("1", zero());
    assert_eq!(doubts(&still), []);
    let moving = FemProblem { convection: Some([formula("1"), formula("0")]), ..still.clone() };
    assert_eq!(doubts(&moving), [Doubt::Convection]);
    assert_eq!(doubts(&poisson("1", vec![dirichlet("all", "x^2")])), [Doubt::DirichletData]);
    assert_eq!(doubts(&poisson("1", vec![dirichlet("all", "2*x-y")])), []);
    assert_eq!(doubts(&poisson("if(x>0.33,1,2)", zero())), [Doubt::Source]);
    assert_eq!(doubts(&FemProblem { reaction: formula("x"), ..still.clone() }), [Doubt::Reaction]);
    assert_eq!(doubts(&FemProblem { diffusion: formula("if(x>y,1,100)"), ..still }), [Doubt::Diffusion]);
    assert_eq!(doubts(&poisson("0", vec![])), [Doubt::Balance]);
}

#[test]
fn jumps_along_edges_are_no_doubt() {
    // Linear in two halves, the flux is continuous: elements of degree 1 are exact.
    let problem = FemProblem {
        diffusion: formula("if(x<0.5,1,1000)"),
        ..poisson("0", vec![dirichlet("open west", "0"), dirichlet("open east", "1")])
    };
    let (bound, _) = bounded(&problem, "x", 0.25, "0.1");
    assert!(bound.is_guaranteed() && bound.total < 1e-6, "{}", bound.total);
}

//! What has no solution, a sentence each.

use glam::dvec2;
use meshbrush_core::domain::{Domain, Polygon};
use meshbrush_fem::fem::{FemError, FemProblem};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, KeptParts};

use crate::solved::{dirichlet, formula, mesh_keeping, neumann, poisson, robin, solve, try_solve};

fn refused(problem: &FemProblem) -> FemError {
    try_solve(&Domain::rectangle(Rect::UNIT), 0.1, "0.1", problem).err().expect("it has no solution")
}

#[test]
fn coefficients_are_positive_and_finite() {
    let zero = || vec![dirichlet("all", "0")];
    let with = |diffusion: &str, reaction: &str, source: &str, convection: &str| FemProblem {
        diffusion: formula(diffusion),
        reaction: formula(reaction),
        convection: Some([formula(convection), formula("0")]),
        ..poisson(source, zero())
    };
    let error = refused(&with("x-0.5", "0", "1", "0"));
    assert!(
        matches!(error, FemError::Diffusion { place, value } if value <= 0.0 && place.x <= 0.5),
        "{error}"
    );
    assert!(error.to_string().starts_with("The diffusion is -0."), "{error}");
    assert!(matches!(refused(&with("0", "0", "1", "0")), FemError::Diffusion { .. }));
    assert!(matches!(refused(&with("1", "-x", "1", "0")), FemError::Negative { what: "reaction", .. }));
    for (problem, what) in [
        (with("ln(x-0.5)", "0", "1", "0"), "diffusion"),
        (with("1", "inf", "1", "0"), "reaction"),
        (with("1", "0", "sqrt(x-0.5)", "0"), "source"),
        (with("1", "0", "1", "1/(x-x)"), "convection"),
    ] {
        let error = refused(&problem);
        assert!(matches!(error, FemError::NotFinite { what: of, .. } if of == what), "{what}: {error}");
    }
    let on_boundary = poisson("1", vec![dirichlet("all", "1/(x-x)")]);
    assert!(matches!(refused(&on_boundary), FemError::NotFinite { what: "value on the boundary", .. }));
    let negative = poisson("1", vec![robin("all", "-1", "0")]);
    assert!(matches!(refused(&negative), FemError::Negative { .. }));
}

#[test]
fn names_of_the_boundary_exist_once() {
    let error = refused(&poisson("1", vec![dirichlet("open soth", "0")]));
    assert!(
        error.to_string().contains("“open soth”") && error.to_string().contains("“open south”"),
        "{error}"
    );
    let twice = vec![dirichlet("open south", "0"), neumann("open south", "0")];
    assert!(matches!(refused(&poisson("1", twice)), FemError::TwoConditions { .. }));
}

#[test]
fn without_a_value_the_mean_is_zero_and_sources_balance() {
    assert!(matches!(refused(&poisson("1", vec![])), FemError::Unbalanced { .. }));
    let balanced = poisson("1", vec![neumann("all", "-0.25")]);
    let solved = solve(&Domain::rectangle(Rect::UNIT), 0.1, "0.02+0.1*x", &balanced);
    assert!(solved.solution.has_mean_zero);
    let [l2, _] = solved.errors(|p| -0.25 * ((p.x - 0.5).powi(2) + (p.y - 0.5).powi(2)) + 1.0 / 24.0);
    assert!(l2 < 1e-3, "{l2}");
}

#[test]
fn each_part_needs_a_condition() {
    let square = |x: f64| vec![dvec2(x, 0.0), dvec2(x + 1.0, 0.0), dvec2(x + 1.0, 1.0), dvec2(x, 1.0)];
    let polygons: Vec<Polygon> = vec![vec![square(0.0)], vec![square(2.0)]];
    let domain = Domain::of_polygons(&polygons).unwrap();
    let (mesh, _, boundary) = mesh_keeping(KeptParts::All, &domain, 0.2, "0.2");
    let solve = |problem: FemProblem| {
        meshbrush_fem::fem::FemSolution::new(&mesh, &problem, &problem.conditions_on(&boundary)?)
    };
    let names: Vec<&str> = boundary.pieces().list().iter().map(|piece| &*piece.name).collect();
    let error = solve(poisson("1", vec![dirichlet(names[0], "0")])).err().unwrap();
    assert!(matches!(error, FemError::PartWithoutCondition { parts: 2, .. }), "{error}");
    assert!(solve(poisson("1", vec![dirichlet("all", "0")])).is_ok());
    assert_eq!(Cleaning::NONE.parts, KeptParts::All);
}

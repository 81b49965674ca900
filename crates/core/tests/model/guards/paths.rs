//! What a planner returns for edits, and what corridors, alternatives and certificates promise.

use std::sync::Arc;

use glam::dvec2;
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{Alternatives, Difference, FormulaCost, PathMesh, PathRequest, Planner};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

fn cost(formula: &str) -> FormulaCost {
    FormulaCost { formula: CostFormula::parse(formula).unwrap(), risk: RiskField::default() }
}

fn mesh(spacing: f64) -> Arc<PathMesh> {
    let lattice = Lattice::covering(Rect::UNIT, spacing, 100_000).unwrap();
    let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    Arc::new(PathMesh::new(mesh.view()))
}

/// A mesh that is fine enough for both costs is not divided: a planner keeps it and follows its marches.
#[test]
fn a_cost_that_changes_on_the_same_triangles_is_followed() {
    let formulas = ["1", "1 + 0.02*x", "1 + 0.02*y", "1.5", "1.5 + 0.01*sin(3*x)"];
    let places = [dvec2(0.1, 0.2), dvec2(0.9, 0.7)];
    let mesh = mesh(0.1);
    let mut planner = Planner::new(Arc::clone(&mesh), &cost(formulas[0])).unwrap();
    planner.solve(&cost(formulas[0]), &places, PathRequest::FULL).unwrap();
    for formula in formulas.iter().rev() {
        let density = cost(formula);
        planner.update(&density, &[Rect::UNIT]).unwrap();
        let followed = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        let mut fresh = Planner::new(Arc::clone(&mesh), &density).unwrap();
        let expected = fresh.solve(&density, &places, PathRequest::FULL).unwrap();
        assert_eq!(fresh.mesh().triangle_count(), mesh.triangle_count(), "{formula}");
        assert_eq!((followed.cost, followed.lower), (expected.cost, expected.lower), "{formula}");
        assert_eq!(followed.points, expected.points, "{formula}");
    }
}

#[test]
fn either_corridor_holds_the_points_of_both() {
    let mut planner = Planner::new(mesh(0.1), &cost("1 + x")).unwrap();
    let mut corridor = |a, b| planner.corridor(&[a, b]).unwrap();
    let one = corridor(dvec2(0.1, 0.45), dvec2(0.95, 0.5));
    let other = corridor(dvec2(0.1, 0.1), dvec2(0.2, 0.9));
    let joined = one.clone().joined(other.clone());
    let pairs: Vec<_> = one.excess().iter().zip(other.excess()).collect();
    let both = pairs.iter().filter(|(a, b)| a < b).count();
    assert!(both > 10 && both < pairs.len() - 10, "{both}");
    for (excess, (a, b)) in joined.excess().iter().zip(pairs) {
        assert_eq!(*excess, a.min(*b));
    }
}

/// Two gaps between walls of cost: the path through the other gap costs more by a known share.
#[test]
fn an_alternative_may_cost_as_much_more_as_was_said() {
    let density =
        cost("1 + 30*exp(-((x - 0.5)/0.05)^2)*(1 - exp(-((y - 0.8)/0.08)^2) - exp(-((y - 0.1)/0.08)^2))");
    let places = vec![dvec2(0.1, 0.5), dvec2(0.9, 0.5)];
    let mesh = mesh(0.05);
    let request = PathRequest { has_bounds: false, ..PathRequest::FULL };
    let best = Planner::new(Arc::clone(&mesh), &density).unwrap().solve(&density, &places, request).unwrap();
    let second = |most_excess: f64| -> Option<f64> {
        let difference = Difference { most_excess, ..Difference::default() };
        let mut search = Alternatives::new(Arc::clone(&mesh), places.clone(), best.clone(), difference);
        while !search.is_done() && search.paths().len() < 2 {
            search.advance(&density).unwrap();
        }
        search.paths().get(1).map(|path| path.cost)
    };
    let excess = second(1.0).unwrap() / best.cost - 1.0;
    assert!(excess > 0.02, "{excess}");
    assert_eq!(second(0.9 * excess), None);
    assert_eq!(second(1.1 * excess).map(|cost| cost > best.cost), Some(true));
}

//! Certificates of paths: the lower bound never exceeds the least cost, and reaches the requested width.
//!
//! MESHBRUSH_TABLE=1 prints nodes, programs and seconds, and goes on to a width of 1e-4.

use std::sync::Arc;
use std::time::Instant;

use crate::exact_paths::{ExactPath, exact_paths, square};
use crate::random_costs::{Cells, RadialPath};
use crate::runs::{prints_table, seeds};
use glam::{DVec2, dvec2};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{Certificate, CertificateEnd, CertificateTask, FormulaCost, PathError};
use meshbrush_mesh::geometry::Rect;

/// Returns the certificate of a known path, with its end. The bound is checked after each program.
fn certified(case: &ExactPath, width: f64) -> Certificate {
    let upper = case.exact * (1.0 + 1e-9);
    let density = Arc::clone(&case.density);
    let task = CertificateTask::in_rectangle(square(), density, case.path.clone(), upper, width).unwrap();
    let task = CertificateTask { placement: Arc::clone(&case.placement), ..task };
    let mut certificate = Certificate::new(task).unwrap();
    let mut before = 0.0;
    while certificate.advance().unwrap().is_none() {
        assert!(certificate.lower() >= before, "{}: the bound falls", case.name);
        before = certificate.lower();
    }
    let lower = certificate.lower();
    assert!(lower <= case.exact * (1.0 + 1e-12), "{}: {lower} exceeds {}", case.name, case.exact);
    certificate
}

#[test]
fn the_bound_is_below_the_exact_cost_and_reaches_the_width() {
    let widths: &[f64] = if prints_table() { &[1e-2, 1e-3, 1e-4] } else { &[1e-2] };
    for case in exact_paths() {
        for &width in widths {
            // A jump across the mesh is the one hard case.
            if case.name == "oblique half-planes" && width < 1e-3 {
                continue;
            }
            let begin = Instant::now();
            let certificate = certified(&case, width);
            if prints_table() {
                eprintln!(
                    "{:28} {width:.0e}: {:5} nodes, {:2} programs, {:6.2} s, width {:.2e}, {:?}",
                    case.name,
                    certificate.nodes(),
                    certificate.programs(),
                    begin.elapsed().as_secs_f64(),
                    certificate.width(),
                    certificate.end().unwrap(),
                );
            }
            assert_eq!(certificate.end(), Some(CertificateEnd::Reached), "{} {width}", case.name);
        }
    }
}

#[test]
fn the_bound_is_below_the_cost_by_quadrature_for_random_radial_densities() {
    let mut widest: f64 = 0.0;
    for seed in seeds(3) {
        let RadialPath { density, path, exact } = RadialPath::random(seed);
        let upper = exact * (1.0 + 1e-9);
        let task = CertificateTask::in_rectangle(Rect::UNIT, Arc::new(density), path, upper, 0.01).unwrap();
        let mut certificate = Certificate::new(task).unwrap();
        while certificate.advance().unwrap().is_none() {}
        assert!(certificate.lower() <= exact * (1.0 + 1e-9), "{seed}: {} {exact}", certificate.lower());
        assert_eq!(certificate.end(), Some(CertificateEnd::Reached), "{seed}");
        widest = widest.max(certificate.width());
    }
    assert!(widest > 0.0);
}

#[test]
fn formulas_are_bounded_as_well_as_densities_with_known_derivatives() {
    for mut case in exact_paths() {
        let formula = match case.name {
            "1/r²" => "1/(x^2 + y^2)",
            "e^x" => "exp(x)",
            _ => continue,
        };
        let before = certified(&case, 0.01).nodes();
        let formula = CostFormula::parse(formula).unwrap();
        case.density = Arc::new(FormulaCost { formula, risk: RiskField::default() });
        let certificate = certified(&case, 0.01);
        assert_eq!(certificate.end(), Some(CertificateEnd::Reached), "{}", case.name);
        let nodes = certificate.nodes();
        assert!(nodes <= before + before / 2, "{}: {nodes} nodes, {before} before", case.name);
    }
}

#[test]
fn cells_of_constant_cost_are_bounded_from_below() {
    for seed in seeds(3) {
        let cells = Cells::random(8, seed);
        // Paths over points on the lines between cells: an upper bound.
        let (start, goal) = (dvec2(0.1, 0.2), dvec2(0.87, 0.81));
        let (path, upper) = cells.best_path(start, goal, 12);
        let task = CertificateTask::in_rectangle(Rect::UNIT, Arc::new(cells), path, upper, 0.02).unwrap();
        let mut certificate = Certificate::new(task).unwrap();
        while certificate.advance().unwrap().is_none() {}
        assert!(certificate.lower() <= upper && certificate.width() < 0.05, "{seed} {}", certificate.width());
    }
}

#[test]
fn bad_input_is_refused_and_stopping_keeps_the_work() {
    let one = exact_paths().remove(0);
    let task = |path: Vec<DVec2>, upper| {
        CertificateTask::in_rectangle(square(), Arc::clone(&one.density), path, upper, 1e-3).unwrap()
    };
    let refused = |path, upper| Certificate::new(task(path, upper)).err();
    let (a, b) = (dvec2(-1.0, 0.0), dvec2(1.0, 0.5));
    assert_eq!(refused(vec![a], 1.0), Some(PathError::TooFewPlaces));
    assert!(matches!(refused(vec![a, dvec2(3.0, 0.0)], 4.0), Some(PathError::BeyondOutline { .. })));
    assert!(matches!(refused(vec![a, dvec2(f64::NAN, 0.0)], 4.0), Some(PathError::NotAPlace { .. })));
    assert!(matches!(refused(vec![a, b], f64::NAN), Some(PathError::InvalidCost { .. })));
    let same = Certificate::new(task(vec![a, a], 0.0)).unwrap();
    assert_eq!((same.end(), same.lower(), same.width()), (Some(CertificateEnd::Reached), 0.0, 0.0));

    // A detour is known at first, and the bound shows that it is one.
    let detour = vec![a, dvec2(0.0, 1.0), b];
    let cost = |path: &[DVec2]| path.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    let mut certificate = Certificate::new(task(detour.clone(), cost(&detour))).unwrap();
    let stop = certificate.stop_signal();
    stop.store(true, std::sync::atomic::Ordering::Relaxed);
    assert_eq!(certificate.advance(), Ok(None));
    assert_eq!(certificate.programs(), 0);
    stop.store(false, std::sync::atomic::Ordering::Relaxed);
    while certificate.advance().unwrap().is_none() {}
    assert_eq!(certificate.end(), Some(CertificateEnd::UpperBoundLimits));
    certificate.improve(vec![a, b], cost(&[a, b]));
    assert_eq!(certificate.end(), Some(CertificateEnd::Reached));
    let programs = certificate.programs();
    assert_eq!(certificate.advance(), Ok(Some(CertificateEnd::Reached)));
    assert_eq!(certificate.programs(), programs, "nothing is left to do");
}

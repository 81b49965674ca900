//! Paths between threats: the best of several valleys is found, however coarse the mesh is.
//!
//! `MESHBRUSH_TABLE=1` prints the figures of each set of threats.

use std::sync::Arc;

use crate::many_directions::directions;
use crate::runs::{prints_table, seeds};
use glam::{DVec2, dvec2};
use meshbrush_core::layers::{Layer, PaintLayers, RiskField, Threat, ThreatLaw, Threats};
use meshbrush_core::path::{
    CertificateTask, CostDensity, PathCertificate, PathFigures, PathMesh, PathRequest, Planner, Solution,
    WeightedCost, Weights,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

const BOUNDS: Rect = Rect::new(DVec2::ZERO, DVec2::splat(100.0));

fn random_cost(random: &mut fastrand::Rng) -> WeightedCost {
    let threat = |random: &mut fastrand::Rng| Threat {
        at: 100.0 * dvec2(random.f64(), random.f64()),
        range: 10.0 + 20.0 * random.f64(),
        peak: 0.4 + 0.6 * random.f64(),
        law: ThreatLaw::ALL[random.usize(..3)].0,
    };
    let threats = Threats::new((0..random.usize(5..12)).map(|_| threat(random)).collect()).unwrap();
    let risk = RiskField::new(&Layer::stack([threats]), PaintLayers::blank());
    WeightedCost::new(Weights { length: 1.0, risk: 10.0 }, risk).unwrap()
}

/// Returns a mesh of triangles of about the given diameter.
fn mesh(diameter: f64) -> PathMesh {
    let lattice = Lattice::covering(BOUNDS, diameter / 2f64.sqrt(), 100_000).unwrap();
    PathMesh::new(Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap().view())
}

fn certified(planner: &Planner, solution: &Solution, cost: &WeightedCost, width: f64) -> PathCertificate {
    let (cost, path) = (Arc::new(cost.clone()), solution.points.clone());
    let task = CertificateTask::in_rectangle(BOUNDS, cost, path, solution.upper, width).unwrap();
    let certificate = PathCertificate::new(solution, &task).unwrap();
    let mut certificate = certificate.with_search(Arc::clone(planner.mesh()));
    while certificate.advance().unwrap().is_none() {}
    certificate
}

#[test]
fn no_search_in_many_directions_finds_a_better_valley_on_a_coarse_mesh() {
    let ends = [dvec2(5.0, 10.0), dvec2(95.0, 85.0)];
    // In the first of them, marches prefer the more expensive of two valleys by 2 %.
    for seed in [913].into_iter().chain(seeds(20)) {
        let mut random = fastrand::Rng::with_seed(seed);
        let cost = random_cost(&mut random);
        let found = directions(&|p| cost.at(p), BOUNDS, ends, 60, 4);
        for diameter in [15.0, 5.0] {
            let mut planner = Planner::new(mesh(diameter), &cost).unwrap();
            let solution = planner.solve(&cost, &ends, PathRequest::FULL).unwrap();
            if prints_table() {
                let (excess, nodes) = (solution.cost / found - 1.0, planner.mesh().node_count());
                eprintln!(
                    "{seed} {diameter}: {found:.3} {excess:+.4} {nodes} nodes, gap {:.3}",
                    solution.gap()
                );
            }
            assert!(solution.lower <= found, "{seed} {diameter}: {found} {}", solution.lower);
            // Marches are exact to first order: of two valleys that cost nearly the same, they may take the
            // wrong one. The certificate then takes the other.
            let mut cost_of_path = solution.cost;
            assert!(cost_of_path <= found * 1.015, "{seed} {diameter}: {found} {cost_of_path}");
            if cost_of_path > found * 1.005 {
                cost_of_path = certified(&planner, &solution, &cost, 0.005).solution().cost;
            }
            assert!(cost_of_path <= found * 1.005, "{seed} {diameter}: {found} {cost_of_path}");
        }
    }
}

#[test]
fn a_certificate_finds_the_better_valley_of_a_path_that_it_cannot_prove() {
    let ends = [dvec2(5.0, 10.0), dvec2(95.0, 85.0)];
    for seed in seeds(2) {
        let mut random = fastrand::Rng::with_seed(seed);
        let cost = random_cost(&mut random);
        let mut planner = Planner::new(mesh(10.0), &cost).unwrap();
        // By way of a corner: another valley.
        let via = [ends[0], dvec2(95.0, 5.0), ends[1]];
        let detour = planner.solve(&cost, &via, PathRequest::FULL).unwrap();
        let best = planner.solve(&cost, &ends, PathRequest::FULL).unwrap();
        let mut known = detour;
        (known.stops, known.lower) = (vec![0, known.points.len() - 1], 0.0);
        let certificate = certified(&planner, &known, &cost, 0.02);
        let proved = certificate.solution();
        let message = format!("{seed}: {} {} {:?}", proved.cost, best.cost, certificate.end());
        assert!(known.gap() > 0.02 && certificate.width() <= 0.02, "{message}");
        assert!(proved.cost <= 1.02 * best.cost && proved.upper >= certificate.lower(), "{message}");
        let [proof] = &certificate.proofs()[..] else { panic!("one leg") };
        assert!(proof.path == proved.points && proof.upper == proved.upper, "{message}");
        let figures = PathFigures::new(&proved.points, &cost, 1e-4);
        assert!((figures.cost - proved.cost).abs() < 1e-3 * proved.cost, "{message}");
    }
}

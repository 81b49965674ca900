//! Paths, their bounds and certificates are the same for any number of threads, bit for bit.
//!
//! `MESHBRUSH_LONG=50` tries 50 times as many documents, and `MESHBRUSH_SEED=17` begins with the 17th.

use std::sync::Arc;

use crate::operations::{LayerEdit, Operation, Scale};
use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{
    CertificateTask, PathCertificate, PathMesh, PathRequest, PathSearch, Planner, Solution, WeightedCost,
    Weights,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

const SCALE: Scale = Scale { diameter: 0.05, smallest: 0.02, triangles: 1000 };
const EDITS: usize = 6;

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn cost(document: &Document) -> WeightedCost {
    let risk = RiskField::new(&document.settings().layers, document.paint()).within(&Rect::UNIT);
    WeightedCost::new(Weights { length: 1.0, risk: 8.0 }, risk).unwrap()
}

fn mesh() -> Arc<PathMesh> {
    let lattice = Lattice::covering(Rect::UNIT, 0.05, 10_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| element.triangle.level() < 2).unwrap();
    Arc::new(PathMesh::new(mesh.view()))
}

/// All numbers of a path, as bits.
fn bits(solution: &Solution) -> Vec<u64> {
    let figures = [solution.cost, solution.lower, solution.upper, solution.length, solution.risk];
    let points = solution.points.iter().flat_map(|point| [point.x, point.y]);
    figures.into_iter().chain(points).map(f64::to_bits).collect()
}

/// Returns the bits of what is found in a document that is edited at random.
fn found(seed: u64) -> Vec<Vec<u64>> {
    let mut random = fastrand::Rng::with_seed(2900 + seed);
    let mut document = Document::new(Settings::default(), None).unwrap();
    let mesh = mesh();
    let mut planner = Planner::new(mesh, &cost(&document)).unwrap();
    let mut all = Vec::new();
    for edit in 0..EDITS {
        let operation = match random.u32(..3) {
            0 => Operation::Layers(LayerEdit::choose(&mut random, SCALE)),
            _ => Operation::stroke(&mut random, SCALE),
        };
        operation.apply(&mut document);
        let density = cost(&document);
        let is_live = random.bool();
        match is_live {
            true => planner.follow(&density, &[Rect::UNIT]).unwrap(),
            false => planner.update(&density, &[Rect::UNIT]).unwrap(),
        }
        let places: Vec<DVec2> = (0..random.usize(2..5)).map(|_| dvec2(random.f64(), random.f64())).collect();
        let request = if is_live { PathRequest::LIVE } else { PathRequest::FULL };
        let mut in_steps = planner.clone();
        let mut search = PathSearch::new(&in_steps, &places, request).unwrap();
        let mut sizes = fastrand::Rng::with_seed(seed);
        let mut step = || search.advance(&mut in_steps, &density, sizes.usize(..300)).unwrap();
        let in_steps = (0..).find_map(|_| step()).unwrap();
        let solution = planner.solve(&density, &places, request).unwrap();
        assert_eq!(bits(&in_steps), bits(&solution), "{seed}");
        all.push(bits(&solution));
        if edit + 1 == EDITS && solution.upper > 0.0 {
            let task = CertificateTask::in_rectangle(
                Rect::UNIT,
                Arc::new(density),
                solution.points.clone(),
                solution.upper,
                0.02,
            );
            let task = CertificateTask { most_nodes: 600, ..task.unwrap() };
            let mut certificate = PathCertificate::new(&solution, &task).unwrap();
            while certificate.programs() < 3 && certificate.advance().unwrap().is_none() {}
            all.push(bits(&certificate.solution()));
        }
    }
    all
}

#[test]
fn paths_and_proofs_are_the_same_for_any_number_of_threads() {
    for seed in seeds(2) {
        let alone = on_threads(1, || found(seed));
        for threads in [2, 3, 8] {
            assert_eq!(on_threads(threads, || found(seed)), alone, "{seed}: {threads} threads");
        }
    }
}

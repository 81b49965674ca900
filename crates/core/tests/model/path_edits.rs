//! A planner that follows edits finds the paths of a new one, whatever layer was edited.
//!
//! `MESHBRUSH_LONG=50` tries 50 times as many documents, and `MESHBRUSH_SEED=17` begins with the 17th.

use std::sync::Arc;

use crate::operations::{LayerEdit, Operation, Scale};
use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{PathMesh, PathRequest, Planner, WeightedCost, Weights};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

const SCALE: Scale = Scale { diameter: 0.05, smallest: 0.02, triangles: 1000 };
const EDITS_OF_A_DOCUMENT: usize = 25;

fn risk(document: &Document) -> RiskField {
    RiskField::new(&document.settings().layers, document.paint())
}

fn cost(risk: RiskField) -> WeightedCost {
    WeightedCost::new(Weights { length: 1.0, risk: 8.0 }, risk).unwrap()
}

fn mesh() -> Arc<PathMesh> {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 10_000).unwrap();
    let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    Arc::new(PathMesh::new(mesh.view()))
}

/// An edit of layers or of paint, or a step of the history.
fn operation(random: &mut fastrand::Rng) -> Operation {
    match random.u32(..10) {
        0..3 => Operation::stroke(random, SCALE),
        3 => Operation::Undo,
        4 => Operation::Redo,
        _ => Operation::Layers(LayerEdit::choose(random, SCALE)),
    }
}

#[test]
fn a_planner_follows_edits_of_every_kind_of_layer_as_a_new_one_does() {
    let (mesh, request) = (mesh(), PathRequest::FULL);
    let (mut within, mut changed) = (0, 0);
    for seed in seeds(16) {
        let mut random = fastrand::Rng::with_seed(2800 + seed);
        let mut document = Document::new(Settings::default(), None).unwrap();
        let mut known = risk(&document);
        let mut planner = Planner::new(Arc::clone(&mesh), &cost(known.clone())).unwrap();
        for edit in 0..EDITS_OF_A_DOCUMENT {
            // Several edits between two paths now and then.
            let mut message = format!("{seed} {edit}:");
            for _ in 0..random.usize(1..4) {
                let operation = operation(&mut random);
                message += &format!(" {operation:.0?}");
                operation.apply(&mut document);
            }
            let new = risk(&document);
            let areas = new.areas_that_differ(&known);
            within += usize::from(areas.is_some());
            let holds = |point: DVec2| areas.iter().flatten().any(|area| area.contains(point));
            for _ in 0..200 {
                let point = dvec2(random.f64(), random.f64());
                if new.at(point) != known.at(point) {
                    changed += 1;
                    assert!(areas.is_none() || holds(point), "{point} {areas:?} {message}");
                }
            }
            let density = cost(new.clone());
            planner.update(&density, &areas.unwrap_or_else(|| vec![Rect::UNIT])).unwrap();
            let places = [(); 2].map(|()| dvec2(random.f64(), random.f64()));
            let followed = planner.solve(&density, &places, request).unwrap();
            let mut fresh = Planner::new(Arc::clone(&mesh), &density).unwrap();
            assert_eq!(planner.costs().least, fresh.costs().least, "{message}");
            assert_eq!(planner.costs().mean, fresh.costs().mean, "{message}");
            assert_eq!(followed, fresh.solve(&density, &places, request).unwrap(), "{message}");
            known = new;
        }
    }
    assert!(within > 60 && changed > 300, "{within} {changed}");
}

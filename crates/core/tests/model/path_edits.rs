//! A planner that follows edits finds the paths of a new one, whatever layer was edited.
//!
//! `MESHBRUSH_LONG=50` tries 50 times as many documents, and `MESHBRUSH_SEED=17` begins with the 17th.

use std::sync::Arc;

use crate::operations::{LayerEdit, Operation, Scale};
use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{Layer, LayerKind, Mask, Quantity, RiskField, Threat, ThreatLaw, Threats};
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_core::path::{PathArea, PathMesh, PathRequest, Planner, WeightedCost, Weights};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

/// Strokes paint risk where no diameter is much smaller than that of the domain.
const SCALE: Scale = Scale { diameter: 0.05, smallest: 0.05, triangles: 1000 };
const EDITS_OF_A_DOCUMENT: usize = 15;
/// Quick paths, with bounds: both planners do the same for better ones.
const REQUEST: PathRequest = PathRequest { has_bounds: true, ..PathRequest::LIVE };

fn risk(document: &Document) -> RiskField {
    RiskField::new(&document.settings().layers, document.paint())
}

fn cost(risk: RiskField) -> WeightedCost {
    WeightedCost::new(Weights { length: 1.0, risk: 1.5 }, risk).unwrap()
}

fn mesh() -> Arc<PathMesh> {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 10_000).unwrap();
    let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    Arc::new(PathMesh::new(mesh.view()))
}

/// Returns a document with risk of all kinds: painted, of threats and of a formula.
fn document(random: &mut fastrand::Rng) -> Document {
    let mut threat = |_| Threat {
        at: dvec2(random.f64(), random.f64()),
        range: 0.2 + 0.2 * random.f64(),
        peak: 0.5 * random.f64(),
        law: ThreatLaw::ALL[random.usize(..3)].0,
    };
    let threats = Threats::new((0..3).map(&mut threat).collect()).unwrap();
    let formula = Formula::parse("0.3*gauss(hypot(x - 0.6, y - 0.3), 0.2)").unwrap();
    let layers = Layer::stack([
        LayerKind::constant(0.2),
        LayerKind::risk(formula),
        LayerKind::Threats(threats),
        LayerKind::paint(Quantity::Risk),
    ]);
    Document::new(Settings { layers, ..Settings::default() }, None).unwrap()
}

/// An edit of layers or of paint, or a step of the history.
fn operation(random: &mut fastrand::Rng) -> Operation {
    match random.u32(..10) {
        0..5 => {
            let medium = if random.u32(..4) == 0 { Medium::Eraser } else { Medium::Risk(0.7 * random.f64()) };
            let brush = Brush { medium, radius: 0.03 + 0.1 * random.f64(), hardness: 0.2, strength: 0.9 };
            let at = dvec2(random.f64(), random.f64());
            Operation::Stroke(brush, vec![at, at + 0.1 * dvec2(random.f64(), random.f64())])
        }
        5 => Operation::stroke(random, SCALE),
        6 => Operation::Undo,
        7 => Operation::Redo,
        _ => Operation::Layers(LayerEdit::choose(random, SCALE)),
    }
}

#[test]
fn a_planner_follows_edits_of_every_kind_of_layer_as_a_new_one_does() {
    let mesh = mesh();
    let (mut within, mut changed, mut followed_marches) = (0, 0, 0);
    for seed in seeds(4) {
        let mut random = fastrand::Rng::with_seed(2800 + seed);
        let mut document = document(&mut random);
        let mut known = risk(&document);
        let mut planner = Planner::new(Arc::clone(&mesh), &cost(known.clone())).unwrap();
        // The places stay for some edits, so that marches follow, too.
        let mut places = [dvec2(0.1, 0.2), dvec2(0.9, 0.8)];
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
            within += usize::from(areas.as_ref().is_some_and(|areas| !areas.is_empty()));
            let holds = |point: DVec2| areas.iter().flatten().any(|area| area.contains(point));
            for _ in 0..200 {
                let point = dvec2(random.f64(), random.f64());
                if new.at(point) != known.at(point) {
                    changed += 1;
                    assert!(areas.is_none() || holds(point), "{point} {areas:?} {message}");
                }
            }
            let density = cost(new.clone());
            let several = areas.as_ref().is_some_and(|areas| areas.len() > 1);
            planner.update(&density, &areas.unwrap_or_else(|| vec![Rect::UNIT])).unwrap();
            if random.u32(..4) == 0 {
                places = [(); 2].map(|()| dvec2(random.f64(), random.f64()));
            } else {
                followed_marches += usize::from(several);
            }
            let followed = planner.solve(&density, &places, REQUEST).unwrap();
            let mut fresh = Planner::new(Arc::clone(&mesh), &density).unwrap();
            assert_eq!(planner.costs().least, fresh.costs().least, "{message}");
            assert_eq!(planner.costs().mean, fresh.costs().mean, "{message}");
            assert_eq!(followed, fresh.solve(&density, &places, REQUEST).unwrap(), "{message}");
            known = new;
        }
    }
    assert!(within > 10 && changed > 300 && followed_marches > 5, "{within} {changed} {followed_marches}");
}

/// Returns a mesh that is finer around a place than one before, or another one, as after an undo.
fn next_mesh(random: &mut fastrand::Rng, known: &Mesh) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 10_000).unwrap();
    let mut mesh = match random.u32(..5) {
        0 => Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap(),
        _ => known.clone(),
    };
    let near = dvec2(random.f64(), random.f64());
    let finer = mesh.refine(&Limits::default(), |element| {
        let [a, b, c] = element.world_corners();
        element.diameter() > 0.02 + 2.0 * ((a + b + c) / 3.0).distance(near)
    });
    finer.unwrap();
    mesh
}

#[test]
fn a_planner_goes_over_to_other_meshes_as_a_new_one_does() {
    let mut moved = 0;
    for seed in seeds(4) {
        let mut random = fastrand::Rng::with_seed(2900 + seed);
        let mut document = document(&mut random);
        let mut known = risk(&document);
        let corner = dvec2(0.3 + 0.2 * random.f64(), 0.3 + 0.2 * random.f64());
        let ring = [(0.0, 0.0), (0.17, 0.0), (0.17, 0.17), (0.0, 0.17)].map(|(x, y)| corner + dvec2(x, y));
        let block = Mask::new(&[vec![ring.to_vec()]]).unwrap();
        let area = PathArea::outside_of(&if random.bool() { vec![block] } else { Vec::new() });
        let lattice = Lattice::covering(Rect::UNIT, 0.1, 10_000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let mut planner = Planner::new(PathMesh::in_area(mesh.view(), &area), &cost(known.clone())).unwrap();
        // The places stay for some edits, so that marches go over, too.
        let mut places = [dvec2(0.1, 0.2), dvec2(0.9, 0.8)];
        for edit in 0..EDITS_OF_A_DOCUMENT {
            let operation = operation(&mut random);
            let message = format!("{seed} {edit}: {operation:.0?}");
            operation.apply(&mut document);
            mesh = next_mesh(&mut random, &mesh);
            let new = risk(&document);
            let areas = new.areas_that_differ(&known).unwrap_or_else(|| vec![Rect::UNIT]);
            let density = cost(new.clone());
            let path_mesh = Arc::new(PathMesh::in_area(mesh.view(), &area));
            match random.u32(..4) {
                // Live on the mesh as it was, and then the mesh follows.
                0 => {
                    planner.follow(&density, &areas).unwrap();
                    planner.move_to(Arc::clone(&path_mesh), &density, &[]).unwrap();
                }
                _ => planner.move_to(Arc::clone(&path_mesh), &density, &areas).unwrap(),
            }
            moved += 1;
            let mut fresh = Planner::new(path_mesh, &density).unwrap();
            assert_eq!(planner.costs().least, fresh.costs().least, "{message}");
            assert_eq!(planner.costs().mean, fresh.costs().mean, "{message}");
            if random.u32(..5) == 0 {
                places = [
                    dvec2(0.25 * random.f64(), random.f64()),
                    dvec2(0.75 + 0.25 * random.f64(), random.f64()),
                ];
            }
            let followed = planner.solve(&density, &places, REQUEST);
            assert_eq!(followed, fresh.solve(&density, &places, REQUEST), "{message}");
            known = new;
        }
    }
    assert!(moved >= EDITS_OF_A_DOCUMENT);
}

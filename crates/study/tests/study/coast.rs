//! What follows the refinement on a coast: triangles outside are removed, and nodes move onto the outline.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use fastrand::Rng;
use meshbrush_core::build::{BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{Layer, LayerKind, PaintLayers, SizeFieldSpec};
use meshbrush_core::outline::{DerivationAction, DerivedMesh};
use meshbrush_mesh::geometry::{Lattice, LatticePoint};
use meshbrush_mesh::mesh::{Cleaning, KeptParts, Limits, Mesh, NodeId, Progress};
use meshbrush_study::steps::{StepAction, StepPlayer, StepRecorder};

use crate::random_coast::random_coast;

type Corners = [LatticePoint; 3];

fn sorted(mut corners: Corners) -> Corners {
    corners.sort_by_key(|corner| (corner.x, corner.y));
    corners
}

/// Returns the triangles at a step by the positions of their corners, in ascending order.
fn triangles(player: &StepPlayer) -> Vec<Corners> {
    let mut all: Vec<_> = player.triangles().map(|one| sorted(one.corners(player.nodes()))).collect();
    all.sort_by_key(|corners| corners.map(|corner| (corner.x, corner.y)));
    all
}

/// Returns the mesh that the program shows for a random coast, and the settings that the steps need.
fn built(seed: u64) -> (BuiltMesh, Cleaning) {
    let mut random = Rng::with_seed(seed);
    let domain = Domain::of_polygons(&random_coast(&mut random)).unwrap();
    let spacing = domain.bounds.size().max_element() / 4.0;
    let diameter = 0.2 * spacing;
    let boundary = match seed % 4 {
        0 => BoundaryTreatment::Fitted { diameter },
        3 => BoundaryTreatment::Report,
        _ => BoundaryTreatment::OnOutline { diameter },
    };
    let cleaning = match seed % 3 {
        _ if boundary == BoundaryTreatment::Report => Cleaning::NONE,
        0 => Cleaning::NONE,
        1 => Cleaning::FOR_SOLVERS,
        _ => Cleaning { parts: KeptParts::Share(0.05), keeps_pinches: true, ..Cleaning::NONE },
    };
    let field = SizeFieldSpec {
        layers: Layer::stack([LayerKind::target(Formula::parse(&format!("{spacing:?}")).unwrap())]),
        transfer: Transfer::between(0.01 * spacing, 2.0 * spacing),
        unasked: 2.0 * spacing,
        outline: None,
        gradation: None,
        projection: None,
    };
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, spacing, 1_000_000).unwrap(),
        domain,
        boundary,
        lines: Default::default(),
        field,
        rule: RefinementRule::Area,
        cleaning,
        limits: Limits::default(),
    });
    while builder.advance(None, 100_000).unwrap() == Progress::More {}
    (builder.finish(), cleaning)
}

fn player(built: &BuiltMesh, cleaning: &Cleaning) -> StepPlayer {
    let limits = Limits::default();
    let coarse = Mesh::coarse_grid(built.mesh.lattice(), |node| built.domain.admits(node), &limits).unwrap();
    let mut recorder = StepRecorder::new(coarse, limits, 100_000);
    let mut criterion = built.criterion(None);
    while recorder.advance(|element| criterion.exceeds(element), 1000).unwrap() == Progress::More {}
    StepPlayer::new(Arc::new(recorder.finish_on(
        &built.domain,
        built.edge_targets(PaintLayers::blank()),
        cleaning,
    )))
}

#[test]
fn the_last_step_on_a_coast_is_the_mesh_that_the_program_shows() {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for seed in 0..36 {
        let (built, cleaning) = built(seed);
        let mut player = player(&built, &cleaning);
        player.go_to(usize::MAX);
        let derived =
            DerivedMesh::new(&built.mesh, &built.domain, built.edge_targets(PaintLayers::blank()), &cleaning);
        let extract = derived.extract(&built.mesh);
        let of_cell =
            |corners: [usize; 3]| sorted(corners.map(|node| extract.node(NodeId::from_index(node))));
        let mut shown: Vec<_> = extract.cells().map(|cell| of_cell(cell.corners)).collect();
        shown.sort_by_key(|corners| corners.map(|corner| (corner.x, corner.y)));
        assert!(triangles(&player) == shown, "seed {seed}: {} and {}", triangles(&player).len(), shown.len());
        for stage in player.recording().stages() {
            *seen.entry(format!("{:?}", stage.change.action)).or_default() += 1;
        }
    }
    assert_eq!(seen.len(), 10, "{seen:?}");
}

#[test]
fn each_stage_says_all_that_it_changes_and_what_is_removed_lay_outside() {
    for seed in 0..12 {
        let (built, cleaning) = built(seed);
        let mut player = player(&built, &cleaning);
        let stages = player.recording().stages().to_vec();
        let first = player.len() - stages.len();
        player.go_to(first);
        assert!(stages.is_empty() || player.step().unwrap().action == StepAction::Finish);
        for (number, stage) in stages.iter().enumerate() {
            let (nodes, before) = (player.nodes().to_vec(), counted(&player));
            player.go_to(first + number + 1);
            assert_eq!(player.step().unwrap().action, StepAction::Derive(stage.change));
            let moved = nodes.iter().zip(player.nodes()).filter(|(old, new)| old != new).count();
            assert_eq!(moved, player.moves().count(), "seed {seed}, {:?}", stage.change);
            let after = counted(&player);
            let gone = before.keys().filter(|number| !after.contains_key(number));
            assert_eq!(gone.map(|number| before[number]).sum::<usize>(), stage.removed.len());
            let is_nothing = stage.change.removed + stage.change.changed + stage.change.moved == 0;
            assert!(!is_nothing || before != after, "seed {seed}: {:?}", stage.change);
            if stage.change.action == DerivationAction::RemoveByCorners {
                let region = built.domain.region_on_outline().unwrap();
                assert!(
                    stage.removed.iter().flat_map(|(_, corners)| corners).all(|&node| !region.contains(node))
                );
            }
            let (algorithm, lines) = player.step().unwrap().lines();
            assert!(lines.start > 0 && lines.end <= algorithm.lines().len() + 1, "{algorithm:?}");
            assert!(algorithm.number().is_none() && player.step().unwrap().sentence().ends_with('.'));
        }
        let last = triangles(&player);
        player.go_to(first);
        assert_eq!(player.triangles().count(), player.rows().len());
        player.go_to(usize::MAX);
        assert!(triangles(&player) == last, "there and back");
    }
}

/// Returns the number of pieces of each triangle.
fn counted(player: &StepPlayer) -> HashMap<u32, usize> {
    let mut pieces = HashMap::new();
    player.triangles().for_each(|one| *pieces.entry(one.number).or_default() += 1);
    pieces
}

//! The follower while settings are dragged and while the mesh is held by other work.

use std::sync::Arc;

use glam::dvec2;
use meshbrush::internals::document::{Base, Document, Follower, MeshChange, Setting, Settings, Stage};
use meshbrush::internals::field::Formula;
use meshbrush::internals::mesh::Mesh;
use meshbrush::internals::paint::{Brush, Medium};

/// Work in one slice, as in the window.
const SLICE: usize = 2048;

fn settle(follower: &mut Follower, document: &mut Document) {
    let settled = (0..1_000_000).any(|_| follower.advance(document, SLICE).unwrap() == Stage::InStep);
    assert!(settled, "the follower never gets in step");
}

fn assert_as_from_scratch(follower: &Follower, document: &Document) {
    let from_scratch = Follower::new(&mut document.clone()).unwrap();
    assert_eq!(follower.mesh().fingerprint(), from_scratch.mesh().fingerprint());
}

/// More than a hundred thousand triangles below a wave, few above it.
fn large() -> (Document, Follower) {
    let formula = Formula::parse("if(y < 0.4 + 0.1 * sin(7 * x), 0.004, 0.2)").unwrap();
    let base = Base::Formula(formula);
    let mut document =
        Document::new(Settings { base, resolution: 400, ..Settings::default() }, None).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    assert!(follower.mesh().raw_triangle_count() > 100_000, "{}", follower.mesh().raw_triangle_count());
    (document, follower)
}

fn paint(document: &mut Document) {
    document.begin_stroke(Brush { medium: Medium::Risk(1.0), radius: 0.05, hardness: 1.0, strength: 1.0 });
    document.draw_to(dvec2(0.3, 0.8));
    document.draw_to(dvec2(0.6, 0.8));
    document.end_stroke();
}

/// The arrays of a mesh.
fn arrays(
    mesh: &Mesh,
) -> (Vec<meshbrush::internals::geometry::LatticePoint>, Vec<meshbrush::internals::mesh::Triangle>) {
    (mesh.raw_nodes().to_vec(), mesh.raw_triangles().to_vec())
}

#[test]
fn a_mesh_that_is_held_is_copied_in_slices_and_stays_as_it_was() {
    let (mut document, mut follower) = large();
    let held = follower.shared_mesh();
    let (before, fingerprint) = (arrays(&held), held.fingerprint());
    paint(&mut document);
    let (mut copied, mut slices) = (0, 0);
    loop {
        let stage = follower.advance(&mut document, SLICE).unwrap();
        if let Stage::Copying { triangles } = stage {
            // A small part of the mesh in each slice, while the shown mesh is still the one that is held.
            assert!(triangles - copied <= before.1.len() / 4, "{copied} to {triangles}");
            assert!(std::ptr::eq(follower.mesh(), &*held));
            (copied, slices) = (triangles, slices + 1);
        }
        if stage == Stage::InStep {
            break;
        }
    }
    assert!(slices >= before.1.len() / (8 * SLICE), "copied in {slices} slices");
    assert!(arrays(&held) == before && held.fingerprint() == fingerprint);
    assert_ne!(follower.mesh().fingerprint(), fingerprint);
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn the_copy_is_dropped_when_the_mesh_is_no_longer_held() {
    let (mut document, mut follower) = large();
    let held = follower.shared_mesh();
    let shown = Arc::as_ptr(&held);
    paint(&mut document);
    while !matches!(follower.advance(&mut document, SLICE).unwrap(), Stage::Copying { .. }) {}
    drop(held);
    let stage = follower.advance(&mut document, SLICE).unwrap();
    assert!(matches!(stage, Stage::Refining { .. }), "{stage:?}");
    settle(&mut follower, &mut document);
    assert!(std::ptr::eq(follower.mesh(), shown), "it was updated where it is");
    assert_as_from_scratch(&follower, &document);
}

/// Drags a setting through `moves` values, with a few slices of work after each. Returns how often another
/// mesh was shown.
fn drag(
    document: &mut Document,
    follower: &mut Follower,
    moves: usize,
    slices: usize,
    setting: impl Fn(f64) -> Setting,
) -> usize {
    let mut shown = 0;
    follower.take_change();
    for step in 1..=moves {
        document.set(setting(step as f64 / moves as f64)).unwrap();
        for _ in 0..slices {
            follower.advance(document, SLICE).unwrap();
        }
        shown += usize::from(follower.take_change() == Some(MeshChange::Replaced));
    }
    document.end_gesture();
    shown
}

#[test]
fn the_mesh_moves_while_a_setting_is_dragged_and_ends_as_from_scratch() {
    let (mut document, mut follower) = large();
    // One mesh takes more slices than there are between two moves.
    let settings: [fn(f64) -> Setting; 3] = [
        |t| Setting::TransferShape(1.0 + t),
        |t| Setting::SmallestDiameter(0.0024 + 0.002 * t),
        |t| Setting::Spacing(1.0 / 24.0 + 0.01 * t),
    ];
    for setting in settings {
        let shown = drag(&mut document, &mut follower, 200, 20, setting);
        assert!((5..200).contains(&shown), "{shown} meshes in 200 moves");
        settle(&mut follower, &mut document);
        assert_as_from_scratch(&follower, &document);
    }
}

#[test]
fn a_change_of_spacing_or_transfer_evaluates_no_formula() {
    let (mut document, mut follower) = large();
    assert_eq!(follower.field().evaluations(), 400 * 400);
    for setting in [
        Setting::Spacing(0.05),
        Setting::TransferShape(2.0),
        Setting::SmallestDiameter(0.003),
        Setting::LargestDiameter(0.1),
    ] {
        document.set(setting.clone()).unwrap();
        settle(&mut follower, &mut document);
        assert_eq!(follower.field().evaluations(), 0, "{setting:?}");
        assert_as_from_scratch(&follower, &document);
    }
    let other = Base::Formula(Formula::parse("0.05").unwrap());
    document.set(Setting::Base(other)).unwrap();
    settle(&mut follower, &mut document);
    assert_eq!(follower.field().evaluations(), 400 * 400);
}

#[test]
fn another_document_is_not_kept_waiting_by_a_rebuild() {
    let (mut document, mut follower) = large();
    document.set(Setting::SmallestDiameter(0.0015)).unwrap();
    document.end_gesture();
    for _ in 0..100 {
        follower.advance(&mut document, SLICE).unwrap();
    }
    follower.take_change();
    document.set(Setting::Resolution(300)).unwrap();
    settle(&mut follower, &mut document);
    assert_eq!(follower.settings(), document.settings());
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn a_cancelled_update_is_not_in_step_and_the_next_edit_catches_up() {
    let (mut document, mut follower) = large();
    follower.cancel(&document);
    assert_eq!(follower.stage(), Stage::InStep, "there was nothing to cancel");
    paint(&mut document);
    for _ in 0..3 {
        follower.advance(&mut document, SLICE).unwrap();
    }
    follower.cancel(&document);
    assert_eq!(follower.stage(), Stage::GaveUp(None));
    assert_eq!(follower.advance(&mut document, SLICE), Ok(Stage::GaveUp(None)));
    assert!(!follower.is_in_step(&document));
    document.undo();
    settle(&mut follower, &mut document);
    assert_as_from_scratch(&follower, &document);
}

//! The follower while settings are dragged and while the mesh is held by other work.

use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, MeshChange, Setting, Settings, Stage};
use meshbrush_core::domain::{Domain, OutlineOnEarth, corners};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    Combine, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, Mask, Quantity, ShapeList, Shapes, Threat,
    ThreatLaw, Threats,
};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Mesh;

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
    let layers = Layer::default_stack(LayerKind::target(formula));
    let mut document = Document::new(Settings { layers, ..Settings::default() }, None).unwrap();
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

/// Returns the arrays of a mesh.
fn arrays(mesh: &Mesh) -> (Vec<meshbrush_mesh::geometry::LatticePoint>, Vec<meshbrush_mesh::mesh::Triangle>) {
    (mesh.raw_nodes().to_vec(), mesh.raw_triangles().to_vec())
}

#[test]
fn the_bare_rectangle_stands_for_the_mesh_of_another_document_until_it_is_made() {
    let (mut document, mut follower) = large();
    let bounds = Rect::new(dvec2(-3.0, 2.0), dvec2(9.0, 5.0));
    let domain = Domain::rectangle(bounds);
    for edits in [false, true] {
        let transfer = Transfer::between(0.002, 0.004);
        let other =
            Settings { domain: domain.clone(), transfer, spacing: 0.5, ..document.settings().clone() };
        let other = Settings { layers: Layer::default_stack(LayerKind::constant(0.2)), ..other };
        document.replace_with(Document::new(other, None).unwrap());
        let revision = follower.revision();
        follower.show_bare(&document);
        assert!(follower.revision() > revision && follower.take_change() == Some(MeshChange::Replaced));
        let (mesh, lattice) = (follower.mesh(), follower.mesh().lattice());
        assert!(mesh.raw_triangle_count() < 20 && lattice.bounds() == bounds, "few cells, whatever h_max is");
        assert!(!follower.is_in_step(&document));
        document.set(Setting::LargestDiameter(0.3)).unwrap();
        document.set(Setting::SmallestDiameter(0.1)).unwrap();
        if edits {
            follower.advance(&mut document, SLICE).unwrap();
            paint(&mut document);
            document.set(Setting::Gradation(Some(0.3))).unwrap();
        }
        settle(&mut follower, &mut document);
        assert_as_from_scratch(&follower, &document);
    }
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

/// Drags a setting through `moves` values, with a few slices of work after each. Returns after how many moves
/// another mesh was shown, and after how many the shown one changed where it is.
fn drag(
    document: &mut Document,
    follower: &mut Follower,
    moves: usize,
    slices: usize,
    setting: impl Fn(f64) -> Setting,
) -> [usize; 2] {
    let [mut replaced, mut changed] = [0; 2];
    follower.take_change();
    for step in 1..=moves {
        document.set(setting(step as f64 / moves as f64)).unwrap();
        for _ in 0..slices {
            follower.advance(document, SLICE).unwrap();
        }
        match follower.take_change() {
            Some(MeshChange::Replaced) => replaced += 1,
            Some(MeshChange::Within(_)) => changed += 1,
            None => {}
        }
    }
    document.end_gesture();
    [replaced, changed]
}

#[test]
fn the_mesh_moves_while_a_setting_is_dragged_and_ends_as_from_scratch() {
    let (mut document, mut follower) = large();
    // One mesh takes more slices than there are between two moves.
    let spacing = |t| Setting::Spacing(1.0 / 24.0 + 0.01 * t);
    let [replaced, _] = drag(&mut document, &mut follower, 200, 4, spacing);
    assert!((5..200).contains(&replaced), "{replaced} meshes in 200 moves");
    settle(&mut follower, &mut document);
    assert_as_from_scratch(&follower, &document);
    // Other layers and limits are followed where h̄ differs.
    let disc = |t| {
        let text = format!("if(hypot(x - 0.3 - 0.4 * {t}, y - 0.8) < 0.1, 0.006, 0.2)");
        Setting::Layers(Layer::default_stack(LayerKind::target(Formula::parse(&text).unwrap())))
    };
    let smallest = |t| Setting::SmallestDiameter(0.0045 + 0.05 * t);
    let settings: [&dyn Fn(f64) -> Setting; 2] = [&smallest, &disc];
    for setting in settings {
        let [replaced, changed] = drag(&mut document, &mut follower, 200, 20, setting);
        assert!(replaced == 0 && changed >= 5, "{replaced} meshes, {changed} changes in 200 moves");
        settle(&mut follower, &mut document);
        assert_as_from_scratch(&follower, &document);
    }
}

#[test]
fn layers_transfer_and_gradation_change_the_mesh_where_it_is() {
    let (mut document, mut follower) = large();
    paint(&mut document);
    settle(&mut follower, &mut document);
    follower.take_change();
    let with = |document: &Document, edit: fn(&mut Vec<Layer>)| {
        let mut layers = document.settings().layers.clone();
        edit(&mut layers);
        Setting::Layers(layers)
    };
    let target = |text| LayerKind::target(Formula::parse(text).unwrap());
    let edits: [&dyn Fn(&Document) -> Setting; 9] = [
        &|document| with(document, |layers| layers[2].visible = false),
        &|document| with(document, |layers| layers[2].visible = true),
        &|document| with(document, |layers| layers[2].combine = Combine::Replace),
        &|document| with(document, |layers| layers.swap(0, 2)),
        &|document| with(document, |layers| _ = layers.remove(1)),
        &|_| Setting::Layers(Layer::default_stack(target("if(x < 0.5, 0.01, inf)"))),
        &|_| Setting::Gradation(Some(0.7)),
        &|_| Setting::TransferShape(2.0),
        &|_| Setting::SmallestDiameter(0.004),
    ];
    for (number, edit) in edits.iter().enumerate() {
        document.set(edit(&document)).unwrap();
        document.end_gesture();
        settle(&mut follower, &mut document);
        let change = follower.take_change();
        assert!(!matches!(change, Some(MeshChange::Replaced)), "edit {number}");
        assert_eq!(follower.settings(), document.settings());
        assert_as_from_scratch(&follower, &document);
    }
}

#[test]
fn limits_that_change_most_of_a_large_mesh_make_another_one() {
    let formula = Formula::parse("0.0045 + 0.001 * x").unwrap();
    let layers = Layer::default_stack(LayerKind::target(formula));
    let settings = Settings { layers, ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    document.set(Setting::SmallestDiameter(0.003)).unwrap();
    let mut follower = Follower::new(&mut document).unwrap();
    paint(&mut document);
    settle(&mut follower, &mut document);
    let count = follower.mesh().raw_triangle_count();
    assert!(count > 250_000, "{count}");
    follower.take_change();
    for (h_min, is_replaced) in [(0.012, true), (0.003, false), (0.0028, true)] {
        document.set(Setting::SmallestDiameter(h_min)).unwrap();
        document.end_gesture();
        let before = follower.mesh().fingerprint();
        // The shown mesh stays until the other one is complete.
        while follower.advance(&mut document, SLICE).unwrap() != Stage::InStep {
            let is_kept = follower.mesh().raw_triangle_count() == count;
            assert!(!is_replaced || !is_kept || follower.mesh().fingerprint() == before);
        }
        let change = follower.take_change();
        assert_eq!(matches!(change, Some(MeshChange::Replaced)), is_replaced, "{h_min}");
        assert_as_from_scratch(&follower, &document);
    }
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
    document.set(Setting::Bounds(Rect::new(DVec2::ZERO, dvec2(1.0, 0.8)))).unwrap();
    settle(&mut follower, &mut document);
    assert_eq!(follower.settings(), document.settings());
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn a_mesh_that_cannot_be_made_is_an_error_only_while_the_document_asks_for_it() {
    let (mut document, mut follower) = with_layers(Layer::stack([LayerKind::constant(0.1)]));
    document.set(Setting::MaxTriangles(20_000)).unwrap();
    settle(&mut follower, &mut document);
    for (spacing, changes_again) in [(0.3, true), (0.2, false)] {
        document.set(Setting::Spacing(spacing)).unwrap();
        change_layers(&mut document, |layers| layers[0].kind = LayerKind::constant(0.002));
        while !matches!(follower.advance(&mut document, 256).unwrap(), Stage::Refining { .. }) {}
        if changes_again {
            change_layers(&mut document, |layers| layers[0].kind = LayerKind::constant(0.05));
            settle(&mut follower, &mut document);
            assert_as_from_scratch(&follower, &document);
        } else {
            let error = (0..1000).find_map(|_| follower.advance(&mut document, SLICE).err()).unwrap();
            assert!(error.to_string().contains("triangles"), "{error}");
        }
    }
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

/// Returns a document of the unit square with these layers, and its follower.
fn with_layers(layers: Vec<Layer>) -> (Document, Follower) {
    let mut document = Document::new(Settings { layers, ..Settings::default() }, None).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    (document, follower)
}

/// Changes the layers of a document without a slice of the follower.
fn change_layers(document: &mut Document, change: impl FnOnce(&mut Vec<Layer>)) {
    let mut layers = document.settings().layers.clone();
    change(&mut layers);
    document.set(Setting::Layers(layers)).unwrap();
    document.end_gesture();
}

fn square(centre: DVec2, half: f64) -> Vec<DVec2> {
    corners(&Rect::around(centre, half))
}

#[test]
fn an_edited_outline_changes_the_layer_that_measures_the_distance_to_it() {
    for range in [f64::INFINITY, 0.1] {
        let distance =
            LayerKind::Distance(DistanceLayer { to: DistanceTo::Outline, at_zero: 0.01, slope: 0.2, range });
        let (mut document, mut follower) = with_layers(Layer::stack([LayerKind::constant(0.2), distance]));
        let l_shape = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.5, 0.5], [0.5, 1.0], [0.0, 1.0]];
        let l_shape = l_shape.map(DVec2::from).to_vec();
        let domain =
            Domain::of_stored_polygons(vec![vec![l_shape]], Rect::UNIT, &OutlineOnEarth::default()).unwrap();
        document.set(Setting::Domain(domain)).unwrap();
        document.end_gesture();
        follower.take_change();
        settle(&mut follower, &mut document);
        assert!(matches!(follower.take_change(), Some(MeshChange::Within(_))), "it is followed in place");
        assert_as_from_scratch(&follower, &document);
        // Outline and layers between two slices.
        document.undo();
        change_layers(&mut document, |layers| layers[0].kind = LayerKind::constant(0.05));
        settle(&mut follower, &mut document);
        assert!(matches!(follower.take_change(), Some(MeshChange::Within(_))), "both are followed in place");
        assert_as_from_scratch(&follower, &document);
    }
}

#[test]
fn edits_between_two_slices_do_not_hide_each_other() {
    let threat = |x| Threat { at: dvec2(x, 0.5), range: 0.1, peak: 0.9, law: ThreatLaw::Radar };
    let threats = Threats::new(vec![threat(0.2), threat(0.8)]).unwrap();
    let layers = Layer::stack([LayerKind::constant(0.2), LayerKind::Threats(threats.clone())]);
    let (mut document, mut follower) = with_layers(layers);
    document.set(Setting::TransferShape(4.0)).unwrap();
    let mut moved = threats;
    moved.set(0, threat(0.25)).unwrap();
    change_layers(&mut document, |layers| layers[1].kind = LayerKind::Threats(moved));
    settle(&mut follower, &mut document);
    assert_as_from_scratch(&follower, &document);
}

#[test]
fn layers_as_small_as_the_squares_of_functions_leave_nothing_behind() {
    let side = f64::from(1u32 << 15).recip();
    for n in 0..40 {
        let centre = dvec2(0.5 + 0.03 * f64::from(n) * side, 0.4 + 0.07 * f64::from(n) * side);
        let mask = Mask::new(&[vec![square(centre, 0.51 * side + 0.04 * f64::from(n) * side)]]).unwrap();
        let mut layers = Layer::stack([LayerKind::constant(0.2), LayerKind::constant(2e-5)]);
        layers[1].mask = Some(mask);
        let points = ShapeList { points: vec![centre], ..ShapeList::default() };
        let to = DistanceTo::Shapes { name: String::new(), shapes: Shapes::new(points, false).unwrap() };
        let range = 0.1 * f64::from(n) * side + 0.5 * side;
        let distance = LayerKind::Distance(DistanceLayer { to, at_zero: 2e-5, slope: 0.0, range });
        layers.push(Layer::new(LayerId(2), "distance", distance));
        let threat = Threat { at: centre, range, peak: 1.0, law: ThreatLaw::Disc };
        let threats = LayerKind::Threats(Threats::new(vec![threat]).unwrap());
        layers.push(Layer::new(LayerId(3), "threats", threats));
        for shown in 1..4 {
            let mut layers = layers.clone();
            (1..4).for_each(|other| layers[other].visible = other == shown);
            let transfer = Transfer::between(2e-5, 0.2);
            let settings = Settings { layers, transfer, ..Settings::default() };
            let mut document = Document::new(settings, None).unwrap();
            let mut follower = Follower::new(&mut document).unwrap();
            change_layers(&mut document, |layers| layers[shown].visible = false);
            settle(&mut follower, &mut document);
            assert_as_from_scratch(&follower, &document);
        }
    }
}

/// Paint that asks for more is followed by questions about the painted layers, and the floors above them,
/// which change what they ask for; also while the mesh still follows paint on another layer.
#[test]
fn paint_below_a_floor_is_followed_as_the_whole_stack_asks() {
    let mut layers = Layer::stack([
        LayerKind::constant(0.2),
        LayerKind::paint(Quantity::Risk),
        LayerKind::constant(0.03),
        LayerKind::paint(Quantity::Diameter),
    ]);
    layers[2].combine = Combine::Floor;
    layers[2].mask = Some(Mask::new(&[vec![square(dvec2(0.4, 0.5), 0.1)]]).unwrap());
    let risk = Brush { medium: Medium::Risk(1.0), radius: 0.06, hardness: 0.5, strength: 1.0 };
    let diameter = Brush { medium: Medium::Diameter(0.01, DiameterChange::Finer), ..risk };
    for (gradation, brushes) in
        [(None, [diameter, risk]), (Some(0.2), [diameter, risk]), (Some(0.2), [risk, diameter])]
    {
        let (mut document, mut follower) = with_layers(layers.clone());
        document.set(Setting::Gradation(gradation)).unwrap();
        settle(&mut follower, &mut document);
        for brush in brushes {
            document.begin_stroke(brush);
            document.draw_to(dvec2(0.3, 0.5));
            document.draw_to(dvec2(0.6, 0.55));
            document.end_stroke();
            follower.advance(&mut document, 1).unwrap();
        }
        settle(&mut follower, &mut document);
        assert_as_from_scratch(&follower, &document);
        for _ in brushes {
            document.undo();
            follower.advance(&mut document, 1).unwrap();
        }
        settle(&mut follower, &mut document);
        assert_as_from_scratch(&follower, &document);
    }
}

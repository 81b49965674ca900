//! The mesh that is derived along an outline, while the document is edited.

use std::collections::HashSet;

use eframe::egui::{Key, Modifiers};
use fastrand::Rng;
use glam::{DVec2, dvec2};

use super::{Window, key, send, show, wait_until, window};
use crate::app::features::domain::DomainCommand;
use crate::app::features::regions::{RegionCommand, RegionTarget};
use meshbrush_core::document::{Document, DrawnShape, Follower, Settings};
use meshbrush_core::domain::{CutShape, Domain, Line, LineKind};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_kit::kit::command::{BrushCommand, Command, EditCommand, LayerCommand};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Cleaning, NodeId, TriangleId};

type Corners = [[u32; 2]; 3];

fn sorted(mut triangles: Vec<Corners>) -> Vec<Corners> {
    triangles.iter_mut().for_each(|corners| corners.sort_unstable());
    triangles.sort_unstable();
    triangles
}

fn corners(points: [LatticePoint; 3]) -> Corners {
    points.map(|p| [p.x, p.y])
}

/// Returns the triangles that the canvas draws: the mesh without the replaced ones, and the pieces.
fn drawn(window: &Window) -> Vec<Corners> {
    let session = window.state().session();
    let (mesh, pieces) = (session.mesh(), session.derivation().pieces());
    let replaced: HashSet<TriangleId> = pieces.replaced().collect();
    let kept = mesh.triangles().filter(|(id, _)| !replaced.contains(id));
    let mut triangles: Vec<Corners> = kept.map(|(id, _)| corners(mesh.corners(id))).collect();
    let shown = pieces.triangles().iter().filter(|piece| !piece.is_outside());
    triangles.extend(shown.map(|piece| corners(piece.vertices.map(|node| pieces.nodes()[node.index()]))));
    sorted(triangles)
}

/// Returns the derived mesh of a document, from scratch.
fn from_scratch(document: &Document) -> Vec<Corners> {
    let follower = Follower::new(&mut document.clone()).unwrap();
    let cleaning = follower.settings().derived_cleaning();
    let targets = follower.edge_targets(document.paint());
    let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
    let extract = derived.extract(follower.mesh());
    let cells = extract.cells().map(|cell| cell.corners.map(|n| extract.node(NodeId::from_index(n))));
    sorted(cells.map(corners).collect())
}

/// Returns the derived mesh of the mesh as it is, from scratch and with all parts; `None` while the pieces
/// are not kept in step with the mesh, or something is removed from them.
fn whole_from_scratch(window: &Window) -> Option<Vec<Corners>> {
    let session = window.state().session();
    let follower = session.follower();
    session.derivation().shows_whole_coast(follower).then_some(())?;
    let targets = follower.edge_targets(session.document().paint());
    let improves_boundary = follower.settings().derived_cleaning().improves_boundary;
    let cleaning = Cleaning { improves_boundary, ..Cleaning::NONE };
    let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
    let extract = derived.extract(follower.mesh());
    let cells = extract.cells().map(|cell| cell.corners.map(|n| extract.node(NodeId::from_index(n))));
    Some(sorted(cells.map(corners).collect()))
}

fn ring(radius: f64) -> Vec<DVec2> {
    (0..62).map(|k: u32| radius * DVec2::from_angle(f64::from(k) * 0.1)).collect()
}

/// Returns a lake with an island.
fn lake() -> Settings {
    let island = ring(0.3).into_iter().map(|p| p + dvec2(0.2, 0.1)).collect();
    let mut lake =
        Settings::for_domain("lake".into(), Domain::of_polygons(&[vec![ring(1.0), island]]).unwrap());
    lake.transfer = lake.transfer.with_smallest(2.0 * lake.transfer.h_min);
    lake
}

/// Returns the lake with better triangles along its outline, a line across it and one around a place.
fn lake_with_lines() -> Settings {
    let line = |name: &str, points: Vec<DVec2>, closed| Line {
        name: name.into(),
        points,
        closed,
        kind: LineKind::Edges,
    };
    let around = ring(0.2).into_iter().step_by(8).map(|p| p - dvec2(0.4, 0.5)).collect();
    let across = vec![dvec2(-1.1, 0.1), dvec2(0.0, 0.05), dvec2(0.2, 0.6), dvec2(0.5, 1.0)];
    let mut lake = lake();
    lake.lines = vec![line("across", across, false), line("around", around, true)].into();
    lake.cleaning.improves_boundary = true;
    lake
}

/// Draws a stroke on the mask of a layer, on a keep-out region or on shapes.
fn draw_on_a_region(window: &mut Window, path: Vec<DVec2>, random: &mut Rng) {
    let document = window.state().session().document();
    let (layers, painted) = (&document.settings().layers, document.active_layer().unwrap().id);
    let layer = layers[random.usize(..layers.len())].id;
    let target = match random.usize(..3) {
        0 => RegionTarget::KeepOut,
        // Each stroke on another layer than one of shapes adds a layer.
        1 if layers.len() < 5 => RegionTarget::Shapes,
        _ => RegionTarget::Mask,
    };
    let stroke = CutShape::Stroke { path, radius: 0.05 + 0.1 * random.f64() };
    send(window, Command::from(LayerCommand::Select(layer)));
    send(window, Command::from(RegionCommand::Target(target)));
    send(window, Command::from(RegionCommand::Draw(DrawnShape::Area(stroke), random.u32(..3) > 0)));
    send(window, Command::from(EditCommand::EndGesture));
    // The strokes of the brush go on.
    send(window, Command::from(LayerCommand::Select(painted)));
}

#[test]
fn what_is_drawn_is_derived_from_scratch_whenever_the_mesh_is_up_to_date() {
    let mut window = window();
    let (some_retired, compared) = edited(&mut window, lake(), 40);
    assert!(some_retired > 0, "no stroke changed a replaced triangle before the mesh was derived again");
    assert!(compared > 30, "{compared} frames of strokes were compared");
}

#[test]
fn what_is_drawn_with_lines_and_better_triangles_is_derived_from_scratch() {
    let (_, compared) = edited(&mut window(), lake_with_lines(), 30);
    assert!(compared > 20, "{compared} frames of strokes were compared");
}

/// Edits a document, and compares what is drawn. Returns the number of frames of strokes with retired pieces,
/// and of those that were compared.
fn edited(window: &mut Window, settings: Settings, edits: usize) -> (usize, usize) {
    send(window, show(settings));
    let mut random = Rng::with_seed(5);
    let (mut some_retired, mut compared) = (0, 0);
    for _ in 0..edits {
        let mut point = || 2.2 * dvec2(random.f64() - 0.5, random.f64() - 0.5);
        let (a, b) = (point(), point());
        match random.u32(..8) {
            0 => {
                let cut_shape = CutShape::Stroke { path: vec![a], radius: 0.05 + 0.1 * random.f64() };
                send(window, Command::from(DomainCommand::Reshape(cut_shape, random.bool())));
                send(window, Command::from(EditCommand::EndGesture));
            }
            1 => key(window, Modifiers::COMMAND, Key::Z),
            2 | 3 => draw_on_a_region(window, vec![a, b], &mut random),
            _ => {
                window.state_mut().send(Command::from(BrushCommand::BeginStroke(a)));
                for step in 0..=4 {
                    window
                        .state_mut()
                        .send(Command::from(BrushCommand::DrawTo(a.lerp(b, f64::from(step) / 4.0))));
                    window.step();
                    let pieces = window.state().session().derivation().pieces();
                    some_retired += usize::from(pieces.triangles().iter().any(|piece| piece.is_outside()));
                    if let Some(from_scratch) = whole_from_scratch(window) {
                        assert!(drawn(window) == from_scratch, "the coast is not in step in a stroke");
                        compared += 1;
                    }
                }
                window.state_mut().send(Command::from(BrushCommand::EndStroke));
            }
        }
        if random.bool() {
            continue;
        }
        wait_until(window, |window| {
            let session = window.state().session();
            session.derived().is_some() && session.follower().is_in_step(session.document())
        });
        let drawn = drawn(window);
        assert!(drawn == from_scratch(window.state().session().document()));
        let derived = window.state().session().derived().unwrap();
        assert_eq!(derived.level_counts.iter().sum::<usize>(), drawn.len());
    }
    (some_retired, compared)
}

#[test]
fn what_cleaning_removed_stays_removed_in_a_stroke() {
    let pond: Vec<DVec2> = ring(0.2).into_iter().map(|p| p + dvec2(1.5, 0.0)).collect();
    let mut settings =
        Settings::for_domain("lakes".into(), Domain::of_polygons(&[vec![ring(1.0)], vec![pond]]).unwrap());
    settings.transfer = settings.transfer.with_smallest(2.0 * settings.transfer.h_min);
    let mut window = window();
    send(&mut window, show(settings));
    let is_derived = |window: &Window| {
        let session = window.state().session();
        session.derived().is_some() && session.derivation().shows_coast(session.follower())
    };
    wait_until(&mut window, is_derived);
    let lattice = *window.state().session().mesh().lattice();
    let in_pond = |corners: &Corners| {
        corners.iter().all(|&[x, y]| {
            lattice.world_from_lattice(LatticePoint::new(x, y)).distance(dvec2(1.5, 0.0)) < 0.25
        })
    };
    assert!(!drawn(&window).iter().any(in_pond), "the pond is removed");
    let before = drawn(&window).len();
    window.state_mut().send(Command::from(BrushCommand::BeginStroke(dvec2(0.0, -1.0))));
    for step in 0..10 {
        let to = dvec2(0.09 * f64::from(step), -1.0 + 0.02 * f64::from(step));
        window.state_mut().send(Command::from(BrushCommand::DrawTo(to)));
        window.step();
        assert!(window.state().session().derivation().shows_coast(window.state().session().follower()));
        assert!(!drawn(&window).iter().any(in_pond), "the pond is drawn in a stroke");
    }
    assert_ne!(drawn(&window).len(), before, "the stroke changes the mesh");
    window.state_mut().send(Command::from(BrushCommand::EndStroke));
    wait_until(&mut window, is_derived);
    assert!(drawn(&window) == from_scratch(window.state().session().document()));
}

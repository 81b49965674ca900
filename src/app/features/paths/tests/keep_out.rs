//! Regions that paths stay out of: added from files and masks, seen in the panel, undone and saved.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use super::{GOAL, START, shown, wait_for_paths, window_with_path};
use crate::app::features::paths::{KeepOutCommand, PathCommand};
use crate::app::tests::tips::unexplained;
use crate::app::tests::{
    TALL, Window, active, choose, click_button, entries, notice, send, settings, show, type_into, wait_until,
    window_of,
};
use meshbrush_core::document::{KeepOut, PathCost, PathPlan, Settings};
use meshbrush_core::domain::Domain;
use meshbrush_core::layers::Mask;
use meshbrush_core::path::Weights;
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand};

/// A wall between start and goal, open above.
const WALL: [DVec2; 4] = [dvec2(0.45, -0.1), dvec2(0.6, -0.1), dvec2(0.6, 0.95), dvec2(0.45, 0.95)];

fn wall() -> Mask {
    Mask::new(&[vec![WALL.to_vec()]]).unwrap()
}

fn file(name: &str, ring: &[DVec2]) -> PathBuf {
    let file = crate::app::tests::folder("app-keep-out", name).join("wall.geojson");
    let corner = |p: &DVec2| format!("[{}, {}]", p.x, p.y);
    let ring: Vec<_> = ring.iter().chain(ring.first()).map(corner).collect();
    fs::write(&file, format!(r#"{{"type": "Polygon", "coordinates": [[{}]]}}"#, ring.join(", "))).unwrap();
    file
}

/// Returns whether the path that is shown enters the wall, at a thousand places of each of its pieces.
fn enters_wall(window: &Window) -> bool {
    let points = &shown(window)[0].found.as_ref().unwrap().solution.points;
    let wall = wall();
    let pieces = points.windows(2);
    pieces
        .flat_map(|ends| (1..1000).map(|n| ends[0].lerp(ends[1], f64::from(n) / 1000.0)))
        .any(|p| wall.contains(p))
}

/// Whether the path costs as much as before, but for rounding: the mesh of the paths is bisected for the cost
/// that it is made for, and is another one after each change of the regions.
fn assert_is_straight_again(window: &Window, before: f64) {
    let cost = shown(window)[0].found.as_ref().unwrap().solution.cost;
    assert!((cost / before - 1.0).abs() < 1e-12, "{cost} {before}");
}

fn buttons(window: &Window) -> usize {
    window.query_all_by_role_and_label(Role::Button, "Remove keep-out region").count()
}

#[test]
fn a_region_from_a_file_is_avoided_undone_and_removed() {
    let mut window = window_with_path();
    // The shortest path.
    let cost = PathCost::Weighted(Weights { length: 1.0, risk: 0.0 });
    send(&mut window, Command::from(PathCommand::Cost(cost)));
    send(&mut window, Command::from(EditCommand::EndGesture));
    wait_for_paths(&mut window);
    let before = shown(&window)[0].found.as_ref().unwrap().solution.cost;
    assert!(enters_wall(&window));
    let (file, edits) = (file("avoided", &WALL), entries(&window));
    click_button(&mut window, "Add keep-out region…");
    type_into(&mut window, "Path", file.to_str().unwrap());
    wait_until(&mut window, |window| buttons(window) == 1);
    wait_for_paths(&mut window);
    assert_eq!(entries(&window), edits + 1);
    let region = window.get_by_role_and_label(Role::Definition, "Keep out: wall.geojson");
    assert!(region.value().unwrap().starts_with("0.157"), "{:?}", region.value());
    assert_eq!(unexplained(&window), [""; 0]);
    let around = shown(&window)[0].found.as_ref().unwrap().solution.clone();
    assert!(!enters_wall(&window) && around.lower > before, "{} {before}", around.lower);
    send(&mut window, Command::from(EditCommand::Undo));
    wait_for_paths(&mut window);
    assert_is_straight_again(&window, before);
    send(&mut window, Command::from(EditCommand::Redo));
    wait_for_paths(&mut window);
    assert!(!enters_wall(&window));
    click_button(&mut window, "Remove keep-out region");
    wait_for_paths(&mut window);
    assert_eq!(buttons(&window), 0);
    assert_is_straight_again(&window, before);
}

#[test]
fn a_certificate_knows_the_regions() {
    // In a domain of polygons, only a certificate gives a bound.
    let square = vec![vec![dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(1.0, 1.0), dvec2(0.0, 1.0)]];
    let domain = Domain::of_polygons(&[square]).unwrap();
    let keep_out = [KeepOut { name: String::new(), mask: wall() }].into();
    let cost = PathCost::Weighted(Weights { length: 1.0, risk: 0.0 });
    let paths = Arc::new(PathPlan { routes: vec![vec![START, GOAL]], cost, keep_out, ..PathPlan::default() });
    let settings = Settings { paths, ..Settings::for_domain("Wall".into(), domain) };
    let mut window = window_of(TALL);
    send(&mut window, Command::from(PathCommand::Width(0.15)));
    send(&mut window, show(settings));
    wait_for_paths(&mut window);
    let solution = &shown(&window)[0].found.as_ref().unwrap().solution;
    let corners = [START, WALL[3], WALL[2], GOAL];
    let exact: f64 = corners.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
    assert!(solution.lower > START.distance(GOAL) && solution.lower <= exact, "{}", solution.lower);
    assert!(solution.upper >= exact, "{}", solution.upper);
}

#[test]
fn a_region_around_the_start_keeps_the_last_path_and_says_why() {
    let mut window = window_with_path();
    let before = shown(&window)[0].found.as_ref().unwrap().solution.points.clone();
    let around = [dvec2(-0.1, -0.1), dvec2(0.25, -0.1), dvec2(0.25, 0.3), dvec2(-0.1, 0.3)];
    let file = file("start", &around);
    send(&mut window, Command::from(PathCommand::KeepOut(KeepOutCommand::Open(file))));
    wait_until(&mut window, |window| shown(window)[0].problem.is_some());
    assert_eq!(shown(&window)[0].found.as_ref().unwrap().solution.points, before);
    let sentence = window.query_by_label_contains("lies in a keep-out region").unwrap();
    let sentence = sentence.accesskit_node().value().unwrap_or_default();
    assert!(sentence.starts_with("The start ") && sentence.ends_with("outdated."), "{sentence}");
    assert!(settings(&window).paths.routes[0][0].distance(START) < 0.01);
    choose(&mut window, "Tool", "Remove all keep-out regions");
    wait_until(&mut window, |window| shown(window)[0].problem.is_none());
}

#[test]
fn the_mask_of_the_selected_layer_becomes_a_region_once() {
    let mut window = window_with_path();
    let layer = active(&window).id;
    send(&mut window, Command::from(LayerCommand::Mask(layer, Some(wall()))));
    click_button(&mut window, "Use the layer's mask");
    wait_for_paths(&mut window);
    assert!(!enters_wall(&window));
    let name = format!("Keep out: {}", active(&window).name);
    assert!(window.query_by_label(&name).is_some());
    click_button(&mut window, "Use the layer's mask");
    assert_eq!(buttons(&window), 1, "it is a region already");
    send(&mut window, Command::from(LayerCommand::Mask(layer, None)));
    assert_eq!(buttons(&window), 1, "a region does not change with the mask");
}

#[test]
fn a_file_that_is_no_region_is_refused_with_its_name() {
    let mut window = window_with_path();
    let (flat, edits) = (file("flat", &[WALL[0], WALL[1], WALL[0].midpoint(WALL[1])]), entries(&window));
    send(&mut window, Command::from(PathCommand::KeepOut(KeepOutCommand::Open(flat))));
    wait_until(&mut window, |window| notice(window).contains("wall.geojson"));
    assert_eq!((buttons(&window), entries(&window)), (0, edits));
}

//! Jobs done by the pointer at 1440 × 900: no control must be scrolled to, and the clicks are counted.
//! With one column of sections at the right, the same jobs took 64 clicks and 20 scrolls; now they take 65
//! and none. `MESHBRUSH_SCREENS=/tmp/screens` leaves a picture of each there.

mod hands;

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{click, folder, key, level_at, send, settings, stroke, wait_for_jobs, wait_until};
use hands::Hands;
use meshbrush_core::layers::{Depths, RasterLayer};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, ViewCommand};

/// A grid over the unit square.
const DEPTHS: &str = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\nNODATA_value -9999\n\
                      0.1 0.05\n0.02 0.01\n";

#[test]
fn a_harbour_is_painted_and_refined_at_a_thousandfold_zoom() {
    let mut hands = Hands::new();
    let harbour = dvec2(0.9, 0.5);
    hands.menu("File", "New… Ctrl+N");
    hands.press_in_list("Rectangle");
    send(&mut hands.window, Command::from(ViewCommand::LookAt(harbour)));
    send(&mut hands.window, Command::from(ViewCommand::Zoom(1000.0)));
    hands.press(Role::RadioButton, "Diameter");
    hands.press(Role::RadioButton, "Set");
    hands.enter("Radius value", "0.0002");
    hands.enter("h_min value", "0.00005");
    hands.enter("Diameter value", "0.0001");
    hands.act(|window| stroke(window, harbour, harbour + dvec2(0.0001, 0.0)));
    let level = level_at(&hands.window, harbour);
    assert!(level > 15, "{level}");
    hands.tool("Eraser");
    hands.act(|window| click(window, harbour, Modifiers::NONE));
    hands.tab(Tab::Mesh);
    hands.read(Role::Button, "Levels");
    hands.open("Statistics");
    wait_for_jobs(&mut hands.window);
    hands.read(Role::Button, "Shortest edge");
    hands.took(13);
}

#[test]
fn a_coast_gets_a_gradation_and_a_named_open_boundary() {
    let mut hands = Hands::new();
    hands.menu("Examples", "Aegean Sea");
    hands.press(Role::CheckBox, "Limit gradation");
    hands.enter("Gradation g value", "0.3");
    hands.tool("Domain");
    hands.enter("At outline value", "0.1");
    hands.tool("Boundary");
    wait_until(&mut hands.window, |window| window.state().session().boundary_pieces().is_some());
    let pieces = hands.window.state().session().boundary_pieces().unwrap();
    let open = pieces.list().iter().find(|piece| piece.name == "open south").unwrap().middle();
    hands.act(|window| click(window, open, Modifiers::NONE));
    hands.enter("Name", "Libyan Sea");
    let named = hands.window.state().session().boundary_pieces().unwrap();
    assert!(named.list().iter().any(|piece| piece.name == "Libyan Sea"));
    wait_until(&mut hands.window, |window| window.state().session().derived().is_some());
    hands.tab(Tab::Mesh);
    hands.open("Fit to outline");
    hands.read(Role::Definition, "Misclassified");
    hands.took(11);
}

#[test]
fn a_depth_model_becomes_the_size_of_triangles() {
    let file = folder("six-jobs", "depths").join("depths.asc");
    fs::write(&file, DEPTHS).unwrap();
    let mut hands = Hands::new();
    hands.add_layer("grid, as target diameter…");
    key(&mut hands.window, Modifiers::COMMAND, Key::A);
    hands.window.event(Event::Text(file.to_str().unwrap().to_owned()));
    hands.window.run();
    key(&mut hands.window, Modifiers::NONE, Key::Enter);
    wait_until(&mut hands.window, |window| {
        settings(window).layers.iter().any(|layer| layer.kind.is::<RasterLayer>())
    });
    hands.press(Role::RadioButton, "Curve");
    hands.enter("h_min value", "0.008");
    hands.tab(Tab::Domain);
    hands.choose("Unit", "Kilometres (km)");
    hands.overlay("Target");
    hands.tab(Tab::Mesh);
    hands.read(Role::Button, "Levels");
    hands.open("Statistics");
    wait_for_jobs(&mut hands.window);
    hands.read(Role::Button, "Shortest edge");
    hands.took(11);
}

#[test]
fn threats_are_placed_and_a_path_leads_between_them() {
    let mut hands = Hands::new();
    hands.press(Role::Button, "Add layer");
    hands.press_in_list("threats");
    hands.act(|window| click(window, dvec2(0.5, 0.8), Modifiers::NONE));
    hands.enter("Range value", "0.2");
    hands.enter("Peak value", "0.9");
    hands.press(Role::RadioButton, "Disc");
    hands.act(|window| click(window, dvec2(0.55, 0.2), Modifiers::NONE));
    hands.tool("Path");
    hands.act(|window| click(window, dvec2(0.05, 0.05), Modifiers::NONE));
    hands.act(|window| click(window, dvec2(0.95, 0.95), Modifiers::NONE));
    wait_for_jobs(&mut hands.window);
    hands.enter("Caution value", "20");
    hands.choose("Prove within", "5 %");
    hands.press(Role::CheckBox, "Corridor");
    wait_for_jobs(&mut hands.window);
    hands.read(Role::Definition, "Proved");
    hands.overlay("Risk");
    hands.took(16);
}

#[test]
fn a_lecture_goes_through_figure_3() {
    let mut hands = Hands::new();
    hands.menu("Method", "The report, Figure 3: the halves of a triangle");
    wait_until(&mut hands.window, |window| window.query_by_label("Changed rows").is_some());
    for _ in 0..3 {
        hands.press(Role::Button, "Next step");
    }
    hands.read(Role::Button, "Changed rows");
    hands.press(Role::Button, "Leave the steps");
    hands.read(Role::Button, "Close the figure");
    hands.menu("Method", "Plot closure cost");
    wait_for_jobs(&mut hands.window);
    hands.read(Role::Button, "Export plot…");
    hands.took(8);
}

#[test]
fn a_point_is_inspected_and_pinned() {
    let mut hands = Hands::new();
    hands.tool("Query");
    hands.act(|window| click(window, dvec2(0.7431, 0.0208), Modifiers::NONE));
    hands.press(Role::RadioButton, "Risk");
    hands.read(Role::Definition, "Interpolated");
    hands.press(Role::Button, "Pin");
    hands.read(Role::ListItem, "Pin 1");
    hands.press(Role::Button, "Copy table");
    hands.press(Role::Button, "Parent");
    hands.took(6);
}

/// Types a path into the question for a file, and waits until `is_done`.
fn give_file(hands: &mut Hands, file: &std::path::Path, is_done: impl Fn(&super::Window) -> bool) {
    key(&mut hands.window, Modifiers::COMMAND, Key::A);
    hands.window.event(Event::Text(file.to_str().unwrap().to_owned()));
    hands.window.run();
    key(&mut hands.window, Modifiers::NONE, Key::Enter);
    wait_until(&mut hands.window, is_done);
}

#[test]
fn a_coast_becomes_a_file_for_a_solver_from_nothing() {
    let assets = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let file = folder("six-jobs", "solver").join("sea.14");
    let asks = |window: &super::Window| window.query_by_label("What is the file to be?").is_some();
    let mut hands = Hands::new();
    hands.menu("File", "Open… Ctrl+O");
    give_file(&mut hands, &assets.join("celtic_sea.geojson"), asks);
    hands.press_in_list("Open");
    wait_until(&mut hands.window, |window| settings(window).domain.projection.is_some());
    hands.menu("File", "Add data… Ctrl+Shift+D");
    give_file(&mut hands, &assets.join("celtic_sea_depths.tif"), asks);
    hands.act(|window| window.get_by_role_and_label(Role::RadioButton, "Depth of water").click());
    hands.press_in_list("Add");
    wait_until(&mut hands.window, |window| {
        settings(window).layers.iter().any(|layer| layer.kind.is::<Depths>())
    });
    hands.enter("h_min value", "4000");
    hands.enter("h_max value", "40000");
    hands.press(Role::CheckBox, "Limit gradation");
    wait_until(&mut hands.window, |window| window.state().session().derived().is_some());
    hands.menu("File", "Export mesh… Ctrl+E");
    give_file(&mut hands, &file, |window| !window.state().background.rows(true).is_empty());
    wait_until(&mut hands.window, |window| window.state().background.rows(true).is_empty());
    let written = fs::read_to_string(&file).unwrap();
    let open = written.lines().find(|line| line.contains("open boundaries")).unwrap();
    assert!(!open.starts_with('0'), "{open}");
    hands.took(12);
}

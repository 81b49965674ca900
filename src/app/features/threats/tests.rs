//! Threats placed, dragged, typed, deleted, and kept in tables.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use crate::app::features::inspection::QUERY;
use crate::app::features::painting::BRUSH;
use crate::app::features::threats::{THREATS, ThreatsCommand};
use crate::app::tests::{
    FREE, TALL, Window, click, document, entries, fingerprint, folder, key, level_at, move_to, notice, press,
    release, send, stroke, triangles, type_into, value_of, wait_for_notice, wait_until, window_of,
};
use meshbrush_core::layers::{LayerId, Threat, ThreatLaw, Threats};
use meshbrush_kit::kit::command::{Command, LayerCommand};

/// Returns a window with a new, empty layer of threats, added by the menu of the panel.
fn window_with_threats() -> Window {
    let mut window = window_of(TALL);
    for name in ["Add layer", "threats"] {
        click_button(&mut window, name);
    }
    assert_eq!((window.state().tools().tool, entries(&window)), (&THREATS, 1));
    window
}

fn click_button(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::Button, name).click();
    window.run();
}

fn threats(window: &Window) -> Vec<Threat> {
    let layer = document(window).active_layer().expect("a selected layer");
    let Some(threats) = layer.kind.get::<Threats>() else { panic!("{} is selected", layer.name) };
    threats.list().to_vec()
}

fn is_near(a: DVec2, b: DVec2) -> bool {
    a.distance(b) < 2e-3
}

#[test]
fn the_laws_are_told_as_formulas() {
    let mut window = window_with_threats();
    click(&mut window, FREE, Modifiers::NONE);
    for (law, formula) in
        [("Radar", "((R/r)⁴ − 1) / 15"), ("Gaussian", "e^(−4.5 (r/R)²)"), ("Disc", "t² (3 − 2t)")]
    {
        let choice = window.get_by_role_and_label(Role::RadioButton, law);
        let help = choice.accesskit_node().description().unwrap_or_default();
        assert!(help.contains(formula), "{law}: {help}");
    }
}

#[test]
fn a_click_places_a_threat_and_the_mesh_follows() {
    let mut window = window_with_threats();
    let (before, empty) = (triangles(&window), fingerprint(&window));
    let coarse = level_at(&window, FREE);
    click(&mut window, FREE, Modifiers::NONE);
    assert!(threats(&window).len() == 1 && is_near(threats(&window)[0].at, FREE));
    assert!(triangles(&window) > before && level_at(&window, FREE) > coarse);
    assert_eq!(entries(&window), 2, "the layer, and the threat");
    // A second click there selects it.
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!((threats(&window).len(), entries(&window)), (1, 2));
    click(&mut window, FREE, Modifiers::COMMAND);
    assert_eq!(threats(&window).len(), 2, "Ctrl places one on another");
    for _ in 0..2 {
        key(&mut window, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!((threats(&window), fingerprint(&window)), (vec![], empty));
}

#[test]
fn a_drag_of_the_middle_moves_a_threat_as_one_undo_step() {
    let mut window = window_with_threats();
    click(&mut window, FREE, Modifiers::NONE);
    let (placed, mesh) = (threats(&window)[0], fingerprint(&window));
    let to = dvec2(0.6, 0.3);
    press(&mut window, FREE, Modifiers::NONE);
    move_to(&mut window, FREE.lerp(to, 0.5));
    assert!(is_near(threats(&window)[0].at, FREE.lerp(to, 0.5)), "the mesh follows meanwhile");
    assert_ne!(fingerprint(&window), mesh);
    move_to(&mut window, to);
    release(&mut window, to);
    let moved = threats(&window)[0];
    assert!(is_near(moved.at, to), "{moved:?}");
    assert_eq!(moved, Threat { at: moved.at, ..placed });
    assert_eq!(entries(&window), 3);
    let dragged = fingerprint(&window);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((threats(&window)[0], fingerprint(&window)), (placed, mesh));
    key(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!((threats(&window)[0], fingerprint(&window)), (moved, dragged));
}

#[test]
fn a_drag_of_the_ring_changes_the_range_and_escape_takes_it_back() {
    let mut window = window_with_threats();
    let at = dvec2(0.5, 0.5);
    click(&mut window, at, Modifiers::NONE);
    let placed = threats(&window)[0];
    let on_ring = |range: f64| at + dvec2(0.0, range);
    stroke(&mut window, on_ring(placed.range), on_ring(0.3));
    let wide = threats(&window)[0];
    assert!((wide.range - 0.3).abs() < 2e-3 && wide.at == placed.at, "{wide:?}");
    assert_eq!(entries(&window), 3);
    press(&mut window, on_ring(wide.range), Modifiers::NONE);
    move_to(&mut window, on_ring(0.1));
    assert!(threats(&window)[0].range < 0.2);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!((threats(&window)[0], entries(&window)), (wide, 3));
    release(&mut window, on_ring(0.1));
    assert_eq!(threats(&window)[0], wide);
}

#[test]
fn a_drag_from_a_free_place_places_a_threat_with_its_range() {
    let mut window = window_with_threats();
    let middle = dvec2(0.5, 0.5);
    stroke(&mut window, middle, middle + dvec2(0.25, 0.0));
    let placed = threats(&window)[0];
    assert!(is_near(placed.at, middle) && (placed.range - 0.25).abs() < 2e-3, "{placed:?}");
    assert_eq!(entries(&window), 2);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(threats(&window), []);
}

#[test]
fn the_selected_threat_is_typed_and_deleted() {
    let mut window = window_with_threats();
    for at in [dvec2(0.3, 0.3), dvec2(0.7, 0.7)] {
        click(&mut window, at, Modifiers::NONE);
    }
    click(&mut window, dvec2(0.3, 0.3), Modifiers::NONE);
    assert_eq!(entries(&window), 3, "selecting is no edit");
    for (row, text) in [("x", "0.25"), ("y", "0.125"), ("Range value", "0.5"), ("Peak value", "0.375")] {
        type_into(&mut window, row, text);
    }
    window.get_by_role_and_label(Role::RadioButton, "Gaussian").click();
    window.run();
    let typed = Threat { at: dvec2(0.25, 0.125), range: 0.5, peak: 0.375, law: ThreatLaw::Gaussian };
    assert_eq!((threats(&window)[0], entries(&window)), (typed, 8));
    let other = threats(&window)[1];
    type_into(&mut window, "Selected threat", "2");
    assert_eq!(entries(&window), 8);
    click_button(&mut window, "Delete threat");
    assert_eq!(threats(&window), [typed]);
    let button = window.get_by_role_and_label(Role::Button, "Delete threat");
    assert!(button.accesskit_node().is_disabled(), "no threat is selected");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(threats(&window), [typed, other]);
    click(&mut window, typed.at, Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!(threats(&window), [other]);
    click_button(&mut window, "Add threat");
    assert_eq!(threats(&window).len(), 2);
}

#[test]
fn tables_are_saved_and_opened() {
    let folder = folder("app-threats", "tables");
    let file = folder.join("sites.csv");
    let mut window = window_with_threats();
    for at in [dvec2(0.3, 0.3), dvec2(0.7, 0.7)] {
        click(&mut window, at, Modifiers::NONE);
    }
    let saved = threats(&window);
    click_button(&mut window, "Save table…");
    type_into(&mut window, "Path", file.to_str().unwrap());
    assert!(wait_for_notice(&mut window).starts_with("2 threats written to "), "{}", notice(&window));
    assert!(fs::read_to_string(&file).unwrap().starts_with("x,y,range,peak,law\n"));
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!(threats(&window).len(), 1);
    let before = entries(&window);
    click_button(&mut window, "Open table…");
    type_into(&mut window, "Path", file.to_str().unwrap());
    wait_until(&mut window, |window| threats(window) == saved);
    assert_eq!(entries(&window), before + 1);
    fs::write(&file, "x,y,range,peak\n1,2,0,1\n").unwrap();
    send(&mut window, Command::from(ThreatsCommand::Open(file)));
    assert!(wait_for_notice(&mut window).contains("line 2: range is 0"), "{}", notice(&window));
    assert_eq!(threats(&window), saved);
}

#[test]
fn threats_are_placed_on_layers_of_threats_that_are_not_locked() {
    let mut window = window_with_threats();
    let layer = document(&window).active_layer().unwrap().id;
    send(&mut window, Command::from(LayerCommand::Lock(layer, true)));
    click(&mut window, FREE, Modifiers::NONE);
    assert!(notice(&window).contains("is locked") && threats(&window).is_empty(), "{}", notice(&window));
    click_button(&mut window, "Unlock the layer");
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!(threats(&window).len(), 1);
    // Paint layers are painted on; back on the threats, the tool edits them again.
    send(&mut window, Command::from(LayerCommand::Select(LayerId(2))));
    assert_eq!(window.state().tools().tool, &BRUSH);
    send(&mut window, Command::from(LayerCommand::Select(layer)));
    assert_eq!(window.state().tools().tool, &THREATS);
    key(&mut window, Modifiers::NONE, Key::Q);
    send(&mut window, Command::from(LayerCommand::Select(LayerId(2))));
    assert_eq!(window.state().tools().tool, &QUERY, "a tool that reads stays");
    key(&mut window, Modifiers::NONE, Key::K);
    click(&mut window, FREE, Modifiers::NONE);
    assert!(notice(&window).contains("has no threats"), "{}", notice(&window));
    click_button(&mut window, "Add a layer of threats");
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!(threats(&window).len(), 1);
    assert_eq!(value_of(&window, Role::Definition, "Threats"), "1");
}

//! When commands run, and the tables of tools and panels.

use std::collections::BTreeSet;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{
    TALL, canvas, entries, fingerprint, key, move_to, open_popup, open_section, open_tab, paint, send,
    value_of, wait_until, window, window_of,
};
use crate::app::features::ROWS;
use meshbrush_core::document::Example;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_kit::kit::{Tab, all_tools};
use meshbrush_mesh::mesh::Location;

#[test]
fn commands_run_where_the_canvas_has_no_room() {
    let mut window = window();
    let before = fingerprint(&window);
    paint(&mut window, 0.9);
    assert_ne!(fingerprint(&window), before);
    window.set_size(vec2(1440.0, 30.0));
    window.run();
    assert!(canvas(&window).height() < 1.0, "{}", canvas(&window));
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!((fingerprint(&window), entries(&window)), (before, 0));
    key(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(entries(&window), 1, "keys too");
}

#[test]
fn a_hidden_window_runs_commands_and_takes_its_last_input_once() {
    let mut window = window();
    let before = fingerprint(&window);
    paint(&mut window, 0.9);
    window.key_press_modifiers(Modifiers::NONE, Key::E);
    window.step();
    let ctx = window.ctx.clone();
    // eframe calls only `logic` then, with the input of the last frame.
    window.state_mut().send(Command::from(ShellCommand::Use(all_tools(ROWS)[0])));
    window.state_mut().send(Command::from(EditCommand::Undo));
    for _ in 0..50 {
        window.state_mut().advance(&ctx);
    }
    assert_eq!((fingerprint(&window), entries(&window)), (before, 0));
    assert_eq!(window.state().tools().tool, all_tools(ROWS)[0]);
}

#[test]
fn a_command_shows_an_overlay_and_its_key_hides_it_again() {
    let mut window = window_of(TALL);
    let overlay = |window: &super::Window| window.state().view().overlay;
    for _ in 0..2 {
        send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Risk)));
        assert_eq!(overlay(&window), FieldOverlay::Risk, "sent twice, it stays");
    }
    key(&mut window, Modifiers::NONE, Key::O);
    assert_eq!(overlay(&window), FieldOverlay::None);
    key(&mut window, Modifiers::SHIFT, Key::O);
    assert_eq!(overlay(&window), FieldOverlay::Target);
    for (name, expected) in [("No overlay", FieldOverlay::None), ("Target", FieldOverlay::Target)] {
        open_popup(&mut window, "Overlays");
        window.get_by_role_and_label(Role::RadioButton, name).click();
        window.run();
        assert_eq!(overlay(&window), expected);
    }
}

#[test]
fn the_status_bar_says_outside_between_the_polygons_and_their_bounds() {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    let bounds = window.state().session().document().settings().domain.bounds;
    let mesh = window.state().session().mesh();
    let grid = (1..40).flat_map(|i| (1..40).map(move |j| dvec2(f64::from(i), f64::from(j)) / 40.0));
    let mut points = grid.map(|share| bounds.min + share * bounds.size());
    let land = points.find(|&point| mesh.locate(point) == Location::OutsideDomain).unwrap();
    move_to(&mut window, land);
    assert_eq!(value_of(&window, Role::Definition, "h̄"), "outside");
    let sea = dvec2(25.25, 38.1);
    move_to(&mut window, sea);
    assert!(value_of(&window, Role::Definition, "h̄").starts_with(|first: char| first.is_ascii_digit()));
}

#[test]
fn parts_and_holes_are_counted_for_every_boundary_treatment() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    key(&mut window, Modifiers::NONE, Key::D);
    open_section(&mut window, "Fit to outline");
    for treatment in ["As in report", "Fitted", "On outline"] {
        open_tab(&mut window, Tab::Domain);
        window.get_by_role_and_label(Role::RadioButton, treatment).click();
        open_tab(&mut window, Tab::Mesh);
        wait_until(&mut window, |window| window.state().session().derived().is_some());
        for row in ["Parts", "Holes"] {
            let value = value_of(&window, Role::Definition, row);
            assert!(value.starts_with(|first: char| first.is_ascii_digit()), "{treatment}: {value}");
        }
    }
}

#[test]
fn every_tool_has_its_own_name_and_key_a_hint_and_its_tab() {
    let names: BTreeSet<_> = all_tools(ROWS).iter().map(|tool| tool.name).collect();
    let keys: BTreeSet<_> = all_tools(ROWS).iter().map(|tool| tool.key.name()).collect();
    assert_eq!((names.len(), keys.len()), (all_tools(ROWS).len(), all_tools(ROWS).len()));
    let mut window = window();
    for tool in all_tools(ROWS) {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        assert!(!window.state().tools().hint(&window.state().state(None)).is_empty(), "{tool:?}");
        if let Some(tab) = tool.tab {
            assert_eq!(window.state().view().dock.tab(), tab, "{tool:?}");
        }
    }
}

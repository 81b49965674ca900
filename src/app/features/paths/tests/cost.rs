//! The cost of paths: weights, the slider from the shortest to the safest, and a formula.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::{Window, is_complete, shown, wait_for_paths, window_with_path};
use crate::app::tests::{click, entries, key, send, set, settings, tips, type_into, wait_until};
use meshbrush_core::document::{PathCost, Setting};
use meshbrush_core::path::{Solution, Weights};
use meshbrush_kit::kit::command::{Command, EditCommand};
use meshbrush_mesh::text::LengthUnit;

fn solution(window: &Window) -> Solution {
    shown(window)[0].found.clone().unwrap().solution
}

fn formula(window: &Window) -> String {
    match &settings(window).paths.cost {
        PathCost::Formula(formula) => formula.source().to_owned(),
        PathCost::Weighted(weights) => format!("{weights:?}"),
    }
}

#[test]
fn the_figures_say_what_is_bounded_and_how_lengths_are_measured() {
    let mut window = window_with_path();
    let help = |window: &Window, name: &str| {
        let row = window.get_by_role_and_label(Role::Definition, name);
        row.accesskit_node().description().unwrap_or_default()
    };
    let least = help(&window, "Least possible cost");
    assert!(least.contains("no path through the domain costs less than the first"), "{least}");
    assert!(help(&window, "Proved").contains("not for the mesh"));
    assert!(help(&window, "Length").contains("in the plane"));
    let in_degrees = |window: &Window| window.query_by_label_contains("not in metres on the earth").is_some();
    assert!(!in_degrees(&window));
    set(&mut window, Setting::LengthUnit(LengthUnit::Degree));
    assert!(in_degrees(&window) && help(&window, "Length").contains("not the shortest in metres"));
}

#[test]
fn a_formula_takes_the_place_of_the_weights_and_is_undone() {
    let mut window = window_with_path();
    let before = solution(&window);
    window.get_by_role_and_label(Role::RadioButton, "Formula").click();
    window.run();
    assert_eq!(formula(&window), "1 + 10*risk");
    wait_for_paths(&mut window);
    assert!((solution(&window).cost / before.cost - 1.0).abs() < 1e-6, "the formula says the same");
    type_into(&mut window, "Cost per length", "1 + 200*risk");
    assert_eq!(formula(&window), "1 + 200*risk");
    wait_for_paths(&mut window);
    assert!(solution(&window).risk < before.risk && solution(&window).length > before.length);
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(formula(&window), "1 + 10*risk");
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(settings(&window).paths.cost, PathCost::default());
    wait_for_paths(&mut window);
    assert_eq!(solution(&window).points, before.points);
}

#[test]
fn a_mistake_in_the_formula_is_shown_and_changes_nothing() {
    let mut window = window_with_path();
    window.get_by_role_and_label(Role::RadioButton, "Formula").click();
    window.run();
    type_into(&mut window, "Cost per length", "1 + risky");
    assert_eq!(formula(&window), "1 + 10*risk");
    assert!(window.query_by_label_contains("risky").is_some(), "the row says what is wrong");
    // It can be read, but is no cost everywhere.
    key(&mut window, Modifiers::NONE, Key::Escape);
    type_into(&mut window, "Cost per length", "x - 0.5");
    wait_until(&mut window, |window| window.state().paths().shown()[0].problem.is_some());
    let problem = shown(&window)[0].problem.clone().unwrap().to_string();
    assert!(problem.contains("must be positive"), "{problem}");
    assert!(window.query_by_label_contains("The path that is shown is outdated.").is_some());
    window.get_by_role_and_label(Role::RadioButton, "Weights").click();
    window.run();
    wait_for_paths(&mut window);
    assert!(shown(&window)[0].problem.is_none());
}

#[test]
fn the_slider_goes_from_the_shortest_path_to_the_safest() {
    let mut window = window_with_path();
    let slider = window.get_by_role_and_label(Role::Slider, "Caution").rect();
    let mut lengths = Vec::new();
    for share in [0.02, 0.25, 0.5] {
        let steps = entries(&window);
        let at = slider.lerp_inside(eframe::egui::vec2(share, 0.5));
        crate::app::tests::press_at(&mut window, at, eframe::egui::PointerButton::Primary, Modifiers::NONE);
        crate::app::tests::release_at(&mut window, at, eframe::egui::PointerButton::Primary);
        assert_eq!(entries(&window), steps + 1, "one gesture");
        wait_for_paths(&mut window);
        let PathCost::Weighted(Weights { length, .. }) = settings(&window).paths.cost else { panic!() };
        assert_eq!(length, 1.0);
        lengths.push(solution(&window).length);
    }
    assert!(lengths[0] < lengths[1] && lengths[1] <= lengths[2], "{lengths:?}");
    assert!(is_complete(&window));
}

#[test]
fn every_control_of_the_path_has_a_sentence() {
    let mut window = window_with_path();
    assert_eq!(tips::unexplained(&window), [""; 0]);
    click(&mut window, dvec2(0.1, 0.9), Modifiers::COMMAND);
    window.get_by_role_and_label(Role::RadioButton, "Formula").click();
    window.run();
    wait_for_paths(&mut window);
    assert_eq!(tips::unexplained(&window), [""; 0]);
}

//! Other paths: the corridor, alternatives, and the front.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, PointerButton, Shape, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::DVec2;

use super::{Window, shown, wait_for_paths, window_with_path};
use crate::app::features::paths::{
    AlternativesCommand, CORRIDOR_COLOR, FrontCommand, PathCommand, PathFinder,
};
use crate::app::tests::{
    RESTING_PLACE, key, painted_shapes, press_at, release_at, send, settings, tips, wait_for_jobs, wait_until,
};
use meshbrush_core::document::PathCost;
use meshbrush_kit::kit::command::{Command, EditCommand};

fn paths(window: &Window) -> &PathFinder {
    window.state().paths()
}

/// Clicks a check box of the panel.
fn check(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::CheckBox, name).click();
    window.run();
}

fn area(lines: &[Vec<DVec2>]) -> f64 {
    lines.iter().flat_map(|line| line.windows(2)).map(|ends| 0.5 * ends[0].perp_dot(ends[1])).sum()
}

#[test]
fn the_corridor_is_shown_as_wide_as_its_slider_says() {
    let mut window = window_with_path();
    assert!(paths(&window).corridor.lines().is_empty(), "off by default");
    let solution = shown(&window)[0].found.clone().unwrap().solution;
    check(&mut window, "Corridor");
    wait_until(&mut window, |window| !paths(window).corridor.lines().is_empty());
    assert_eq!(shown(&window)[0].found.as_ref().unwrap().solution, solution, "the path stays as it is");
    let legend = window.get_by_label("Legend: paths within 5 %").rect();
    let is_swatch = |shape: &&Shape| match shape {
        Shape::Rect(swatch) => swatch.fill == CORRIDOR_COLOR && legend.contains_rect(swatch.rect),
        _ => false,
    };
    assert_eq!(painted_shapes(window.output()).iter().filter(|shape| is_swatch(shape)).count(), 1);
    assert_eq!(tips::unexplained(&window), [""; 0]);
    let before = area(paths(&window).corridor.lines());
    assert!(before > 0.0 && before < 1.0, "{before}");
    let slider = window.get_by_role_and_label(Role::Slider, "Above best").rect();
    let at = slider.lerp_inside(vec2(0.9, 0.5));
    press_at(&mut window, at, PointerButton::Primary, Modifiers::NONE);
    release_at(&mut window, at, PointerButton::Primary);
    assert!(paths(&window).corridor.share > 0.2, "{}", paths(&window).corridor.share);
    wait_until(&mut window, |window| area(paths(window).corridor.lines()) > before);
    window.run_steps(5);
    assert!(super::is_complete(&window));
    check(&mut window, "Corridor");
    assert!(paths(&window).corridor.lines().is_empty());
}

#[test]
fn the_corridor_follows_an_edit() {
    let mut window = window_with_path();
    check(&mut window, "Corridor");
    wait_until(&mut window, |window| !paths(window).corridor.lines().is_empty());
    let before = paths(&window).corridor.lines().to_vec();
    key(&mut window, Modifiers::NONE, Key::B);
    super::stroke(&mut window, glam::dvec2(0.3, 0.2), glam::dvec2(0.35, 0.5));
    wait_for_paths(&mut window);
    wait_until(&mut window, |window| paths(window).corridor.lines() != before);
    send(&mut window, Command::from(PathCommand::DeleteAll));
    assert!(paths(&window).corridor.lines().is_empty() && paths(&window).corridor.is_on);
}

#[test]
fn an_alternative_is_pointed_at_and_taken() {
    let mut window = window_with_path();
    check(&mut window, "Alternatives");
    wait_until(&mut window, |window| !paths(window).alternatives.paths().is_empty());
    send(&mut window, Command::from(PathCommand::Alternatives(AlternativesCommand::Cancel)));
    let alternatives = paths(&window).alternatives.paths().to_vec();
    assert_eq!(tips::unexplained(&window), [""; 0]);
    let row = window.get_by_role_and_label(Role::Button, "Alternative 1").rect().center();
    window.hover_at(row);
    window.run();
    assert_eq!(paths(&window).alternatives.pointed, Some(0));
    let places = settings(&window).paths.routes[0].clone();
    wait_for_jobs(&mut window);
    press_at(&mut window, row, PointerButton::Primary, Modifiers::NONE);
    release_at(&mut window, row, PointerButton::Primary);
    assert_eq!(settings(&window).paths.routes[0].len(), 3);
    window.hover_at(RESTING_PLACE);
    wait_for_paths(&mut window);
    let taken = shown(&window)[0].found.clone().unwrap().solution;
    assert!(taken.cost <= alternatives[0].cost * (1.0 + 1e-3), "{} {}", taken.cost, alternatives[0].cost);
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(settings(&window).paths.routes[0], places);
}

#[test]
fn a_path_of_the_front_is_pointed_at_and_taken() {
    let mut window = window_with_path();
    check(&mut window, "Front");
    assert!(window.query_by_label("Cancel front").is_some());
    assert_eq!(tips::unexplained(&window), [""; 0]);
    wait_until(&mut window, |window| paths(window).front.points().len() >= 3);
    send(&mut window, Command::from(PathCommand::Front(FrontCommand::Cancel)));
    let front = paths(&window).front.points().to_vec();
    // Somewhere in the plot is a point.
    let plot = window.get_by_role_and_label(Role::Image, "Length against risk").rect();
    let places = (0..100).map(|n| plot.lerp_inside(vec2((n % 10) as f32 / 10.0, (n / 10) as f32 / 10.0)));
    let at = places.into_iter().find(|&at| {
        window.hover_at(at);
        window.run();
        paths(&window).front.pointed.is_some()
    });
    let (at, pointed) = (at.unwrap(), paths(&window).front.pointed.unwrap());
    // As long as jobs run, frames follow each other, and a press becomes too long for a click.
    wait_for_jobs(&mut window);
    press_at(&mut window, at, PointerButton::Primary, Modifiers::NONE);
    release_at(&mut window, at, PointerButton::Primary);
    assert_eq!(settings(&window).paths.cost, PathCost::Weighted(front[pointed].weights));
    wait_for_paths(&mut window);
    assert_eq!(paths(&window).front.points(), front, "the front does not depend on the weights");
    let solution = shown(&window)[0].found.clone().unwrap().solution;
    assert!((solution.length / front[pointed].solution.length - 1.0).abs() < 1e-3);
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(settings(&window).paths.cost, PathCost::default());
    wait_for_paths(&mut window);
    let length = shown(&window)[0].found.as_ref().unwrap().solution.length;
    send(&mut window, Command::from(PathCommand::Front(FrontCommand::Shorter)));
    wait_for_paths(&mut window);
    assert!(shown(&window)[0].found.as_ref().unwrap().solution.length < length);
}

#[test]
fn the_work_on_other_paths_is_cancelled() {
    let mut window = window_with_path();
    check(&mut window, "Front");
    check(&mut window, "Alternatives");
    window.get_by_role_and_label(Role::Button, "Cancel front").click();
    window.run();
    assert!(paths(&window).front.progress().is_none());
    if window.query_by_label("Cancel search").is_some() {
        window.get_by_role_and_label(Role::Button, "Cancel search").click();
        window.run();
    }
    assert!(!paths(&window).alternatives.is_running());
    window.run_steps(3);
    assert!(paths(&window).front.progress().is_none(), "it does not begin again");
}

//! The polygon that the domain tool cuts with, corner by corner.

use eframe::egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::domain::DomainTool;
use crate::app::features::domain::{DomainCommand, DomainToolMode};
use crate::app::tests::{
    Window, area, click, entries, key, move_to, notice, on_screen, open_menu, press, press_at, release,
    release_at, send, wait_until, window,
};
use meshbrush_kit::kit::command::{Command, FileCommand};

const CORNERS: [DVec2; 4] = [dvec2(0.2, 0.2), dvec2(0.4, 0.2), dvec2(0.4, 0.4), dvec2(0.2, 0.4)];

/// Returns a new document and an open polygon with these corners.
fn with_corners(corners: &[DVec2]) -> Window {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(DomainCommand::Mode(DomainToolMode::Polygon)));
    for &corner in corners {
        click(&mut window, corner, Modifiers::NONE);
    }
    window
}

fn corner_count(window: &Window) -> usize {
    window.state().tools().settings::<DomainTool>().corners.len()
}

/// Whether the polygon was cut out: a square of 0.2 × 0.2, unless a corner was moved.
fn wait_for_cut(window: &mut Window, removed: f64) {
    wait_until(window, |window| !window.state().is_cutting() && corner_count(window) == 0);
    wait_until(window, |window| (area(window) - (1.0 - removed)).abs() < 2e-3);
    assert_eq!(entries(window), 1);
}

#[test]
fn backspace_and_ctrl_z_remove_the_last_corner() {
    let mut window = with_corners(&CORNERS);
    key(&mut window, Modifiers::NONE, Key::Backspace);
    assert_eq!(corner_count(&window), 3);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((corner_count(&window), entries(&window)), (2, 0));
    open_menu(&mut window, "Edit");
    assert!(window.query_by_label_contains("Undo corner of the polygon").is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    // The document is undone only when no corner is left.
    send(&mut window, Command::from(DomainCommand::RemoveCorner));
    send(&mut window, Command::from(DomainCommand::RemoveCorner));
    assert_eq!(corner_count(&window), 0);
    open_menu(&mut window, "Edit");
    assert!(window.query_by_label_contains("Undo corner of the polygon").is_none());
}

#[test]
fn a_double_click_closes_the_polygon() {
    let mut window = with_corners(&CORNERS[..3]);
    click(&mut window, CORNERS[3], Modifiers::NONE);
    click(&mut window, CORNERS[3], Modifiers::NONE);
    wait_for_cut(&mut window, 0.04);
}

#[test]
fn a_right_click_closes_the_polygon() {
    let mut window = with_corners(&CORNERS);
    let at = on_screen(&window, dvec2(0.7, 0.7));
    press_at(&mut window, at, PointerButton::Secondary, Modifiers::NONE);
    release_at(&mut window, at, PointerButton::Secondary);
    wait_for_cut(&mut window, 0.04);
}

#[test]
fn two_corners_are_kept_and_a_third_is_asked_for() {
    let mut window = with_corners(&CORNERS[..2]);
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(notice(&window).contains("three corners"), "{}", notice(&window));
    assert_eq!((corner_count(&window), entries(&window)), (2, 0));
}

#[test]
fn corners_can_be_dragged_before_the_polygon_is_closed() {
    let mut window = with_corners(&CORNERS);
    // The third and the first corner; a drag that ends on the same corner does not close.
    for (from, to) in [(CORNERS[2], dvec2(0.6, 0.4)), (CORNERS[0], dvec2(0.2, 0.1))] {
        press(&mut window, from, Modifiers::NONE);
        move_to(&mut window, from.lerp(to, 0.5));
        move_to(&mut window, to);
        release(&mut window, to);
    }
    let corners = &window.state().tools().settings::<DomainTool>().corners;
    assert_eq!(corners.len(), 4);
    assert!(corners[2].distance(dvec2(0.6, 0.4)) < 1e-3 && corners[0].distance(dvec2(0.2, 0.1)) < 1e-3);
    let shoelace = |ring: &[DVec2]| {
        let sum: f64 = (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum();
        0.5 * sum.abs()
    };
    let removed = shoelace(corners);
    key(&mut window, Modifiers::NONE, Key::Enter);
    wait_for_cut(&mut window, removed);
}

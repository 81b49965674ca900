//! Drawing lines with the pointer.

use eframe::egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::{are_near, draw, lines, names, tool, with_tool};
use crate::app::features::lines::{LINE, LineToolMode, LinesCommand};
use crate::app::tests::{
    click, entries, key, move_to, notice, on_screen, open_menu, press, press_at, release, release_at, send,
    stroke, window,
};
use meshbrush_kit::kit::command::{Command, EditCommand};

const CORNERS: [DVec2; 4] = [dvec2(0.2, 0.2), dvec2(0.4, 0.3), dvec2(0.6, 0.25), dvec2(0.7, 0.6)];

#[test]
fn clicks_set_corners_and_enter_a_double_click_and_the_other_button_end_the_line() {
    let mut window = with_tool(LineToolMode::Corners);
    draw(&mut window, &CORNERS);
    assert!(are_near(&lines(&window)[0].points, &CORNERS), "{:?}", lines(&window));
    assert_eq!((lines(&window)[0].closed, entries(&window), tool(&window).selected), (false, 1, Some(0)));
    let moved = CORNERS.map(|corner| corner + dvec2(0.0, 0.3));
    moved.iter().for_each(|&corner| click(&mut window, corner, Modifiers::NONE));
    click(&mut window, moved[3], Modifiers::NONE);
    assert!(are_near(&lines(&window)[1].points, &moved), "{:?}", lines(&window)[1]);
    click(&mut window, dvec2(0.1, 0.8), Modifiers::NONE);
    click(&mut window, dvec2(0.15, 0.9), Modifiers::NONE);
    let at = on_screen(&window, dvec2(0.9, 0.1));
    press_at(&mut window, at, PointerButton::Secondary, Modifiers::NONE);
    release_at(&mut window, at, PointerButton::Secondary);
    assert_eq!((names(&window), entries(&window)), (vec!["line 1", "line 2", "line 3"], 3));
    assert_eq!(tool(&window).selected, Some(2));
    for left in [2, 1, 0] {
        key(&mut window, Modifiers::COMMAND, Key::Z);
        assert_eq!(lines(&window).len(), left);
    }
    send(&mut window, Command::from(EditCommand::Redo));
    assert!(are_near(&lines(&window)[0].points, &CORNERS));
}

#[test]
fn a_click_on_the_first_corner_closes_the_line() {
    let mut window = with_tool(LineToolMode::Corners);
    for &corner in &CORNERS[..2] {
        click(&mut window, corner, Modifiers::NONE);
    }
    click(&mut window, CORNERS[0], Modifiers::NONE);
    assert!(notice(&window).contains("needs three corners"), "{}", notice(&window));
    click(&mut window, CORNERS[3], Modifiers::NONE);
    click(&mut window, CORNERS[0], Modifiers::NONE);
    let line = &lines(&window)[0];
    assert!(line.closed && are_near(&line.points, &[CORNERS[0], CORNERS[1], CORNERS[3]]), "{line:?}");
    assert_eq!(entries(&window), 1);
}

#[test]
fn escape_backspace_and_another_mode_take_the_corners_back() {
    let mut window = with_tool(LineToolMode::Corners);
    CORNERS.iter().for_each(|&corner| click(&mut window, corner, Modifiers::NONE));
    key(&mut window, Modifiers::NONE, Key::Backspace);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((tool(&window).corners.len(), entries(&window)), (2, 0));
    open_menu(&mut window, "Edit");
    assert!(window.query_by_label_contains("Undo corner of the line").is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(tool(&window).corners.is_empty());
    click(&mut window, CORNERS[0], Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(notice(&window).contains("needs two corners"), "{}", notice(&window));
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::FreeHand)));
    assert!(tool(&window).corners.is_empty() && lines(&window).is_empty());
}

#[test]
fn a_corner_is_dragged_while_the_line_is_drawn() {
    let mut window = with_tool(LineToolMode::Corners);
    CORNERS[..3].iter().for_each(|&corner| click(&mut window, corner, Modifiers::NONE));
    stroke(&mut window, CORNERS[1], dvec2(0.45, 0.5));
    key(&mut window, Modifiers::NONE, Key::Enter);
    let wanted = [CORNERS[0], dvec2(0.45, 0.5), CORNERS[2]];
    assert!(are_near(&lines(&window)[0].points, &wanted), "{:?}", lines(&window));
}

#[test]
fn a_line_by_free_hand_has_few_corners_and_follows_the_pointer() {
    let mut window = with_tool(LineToolMode::FreeHand);
    press(&mut window, dvec2(0.2, 0.5), Modifiers::NONE);
    let at = |n: i32| dvec2(0.2 + 0.006 * f64::from(n), 0.5 + 0.15 * (f64::from(n) / 16.0).sin());
    (1..=100).for_each(|n| move_to(&mut window, at(n)));
    release(&mut window, at(100));
    let line = lines(&window)[0].clone();
    assert!(!line.closed && (8..40).contains(&line.points.len()), "{} corners", line.points.len());
    assert!(line.points[line.points.len() - 1].distance(at(100)) < 2e-3);
    // No corner of the hand is more than 3 points beside the line.
    let px = on_screen(&window, dvec2(1.0, 0.0)).x - on_screen(&window, DVec2::ZERO).x;
    let distance = |point: DVec2| {
        let ends = line.points.windows(2).map(|ends| [ends[0], ends[1]]);
        let near = ends.map(|ends| meshbrush_mesh::geometry::nearest_on_segment(point, ends));
        near.map(|near| near.distance(point)).fold(f64::INFINITY, f64::min)
    };
    assert!((0..=100).all(|n| distance(at(n)) * f64::from(px) < 3.0));
    assert_eq!((entries(&window), names(&window)), (1, vec!["line 1"]));
    click(&mut window, dvec2(0.5, 0.5), Modifiers::NONE);
    assert_eq!(lines(&window).len(), 1, "a click draws nothing");
}

#[test]
fn rectangles_and_circles_are_closed_lines() {
    let mut window = with_tool(LineToolMode::Rectangle);
    stroke(&mut window, dvec2(0.2, 0.2), dvec2(0.5, 0.4));
    assert!(lines(&window)[0].closed);
    assert!((lines(&window)[0].length() - 1.0).abs() < 1e-2, "{}", lines(&window)[0].length());
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::Circle)));
    press(&mut window, dvec2(0.7, 0.7), Modifiers::NONE);
    move_to(&mut window, dvec2(0.8, 0.7));
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, dvec2(0.8, 0.7));
    assert_eq!(lines(&window).len(), 1, "Escape gives the circle up");
    stroke(&mut window, dvec2(0.7, 0.7), dvec2(0.8, 0.7));
    let around = std::f64::consts::TAU * 0.1;
    assert!((lines(&window)[1].length() - around).abs() < 5e-3, "{}", lines(&window)[1].length());
}

#[test]
fn the_key_and_the_button_of_the_panel_select_the_tool() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, LINE.key);
    assert_eq!(window.state().tools().tool, &LINE);
    draw(&mut window, &CORNERS[..2]);
    assert!(window.query_by_label("line 1").is_some(), "its row comes into view");
}

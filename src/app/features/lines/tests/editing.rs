//! Lines in the list, and corners of lines on the canvas.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::{are_near, draw, lines, names, tool, wait_for_fits, with_tool};
use crate::app::features::lines::{LineToolMode, LinesCommand};
use crate::app::tests::{
    Window, click, click_button, entries, key, move_to, notice, press, release, send, stroke, type_into,
};
use meshbrush_kit::kit::command::Command;

const CORNERS: [DVec2; 3] = [dvec2(0.2, 0.2), dvec2(0.5, 0.35), dvec2(0.8, 0.25)];

/// Returns a document with two lines, of which the first is selected to be edited.
fn with_two_lines() -> Window {
    let mut window = with_tool(LineToolMode::Corners);
    draw(&mut window, &CORNERS);
    draw(&mut window, &[dvec2(0.2, 0.7), dvec2(0.8, 0.8)]);
    send(&mut window, Command::from(LinesCommand::Mode(LineToolMode::Edit)));
    click(&mut window, CORNERS[0].midpoint(CORNERS[1]), Modifiers::NONE);
    assert_eq!(tool(&window).selected, Some(0));
    window
}

#[test]
fn corners_are_dragged_set_and_deleted_and_each_is_one_entry() {
    let mut window = with_two_lines();
    stroke(&mut window, CORNERS[1], dvec2(0.55, 0.5));
    let mut wanted = CORNERS.to_vec();
    wanted[1] = dvec2(0.55, 0.5);
    assert!(are_near(&lines(&window)[0].points, &wanted), "{:?}", lines(&window)[0]);
    assert_eq!(entries(&window), 3);
    let middle = wanted[1].midpoint(wanted[2]);
    stroke(&mut window, middle, middle + dvec2(0.05, 0.1));
    wanted.insert(2, middle + dvec2(0.05, 0.1));
    assert!(are_near(&lines(&window)[0].points, &wanted), "{:?}", lines(&window)[0]);
    assert_eq!((entries(&window), tool(&window).corner), (4, Some(2)));
    key(&mut window, Modifiers::NONE, Key::Delete);
    wanted.remove(2);
    assert!(are_near(&lines(&window)[0].points, &wanted));
    assert_eq!(entries(&window), 5);
    for _ in 0..3 {
        key(&mut window, Modifiers::COMMAND, Key::Z);
    }
    assert!(are_near(&lines(&window)[0].points, &CORNERS));
    // A corner of the line is no place to insert another one.
    press(&mut window, CORNERS[1], Modifiers::NONE);
    move_to(&mut window, dvec2(0.6, 0.6));
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, dvec2(0.6, 0.6));
    assert!(are_near(&lines(&window)[0].points, &CORNERS), "Escape takes the drag back");
}

#[test]
fn a_line_keeps_the_corners_that_it_needs() {
    let mut window = with_two_lines();
    send(&mut window, Command::from(LinesCommand::Select(Some(1))));
    click(&mut window, dvec2(0.2, 0.7), Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert!(notice(&window).contains("two corners"), "{}", notice(&window));
    send(&mut window, Command::from(LinesCommand::TakeCorner(None)));
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!((names(&window), tool(&window).selected), (vec!["line 1"], None));
    click(&mut window, dvec2(0.5, 0.9), Modifiers::NONE);
    assert_eq!(tool(&window).selected, None);
}

#[test]
fn rows_of_the_list_select_rename_and_delete_lines() {
    let mut window = with_two_lines();
    wait_for_fits(&mut window);
    window.get_by_role_and_label(Role::Button, "line 2").click();
    window.run();
    assert_eq!(tool(&window).selected, Some(1));
    type_into(&mut window, "Name", "west mole");
    assert_eq!((names(&window), entries(&window)), (vec!["line 1", "west mole"], 3));
    type_into(&mut window, "Name", " ");
    assert!(notice(&window).contains("keeps its name"), "{}", notice(&window));
    let before = window.state().view().camera;
    click_button(&mut window, "Zoom to line");
    let camera = window.state().view().camera.unwrap();
    assert_ne!(window.state().view().camera, before);
    assert!(lines(&window)[1].points.iter().all(|&point| camera.visible_world().contains(point)));
    click_button(&mut window, "Delete line");
    assert_eq!((names(&window), tool(&window).selected), (vec!["line 1"], None));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(names(&window), ["line 1", "west mole"]);
    window.get_by_role_and_label(Role::Button, "line 1").click();
    window.run();
    click_button(&mut window, "Delete line");
    draw_another(&mut window);
    assert_eq!(names(&window), ["west mole", "line 1"], "the least number that is free");
}

fn draw_another(window: &mut Window) {
    send(window, Command::from(LinesCommand::Mode(LineToolMode::Corners)));
    draw(window, &[dvec2(0.4, 0.75), dvec2(0.5, 0.76)]);
}

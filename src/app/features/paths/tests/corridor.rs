//! Corridors: layers along the paths as they were when they were taken.

use eframe::egui::Modifiers;
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::{GOAL, Window, shown, wait_for_paths, window_with_path};
use crate::app::features::paths::PathCommand;
use crate::app::tests::{
    active, choose_in_palette, click_button, entries, move_to, notice, press, release, send, settings,
    triangles,
};
use meshbrush_core::layers::{DistanceLayer, DistanceTo};
use meshbrush_kit::kit::command::{Command, EditCommand};

const ADD: &str = "Add layer: corridor along the paths";

fn points(window: &Window) -> Vec<DVec2> {
    shown(window)[0].found.as_ref().unwrap().solution.points.clone()
}

/// Returns the line and the width of the selected corridor.
fn corridor(window: &Window) -> (Vec<DVec2>, f64) {
    let Some(DistanceLayer { to: DistanceTo::Corridor { lines, width }, .. }) = active(window).kind.get()
    else {
        panic!("{:?} is no corridor", active(window).kind)
    };
    (lines.list().lines[0].clone(), *width)
}

#[test]
fn a_corridor_refines_along_the_path_stays_there_and_takes_it_again() {
    let mut window = window_with_path();
    let (path, before, edits) = (points(&window), triangles(&window), entries(&window));
    choose_in_palette(&mut window, ADD);
    wait_for_paths(&mut window);
    assert_eq!((active(&window).name.as_str(), entries(&window)), ("Corridor", edits + 1));
    assert_eq!(corridor(&window).0, path);
    assert!(triangles(&window) > before);
    let h_min = settings(&window).transfer.h_min;
    for &point in &path {
        let session = window.state().session();
        let triangle = session.locate(point).triangle().unwrap();
        assert!(session.view().diameter(triangle) <= h_min, "at {point}");
    }
    let with_corridor = triangles(&window);
    press(&mut window, GOAL, Modifiers::NONE);
    move_to(&mut window, dvec2(0.9, 0.4));
    release(&mut window, dvec2(0.9, 0.4));
    wait_for_paths(&mut window);
    assert_eq!(corridor(&window).0, path, "it does not move by itself");
    assert_eq!(triangles(&window), with_corridor);
    click_button(&mut window, "Take the current path again");
    wait_for_paths(&mut window);
    assert_eq!(corridor(&window).0.last(), Some(&settings(&window).paths.routes[0][1]));
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(corridor(&window).0, path);
    send(&mut window, Command::from(EditCommand::Undo));
    send(&mut window, Command::from(EditCommand::Undo));
    assert_eq!(triangles(&window), before);
}

#[test]
fn without_a_current_path_there_is_no_corridor_and_a_sentence() {
    let mut window = window_with_path();
    let edits = entries(&window);
    send(&mut window, Command::from(PathCommand::DeleteAll));
    send(&mut window, Command::from(PathCommand::AddCorridor));
    assert!(notice(&window).contains("There is no path"), "{}", notice(&window));
    assert_eq!(entries(&window), edits + 1);
    assert!(window.query_by_label("Take the current path again").is_none());
}

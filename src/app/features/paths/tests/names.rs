//! Names, colours and labels of paths.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{START, wait_for_paths, window_with_path};
use crate::app::features::paths::PathCommand;
use crate::app::tests::{Window, click, entries, key, send, settings, type_into};
use meshbrush_kit::kit::command::{Command, EditCommand};

fn says(window: &Window, label: &str) -> bool {
    window.query_by_role_and_label(Role::Label, label).is_some()
}

#[test]
fn the_ends_of_paths_are_labelled_with_a_name_that_can_be_typed() {
    let mut window = window_with_path();
    assert!(says(&window, "Path 1: start") && says(&window, "Path 1: goal"));
    let before = entries(&window);
    type_into(&mut window, "Name", "Ferry");
    assert_eq!(settings(&window).paths.name(0), "Ferry");
    assert!(says(&window, "Ferry: start") && says(&window, "Ferry: goal"));
    assert_eq!(entries(&window), before + 1, "one gesture");
    send(&mut window, Command::from(EditCommand::Undo));
    assert!(says(&window, "Path 1: start"));
}

#[test]
fn each_path_has_its_name_and_deleting_one_keeps_those_of_others() {
    let mut window = window_with_path();
    click(&mut window, dvec2(0.1, 0.5), Modifiers::NONE);
    click(&mut window, dvec2(0.9, 0.4), Modifiers::NONE);
    wait_for_paths(&mut window);
    assert!(says(&window, "Path 1: start") && says(&window, "Path 2: goal"));
    send(&mut window, Command::from(PathCommand::Name("North".into())));
    send(&mut window, Command::from(EditCommand::EndGesture));
    assert!(says(&window, "North: start"), "the path of the selected place");
    click(&mut window, START, Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!((settings(&window).paths.routes.len(), settings(&window).paths.name(0)), (1, "North".into()));
    assert!(says(&window, "North: start") && !says(&window, "Path 1: start"));
}

//! A picture behind the mesh.

use std::fs;
use std::path::PathBuf;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::corners::NAMES;
use crate::app::features::picture::PictureCommand;
use crate::app::tests::{
    TALL, Window, choose_in_palette, document, entries, fingerprint, folder, key, move_to, notice,
    open_section, press_at, release, send, set, settings, type_into, value_of, wait_for_notice, wait_until,
    window_of,
};
use meshbrush_core::document::{Background, Document, Setting};
use meshbrush_io::io::{self, project};
use meshbrush_kit::kit::command::Command;
use meshbrush_mesh::geometry::Rect;

/// Returns a picture of 4 × 2 pixels.
fn picture(folder: PathBuf) -> PathBuf {
    let file = folder.join("map.png");
    let rgba: Vec<u8> = (0..32).map(|i| if i % 4 == 3 { 255 } else { 40 * (i % 6) }).collect();
    io::write_file(&file, |mut out| io::png::write(&mut out, [4, 2], &rgba)).unwrap();
    file
}

fn background(window: &Window) -> Option<&Background> {
    settings(window).background.as_ref()
}

fn with_background(folder: PathBuf) -> Window {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(PictureCommand::Open(picture(folder))));
    wait_until(&mut window, |window| background(window).is_some());
    window
}

#[test]
fn a_picture_covers_the_domain_and_is_moved_faded_and_removed() {
    let mut window = with_background(folder("background picture", "panel"));
    let (mesh, before) = (fingerprint(&window), entries(&window));
    assert_eq!(background(&window).unwrap().bounds, Rect::UNIT);
    open_section(&mut window, "Background picture");
    assert_eq!(value_of(&window, Role::Definition, "Picture"), "map.png");
    type_into(&mut window, "Opacity value", "0.3");
    type_into(&mut window, "Picture right", "2");
    assert_eq!(background(&window).unwrap().opacity, 0.3);
    assert_eq!(background(&window).unwrap().bounds.max, dvec2(2.0, 1.0));
    assert_eq!((fingerprint(&window), entries(&window)), (mesh, before + 2), "the mesh is the same");
    type_into(&mut window, "Picture left", "3");
    assert!(notice(&window).contains("right side is right of the left one"), "{}", notice(&window));
    window.get_by_role_and_label(Role::Button, "Cover the domain").click();
    window.run();
    assert_eq!(background(&window).unwrap().bounds, Rect::UNIT);
    window.get_by_role_and_label(Role::Button, "Remove picture").click();
    window.run();
    assert_eq!(background(&window), None);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(background(&window).is_some(), "undo brings it back");
}

#[test]
fn a_world_file_beside_the_picture_places_it() {
    let folder = folder("background picture", "world");
    fs::write(folder.join("map.pgw"), "0.25\n0\n0\n-0.25\n0.125\n0.875\n").unwrap();
    let window = with_background(folder);
    assert_eq!(background(&window).unwrap().bounds, Rect::new(dvec2(0.0, 0.5), dvec2(1.0, 1.0)));
}

#[test]
fn the_picture_is_saved_with_the_project() {
    let window = with_background(folder("background picture", "saved"));
    let mut bytes = Vec::new();
    project::write(&mut bytes, &project::Project::of(document(&window))).unwrap();
    let opened = project::from_bytes(&bytes, "x.meshbrush".as_ref()).unwrap();
    let opened: Document = opened.into_document().unwrap();
    assert_eq!(opened.settings(), settings(&window));
    let mut again = Vec::new();
    project::write(&mut again, &project::Project::of(&opened)).unwrap();
    assert!(again == bytes, "saving an opened project gives the same file");
}

#[test]
fn a_picture_that_cannot_be_shown_is_refused_with_a_sentence() {
    let folder = folder("background picture", "refused");
    let file = picture(folder.clone());
    fs::write(folder.join("map.wld"), "0.25\n0.1\n0\n-0.25\n0\n0\n").unwrap();
    let mut window = window_of(TALL);
    send(&mut window, Command::from(PictureCommand::Open(file)));
    let problem = wait_for_notice(&mut window);
    assert!(problem.contains("map.wld") && problem.contains("north up"), "{problem}");
    assert_eq!(background(&window), None);
    choose_in_palette(&mut window, "Open background picture…");
    set(&mut window, Setting::Background(None));
    assert_eq!(entries(&window), 0);
}

#[test]
fn the_corners_of_the_picture_are_dragged_on_the_canvas() {
    let mut window = with_background(folder("background picture", "corners"));
    let handle =
        |window: &Window, name| window.query_by_role_and_label(Role::Button, name).map(|node| node.rect());
    assert!(handle(&window, NAMES[0]).is_none());
    open_section(&mut window, "Background picture");
    window.get_by_role_and_label(Role::CheckBox, "Drag corners on the canvas").click();
    window.run();
    let before = entries(&window);
    let from = handle(&window, NAMES[1]).unwrap().center();
    press_at(&mut window, from, PointerButton::Primary, Modifiers::NONE);
    for share in [0.3, 0.6, 0.75] {
        move_to(&mut window, dvec2(share, 0.5));
    }
    release(&mut window, dvec2(0.75, 0.5));
    let bounds = background(&window).unwrap().bounds;
    assert!(bounds.min == dvec2(0.0, 0.0) && bounds.max.distance(dvec2(0.75, 0.5)) < 0.01, "{bounds:?}");
    assert_eq!(entries(&window), before + 1, "one entry for the drag");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(background(&window).unwrap().bounds, Rect::UNIT);
}

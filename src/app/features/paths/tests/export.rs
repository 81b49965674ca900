//! Paths written to files from the window.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use super::{GOAL, shown, wait_for_paths, window_with_path};
use crate::app::features::paths::PathCommand;
use crate::app::features::paths::Paths;
use crate::app::tests::tips::unexplained;
use crate::app::tests::{
    TALL, Window, click_button, folder, key, move_to, notice, open_menu, press, release, send, set, settings,
    type_into, value_of, wait_for_notice, wait_until, window_of,
};
use meshbrush_core::document::{PathCost, Setting};
use meshbrush_core::path::{Solution, Weights};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::text::LengthUnit;

fn solution(window: &Window) -> Solution {
    shown(window)[0].found.as_ref().unwrap().solution.clone()
}

/// Exports the path, and returns what the file contains.
fn exported(window: &mut Window, file: &Path) -> Vec<u8> {
    send(window, Command::from(PathCommand::ExportAs(file.to_owned())));
    let notice = wait_for_notice(window);
    assert!(notice.starts_with("The path was written to "), "{notice}");
    send(window, Command::from(ShellCommand::DismissNotice));
    fs::read(file).unwrap()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

fn refused(window: &mut Window, file: &Path) -> String {
    send(window, Command::from(PathCommand::Export(file.to_owned())));
    let sentence = wait_for_notice(window);
    assert!(!file.exists(), "{sentence}");
    send(window, Command::from(ShellCommand::DismissNotice));
    sentence
}

#[test]
fn each_format_is_written() {
    let (mut window, folder) = (window_with_path(), folder("app-path-export", "formats"));
    let solution = solution(&window);
    let feature: serde_json::Value =
        serde_json::from_slice(&exported(&mut window, &folder.join("a.geojson"))).unwrap();
    let points = feature["geometry"]["coordinates"].as_array().unwrap();
    let points: Vec<DVec2> =
        points.iter().map(|p| dvec2(p[0].as_f64().unwrap(), p[1].as_f64().unwrap())).collect();
    assert_eq!(points, solution.points);
    let properties = &feature["properties"];
    assert_eq!(properties["cost"], solution.cost);
    assert_eq!(properties["document"], settings(&window).name.as_str());
    assert!(
        text(exported(&mut window, &folder.join("a.csv"))).starts_with("x,y,distance,cost,risk,density\n")
    );
    let drawing = text(exported(&mut window, &folder.join("a.svg")));
    assert!(drawing.starts_with("<svg ") && drawing.contains("<polyline"));
    assert_eq!(&exported(&mut window, &folder.join("a.png"))[1..4], b"PNG");
}

#[test]
fn a_picture_has_the_colours_of_the_overlay_on_the_canvas() {
    let (mut window, folder) = (window_with_path(), folder("app-path-export", "overlay"));
    let of_levels = text(exported(&mut window, &folder.join("levels.svg")));
    assert!(of_levels.contains("<title>Level, diameter, count</title>"));
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::SmallestAngle)));
    let of_angles = text(exported(&mut window, &folder.join("angles.svg")));
    assert!(of_angles.contains("<title>Smallest angle</title>"), "its legend is there");
    assert!(of_angles.contains("<polyline") && !of_angles.contains("<title>Level, diameter"));
}

#[test]
fn the_table_is_that_of_the_command_line() {
    let (mut window, folder) = (window_with_path(), folder("app-path-export", "table"));
    let [project, here, there] = ["a.meshbrush", "here.csv", "there.csv"].map(|name| folder.join(name));
    send(&mut window, Command::from(FileCommand::SaveTo(project.clone())));
    assert!(wait_for_notice(&mut window).starts_with("Saved to "));
    send(&mut window, Command::from(ShellCommand::DismissNotice));
    send(&mut window, Command::from(PathCommand::ExportTolerance(0.01)));
    let places = settings(&window).paths.routes[0].clone();
    let [from, to] = [places[0], places[1]].map(|place| format!("{},{}", place.x, place.y));
    let [project, written] = [&project, &there].map(|file| file.to_str().unwrap());
    let files = ["--project", project, "-o", written];
    let typed = [&["meshbrush", "path", "--simplify", "0.01", "--from", &from, "--to", &to][..], &files[..]];
    assert_eq!(meshbrush_cli::cli::run(typed.concat().into_iter().map(Into::into), None), ExitCode::SUCCESS);
    let table = text(exported(&mut window, &here));
    assert_eq!(table, fs::read_to_string(there).unwrap());
    assert!(table.lines().count() - 1 < solution(&window).points.len(), "points were left out");
    let cost: f64 = table.lines().last().unwrap().split(',').nth(3).unwrap().parse().unwrap();
    // The cost is that of the path in the file, which leaves points out.
    let least = solution(&window).cost;
    assert!(least < cost && cost < 1.05 * least, "{cost} {least}");
}

#[test]
fn the_panel_asks_for_file_and_tolerance() {
    let (mut window, folder) = (window_with_path(), folder("app-path-export", "panel"));
    let file = folder.join("path.geojson");
    let lines = |file: &PathBuf| fs::read_to_string(file).unwrap().lines().count();
    exported(&mut window, &file);
    let all = lines(&file);
    type_into(&mut window, "Export tolerance", "0.02");
    assert_eq!(window.state().features().get::<Paths>().tool.export_tolerance, 0.02);
    assert_eq!(unexplained(&window), [""; 0]);
    click_button(&mut window, "Export path…");
    window.get_by_role_and_label(Role::ComboBox, "Format").click();
    window.run();
    window.get_by_label_contains("navigation programs").click();
    window.run();
    assert!(value_of(&window, Role::TextInput, "Path").ends_with(".gpx"), "the name follows the format");
    window.get_by_role_and_label(Role::ComboBox, "Format").click();
    window.run();
    window.get_by_label_contains("QGIS and web maps").click();
    window.run();
    // The ending is added.
    type_into(&mut window, "Path", file.with_extension("").to_str().unwrap());
    wait_until(&mut window, |window| window.query_by_role_and_label(Role::Button, "Replace").is_some());
    window.get_by_role_and_label(Role::Button, "Replace").click();
    wait_until(&mut window, |window| notice(window).starts_with("The path was written to "));
    assert!(lines(&file) < all);
}

#[test]
fn an_outdated_path_is_not_exported() {
    let (mut window, folder) = (window_with_path(), folder("app-path-export", "outdated"));
    let file = folder.join("path.csv");
    let cost = PathCost::Weighted(Weights { length: 1.0, risk: 3.0 });
    // Both in one frame.
    window.state_mut().send(Command::from(PathCommand::Cost(cost)));
    window.state_mut().send(Command::from(EditCommand::EndGesture));
    let sentence = refused(&mut window, &file);
    assert_eq!(sentence, "The path is being found for the last edit. Export it again when that is done.");
    wait_for_paths(&mut window);
    exported(&mut window, &file);
    fs::remove_file(&file).unwrap();
    press(&mut window, GOAL, Modifiers::NONE);
    move_to(&mut window, dvec2(0.9, 1.05));
    release(&mut window, dvec2(0.9, 1.05));
    wait_until(&mut window, |window| shown(window)[0].problem.is_some());
    wait_for_paths(&mut window);
    let sentence = refused(&mut window, &file);
    assert!(sentence.starts_with("The goal ") && sentence.ends_with("so it is not exported."), "{sentence}");
}

#[test]
fn a_file_of_another_kind_is_refused_and_a_document_without_path_has_nothing_to_export() {
    let (mut window, folder) = (window_with_path(), folder("app-path-export", "kinds"));
    let sentence = refused(&mut window, &folder.join("path.vtu"));
    assert!(sentence.ends_with("use .geojson, .csv, .gpx, .kml, .svg or .png."), "{sentence}");
    let sentence = refused(&mut window, &folder.join("no such folder/path.csv"));
    assert!(sentence.contains("could not be written: there is no folder"), "{sentence}");
    let sentence = refused(&mut window, &folder.join("path.gpx"));
    assert!(sentence.contains("GPX and KML have longitudes and latitudes"), "{sentence}");
    set(&mut window, Setting::LengthUnit(LengthUnit::Degree));
    wait_for_paths(&mut window);
    let file = folder.join("path.kml");
    exported(&mut window, &file);
    assert!(fs::read_to_string(&file).unwrap().contains("<Placemark><name>Path 1</name>"));
    open_menu(&mut window, "File");
    // The panel has one as well, farther down.
    let entries = window.get_all_by_role_and_label(Role::Button, "Export path…");
    entries.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top())).unwrap().click();
    window.run();
    assert!(window.query_by_role_and_label(Role::TextInput, "Path").is_some());
    let mut empty = window_of(TALL);
    open_menu(&mut empty, "File");
    assert!(empty.get_by_role_and_label(Role::Button, "Export path…").accesskit_node().is_disabled());
    key(&mut empty, Modifiers::NONE, Key::Escape);
    let sentence = refused(&mut empty, &folder.join("path.csv"));
    assert!(sentence.starts_with("There is no path: "), "{sentence}");
}

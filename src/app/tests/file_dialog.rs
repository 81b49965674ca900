//! The file dialog in the window.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{
    Window, button_event, choose, document, key, notice, paint, send, set, value_of, wait_for_jobs,
    wait_for_notice, wait_until, window, window_with,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_io::io::project;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::render::export::ExportFormat;
use meshbrush_ui::widgets::format;

/// Returns a folder with files and folders.
fn folder(name: &str) -> PathBuf {
    let folder = super::folder("app-file-dialog", name);
    for name in ["coasts", "Maps", ".hidden"] {
        fs::create_dir(folder.join(name)).unwrap();
    }
    let triangle = r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]}"#;
    fs::write(folder.join("coasts/north.geojson"), triangle).unwrap();
    fs::write(folder.join("coasts/north sea.geojson"), triangle).unwrap();
    fs::write(folder.join("coasts/broken.geojson"), "{\"type\": \"Polygon\"").unwrap();
    fs::write(folder.join("notes.txt"), "no domain").unwrap();
    folder
}

fn press(window: &mut Window, button: &str) {
    window.get_by_role_and_label(Role::Button, button).click();
    window.run();
}

fn type_text(window: &mut Window, text: &str) {
    window.event(Event::Text(text.to_owned()));
    window.run();
}

fn text(window: &Window) -> String {
    value_of(window, Role::TextInput, "Path")
}

/// Returns the rows of the list of files, from the top. Rows of layers, behind the dialog, have a value as
/// well.
fn rows(window: &Window) -> Vec<String> {
    let is_file = |row: &egui_kittest::Node<'_>| row.accesskit_node().value().is_none();
    let mut rows: Vec<_> = window.query_all_by_role(Role::ListBoxOption).filter(is_file).collect();
    rows.sort_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
    rows.iter().map(|row| row.accesskit_node().label().unwrap_or_default()).collect()
}

fn row(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::ListBoxOption, name).click();
    window.run();
}

fn wait_for_rows(window: &mut Window, expected: &[&str]) {
    wait_until(window, |window| rows(window) == expected);
}

fn go_to(window: &mut Window, folder: &Path) {
    key(window, Modifiers::COMMAND, Key::A);
    type_text(window, folder.to_str().unwrap());
    key(window, Modifiers::NONE, Key::Enter);
}

fn is_open(window: &Window) -> bool {
    window.query_by_role_and_label(Role::TextInput, "Path").is_some()
}

/// Answers the question about a coast as proposed.
fn answer(window: &mut Window) {
    wait_until(window, |window| window.query_by_label("What is the file to be?").is_some());
    press(window, "Open");
}

#[test]
fn a_domain_is_found_by_clicks_and_by_typing() {
    let folder = folder("find");
    // Frames short enough for a double click.
    let mut window = window_with(Harness::builder().with_size(vec2(1440.0, 900.0)).with_step_dt(0.02));
    choose(&mut window, "File", "Open domain… Ctrl+Shift+O");
    go_to(&mut window, &folder);
    wait_for_rows(&mut window, &["coasts/", "Maps/"]);
    row(&mut window, "coasts/");
    wait_for_rows(&mut window, &["broken.geojson", "north sea.geojson", "north.geojson"]);
    press(&mut window, "Folder above");
    wait_for_rows(&mut window, &["coasts/", "Maps/"]);

    // The list narrows to what is typed, and Tab completes it.
    type_text(&mut window, "CO");
    wait_for_rows(&mut window, &["coasts/"]);
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert_eq!(text(&window), "coasts/");
    wait_for_rows(&mut window, &["broken.geojson", "north sea.geojson", "north.geojson"]);
    type_text(&mut window, "n");
    wait_for_rows(&mut window, &["north sea.geojson", "north.geojson"]);
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert_eq!(text(&window), "coasts/north", "as far as they agree");
    key(&mut window, Modifiers::NONE, Key::ArrowDown);
    key(&mut window, Modifiers::NONE, Key::ArrowDown);
    key(&mut window, Modifiers::NONE, Key::Enter);
    answer(&mut window);
    wait_until(&mut window, |window| document(window).settings().name == "north");
    assert!(!is_open(&window));

    // The folder is remembered.
    choose(&mut window, "File", "Open domain… Ctrl+Shift+O");
    wait_for_rows(&mut window, &["broken.geojson", "north sea.geojson", "north.geojson"]);
    let at = window.get_by_role_and_label(Role::ListBoxOption, "north sea.geojson").rect().center();
    for _ in 0..2 {
        window.event(Event::PointerMoved(at));
        window.event(button_event(at, PointerButton::Primary, true, Modifiers::NONE));
        window.event(button_event(at, PointerButton::Primary, false, Modifiers::NONE));
    }
    answer(&mut window);
    wait_until(&mut window, |window| document(window).settings().name == "north sea");
}

#[test]
fn an_error_stays_in_the_dialog_and_keeps_what_was_typed() {
    let folder = folder("errors");
    let mut window = window();
    let version = document(&window).version();
    key(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
    for (name, problem) in [("coasts/broken.geojson", "cut off"), ("missing.geojson", "There is no file")] {
        go_to(&mut window, &folder);
        type_text(&mut window, name);
        press(&mut window, "Open");
        wait_until(&mut window, |window| window.query_by_role(Role::Alert).is_some());
        let message = window.get_by_role(Role::Alert).accesskit_node().label().unwrap_or_default();
        assert!(message.contains(problem), "{message}");
        assert_eq!((text(&window).as_str(), notice(&window).as_str()), (name, ""));
        type_text(&mut window, "x");
        assert!(window.query_by_role(Role::Alert).is_none(), "the text is another one");
    }
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!is_open(&window));
    assert_eq!(document(&window).version(), version);

    // To write to a folder that is not there.
    key(&mut window, Modifiers::COMMAND, Key::E);
    key(&mut window, Modifiers::COMMAND, Key::A);
    let typed = folder.join("no folder/mesh.vtu");
    type_text(&mut window, typed.to_str().unwrap());
    press(&mut window, "Export");
    wait_until(&mut window, |window| window.query_by_role(Role::Alert).is_some());
    assert!(window.query_by_label_contains("there is no folder").is_some());
    assert_eq!(text(&window), typed.to_str().unwrap());
}

#[test]
fn edits_are_asked_about_only_for_a_file_that_can_be_opened() {
    let folder = folder("asked");
    let question = "Save changes to “Radar threats”?";
    let mut window = window();
    paint(&mut window, 0.9);
    key(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
    go_to(&mut window, &folder.join("coasts"));
    type_text(&mut window, "broken.geojson");
    key(&mut window, Modifiers::NONE, Key::Enter);
    wait_until(&mut window, |window| window.query_by_role(Role::Alert).is_some());
    assert!(window.query_by_label(question).is_none());
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, "north.geojson");
    key(&mut window, Modifiers::NONE, Key::Enter);
    answer(&mut window);
    wait_until(&mut window, |window| window.query_by_label(question).is_some());
    assert!(!is_open(&window) && document(&window).settings().name == "Radar threats");
}

#[test]
fn an_export_proposes_a_name_and_says_what_it_writes() {
    let folder = folder("export");
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::E);
    assert_eq!(text(&window), "Radar threats.vtu");
    let count = format::count(window.state().session().triangle_count() as u64);
    let says = |window: &Window, text: &str| window.query_by_label_contains(text).is_some();
    wait_until(&mut window, |window| {
        says(window, &format!("{count} triangles, ")) && says(window, " nodes, ")
    });
    window.get_by_role_and_label(Role::ComboBox, "Format").click();
    window.run();
    window.get_by_label_contains(".node").click();
    window.run();
    assert_eq!(text(&window), "Radar threats.node");
    wait_until(&mut window, |window| says(window, "in 4 files"));
    type_text(&mut window, "x"); // replaces nothing: the cursor is at the end
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, &format!("{}/", folder.display()));
    wait_for_rows(&mut window, &["coasts/", "Maps/"]);
    row(&mut window, "coasts/");
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, "mesh");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(wait_for_notice(&mut window).contains("triangles written to"));
    let written = folder.join("coasts/mesh.node");
    assert!(written.exists(), "the ending is added");
    assert!(!is_open(&window));

    // A name that is there is asked about over the dialog, which stays.
    send(&mut window, Command::from(ShellCommand::Escape));
    key(&mut window, Modifiers::COMMAND, Key::E);
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, "mesh.node");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(says(&window, "Replace 4 files?"));
    let cancel = window.get_all_by_role_and_label(Role::Button, "Cancel").last().unwrap();
    cancel.click();
    window.run();
    assert_eq!(text(&window), "mesh.node");
}

#[test]
fn an_export_says_its_size_on_disk_and_what_may_be_missed() {
    let folder = folder("figures");
    let mut window = window();
    let says = |window: &Window, text: &str| window.query_by_label_contains(text).is_some();
    for name in ["mesh.vtu", "mesh.14", "mesh.node", "mesh.nc"] {
        key(&mut window, Modifiers::COMMAND, Key::E);
        key(&mut window, Modifiers::COMMAND, Key::A);
        type_text(&mut window, &format!("{}/{name}", folder.display()));
        wait_until(&mut window, |window| says(window, " nodes, "));
        let figures = window.get_by_label_contains(" nodes, ");
        let figures = figures.accesskit_node().value().unwrap_or_default();
        let for_solver = name == "mesh.14";
        assert!(!says(&window, "No part of the boundary is open"), "the sides of a rectangle are: {name}");
        assert_eq!(says(&window, "a depth of 0 everywhere"), for_solver, "{name}");
        key(&mut window, Modifiers::NONE, Key::Enter);
        wait_for_notice(&mut window);
        send(&mut window, Command::from(ShellCommand::Escape));
        let path = folder.join(name);
        let files = ExportFormat::from_path(&path).unwrap().files(&path);
        let bytes: u64 = files.iter().map(|file| fs::metadata(file).unwrap().len()).sum();
        assert!(
            figures.contains(&format!(", {}", format::file_size(bytes))),
            "{name}: {figures} for {bytes}"
        );
    }
    key(&mut window, Modifiers::COMMAND, Key::E);
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, "mesh.png");
    assert!(says(&window, "no nodes and triangles"));
}

#[test]
fn the_sizes_of_exports_are_about_right() {
    let folder = folder("sizes");
    for example in [Example::Threats, Example::Aegean] {
        let mut window = window();
        send(&mut window, Command::from(FileCommand::OpenExample(example)));
        wait_until(&mut window, |window| {
            window.state().session().document().settings().domain.region().is_none()
                || window.state().session().derived().is_some()
        });
        let triangles = window.state().session().triangle_count();
        for format in ExportFormat::all() {
            let Some(about) = format.approximate_bytes(triangles) else { continue };
            let unit = window.state().session().document().settings().unit;
            if format.name() == "ll" && unit == LengthUnit::Kilometre {
                continue; // it holds degrees only
            }
            if format.name() == "disv" && unit == LengthUnit::Degree {
                continue; // it holds lengths only
            }
            let file = folder.join(format!("{example:?}.{}", format.ending()));
            send(&mut window, Command::from(FileCommand::Export(file.clone())));
            wait_for_notice(&mut window);
            send(&mut window, Command::from(ShellCommand::Escape));
            let bytes: u64 = format.files(&file).iter().map(|file| fs::metadata(file).unwrap().len()).sum();
            let ratio = about as f64 / bytes as f64;
            assert!((0.6..1.5).contains(&ratio), "{format:?}: {about} instead of {bytes} bytes");
        }
    }
}

#[test]
fn a_project_is_saved_under_the_name_of_the_document() {
    let folder = folder("save");
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::S);
    assert_eq!(text(&window), "Radar threats.meshbrush");
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, &format!("{}/coasts", folder.display()));
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(is_open(&window), "it is a folder");
    // The dialog has a button for each folder above: none of them should have the name of the document.
    type_text(&mut window, "saved radar");
    press(&mut window, "Save");
    wait_until(&mut window, |window| window.query_by_label("saved radar").is_some());
    let saved = project::read(&folder.join("coasts/saved radar.meshbrush")).unwrap();
    assert!(saved.settings() == document(&window).settings() && !is_open(&window));
}

#[test]
fn an_export_says_what_its_coordinates_are() {
    let mut window = window();
    let says = |window: &mut Window, text: &str| {
        key(window, Modifiers::COMMAND, Key::E);
        let is_said = window.query_by_label_contains(text).is_some();
        key(window, Modifiers::NONE, Key::Escape);
        is_said
    };
    assert!(!says(&mut window, "Coordinates are"), "the document has no unit");
    for (example, sentence) in [
        (Example::Aegean, "Coordinates are in degrees."),
        (Example::CelticSea, "Coordinates are longitudes and latitudes in degrees."),
        (Example::Terrain, "Coordinates are in kilometres."),
    ] {
        send(&mut window, Command::from(FileCommand::OpenExample(example)));
        assert!(says(&mut window, sentence), "{}", example.name());
    }
}

#[test]
fn a_mesh_of_a_sea_is_written_in_degrees_or_in_the_plane() {
    let folder = folder("plane");
    let mut window = window();
    send(&mut window, Command::from(FileCommand::OpenExample(Example::CelticSea)));
    wait_for_jobs(&mut window);
    set(&mut window, Setting::SmallestDiameter(15_000.0));
    wait_until(&mut window, |window| window.state().session().derived().is_some());
    let degrees = "Coordinates are longitudes and latitudes in degrees.";
    let metres = "Coordinates are metres in the plane of the document.";
    // The third line has the first node: its number and place.
    let first_x = |file: &str| -> f64 {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        text.lines().nth(2).unwrap().split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    for (file, choice, sentence) in [
        ("sea.gr3", None, degrees),
        ("sea.disv", None, metres),
        ("plane.gr3", Some("Plane of the document, in m"), metres),
        ("lonlat.gr3", Some("Longitude and latitude"), degrees),
    ] {
        key(&mut window, Modifiers::COMMAND, Key::E);
        key(&mut window, Modifiers::COMMAND, Key::A);
        type_text(&mut window, &format!("{}/{file}", folder.display()));
        if let Some(choice) = choice {
            window.get_by_role_and_label(Role::ComboBox, "Coordinates").click();
            window.run();
            window.get_by_label(choice).click();
            window.run();
        }
        assert!(window.query_by_label_contains(sentence).is_some(), "{file}");
        if file.ends_with("disv") {
            key(&mut window, Modifiers::NONE, Key::Escape);
            continue; // MODFLOW takes no cell of depth 0
        }
        key(&mut window, Modifiers::NONE, Key::Enter);
        wait_for_notice(&mut window);
        send(&mut window, Command::from(ShellCommand::Escape));
        assert_eq!(first_x(file).abs() > 180.0, sentence == metres, "{file}: {}", first_x(file));
    }
}

#[test]
fn a_new_project_is_saved_beside_the_file_that_it_was_made_from() {
    let folder = folder("beside");
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(folder.join("coasts/north.geojson"))));
    answer(&mut window);
    wait_until(&mut window, |window| document(window).settings().name == "north");
    key(&mut window, Modifiers::COMMAND, Key::S);
    assert_eq!(text(&window), "north.meshbrush");
    wait_until(&mut window, |window| window.query_by_role_and_label(Role::Button, "coasts").is_some());
}

/// The next export of a document has the format of the last one; another document begins with the default.
#[test]
fn the_last_format_of_a_document_is_proposed_again() {
    let folder = folder("format");
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::E);
    assert!(text(&window).ends_with(".vtu"), "{}", text(&window));
    go_to(&mut window, &folder.join("sea.14"));
    wait_until(&mut window, |window| !is_open(window));
    key(&mut window, Modifiers::COMMAND, Key::E);
    assert!(text(&window).ends_with(".14"), "{}", text(&window));
    key(&mut window, Modifiers::NONE, Key::Escape);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Threats)));
    key(&mut window, Modifiers::COMMAND, Key::E);
    assert!(text(&window).ends_with(".vtu"), "{}", text(&window));
}

#[test]
fn without_a_name_nothing_can_be_written_and_tab_leaves_a_name_that_was_proposed() {
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::E);
    assert!(!text(&window).is_empty(), "a name is proposed");
    assert!(has_focus(&window) && is_enabled(&window, "Export"));
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert!(!has_focus(&window), "there is nothing to complete");
    key(&mut window, Modifiers::SHIFT, Key::Tab);
    key(&mut window, Modifiers::COMMAND, Key::A);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert!(text(&window).is_empty() && !is_enabled(&window, "Export"));
    type_text(&mut window, " ");
    assert!(!is_enabled(&window, "Export"), "no name either");
}

#[test]
fn tab_completes_what_was_typed_and_otherwise_goes_on_whatever_the_list_has() {
    let folder = folder("tab");
    fs::write(folder.join("coasts/north.meshbrush"), "a project").unwrap();
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(folder.join("coasts/north.geojson"))));
    answer(&mut window);
    wait_until(&mut window, |window| document(window).settings().name == "north");
    key(&mut window, Modifiers::COMMAND, Key::S);
    wait_for_rows(&mut window, &["north.meshbrush"]);
    assert!(text(&window) == "north.meshbrush" && has_focus(&window));
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert!(!has_focus(&window), "the name was proposed");
    key(&mut window, Modifiers::SHIFT, Key::Tab);
    key(&mut window, Modifiers::COMMAND, Key::A);
    type_text(&mut window, "n");
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert!(text(&window) == "north.meshbrush" && has_focus(&window), "{}", text(&window));
    key(&mut window, Modifiers::COMMAND, Key::A);
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert!(text(&window).is_empty() && rows(&window) == ["north.meshbrush"]);
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert!(!has_focus(&window), "nothing is typed any more");
}

fn has_focus(window: &Window) -> bool {
    window.get_by_role_and_label(Role::TextInput, "Path").accesskit_node().is_focused()
}

fn is_enabled(window: &Window, button: &str) -> bool {
    !window.get_by_role_and_label(Role::Button, button).accesskit_node().is_disabled()
}

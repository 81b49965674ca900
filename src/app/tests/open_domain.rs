//! Opening a coast: the question about its coordinates, by every way, and the note at the start.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::project::Dropped;
use super::{
    Window, click_button, entries, folder, key, notice, open_menu, send, settings, step_until, type_into,
    wait_for_notice, wait_until, window,
};
use crate::app::App;
use crate::app::features::domain::DomainCommand;
use meshbrush_core::document::Settings;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_mesh::text::LengthUnit;

const COAST: &str =
    r#"{"type": "Polygon", "coordinates": [[[20, 30], [24, 30], [24, 33], [20, 33], [20, 30]]]}"#;
const WORLD: &str =
    r#"{"type": "Polygon", "coordinates": [[[-180, -89], [180, -89], [180, 89], [-180, 89], [-180, -89]]]}"#;
const UTM: &str = r#"{"type": "Polygon", "crs": {"type": "name", "properties": {"name": "EPSG:32635"}},
    "coordinates": [[[400000, 4000000], [440000, 4000000], [440000, 4030000], [400000, 4030000], [400000, 4000000]]]}"#;
const PLAIN: &str =
    r#"{"type": "Polygon", "coordinates": [[[0, 0], [900, 0], [900, 700], [0, 700], [0, 0]]]}"#;

fn written(test: &str, name: &str, text: &str) -> PathBuf {
    let file = folder("open-domain", test).join(name);
    std::fs::write(&file, text).unwrap();
    file
}

fn is_asked(window: &Window) -> bool {
    window.query_by_label("What is the file to be?").is_some()
}

fn chosen(window: &Window) -> Option<String> {
    let nodes = window.query_all_by_role(Role::RadioButton);
    let mut titles = nodes.filter_map(|node| {
        let data = node.accesskit_node().data().clone();
        (data.toggled() == Some(Toggled::True)).then(|| data.label().unwrap_or_default().to_owned())
    });
    titles.find(|title| title.contains("Domain") || title.contains("document"))
}

/// Waits for the question, and answers that the domain is to be in metres, which is chosen.
fn answer_metres(window: &mut Window, button: &str) {
    wait_until(window, is_asked);
    assert_eq!(chosen(window).as_deref(), Some("Domain in metres"));
    click_button(window, button);
    wait_until(window, |window| settings(window).name == "coast");
    let settings = settings(window);
    assert!(
        settings.unit == LengthUnit::Metre && settings.domain.projection.is_some(),
        "{:?}",
        settings.unit
    );
    assert!(settings.domain.bounds.size().min_element() > 3e5, "{:?}", settings.domain.bounds);
}

fn type_path(window: &mut Window, file: &Path) {
    type_into(window, "Path", &file.display().to_string());
}

/// Does what a person does to open a file.
type Opening = Box<dyn Fn(&mut Window)>;

#[test]
fn every_way_to_open_a_coast_in_degrees_asks_and_proposes_metres() {
    let file = written("ways", "coast.geojson", COAST);
    let mut ways: Vec<(&str, &str, Opening)> = Vec::new();
    let path = file.clone();
    ways.push((
        "New…, Coast…",
        "Open",
        Box::new(move |window| {
            key(window, Modifiers::COMMAND, Key::N);
            click_button(window, "Coast…");
            type_path(window, &path);
        }),
    ));
    let path = file.clone();
    ways.push((
        "Open domain…",
        "Open",
        Box::new(move |window| {
            key(window, Modifiers::COMMAND | Modifiers::SHIFT, Key::O);
            type_path(window, &path);
        }),
    ));
    let path = file.clone();
    ways.push((
        "Open…",
        "Open",
        Box::new(move |window| {
            key(window, Modifiers::COMMAND, Key::O);
            type_path(window, &path);
        }),
    ));
    let path = file.clone();
    ways.push((
        "Add data…",
        "Add",
        Box::new(move |window| {
            key(window, Modifiers::COMMAND | Modifiers::SHIFT, Key::D);
            type_path(window, &path);
        }),
    ));
    let path = file.clone();
    ways.push((
        "drop",
        "Add",
        Box::new(move |window| {
            window.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
            window.run();
        }),
    ));
    for (way, button, open) in ways {
        let mut window = window();
        open(&mut window);
        answer_metres(&mut window, button);
        assert_eq!(notice(&window), "", "{way}");
        // And by the recent files, where the answer can be the other one.
        open_menu(&mut window, "File");
        window.get_by_label_contains("Open recent coast.geojson").click();
        window.run();
        wait_until(&mut window, is_asked);
        assert!(
            window.query_by_label("Outline of this document").is_none(),
            "{way}: it is opened, not added"
        );
        window.get_by_role_and_label(Role::RadioButton, "Domain of a new document").click();
        window.run();
        click_button(&mut window, "Open");
        wait_until(&mut window, |window| settings(window).unit == LengthUnit::Degree);
        assert!(settings(&window).domain.projection.is_none(), "{way}");
    }
}

#[test]
fn a_question_that_is_cancelled_opens_nothing() {
    let file = written("cancelled", "coast.geojson", COAST);
    let mut window = window();
    let (name, before) = (settings(&window).name.clone(), entries(&window));
    send(&mut window, Command::from(FileCommand::Open(file)));
    wait_until(&mut window, is_asked);
    click_button(&mut window, "Cancel");
    assert!(!is_asked(&window));
    assert_eq!((settings(&window).name.clone(), entries(&window)), (name, before));
}

#[test]
fn metres_are_opened_without_a_question_and_keep_their_plane() {
    let file = written("metres", "utm.geojson", UTM);
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(file)));
    wait_until(&mut window, |window| settings(window).name == "utm");
    assert!(!is_asked(&window));
    let settings = settings(&window);
    let plane = settings.domain.projection.expect("the plane of the file is known");
    assert_eq!((settings.unit, plane.kind().name()), (LengthUnit::Metre, "transverse Mercator"));
    assert!((settings.domain.bounds.size().x - 40_000.0).abs() < 1.0, "{:?}", settings.domain.bounds);
}

#[test]
fn coordinates_that_nobody_knows_are_opened_with_a_note() {
    let file = written("plain", "plain.geojson", PLAIN);
    let mut window = window();
    send(&mut window, Command::from(FileCommand::Open(file)));
    let note = wait_for_notice(&mut window);
    assert!(note.contains("plain.geojson names no coordinate system") && note.contains("“Unit”"), "{note}");
    assert_eq!((settings(&window).name.as_str(), settings(&window).unit), ("plain", LengthUnit::None));
}

/// Returns a window that was started with a file, once it says something.
fn started_with(file: PathBuf) -> Window {
    let mut window = Harness::builder()
        .with_size(vec2(1440.0, 900.0))
        .with_max_steps(4000)
        .build_eframe(|cc| App::with_file(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), file).unwrap());
    window.step();
    step_until(&mut window, |window| !notice(window).is_empty());
    window
}

#[test]
fn a_coast_given_at_the_start_is_in_metres_and_a_note_says_so() {
    let mut window = started_with(written("start", "coast.geojson", COAST));
    let note = notice(&window);
    assert!(note.contains("longitudes and latitudes. It was opened in metres"), "{note}");
    assert!(!is_asked(&window));
    assert!(settings(&window).unit == LengthUnit::Metre && settings(&window).domain.projection.is_some());
    click_button(&mut window, "Open in degrees");
    wait_until(&mut window, |window| settings(window).unit == LengthUnit::Degree);
    assert_eq!(notice(&window), "");

    let window = started_with(written("start", "world.geojson", WORLD));
    let note = notice(&window);
    assert!(note.contains("opened in its own coordinates") && !is_asked(&window), "{note}");
    assert_eq!(settings(&window).unit, LengthUnit::Degree);
}

/// An island of a degree of latitude, and a coast from south to north with land to its left, in degrees.
const ISLAND: &str =
    r#"{"type": "Polygon", "coordinates": [[[20, 30], [21, 30], [21, 31], [20, 31], [20, 30]]]}"#;
const LINE: &str = r#"{"type": "LineString", "coordinates": [[20, 30], [21, 31], [20, 32]]}"#;

fn choose(window: &mut Window, title: &str) {
    window.get_by_role_and_label(Role::RadioButton, title).click();
    window.run();
}

#[test]
fn land_is_opened_as_the_sea_around_it() {
    let file = written("sea", "island.geojson", ISLAND);
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Choose(file)));
    wait_until(&mut window, is_asked);
    choose(&mut window, "Sea around this land");
    click_button(&mut window, "Open");
    wait_until(&mut window, |window| settings(window).name == "island");
    let Settings { domain, unit, .. } = settings(&window).clone();
    let region = domain.region().unwrap();
    assert!(unit == LengthUnit::Metre && region.hole_count() == 1 && domain.cuts().len() == 1, "{unit:?}");
    // A frame of 1.2° by 1.2° around 1° by 1°.
    let share = region.area() / domain.bounds.size().element_product();
    assert!((share - (1.0 - 1.0 / 1.44)).abs() < 0.02, "{share}");
    let notice = wait_for_notice(&mut window);
    assert!(notice.contains("water in a frame around the land of island.geojson"), "{notice}");
}

#[test]
fn a_line_of_coast_is_asked_about_and_has_no_domain_of_its_own() {
    let file = written("line", "line.geojson", LINE);
    let mut window = window();
    send(&mut window, Command::from(DomainCommand::Choose(file)));
    wait_until(&mut window, is_asked);
    let radio =
        |title| window.get_by_role_and_label(Role::RadioButton, title).accesskit_node().data().clone();
    assert!(radio("Domain in metres").is_disabled() && radio("Domain of a new document").is_disabled());
    assert_eq!(radio("Sea around this land").toggled(), Some(Toggled::True));
    click_button(&mut window, "Open");
    wait_until(&mut window, |window| settings(window).name == "line");
    let domain = settings(&window).domain.clone();
    let share = domain.region().unwrap().area() / domain.bounds.size().element_product();
    assert!((share - 0.5).abs() < 0.02, "{share}");
    let notice = wait_for_notice(&mut window);
    assert!(notice.contains("land is taken to be to the left of the lines"), "{notice}");
}

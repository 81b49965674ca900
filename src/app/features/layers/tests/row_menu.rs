//! The menu of a row of the list of layers, and what it does.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::stack::select;
use crate::app::tests::{
    TALL, Window, active, button_event, entries, folder, key, notice, select_base, send, set, settings,
    wait_for_jobs, window, window_of, with_base,
};
use meshbrush_core::layers::{FormulaLayer, Quantity};
use meshbrush_kit::kit::command::{Command, LayerCommand};

/// Clicks with the secondary button on the row of a layer.
fn open_menu_of(window: &mut Window, name: &str) {
    let at = window.get_by_role_and_label(Role::ListBoxOption, name).rect().center();
    window.event(Event::PointerMoved(at));
    window.run();
    for is_pressed in [true, false] {
        window.event(button_event(at, PointerButton::Secondary, is_pressed, Modifiers::NONE));
    }
    window.run();
}

fn choose_in_menu(window: &mut Window, entry: &str) {
    window.get_by_role_and_label(Role::Button, entry).click();
    window.run();
}

fn visible(window: &Window) -> Vec<&str> {
    settings(window).layers.iter().filter(|layer| layer.visible).map(|layer| layer.name.as_str()).collect()
}

#[test]
fn a_layer_is_shown_alone_and_all_are_shown_again() {
    let mut window = window_of(TALL);
    let all: Vec<String> = visible(&window).into_iter().map(str::to_owned).collect();
    open_menu_of(&mut window, "Base");
    choose_in_menu(&mut window, "Show only this layer");
    assert_eq!(visible(&window), ["Base"]);
    assert_eq!(active(&window).name, "Base", "the menu selects its layer");
    assert_eq!(entries(&window), 1, "it can be undone in one step");
    open_menu_of(&mut window, "Base");
    choose_in_menu(&mut window, "Show all layers");
    assert_eq!(visible(&window), all);
}

#[test]
fn the_menu_opens_by_keyboard_and_has_what_the_layer_allows() {
    let mut window = window_of(TALL);
    select(&mut window, "Painted risk");
    window.get_by_role_and_label(Role::ListBoxOption, "Painted risk").focus();
    window.run();
    key(&mut window, Modifiers::SHIFT, Key::F10);
    let is_enabled = |window: &Window, entry: &str| {
        !window.get_by_role_and_label(Role::Button, entry).accesskit_node().is_disabled()
    };
    assert!(is_enabled(&window, "Clear the layer") && is_enabled(&window, "Zoom to the layer"));
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_role_and_label(Role::Button, "Clear the layer").is_none());
}

#[test]
fn the_view_goes_to_what_a_layer_asks_for_or_says_that_it_asks_for_nothing() {
    let mut window = window();
    let before = window.state().view().camera;
    let painted = settings(&window).layers.iter().find(|layer| layer.name == "Painted risk").unwrap().id;
    send(&mut window, Command::from(LayerCommand::ZoomTo(painted)));
    assert_ne!(window.state().view().camera, before);
    let blank = settings(&window).layers.iter().find(|layer| layer.name == "Painted diameter").unwrap().id;
    send(&mut window, Command::from(LayerCommand::ZoomTo(blank)));
    assert!(notice(&window).contains("“Painted diameter” asks for nothing"), "{}", notice(&window));
}

#[test]
fn a_grid_of_a_layer_that_asks_for_nothing_says_so() {
    let path = folder("app-layers", "empty grid").join("layer.asc");
    let mut window = window();
    select(&mut window, "Painted diameter");
    send(&mut window, Command::from(LayerCommand::ExportGrid(path)));
    wait_for_jobs(&mut window);
    assert!(
        notice(&window).ends_with("It asks for nothing here: no cell has a value."),
        "{}",
        notice(&window)
    );
}

/// Returns the header of a grid as pairs, and its rows from the top.
fn parsed(text: &str) -> (Vec<(String, f64)>, Vec<Vec<f64>>) {
    let is_header = |line: &&str| line.starts_with(|c: char| c.is_alphabetic());
    let header = text.lines().take_while(is_header).map(|line| {
        let (name, value) = line.split_once(' ').expect("a name and a number");
        (name.to_lowercase(), value.trim().parse().expect("a number"))
    });
    let rows = text.lines().skip_while(is_header);
    let row = |line: &str| line.split_whitespace().map(|value| value.parse().unwrap()).collect();
    (header.collect(), rows.map(row).collect())
}

#[test]
fn a_layer_is_written_as_a_grid_of_what_it_asks_for() {
    let path = folder("app-layers", "grid").join("layer.asc");
    let mut window = window();
    let formula = "0.02 + 0.1*x".parse().unwrap();
    let base = with_base(&window, FormulaLayer { quantity: Quantity::Diameter, formula }.into());
    set(&mut window, base);
    select_base(&mut window);
    send(&mut window, Command::from(LayerCommand::ExportGrid(path.clone())));
    wait_for_jobs(&mut window);
    let said = "what the layer “Base” asks for. 1,024 × 1,024 cells of 0.0009766.";
    assert!(notice(&window).ends_with(said), "{}", notice(&window));
    let (header, rows) = parsed(&std::fs::read_to_string(path).unwrap());
    let of = |name: &str| header.iter().find(|(other, _)| other == name).expect("in the header").1;
    assert_eq!((of("ncols"), of("nrows"), rows.len()), (1024.0, 1024.0, 1024));
    for (row, column) in [(0, 0), (1023, 1023), (300, 700)] {
        let x = of("xllcorner") + (f64::from(column) + 0.5) * of("cellsize");
        let asked = rows[row][column as usize];
        assert!((asked - (0.02 + 0.1 * x)).abs() < 1e-6, "{asked} at x = {x}");
    }
}

//! Actions on a queried triangle: its neighbours, copying, and the menu of the canvas.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, OutputCommand, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use crate::app::features::inspection::{InspectCommand, QUERY};
use crate::app::features::painting::BRUSH;
use crate::app::tests::{
    FREE, TALL, Window, click, entries, key, notice, on_screen, open_section, press_at, release_at, selected,
    send, settings, window, window_of,
};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_mesh::mesh::TriangleId;

fn neighbour(window: &Window, id: TriangleId, place: usize) -> Option<TriangleId> {
    window.state().session().mesh().neighbours(id)[place].triangle()
}

/// Returns the text that the last frames put on the clipboard.
fn copied(window: &Window) -> String {
    let commands = &window.output().platform_output.commands;
    let mut texts = commands.iter().filter_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    texts.next_back().unwrap_or_default()
}

/// Runs single frames until something was copied.
fn copied_soon(window: &mut Window) -> String {
    for _ in 0..6 {
        window.step();
        if !copied(window).is_empty() {
            return copied(window);
        }
    }
    String::new()
}

fn right_click(window: &mut Window, world: glam::DVec2) {
    let at = on_screen(window, world);
    press_at(window, at, PointerButton::Secondary, Modifiers::NONE);
    release_at(window, at, PointerButton::Secondary);
}

/// Clicks an entry of the menu; a tool of the strip at the left may have the same name.
fn choose_here(window: &mut Window, entry: &str) {
    let named = window.get_all_by_role_and_label(Role::Button, entry);
    named.max_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap().click();
    window.run();
}

#[test]
fn the_keys_1_2_3_go_to_the_neighbours_with_the_query_tool_only() {
    let mut window = window_of(TALL);
    key(&mut window, Modifiers::NONE, Key::Q);
    let point = dvec2(0.71, 0.735);
    for (place, digit) in [Key::Num1, Key::Num2, Key::Num3].into_iter().enumerate() {
        click(&mut window, point, Modifiers::NONE);
        let start = selected(&window).unwrap();
        let there = neighbour(&window, start, place);
        key(&mut window, Modifiers::NONE, digit);
        assert_eq!(selected(&window), there, "neighbour {}", place + 1);
    }
    let strength = window.state().tools().paint_strength;
    let here = selected(&window);
    key(&mut window, Modifiers::NONE, Key::Num5);
    assert_eq!(window.state().tools().paint_strength, strength, "digits belong to the query tool");
    key(&mut window, Modifiers::NONE, Key::B);
    key(&mut window, Modifiers::NONE, Key::Num1);
    assert_eq!(window.state().tools().paint_strength, 0.1);
    assert_eq!(selected(&window), here, "with the brush a digit is the strength");
}

#[test]
fn a_key_of_a_neighbour_beyond_the_boundary_says_that_there_is_none() {
    let mut window = window_of(TALL);
    let mesh = window.state().session().mesh();
    let id = mesh.locate(dvec2(0.02, 0.99)).triangle().unwrap();
    let missing = mesh.neighbours(id).iter().position(|n| n.triangle().is_none()).unwrap();
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    send(&mut window, Command::from(InspectCommand::QueryTriangle(id)));
    key(&mut window, Modifiers::NONE, [Key::Num1, Key::Num2, Key::Num3][missing]);
    assert_eq!(selected(&window), Some(id));
    assert!(notice(&window).contains("on the boundary"), "{}", notice(&window));
}

#[test]
fn a_click_on_a_value_copies_all_of_its_digits() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    send(&mut window, Command::from(InspectCommand::Query(dvec2(0.123456789, 0.7))));
    window.get_by_role_and_label(Role::Definition, "Point").click();
    assert_eq!(copied_soon(&mut window), "0.123456789, 0.7");
    window.run();
    let diameter = window.state().session().view().diameter(selected(&window).unwrap());
    window.get_by_role_and_label(Role::Definition, "Diameter").click();
    assert_eq!(copied_soon(&mut window).parse(), Ok(diameter));
}

#[test]
fn ctrl_c_copies_every_value_in_full() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    send(&mut window, Command::from(InspectCommand::Query(dvec2(0.123456789, 0.7))));
    window.event(eframe::egui::Event::Copy);
    let text = copied_soon(&mut window);
    let id = selected(&window).unwrap();
    let value = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(&format!("{name}: ")));
        line.unwrap_or_else(|| panic!("no {name} in {text}")).to_owned()
    };
    assert_eq!(value("Triangle"), id.index().to_string());
    assert_eq!(value("Point"), "0.123456789, 0.7");
    let there = neighbour(&window, id, 0).unwrap();
    assert_eq!(value("Bisection neighbour"), there.index().to_string());
    let readout = window.state().session().readout(window.state().view().quantity).unwrap();
    let triangle = readout.triangle.unwrap();
    assert_eq!(value("True").parse(), Ok(triangle.exact));
    let [a, b, c] = triangle.at_vertices;
    assert_eq!(value("At v₁ v₂ v₃"), format!("{a}, {b}, {c}"));
    // The layer that decides, and what each layer asks for.
    let layers = settings(&window).layers.len();
    assert_eq!(text.lines().count(), 15 + 1 + layers, "{text}");
}

#[test]
fn vertices_and_weights_are_in_the_order_of_files() {
    let mut window = window_of(TALL);
    for point in [dvec2(0.12, 0.7), dvec2(0.31, 0.44), dvec2(0.71, 0.735), dvec2(0.9, 0.13)] {
        send(&mut window, Command::from(InspectCommand::Query(point)));
        let session = window.state().session();
        let triangle = session.readout(window.state().view().quantity).unwrap().triangle.unwrap();
        let cleaning = session.document().settings().derived_cleaning();
        let targets = session.follower().edge_targets(session.document().paint());
        let derived = DerivedMesh::new(session.mesh(), session.follower().domain(), targets, &cleaning);
        let cell = derived.extract(session.mesh()).cell(triangle.id);
        assert_eq!(triangle.vertices.map(|(node, _)| node.index()), cell.corners);
        let weighted = (0..3).map(|i| triangle.zeta[i] * triangle.vertices[i].1).sum::<glam::DVec2>();
        assert!(weighted.distance(point) < 1e-9, "each weight belongs to its vertex: {weighted}");
    }
}

#[test]
fn a_query_opens_the_section_and_scrolls_to_it() {
    let mut window = window();
    open_section(&mut window, "Triangle");
    // It may be scrolled out of sight.
    window.get_by_role_and_label(Role::Button, "Triangle").click_accesskit();
    window.run();
    assert!(window.query_by_label_contains("No query yet").is_none(), "the section is closed");
    // With the brush the section is far down, and the menu of the canvas queries.
    right_click(&mut window, FREE);
    choose_here(&mut window, "Query here");
    window.run();
    let row = window.get_by_role_and_label(Role::Definition, "Diameter").rect();
    assert!(row.top() > 0.0 && row.bottom() < 900.0, "{row:?}");
    assert!(window.state().tools().tool == &BRUSH);
}

#[test]
fn the_menu_of_the_canvas_acts_where_it_was_opened() {
    let mut window = window_of(TALL);
    let before = entries(&window);
    right_click(&mut window, FREE);
    assert_eq!(entries(&window), before, "it begins no stroke");
    choose_here(&mut window, "Copy the coordinates");
    assert!(notice(&window).starts_with("Copied: 0.900"), "{}", notice(&window));
    right_click(&mut window, FREE);
    choose_here(&mut window, "Centre here");
    let middle = crate::app::tests::canvas(&window).center();
    assert!(on_screen(&window, FREE).distance(middle) < 1.0);
    right_click(&mut window, FREE);
    choose_here(&mut window, "Go to… from here");
    let typed = window.get_by_role_and_label(Role::TextInput, "Place").value().unwrap();
    assert!(typed.starts_with("0.900"), "{typed}");
    key(&mut window, Modifiers::NONE, Key::Escape);
    right_click(&mut window, FREE);
    choose_here(&mut window, "Fit domain");
    assert!(window.state().view().is_fitted);
    assert_eq!(entries(&window), before);
}

#[test]
fn a_click_beside_the_menu_only_closes_it() {
    let mut window = window_of(TALL);
    let before = entries(&window);
    right_click(&mut window, FREE);
    assert!(window.query_by_label("Query here").is_some());
    click(&mut window, dvec2(0.2, 0.2), Modifiers::NONE);
    assert!(window.query_by_label("Query here").is_none());
    assert_eq!(entries(&window), before, "the click painted nothing");
    click(&mut window, dvec2(0.2, 0.2), Modifiers::NONE);
    assert_eq!(entries(&window), before + 1, "the next click paints");
    right_click(&mut window, FREE);
    choose_here(&mut window, "Straight line to here");
    assert_eq!(entries(&window), before + 2);
    assert!(settings(&window).background.is_none());
}

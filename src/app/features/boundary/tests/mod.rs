//! Naming, splitting and joining pieces of the boundary, and setting their types.

mod opening;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Vec2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use crate::app::tests::{
    Window, canvas, click, entries, fingerprint, key, on_screen, painted_texts, send, settings, show,
    type_into, wait_until, window_of,
};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryPieces, BoundaryType, Domain};

const SIZE: Vec2 = vec2(1440.0, 2000.0);

/// Returns a window on a square sea with a square island, with the boundary tool in hand.
fn window_on_a_sea() -> Window {
    let square =
        |half: f64| [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| dvec2(x, y));
    let sea = Domain::of_polygons(&[vec![square(1.0).to_vec(), square(0.3).to_vec()]]).unwrap();
    let mut window = window_of(SIZE);
    send(&mut window, show(Settings::for_domain("sea".into(), sea)));
    key(&mut window, Modifiers::NONE, Key::N);
    wait_until(&mut window, |window| window.state().session().boundary_pieces().is_some());
    window
}

#[test]
fn names_of_pieces_are_beside_their_middles() {
    let window = window_on_a_sea();
    let texts = painted_texts(window.output());
    let pieces = window.state().session().boundary_pieces().unwrap();
    let canvas = canvas(&window);
    for piece in pieces.list() {
        let at = on_screen(&window, piece.middle());
        let mut named =
            texts.iter().filter(|(text, rect)| *text == piece.name && canvas.contains_rect(*rect));
        let near = named.any(|(_, rect)| rect.expand(60.0).contains(at));
        assert!(near, "{} is not beside {at}: {texts:?}", piece.name);
    }
}

fn names(window: &Window) -> Vec<String> {
    let Settings { domain, boundary_marks, .. } = settings(window);
    let pieces = BoundaryPieces::of_domain(domain, boundary_marks).unwrap();
    pieces.list().iter().map(|piece| piece.name.clone()).collect()
}

#[test]
fn a_piece_is_clicked_named_and_the_name_undone() {
    let mut window = window_on_a_sea();
    let mesh = fingerprint(&window);
    assert_eq!(names(&window), ["open south", "open east", "open north", "open west", "island 1"]);
    assert!(window.query_by_label("Name").is_none(), "no piece is selected yet");
    click(&mut window, dvec2(0.31, 0.05), Modifiers::NONE);
    type_into(&mut window, "Name", "Rock");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!((names(&window)[4].as_str(), entries(&window)), ("Rock", 1));
    assert_eq!(fingerprint(&window), mesh);
    window.get_by_role_and_label(Role::Button, "Rock");
    // A piece of the list.
    window.get_by_role_and_label(Role::Button, "open west").click();
    window.run();
    type_into(&mut window, "Name", "Inflow");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!((names(&window)[3].as_str(), entries(&window)), ("Inflow", 2));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((names(&window)[3].as_str(), names(&window)[4].as_str()), ("open west", "island 1"));
}

#[test]
fn the_type_of_a_piece_is_chosen_split_undone_and_taken_back() {
    let mut window = window_on_a_sea();
    let mesh = fingerprint(&window);
    let types = |window: &Window| {
        let Settings { domain, boundary_marks, .. } = settings(window);
        let pieces = BoundaryPieces::of_domain(domain, boundary_marks).unwrap();
        pieces.list().iter().map(|piece| piece.set_type).collect::<Vec<_>>()
    };
    let choose = |window: &mut Window, choice: &str| {
        window.get_by_role_and_label(Role::ComboBox, "Type").click();
        window.run();
        window.get_by_label(choice).click();
        window.run();
    };
    assert!(window.query_by_label("Type").is_none(), "no piece is selected yet");
    click(&mut window, dvec2(0.2, -1.0), Modifiers::NONE);
    choose(&mut window, "natural inflow");
    let inflow = Some(BoundaryType::NaturalInflow);
    assert_eq!((types(&window), entries(&window)), (vec![inflow, None, None, None, None], 1));
    assert_eq!(fingerprint(&window), mesh);
    key(&mut window, Modifiers::NONE, Key::S);
    click(&mut window, dvec2(0.5, -1.0), Modifiers::NONE);
    assert_eq!(types(&window)[..3], [inflow, inflow, None], "both parts have the type");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    choose(&mut window, "default (open)");
    assert_eq!(types(&window), [None; 5]);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(types(&window)[0], inflow);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((types(&window)[0], entries(&window)), (None, 0));
}

#[test]
fn a_side_is_split_by_a_click_and_joined_again() {
    let mut window = window_on_a_sea();
    key(&mut window, Modifiers::NONE, Key::S);
    click(&mut window, dvec2(0.2, -1.0), Modifiers::NONE);
    assert_eq!(names(&window)[..2], ["open south part 1", "open south part 2"]);
    assert_eq!(entries(&window), 1);
    click(&mut window, dvec2(0.7, 0.6), Modifiers::NONE);
    assert_eq!(entries(&window), 1, "a click far from the boundary splits nothing");
    // A ring takes two clicks.
    click(&mut window, dvec2(0.3, 0.1), Modifiers::NONE);
    click(&mut window, dvec2(-0.3, 0.1), Modifiers::NONE);
    assert_eq!(names(&window)[5..], ["island 1 part 1", "island 1 part 2"]);
    key(&mut window, Modifiers::NONE, Key::S);
    click(&mut window, dvec2(-0.5, -1.0), Modifiers::NONE);
    window.get_by_role_and_label(Role::Button, "Join with next").click();
    window.run();
    assert_eq!(names(&window)[..2], ["open south", "open east"]);
    assert_eq!(entries(&window), 4);
}

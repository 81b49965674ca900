//! The query tool and the inspector.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use crate::app::features::inspection::{InspectCommand, QUERY};
use crate::app::tests::{
    FREE, RESTING_PLACE, TALL, button_event, click, entries, key, on_screen, open_tab, selected, send,
    value_of, window, window_of,
};
use meshbrush_core::document::Example;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand};
use meshbrush_mesh::mesh::{Location, NodeId};

#[test]
fn a_click_shows_the_triangle_and_each_chip_goes_to_its_neighbour() {
    let mut window = window_of(TALL);
    key(&mut window, Modifiers::NONE, Key::Q);
    assert!(window.query_by_label_contains("No query yet").is_some());
    click(&mut window, dvec2(0.71, 0.735), Modifiers::NONE);
    let mesh = window.state().session().mesh();
    let expected = mesh.locate(dvec2(0.71, 0.735)).triangle().unwrap();
    let start = selected(&window).expect("a triangle under the pointer");
    assert_eq!(start, expected);
    let level = mesh.triangle(start).level();
    let shown = value_of(&window, Role::Definition, "Level · orientation");
    assert!(shown.starts_with(&format!("{level} · ")), "{shown}");
    assert_eq!(entries(&window), 0, "a question is no edit");

    for (i, name) in ["Bisection neighbour", "Second neighbour", "Third neighbour"].iter().enumerate() {
        send(&mut window, Command::from(InspectCommand::QueryTriangle(start)));
        let there = window.state().session().mesh().neighbours(start)[i].triangle().unwrap();
        window.get_by_role_and_label(Role::Button, name).click();
        window.run();
        assert_eq!(selected(&window), Some(there), "{name}");
    }
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(selected(&window), None, "Escape lets go");
    assert!(window.query_by_label_contains("No query yet").is_some());
}

#[test]
fn a_key_and_a_click_in_one_slow_frame_are_a_query() {
    let mut window = window();
    let clicked = on_screen(&window, FREE);
    let q = |pressed| Event::Key {
        key: Key::Q,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let click = |pressed| button_event(clicked, PointerButton::Primary, pressed, Modifiers::NONE);
    window.input_mut().events.extend([
        q(true),
        q(false),
        Event::PointerMoved(clicked),
        click(true),
        click(false),
        Event::PointerMoved(RESTING_PLACE),
    ]);
    window.run();
    let expected = window.state().session().mesh().locate(FREE).triangle();
    assert_eq!(selected(&window), expected, "the click used the tool that the key selected");
    assert_eq!(entries(&window), 0, "nothing was painted");
}

#[test]
fn the_inspector_counts_as_files_do() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    send(&mut window, Command::from(InspectCommand::Query(dvec2(25.25, 38.1))));
    window.run();
    // What files get, derived here again.
    let session = window.state().session();
    let follower = session.follower();
    let targets = follower.edge_targets(session.document().paint());
    let cleaning = follower.settings().derived_cleaning();
    let derived = DerivedMesh::new(follower.mesh(), follower.domain(), targets, &cleaning);
    let extract = derived.extract(follower.mesh());
    let id = selected(&window).expect("a triangle of the sea");
    assert!(
        follower.mesh().locate(dvec2(25.25, 38.1)).triangle().is_some_and(|raw| raw != id),
        "land comes first"
    );
    let shown = |number: usize| meshbrush_ui::widgets::format::count(number as u64);
    window.get_by_role_and_label(Role::Button, &format!("Triangle {}", shown(id.index())));
    for (node, subscript) in extract.cell(id).corners.into_iter().zip(["₁", "₂", "₃"]) {
        let row = value_of(&window, Role::Definition, &format!("v{subscript} · {}", shown(node)));
        let corner = extract.world(NodeId::from_index(node));
        assert!(row.starts_with(&format!("{:.2}", corner.x)), "{row} at {corner}");
    }
    let chips = extract.triangles()[id.index()].raw_neighbours.map(|n| shown(n.triangle().unwrap().index()));
    for (name, number) in ["Bisection neighbour", "Second neighbour", "Third neighbour"].iter().zip(chips) {
        assert_eq!(value_of(&window, Role::Button, name), number, "{name}");
    }
}

#[test]
fn a_click_outside_the_domain_says_so() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::Q);
    click(&mut window, dvec2(-0.1, 0.5), Modifiers::NONE);
    let readout = window.state().session().readout(window.state().view().quantity).unwrap();
    assert_eq!(readout.triangle, None);
    assert_eq!(readout.location, Location::OutsideBounds);
    assert!(window.query_by_label_contains("No triangle here").is_some());
}

#[test]
fn a_chip_at_the_edge_of_the_domain_goes_nowhere() {
    let mut window = window_of(TALL);
    let mesh = window.state().session().mesh();
    let id = mesh.locate(dvec2(0.02, 0.99)).triangle().unwrap();
    let missing = mesh.neighbours(id).iter().position(|n| n.triangle().is_none()).unwrap();
    send(&mut window, Command::from(InspectCommand::QueryTriangle(id)));
    open_tab(&mut window, Tab::Inspect);
    let name = ["Bisection neighbour", "Second neighbour", "Third neighbour"][missing];
    let chip = window.get_by_role_and_label(Role::Button, name);

    assert!(chip.accesskit_node().is_disabled());
    chip.click();
    window.run();
    assert_eq!(selected(&window), Some(id));
}

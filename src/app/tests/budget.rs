//! The price of a dab, budgets, and the messages about them.

use std::collections::BTreeSet;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use super::{
    FREE, TALL, Window, canvas, click, entries, fingerprint, hover, key, notice, open_section, press,
    price_tag, release, send, set, settings, stroke, triangles, type_into, window, window_of,
};
use crate::app::features::domain::DOMAIN;
use crate::app::features::inspection::QUERY;
use crate::app::features::painting::{BRUSH, ERASER};
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::field::RefinementRule;
use meshbrush_kit::kit::command::{BrushCommand, Command, EditCommand, ShellCommand};
use meshbrush_kit::kit::tools::PAN;
use meshbrush_mesh::mesh::MemoryLimit;

/// Returns the number on the tag for a dab at a place, and what a click there then does to the number of
/// triangles.
fn shown_and_actual(window: &mut Window, world: DVec2) -> (String, i64) {
    let message = hover(window, world).expect("a tag beside the ring");
    let before = triangles(window) as i64;
    click(window, world, Modifiers::NONE);
    (message, triangles(window) as i64 - before)
}

fn as_shown(change: i64) -> String {
    match change {
        0 => "no change".into(),
        _ => format!("{} triangles", meshbrush_ui::widgets::format::change(change)),
    }
}

#[test]
fn the_brush_shows_its_price_before_the_click_and_the_price_is_true() {
    let mut window = window();
    let (version, count) = (window.state().session().document().version(), triangles(&window));
    assert_eq!(price_tag(&window), None, "the pointer is not on the canvas");
    assert!(hover(&mut window, FREE).unwrap().starts_with('+'));
    let session = window.state().session();
    assert_eq!(
        (session.document().version(), triangles(&window)),
        (version, count),
        "hovering changes nothing"
    );
    let mut seen = BTreeSet::new();
    for tool in [&BRUSH, &ERASER] {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        for place in [FREE, FREE - dvec2(0.03, 0.02), dvec2(0.02, 0.97), FREE] {
            let (message, change) = shown_and_actual(&mut window, place);
            assert_eq!(message, as_shown(change), "{tool:?} at {place}");
            seen.insert(change.signum());
        }
    }
    assert_eq!(seen.into_iter().collect::<Vec<_>>(), [-1, 1]);
    // Beside the domain.
    assert_eq!(shown_and_actual(&mut window, dvec2(1.09, 0.5)), ("no change: outside the domain".into(), 0));
}

#[test]
fn the_price_is_asked_only_where_a_click_paints_a_dab() {
    let mut window = window();
    assert!(hover(&mut window, FREE).is_some());
    for tool in [&QUERY, &DOMAIN, &PAN] {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        assert_eq!(price_tag(&window), None, "{tool:?}");
    }
    send(&mut window, Command::from(ShellCommand::Use(&BRUSH)));
    assert!(price_tag(&window).is_some());
    window.event(Event::ModifiersChanged(Modifiers::ALT));
    window.run();
    assert_eq!(price_tag(&window), None, "a click picks");
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    press(&mut window, FREE, Modifiers::NONE);
    assert_eq!(price_tag(&window), None, "during a stroke");
    release(&mut window, FREE);
    assert!(price_tag(&window).is_some());
    set(&mut window, Setting::RefinementRule(RefinementRule::Vertex));
    assert!(price_tag(&window).is_some(), "counted in the mesh that the click would make");
    set(&mut window, Setting::RefinementRule(RefinementRule::Area));
    // A larger brush costs more, with the pointer where it is.
    let small = price_tag(&window).unwrap();
    send(&mut window, Command::from(BrushCommand::Scale(2.0)));
    assert_ne!(price_tag(&window).unwrap(), small);
}

#[test]
fn a_price_past_the_budget_says_so() {
    let mut window = window();
    let count = triangles(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    let tag = hover(&mut window, FREE).unwrap();
    assert!(tag.starts_with('+') && tag.ends_with(" triangles, over the budget"), "{tag}");
    send(&mut window, Command::from(ShellCommand::Use(&ERASER)));
    assert!(!price_tag(&window).unwrap().contains("budget"));
}

#[test]
fn the_budgets_are_typed_in_the_panel_and_what_is_too_small_is_told() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    type_into(&mut window, "Memory budget", "0.5");
    assert_eq!(settings(&window).max_memory, 500_000_000);
    type_into(&mut window, "Triangle budget", "1.5M");
    assert_eq!(settings(&window).max_triangles, 1_500_000);
    let count = triangles(&window);
    // Room for fewer triangles than there are.
    type_into(&mut window, "Memory budget", "0.001");
    assert!(notice(&window).contains("1 MB of memory"), "{}", notice(&window));
    assert_eq!((settings(&window).max_memory, triangles(&window)), (500_000_000, count));
    set(&mut window, Setting::MaxMemory(MemoryLimit::TWO_MESHES * (count + 100)));
    let tag = hover(&mut window, FREE).unwrap();
    assert!(tag.ends_with("over the budget"), "{tag}");
}

#[test]
fn past_the_budget_the_message_says_so_and_undo_brings_the_mesh_back() {
    let mut window = window();
    set(&mut window, Setting::MaxTriangles(60_000));
    let before = (fingerprint(&window), settings(&window).clone());
    set(&mut window, Setting::DiameterAtRiskOne(0.0005));
    assert!(notice(&window).contains("60000") || notice(&window).contains("60,000"), "{}", notice(&window));
    assert_eq!((fingerprint(&window), settings(&window).clone()), before);

    let count = triangles(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    let before = fingerprint(&window);
    // A stroke goes as far as the budget does, and is taken back whole.
    stroke(&mut window, FREE, FREE);
    assert!(notice(&window).contains("limit"), "{}", notice(&window));
    assert!((count..=count + 100).contains(&triangles(&window)), "{}", triangles(&window));
    assert_eq!(window.state().session().mesh().violations(), []);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
}

#[test]
fn a_message_is_dismissed_by_its_cross_and_nothing_is_painted_under_it() {
    let mut window = window();
    send(&mut window, Command::from(EditCommand::CancelUpdate));
    assert_eq!(notice(&window), "", "there is no update to cancel");
    send(&mut window, Command::from(ShellCommand::Report("It failed.".into())));
    let (before, version) = (fingerprint(&window), window.state().session().document().version());
    window.get_by_label("Dismiss").click();
    window.run();
    assert_eq!(notice(&window), "");
    assert_eq!((fingerprint(&window), window.state().session().document().version()), (before, version));
    assert_eq!(entries(&window), 0);
}

#[test]
fn while_the_mesh_stops_short_of_the_paint_a_message_says_so_and_stays() {
    let mut window = window();
    let count = triangles(&window);
    let whole = fingerprint(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    stroke(&mut window, FREE, FREE);
    let standing = notice(&window);
    assert!(standing.contains("what you painted is kept") && standing.contains("undo"), "{standing}");
    assert!(window.get_by_role(Role::Alert).accesskit_node().label().is_some_and(|label| label == standing));
    // Neither Escape nor what works elsewhere takes it away, and there is no cross.
    key(&mut window, Modifiers::NONE, Key::Escape);
    set(&mut window, Setting::MaxTriangles(count + 110));
    assert!(notice(&window).contains("what you painted is kept"), "{}", notice(&window));
    assert!(window.query_by_label("Dismiss").is_none());
    assert_eq!(price_tag(&window), None, "no price while the mesh is not up to date");
    assert!(window.query_by_label_contains("Refining").is_none(), "no work continues");
    // A larger budget does, and the work continues by itself.
    set(&mut window, Setting::MaxTriangles(Settings::MAX_TRIANGLES));
    assert_eq!(notice(&window), "");
    assert!(triangles(&window) > count + 110);
    // Undo leads back to the small budget; it takes no other entry with it.
    let entries_before = entries(&window);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(notice(&window).ends_with("the former mesh is shown."), "{}", notice(&window));
    assert_eq!((entries(&window), settings(&window).max_triangles), (entries_before - 1, count + 110));
    // The button undoes the second budget, which does not help, and then the stroke, which does.
    for _ in 0..2 {
        window.get_by_role_and_label(Role::Alert, &notice(&window));
        let on_canvas = canvas(&window);
        let buttons: Vec<_> = window.get_all_by_role_and_label(Role::Button, "Undo").collect();
        buttons.iter().find(|button| on_canvas.contains_rect(button.rect())).expect("in the banner").click();
        drop(buttons);
        window.run();
    }
    assert_eq!((notice(&window), fingerprint(&window)), (String::new(), whole));
    assert_eq!(settings(&window).max_triangles, count + 100);
}

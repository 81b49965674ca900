//! What the command palette finds, and the places in the panels that it puts in sight.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{Window, canvas, key, window, window_of};
use crate::app::catalog::{PLACES, catalog, synonym_starts, words_of};
use crate::app::panels;
use meshbrush_render::render::export::ExportFormat;

/// Types into the palette, and returns the titles that it lists.
fn found(window: &mut Window, query: &str) -> Vec<String> {
    key(window, Modifiers::COMMAND, Key::P);
    window.event(Event::Text(query.into()));
    window.run();
    let rows = window.query_all_by_role(Role::MenuItem);
    rows.filter_map(|node| node.accesskit_node().label()).collect()
}

fn close(window: &mut Window) {
    key(window, Modifiers::NONE, Key::Escape);
}

#[test]
fn commands_are_found_by_words_in_any_order_and_by_other_words() {
    let mut window = window();
    for (query, title) in [
        ("overlay none", "No overlay"),
        ("none overlay", "No overlay"),
        ("export svg", "Export mesh…"),
        ("svg export", "Export mesh…"),
        ("certificate", "Path › Prove within"),
        ("isolate", "Show only the level of the triangle"),
        ("isolate", "Panel Levels"),
        ("spacing", "Mesh › Spacing δ"),
        ("open table", "Open table of threats…"),
        ("table pins", "Copy the table of pins"),
        ("dem", "Add data…"),
        ("cfl", "Panel Quality"),
        ("courant", "Panel Quality"),
        ("time step", "Panel Quality"),
        ("aspect ratio", "Quality › Edge ratio"),
        ("skewness", "Quality › Smallest angle"),
        ("skewness", "Quality › Largest angle"),
        ("bad elements", "Panel Quality"),
        ("slivers", "Quality › Smallest angle"),
        ("slivers", "Overlay smallest angle"),
        ("valence", "Panel Quality"),
        ("narrowest", "Panel Quality"),
        ("widest", "Quality › Largest angle"),
        ("cfl", "Overlay time step"),
        ("budget", "Budgets › Triangle budget"),
        ("ram", "Budgets › Memory budget"),
        ("mesh panel", "Panel Mesh"),
    ] {
        let titles = found(&mut window, query);
        assert!(titles.iter().any(|found| found == title), "{query}: {titles:?}");
        close(&mut window);
    }
    assert_eq!(found(&mut window, "zzzz"), [""; 0]);
}

#[test]
fn titles_come_before_other_words_for_them() {
    let mut window = window();
    assert_eq!(found(&mut window, "undo")[0], "Undo");
    close(&mut window);
    assert_eq!(found(&mut window, "spacing")[0], "Mesh › Spacing δ");
}

#[test]
fn every_place_in_the_panels_is_put_in_sight() {
    for place in PLACES {
        let mut window = window_of(vec2(1280.0, 720.0));
        assert!(panels::all().any(|panel| panel.name == place.panel), "{}", place.panel);
        found(&mut window, &place.title());
        key(&mut window, Modifiers::NONE, Key::Enter);
        let canvas = canvas(&window);
        let is_in_sight = |node: &egui_kittest::Node<'_>| {
            let at = node.rect().center();
            canvas.right() < at.x && (36.0..canvas.bottom()).contains(&at.y)
        };
        // Without a path there is nothing to prove, and the section says how to find one.
        let is_hidden = place.control.is_empty() || place.control == "Prove within";
        let name = if is_hidden { place.section } else { place.control };
        let nodes: Vec<_> = window.query_all_by_label(name).collect();
        assert!(nodes.iter().any(is_in_sight), "{}: {:?}", place.title(), nodes.len());
    }
}

#[test]
fn every_other_word_belongs_to_a_command() {
    let window = window();
    let catalog = catalog(&window.state().state(None));
    for start in synonym_starts() {
        assert!(catalog.iter().any(|item| item.title.starts_with(start)), "no command begins with {start}");
    }
    for ending in ExportFormat::endings() {
        assert!(words_of("Export mesh…").contains(ending), "{ending} is not found");
    }
}

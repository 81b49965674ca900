//! Menus, the command palette, dialogs.

use std::collections::BTreeSet;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, pos2, vec2};
use egui_kittest::kittest::{By, NodeT as _, Queryable as _};

use super::{
    FREE, Window, choose, click, key, open_menu, painted_texts, selected, value_of, wheel, window, window_of,
};
use crate::app::catalog::PLACES;
use crate::app::features::inspection::QUERY;
use meshbrush_kit::kit::Submenu;

#[test]
fn the_palette_finds_and_runs_a_command() {
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::P);
    window.event(Event::Text("quer".into()));
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(window.state().tools().tool, &QUERY);
    assert!(window.query_by_label("Command").is_none(), "it closes");
    key(&mut window, Modifiers::COMMAND, Key::P);
    assert!(window.query_by_label("Command").is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label("Command").is_none());
}

#[test]
fn alt_and_a_letter_open_a_menu_and_arrows_lead_into_it() {
    let mut window = window();
    for (letter, entry) in
        [(Key::F, "New…"), (Key::V, "Zoom in"), (Key::L, "Delete layer"), (Key::X, "Aegean")]
    {
        key(&mut window, Modifiers::ALT, letter);
        assert!(window.query_all_by_label_contains(entry).next().is_some(), "{letter:?} shows {entry}");
        key(&mut window, Modifiers::NONE, Key::ArrowDown);
        let focused = window.query_all(By::new()).find(|node| node.accesskit_node().is_focused());
        let focused = focused.and_then(|node| node.accesskit_node().label()).expect("a focused entry");
        assert!(!["File", "View", "Layer", "Examples"].contains(&&*focused), "{letter:?} leads to {focused}");
        key(&mut window, Modifiers::NONE, Key::Escape);
    }
}

#[test]
fn a_menu_within_a_menu_has_every_kind_of_layer_and_every_overlay() {
    let mut window = window();
    for (menu, within, entries) in [
        ("Layer", "Add layer", ["paint, as risk", "distance to the outline"]),
        ("View", "Overlay", ["slack", "deciding layer"]),
    ] {
        open_menu(&mut window, menu);
        let buttons = window.get_all_by_role_and_label(Role::Button, within);
        buttons.min_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap().click();
        window.run();
        for entry in entries {
            let shown = window.query_all_by_label_contains(entry).next();
            assert!(shown.is_some(), "{menu}, {within} has {entry}");
        }
        key(&mut window, Modifiers::NONE, Key::Escape);
        key(&mut window, Modifiers::NONE, Key::Escape);
    }
}

#[test]
fn every_entry_of_a_menu_is_one_line() {
    let mut window = window();
    open_menu(&mut window, "Tool");
    let height = |window: &Window, entry: &str| {
        window.query_all_by_label_contains(entry).next().unwrap().rect().height()
    };
    assert_eq!(height(&window, "Straight line from"), height(&window, "Larger brush"));
}

#[test]
fn a_long_menu_scrolls_in_a_small_window() {
    let mut window = window_of(vec2(900.0, 400.0));
    open_menu(&mut window, "Tool");
    let bottom = |window: &Window| {
        let last = window.query_all_by_label_contains("Size of the brush").next();
        last.map_or(f32::INFINITY, |entry| entry.rect().bottom())
    };
    assert!(bottom(&window) > 400.0);
    wheel(&mut window, pos2(240.0, 300.0), -2000.0);
    assert!(bottom(&window) < 400.0, "{}", bottom(&window));
}

#[test]
fn every_entry_of_a_menu_is_in_the_palette() {
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::P);
    let mut palette: BTreeSet<String> = labels(&window, Role::MenuItem);
    // Places in the panels are only in the palette.
    palette.retain(|title| PLACES.iter().all(|place| place.title() != *title));
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(palette.len() > 40, "{palette:?}");
    let at_rest = labels(&window, Role::Button);
    let mut menus = BTreeSet::new();
    for menu in ["File", "Edit", "Tool", "Layer", "View", "Examples", "Method", "Help"] {
        open_menu(&mut window, menu);
        let entries: Vec<_> = labels(&window, Role::Button).difference(&at_rest).cloned().collect();
        assert!(!entries.is_empty(), "{menu} is empty");
        menus.extend(entries);
        key(&mut window, Modifiers::NONE, Key::Escape);
        assert_eq!(labels(&window, Role::Button), at_rest, "Escape closes {menu}");
    }
    // The label of an entry ends with its key.
    let names = |entry: &str, title: &str| entry == title || entry.starts_with(&format!("{title} "));
    let is_submenu = |entry: &&String| Submenu::ALL.iter().any(|submenu| entry.starts_with(submenu.title()));
    let unknown: Vec<_> = menus
        .iter()
        .filter(|entry| !is_submenu(entry) && !palette.iter().any(|title| names(entry, title)))
        .collect();
    assert!(unknown.is_empty(), "not in the palette: {unknown:?}");
    for entry in
        ["Undo Ctrl+Z", "Redo Ctrl+Shift+Z", "Larger brush I", "Delete layer Shift+Delete", "Fit domain Home"]
    {
        assert!(menus.contains(entry), "{entry} is not shown with its key");
    }
}

fn labels(window: &Window, role: Role) -> BTreeSet<String> {
    window.get_all_by_role(role).filter_map(|node| node.accesskit_node().label()).collect()
}

#[test]
fn escape_closes_what_is_open_first() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::Q);
    click(&mut window, FREE, Modifiers::NONE);
    choose(&mut window, "Help", "About Meshbrush");
    assert!(window.query_by_label_contains("Maubach").is_some());
    key(&mut window, Modifiers::NONE, Key::B);
    assert_eq!(window.state().tools().tool, &QUERY, "a dialog keeps the keys");
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label_contains("Maubach").is_none());
    assert!(selected(&window).is_some(), "the queried triangle is let go by the next Escape");
}

#[test]
fn letters_typed_at_once_with_the_key_of_a_dialog_arrive_and_are_seen() {
    for (opens, name) in [(Key::P, "Command"), (Key::G, "Place")] {
        // Letters that arrive in the frame of the key, and in those after it.
        for frames in
            [["over", "", ""], ["", "over", ""], ["o", "v", "er"], ["", "ov", "er"], ["", "", "over"]]
        {
            let mut window = window();
            window.input_mut().events.push(pressed(opens, Modifiers::COMMAND));
            for letters in frames {
                // A slow window gets several events in one frame.
                let typed = letters.chars().map(|letter| Event::Text(letter.into()));
                window.input_mut().events.extend(typed);
                window.step();
            }
            let value = value_of(&window, Role::TextInput, name);
            assert_eq!(value, "over", "{name} {frames:?}");
            assert!(is_painted(&window, "over"), "{name} {frames:?}: it is not painted in this frame");
        }
    }
}

fn pressed(key: Key, modifiers: Modifiers) -> Event {
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
}

/// Returns whether this text was painted in the last frame.
fn is_painted(window: &Window, text: &str) -> bool {
    painted_texts(window.output()).iter().any(|(painted, _)| painted == text)
}

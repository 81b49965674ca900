//! The order in which a screen reader reads the window, as a text: a change of it is seen in the comparison
//! of two versions.

use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::vec2;
use egui_kittest::kittest::{AccessKitNode, By, NodeT as _, Queryable as _};

use super::{Window, window_of};

/// The text of the window as it opens, at 1280 × 720.
const EXPECTED: &str = include_str!("reading_order.txt");
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/app/tests/reading_order.txt");

/// Returns a line for a node that a reader stops at: its role, its name and its state.
fn line(node: &AccessKitNode<'_>) -> Option<String> {
    let name = node.label().unwrap_or_default();
    // A text that only shows is read by its value; a control's value is no part of the order.
    let name = if name.is_empty() { node.value().unwrap_or_default() } else { name };
    if name.is_empty() || matches!(node.role(), Role::Window | Role::Unknown) {
        return None;
    }
    let mut line = format!("{:?}: {name}", node.role());
    if node.data().toggled() == Some(Toggled::True) || node.is_selected() == Some(true) {
        line.push_str(", on");
    }
    if node.is_disabled() {
        line.push_str(", disabled");
    }
    Some(line)
}

fn reading(window: &Window) -> String {
    let lines = window.query_all(By::new()).filter_map(|node| line(&node.accesskit_node()));
    lines.map(|line| line + "\n").collect()
}

#[test]
fn a_screen_reader_reads_the_window_in_this_order() {
    let window = window_of(vec2(1280.0, 720.0));
    let reading = reading(&window);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(FILE, &reading).unwrap();
        return;
    }
    let first = reading.lines().zip(EXPECTED.lines()).find(|(now, before)| now != before);
    assert!(
        reading == EXPECTED,
        "the order of reading has changed, first at {first:?}: UPDATE_DOCS=1 cargo test --lib reading_order"
    );
}

/// Menus, tools, the strip of the tool, docks, canvas, status bar.
#[test]
fn the_parts_of_the_window_are_read_in_their_order() {
    let stops = [
        "Button: File",
        "Button: Help",
        "Button: Brush",
        "Button: Undo",
        "Button: Redo",
        "Button: Fit domain",
        "Slider: Radius",
        "Button: View options",
        "Button: Layers",
        "ListBoxOption: Base",
        "Tab: Size",
        "Image: Mesh canvas",
        "Definition: x",
        "Definition: triangles",
    ];
    let places: Vec<_> = stops
        .iter()
        .map(|stop| EXPECTED.lines().position(|line| line.starts_with(stop)).expect(stop))
        .collect();
    assert!(places.is_sorted(), "{places:?}");
}

//! Keys and modifiers.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::{
    FREE, TALL, Window, canvas, click, entries, fingerprint, key, level_at, move_to, press, release, stroke,
    wheel, window, window_of,
};
use crate::app::features::ROWS;
use crate::app::features::inspection::QUERY;
use crate::app::features::painting::{BRUSH, ERASER};
use meshbrush_core::document::Example;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{Tab, all_tools};

#[test]
fn a_tool_is_selected_by_its_key_and_by_its_button() {
    let mut window = window();
    for tool in all_tools(ROWS).into_iter().rev() {
        key(&mut window, Modifiers::NONE, tool.key);
        assert_eq!(window.state().tools().tool, tool);
    }
    for tool in all_tools(ROWS) {
        let buttons = window.get_all_by_role_and_label(Role::Button, tool.name);
        let leftmost = buttons.min_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap();
        leftmost.click();
        window.run();
        assert_eq!(window.state().tools().tool, tool);
    }
}

#[test]
fn the_section_of_a_selected_tool_comes_into_view() {
    let mut window = window_of(vec2(900.0, 600.0));
    let panel = canvas(&window).right_bottom() + vec2(100.0, -40.0);
    wheel(&mut window, panel, -2000.0);
    let top = |window: &Window| window.get_by_role_and_label(Role::Tab, "Size").rect().bottom();
    let section = |window: &Window, name: &str| window.get_by_role_and_label(Role::Button, name).rect().top();
    let scrolled = section(&window, "Size and risk");
    assert!(scrolled < top(&window), "scrolled away");
    key(&mut window, Modifiers::NONE, Key::Q);
    assert!(section(&window, "Triangle") >= top(&window));
    key(&mut window, Modifiers::NONE, Key::B);
    assert_eq!(section(&window, "Size and risk"), scrolled, "each tab keeps its place");
}

#[test]
fn brackets_and_digits_set_the_brush() {
    let mut window = window();
    let before = window.state().tools().clone();
    key(&mut window, Modifiers::NONE, Key::CloseBracket);
    assert!(window.state().tools().radius > before.radius);
    key(&mut window, Modifiers::NONE, Key::OpenBracket);
    key(&mut window, Modifiers::NONE, Key::OpenBracket);
    assert!(window.state().tools().radius < before.radius);
    assert_eq!(window.state().tools().hardness, before.hardness);
    // A keyboard says `{` where Shift and `[` are pressed.
    key(&mut window, Modifiers::SHIFT, Key::CloseCurlyBracket);
    assert!(window.state().tools().hardness > before.hardness);
    key(&mut window, Modifiers::SHIFT, Key::OpenCurlyBracket);
    key(&mut window, Modifiers::SHIFT, Key::OpenCurlyBracket);
    assert!(window.state().tools().hardness < before.hardness);
    for (digit, strength) in [(Key::Num1, 0.1), (Key::Num5, 0.5), (Key::Num0, 1.0)] {
        key(&mut window, Modifiers::NONE, digit);
        assert_eq!(window.state().tools().paint_strength, strength);
    }
    key(&mut window, Modifiers::NONE, Key::E);
    key(&mut window, Modifiers::NONE, Key::Num3);
    assert_eq!(window.state().tools().erase_strength, 0.3);
    assert_eq!(window.state().tools().paint_strength, 1.0, "the eraser has a strength of its own");
}

#[test]
fn alt_or_ctrl_click_picks_the_value_under_the_pointer() {
    let mut window = window();
    click(&mut window, dvec2(0.245, 0.765), Modifiers::ALT);
    assert!((window.state().tools().risk - 0.72).abs() < 0.02, "the risk of the first site");
    key(&mut window, Modifiers::NONE, Key::T);
    let before = window.state().tools().diameter;
    click(&mut window, dvec2(0.245, 0.765), Modifiers::COMMAND);
    assert_ne!(window.state().tools().diameter, before);
    assert_eq!(entries(&window), 0);
}

#[test]
fn shift_click_draws_a_straight_line_from_the_last_stroke() {
    let mut window = window();
    stroke(&mut window, FREE, FREE);
    let middle = FREE - dvec2(0.0, 0.15);
    assert_eq!(level_at(&window, FREE - dvec2(0.0, 0.1)), 0);
    click(&mut window, FREE - dvec2(0.0, 0.2), Modifiers::SHIFT);
    assert!(level_at(&window, middle) > 5);
    assert_eq!(entries(&window), 2);
}

#[test]
fn shift_drag_sizes_the_brush() {
    let mut window = window();
    let before = window.state().tools().radius;
    press(&mut window, FREE, Modifiers::SHIFT);
    move_to(&mut window, FREE + dvec2(0.05, 0.0));
    release(&mut window, FREE + dvec2(0.05, 0.0));
    assert!((window.state().tools().radius - before - 0.05).abs() < 1e-3);
    assert_eq!(entries(&window), 0, "nothing was painted");
}

#[test]
fn keys_typed_into_a_field_stay_there() {
    let mut window = window_of(TALL);
    stroke(&mut window, FREE, FREE);
    let painted = fingerprint(&window);
    window.get_by_role_and_label(Role::TextInput, "Radius value").focus();
    window.run();
    for letter in [Key::E, Key::Q, Key::G, Key::Num1] {
        key(&mut window, Modifiers::NONE, letter);
    }
    window.get_by_role_and_label(Role::TextInput, "Radius value").type_text("0.05");
    window.run();
    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Backspace);
    assert_eq!(window.state().tools().tool, &BRUSH);
    assert!(window.state().view().edges);
    assert_eq!(window.state().tools().paint_strength, 0.8);
    assert_eq!(
        fingerprint(&window),
        painted,
        "neither undo nor clearing reaches the document from a text field"
    );
}

#[test]
fn keys_do_not_reach_what_is_behind_the_help() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::F1);
    let edges = window.state().view().edges;
    for letter in [Key::E, Key::Q, Key::G, Key::Num1] {
        key(&mut window, Modifiers::NONE, letter);
    }
    key(&mut window, Modifiers::COMMAND, Key::Backspace);
    assert_eq!(window.state().tools().tool, &BRUSH);
    assert_eq!(window.state().view().edges, edges);
    assert_eq!(entries(&window), 0);
    key(&mut window, Modifiers::NONE, Key::Escape);
    key(&mut window, Modifiers::NONE, Key::Q);
    assert_eq!(window.state().tools().tool, &QUERY, "the help is closed");
}

#[test]
fn a_key_that_changes_the_tool_says_so_for_a_moment() {
    let mut window = window();
    let says = |window: &Window, text: &str| {
        let labels = window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
        labels.into_iter().any(|label| label == text)
    };
    window.key_press(Key::E);
    window.step();
    window.step();
    assert!(says(&window, "E: Eraser"));
    window.run();
    window.run_steps(10);
    assert!(!says(&window, "E: Eraser"), "it goes away");
    for (key, text) in [(Key::B, "B: Brush"), (Key::V, "V: Set the value"), (Key::Num3, "3: Risk 0.3")] {
        window.key_press(key);
        window.step();
        window.step();
        assert!(says(&window, text), "{text}");
    }
    window.run();
}

#[test]
fn page_keys_walk_the_tree_with_the_query_tool_and_the_layers_with_others() {
    let mut window = window();
    let layer = |window: &Window| super::active(window).id;
    let before = layer(&window);
    key(&mut window, Modifiers::NONE, Key::PageDown);
    let below = layer(&window);
    assert_ne!(below, before);
    key(&mut window, Modifiers::NONE, Key::Q);
    click(&mut window, dvec2(0.245, 0.765), Modifiers::NONE);
    key(&mut window, Modifiers::NONE, Key::PageUp);
    assert_eq!(layer(&window), below, "the layer stays");
    let entries = crate::app::catalog::catalog(&window.state().state(None));
    let back = entries.iter().find(|entry| entry.title == "Go back to the queried triangle");
    assert!(back.is_some_and(|entry| entry.enabled), "the parent is shown");
}

fn focused(window: &Window) -> Option<String> {
    let all =
        [Role::Group, Role::Image, Role::Button].into_iter().flat_map(|role| window.query_all_by_role(role));
    all.into_iter()
        .find(|node| node.accesskit_node().is_focused())
        .and_then(|node| node.accesskit_node().label())
}

#[test]
fn f6_leads_through_the_parts_of_the_window_and_tab_into_them() {
    let mut window = window();
    let mut seen = Vec::new();
    for _ in 0..7 {
        key(&mut window, Modifiers::NONE, Key::F6);
        seen.extend(focused(&window));
    }
    let docks_first =
        ["Layers dock", "Panel", "Status bar", "Menus", "Tools", "Options of the tool", "Mesh canvas"];
    assert_eq!(seen, docks_first);
    for before in ["Options of the tool", "Tools"] {
        key(&mut window, Modifiers::SHIFT, Key::F6);
        assert_eq!(focused(&window).as_deref(), Some(before));
    }
    key(&mut window, Modifiers::NONE, Key::Tab);
    assert_eq!(focused(&window).as_deref(), Some("Brush"));
    assert!(window.state().view().panels, "Tab hides nothing");
    key(&mut window, Modifiers::NONE, Key::F6);
    assert_eq!(focused(&window).as_deref(), Some("Options of the tool"), "from a control within a part, too");
    key(&mut window, Modifiers::NONE, Key::F6);
    assert_eq!(focused(&window).as_deref(), Some("Mesh canvas"));
    window.get_by_role_and_label(Role::TextInput, "Radius value").focus();
    window.run();
    key(&mut window, Modifiers::SHIFT, Key::F6);
    assert_eq!(focused(&window).as_deref(), Some("Tools"), "also from a field");
    key(&mut window, Modifiers::COMMAND, Key::B);
    assert!(!window.state().view().panels);
}

/// Whatever a dock shows, and wherever its last control is, the key leads through all parts.
#[test]
fn f6_sticks_at_no_part_with_any_tab() {
    let mut window = window();
    super::send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
        super::open_tab(&mut window, tab);
        // To the last control of the panel, and from there twice through the window.
        for _ in 0..2 {
            key(&mut window, Modifiers::NONE, Key::F6);
        }
        key(&mut window, Modifiers::SHIFT, Key::Tab);
        let mut seen = Vec::new();
        for _ in 0..14 {
            key(&mut window, Modifiers::NONE, Key::F6);
            seen.extend(focused(&window));
        }
        for part in
            ["Layers dock", "Panel", "Status bar", "Menus", "Tools", "Options of the tool", "Mesh canvas"]
        {
            assert_eq!(seen.iter().filter(|name| *name == part).count(), 2, "{part}, {tab:?}: {seen:?}");
        }
    }
}

#[test]
fn arrows_and_plus_move_and_zoom_the_view_while_the_canvas_has_the_focus() {
    let mut window = window();
    let center = |window: &Window| super::in_world(window, canvas(window).center());
    let before = center(&window);
    key(&mut window, Modifiers::NONE, Key::ArrowRight);
    assert_eq!(center(&window), before, "without the focus arrows do nothing");
    key(&mut window, Modifiers::SHIFT, Key::F6);
    key(&mut window, Modifiers::NONE, Key::F6);
    assert_eq!(focused(&window).as_deref(), Some("Mesh canvas"));
    key(&mut window, Modifiers::NONE, Key::ArrowRight);
    let right = center(&window);
    assert!(right.x > before.x && right.y == before.y, "{before} {right}");
    key(&mut window, Modifiers::NONE, Key::ArrowUp);
    assert!(center(&window).y > right.y);
    let scale = |window: &Window| window.state().view().camera.unwrap().px_per_world();
    let zoomed = scale(&window);
    key(&mut window, Modifiers::NONE, Key::Plus);
    assert!(scale(&window) > zoomed);
    key(&mut window, Modifiers::NONE, Key::E);
    assert_eq!(window.state().tools().tool, &ERASER, "the keys of tools work there");
}

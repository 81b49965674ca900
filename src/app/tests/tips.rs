//! Every control explains itself.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{FREE, TALL, Window, canvas, choose, key, open_section, send, window_of};
use crate::app::command::Command;
use crate::app::tools::TOOLS;

const CONTROLS: [Role; 6] =
    [Role::Button, Role::Slider, Role::TextInput, Role::RadioButton, Role::CheckBox, Role::ComboBox];

/// Names of the controls in tool strip and side panel that have no sentence.
fn unexplained(window: &Window) -> Vec<String> {
    let canvas = canvas(window);
    let in_panels = |x: f32| x < canvas.left() || x > canvas.right();
    let controls = CONTROLS.into_iter().flat_map(|role| window.query_all_by_role(role));
    controls
        .filter(|node| in_panels(node.rect().center().x) && node.rect().top() >= canvas.top())
        // The title of a section shows that it folds.
        .filter(|node| {
            node.accesskit_node().data().is_expanded().is_none()
                || node.accesskit_node().role() == Role::ComboBox
        })
        .filter(|node| node.accesskit_node().description().is_none_or(|text| text.is_empty()))
        .map(|node| node.accesskit_node().label().unwrap_or_default())
        .collect()
}

#[test]
fn every_control_of_the_panels_has_a_sentence() {
    let mut window = window_of(vec2(TALL.x, 2600.0));
    send(&mut window, Command::Query(FREE));
    for section in ["Base field", "Mesh", "Domain", "View"] {
        open_section(&mut window, section);
    }
    assert_eq!(unexplained(&window), [""; 0]);
    window.get_by_role_and_label(Role::RadioButton, "Formula").click();
    for tool in TOOLS {
        send(&mut window, Command::Use(tool));
        assert_eq!(unexplained(&window), [""; 0], "{}", tool.name);
    }
    choose(&mut window, "Examples", "Aegean Sea");
    for tool in TOOLS {
        send(&mut window, Command::Use(tool));
        assert_eq!(unexplained(&window), [""; 0], "{} in a domain of polygons", tool.name);
    }
}

#[test]
fn a_tooltip_is_beside_the_panel() {
    let mut window = window_of(TALL);
    let strength = window.get_by_role_and_label(Role::Slider, "Strength").rect().center();
    window.hover_at(strength);
    window.run_steps(8);
    let tooltip = window.get_by_label_contains("How far one stroke moves").rect();
    assert!(tooltip.right() <= canvas(&window).right(), "{tooltip:?}");
    window.hover_at(window.get_by_role_and_label(Role::Button, "Eraser").rect().center());
    window.run_steps(8);
    let tooltip = window.get_by_label_contains("Takes paint away").rect();
    assert!(tooltip.left() >= canvas(&window).left(), "{tooltip:?}");
}

#[test]
fn risk_and_diameter_take_the_same_room() {
    let mut window = window_of(TALL);
    let hardness = |window: &Window| window.get_by_role_and_label(Role::Slider, "Hardness").rect();
    let before = hardness(&window);
    key(&mut window, Modifiers::NONE, Key::T);
    assert_eq!(hardness(&window), before);
}

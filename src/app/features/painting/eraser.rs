//! The eraser.

use eframe::egui::Key;

use super::ERASER_OPTIONS;
use super::brush::{hint_without_layer, line_to_here, press_to_paint};
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_kit::kit::tools::Tools;
use meshbrush_kit::kit::{Tab, ToolSpec};
use meshbrush_ui::widgets::Hint::{self, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Removes paint.
pub static ERASER: ToolSpec = ToolSpec {
    place: 1,
    tab: Some(Tab::Size),
    options: &ERASER_OPTIONS,
    hint: |state| hint_without_layer(state).unwrap_or(HINT),
    has_ring: |_| true,
    brush: Some(brush),
    erases: true,
    in_space: true,
    press: press_to_paint,
    menu: line_to_here,
    ..ToolSpec::new("Eraser", Key::E, Icon::ERASER)
};

const HINT: &[Hint] = &[
    Text("Drag to remove paint: the mesh coarsens"),
    KeyOf("brush"),
    Text("brush"),
    KeyOf("undo"),
    Text("undo"),
];

fn brush(tools: &Tools) -> Brush {
    let strength = tools.erase_strength;
    Brush { medium: Medium::Eraser, radius: tools.radius, hardness: tools.hardness, strength }
}

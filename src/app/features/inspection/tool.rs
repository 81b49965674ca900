//! The query tool.

use eframe::egui::Key;

use super::QUERY_OPTIONS;
use crate::app::features::inspection::InspectCommand;
use crate::app::features::pins::PinsCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{SettingsDrag, Tab, ToolSpec};
use meshbrush_ui::widgets::Hint::{self, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Queries a point: its triangle, neighbours and values. Moves pins, which have their own commands.
pub static QUERY: ToolSpec = ToolSpec {
    place: 2,
    tab: Some(Tab::Inspect),
    options: &QUERY_OPTIONS,
    hint: |_| HINT,
    queries: true,
    in_space: true,
    menu: |state, _| {
        let triangle = state.readout.and_then(|readout| readout.triangle.as_ref());
        let copy = Command::from(InspectCommand::CopyReadout);
        triangle.map(|_| ("Copy the values of the triangle", copy)).into_iter().collect()
    },
    press: |press, pointer, commands| {
        let at = pointer.world(press.at);
        commands.push(Command::from(PinsCommand::Press { at, reach: pointer.grip_reach() }));
        Some(Box::new(SettingsDrag::new(press.at, |at| Command::from(PinsCommand::DragTo(at)))))
    },
    ..ToolSpec::new("Query", Key::Q, Icon::QUERY)
};

const HINT: &[Hint] = &[
    Text("Click a triangle to inspect it"),
    KeyOf("pin-the-queried-point"),
    Text("pin"),
    KeyOf("go-to-the-bisection-neighbour"),
    KeyOf("go-to-the-second-neighbour"),
    KeyOf("go-to-the-third-neighbour"),
    Text("neighbours"),
    KeyOf("copy-the-values-of-the-triangle"),
    Text("copy values"),
    KeyOf("cancel-or-deselect"),
    Text("deselect"),
];

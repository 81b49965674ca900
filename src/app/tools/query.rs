//! The query tool.

use eframe::egui::Key;

use super::{SettingsDrag, ToolSpec};
use crate::app::command::{Command, InspectCommand, PinsCommand};
use crate::app::features::pins::PINS;
use crate::app::panels;
use crate::app::widgets::Hint::{self, Key as HintKey, Text};
use crate::app::widgets::Icon;

/// Queries a point: its triangle, neighbours and values. Moves pins.
pub static QUERY: ToolSpec = ToolSpec {
    panels: &[&panels::INSPECTOR, &panels::WHY, &PINS],
    hint: |_| HINT,
    highlights_hovered: true,
    explains: true,
    moves_pins: true,
    menu: |state, point| {
        let triangle = state.readout.and_then(|readout| readout.triangle.as_ref());
        let pins = &state.session.document().settings().pins;
        let selected = state.pins.selected_of(pins);
        let pin = Some(("Pin here", Command::Pins(PinsCommand::Add(point))));
        let delete = selected.map(|_| ("Delete the selected pin", Command::Pins(PinsCommand::Delete)));
        let copy = triangle
            .map(|_| ("Copy the values of the triangle", Command::Inspect(InspectCommand::CopyReadout)));
        [pin, delete, copy].into_iter().flatten().collect()
    },
    press: |press, pointer, commands| {
        let at = pointer.world(press.at);
        let reach = PIN_REACH_POINTS * pointer.px_per_point / pointer.camera.px_per_world();
        commands.push(Command::Pins(PinsCommand::Press { at, reach }));
        Some(Box::new(SettingsDrag::new(press.at, |at| Command::Pins(PinsCommand::DragTo(at)))))
    },
    ..ToolSpec::new("Query", Key::Q, Icon::QUERY)
};

/// How far from a pin the pointer still takes hold of it, in points.
pub const PIN_REACH_POINTS: f64 = 9.0;

const HINT: &[Hint] = &[
    Text("Click a triangle to inspect it"),
    HintKey("Shift+P"),
    Text("pin"),
    HintKey("1"),
    HintKey("2"),
    HintKey("3"),
    Text("neighbours"),
    HintKey("Ctrl+C"),
    Text("copy values"),
    HintKey("Esc"),
    Text("deselect"),
];

//! The query tool.

use eframe::egui::Key;
use glam::DVec2;

use super::{SettingsDrag, ToolSpec};
use crate::app::command::{Command, InspectCommand, PinsCommand};
use crate::app::panels;
use crate::app::widgets::Hint::{self, Key as HintKey, Text};
use crate::app::widgets::Icon;

/// Queries a point: its triangle, neighbours and values. Moves pins.
pub static QUERY: ToolSpec = ToolSpec {
    panels: &[&panels::INSPECTOR, &panels::WHY, &panels::PINS],
    hint: |_| HINT,
    highlights_hovered: true,
    explains: true,
    moves_pins: true,
    menu: |state, point| {
        let triangle = state.readout.and_then(|readout| readout.triangle.as_ref());
        let pins = &state.session.document().settings().pins;
        let selected = state.tools.pins.selected_of(pins);
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

/// What the query tool keeps of pins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PinsTool {
    /// The number of the selected pin, from 0.
    pub selected: Option<usize>,
    /// The offset of the pin that is dragged from the pointer, in world units.
    pub grip: Option<DVec2>,
}

impl PinsTool {
    /// The selected pin. An undo can have removed it.
    pub fn selected_of(&self, pins: &[DVec2]) -> Option<usize> {
        self.selected.filter(|number| *number < pins.len())
    }
}

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

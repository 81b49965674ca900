//! The query tool.

use eframe::egui::Key;

use super::ToolSpec;
use crate::app::command::Command;
use crate::app::panels;
use crate::app::widgets::Hint::{self, Key as HintKey, Text};
use crate::app::widgets::Icon;

/// Queries a point: its triangle, neighbours and values.
pub static QUERY: ToolSpec = ToolSpec {
    panels: &[&panels::INSPECTOR, &panels::WHY],
    hint: |_| HINT,
    highlights_hovered: true,
    explains: true,
    menu: |state, _| match state.readout.and_then(|readout| readout.triangle.as_ref()) {
        Some(_) => vec![("Copy the values of the triangle", Command::CopyReadout)],
        None => Vec::new(),
    },
    press: |press, pointer, commands| {
        commands.push(Command::Query(pointer.world(press.at)));
        None
    },
    ..ToolSpec::new("Query", Key::Q, Icon::QUERY)
};

const HINT: &[Hint] = &[
    Text("Click a triangle to inspect it"),
    HintKey("1"),
    HintKey("2"),
    HintKey("3"),
    Text("neighbours"),
    HintKey("Ctrl+C"),
    Text("copy values"),
    HintKey("Esc"),
    Text("deselect"),
];

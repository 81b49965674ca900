//! The query tool.

use eframe::egui::Key;

use super::ToolSpec;
use crate::app::command::Command;
use crate::app::panels;
use crate::app::widgets::Hint::{self, Key as HintKey, Text};
use crate::app::widgets::Icon;

/// Queries a point: its triangle, neighbours and values.
pub static QUERY: ToolSpec = ToolSpec {
    panels: &[&panels::INSPECTOR],
    hint: |_| HINT,
    highlights_hovered: true,
    press: |press, pointer, commands| {
        commands.push(Command::Query(pointer.world(press.at)));
        None
    },
    ..ToolSpec::new("Query", Key::Q, Icon::QUERY)
};

const HINT: &[Hint] =
    &[Text("Click a triangle to inspect it"), HintKey("B"), Text("brush"), HintKey("Esc"), Text("deselect")];

//! The boundary in menus and in the palette.

use eframe::egui::Key;

use super::{BOUNDARY, BoundaryCommand, BoundaryToolMode};
use crate::app::command::Command;
use crate::app::kit::{CatalogItem, FrameState, Menu};

pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tools = state.tools;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::Boundary(command));
    let current = |mode| tools.tool == &BOUNDARY && tools.boundary.mode == mode;
    let (select, split) = (BoundaryToolMode::Select, BoundaryToolMode::Split);
    let mut items = vec![
        item("Select pieces of the boundary", BoundaryCommand::Mode(select)).checked(current(select)).group(),
        item("Split the boundary", BoundaryCommand::Mode(split)).checked(current(split)),
    ];
    if tools.tool == &BOUNDARY {
        let other = if tools.boundary.mode == split { select } else { split };
        items.push(
            item("Select or split", BoundaryCommand::Mode(other))
                .key(Key::S)
                .only("with the boundary tool", true),
        );
        items.push(item("Join the piece with the next", BoundaryCommand::Join));
    }
    // The menu has what the selected tool does.
    let is_tool = tools.tool == &BOUNDARY;
    items.into_iter().map(|item| item.in_menu(is_tool)).collect()
}

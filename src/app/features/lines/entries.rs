//! Lines in menus and in the palette.

use eframe::egui::Key;

use super::files::ADD_LINES;
use super::{LINE, LineEnd, LineToolMode, LinesCommand};
use crate::app::features::lines::LineTool;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// The entries. The menu has those of the tool while it is selected.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let tool = state.tools.settings::<LineTool>();
    let is_tool = state.tools.tool == &LINE;
    let lines = &state.session.document().settings().lines;
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, Command::from(command));
    let mode =
        |title: &str, mode| item(title, LinesCommand::Mode(mode)).checked(is_tool && tool.mode == mode);
    let mut items = vec![
        mode("Draw lines corner by corner", LineToolMode::Corners).group(),
        mode("Draw lines by free hand", LineToolMode::FreeHand),
        mode("Draw rectangles as lines", LineToolMode::Rectangle),
        mode("Draw circles as lines", LineToolMode::Circle),
        mode("Follow the deepest way", LineToolMode::DeepestWay),
        mode("Move corners of lines", LineToolMode::Edit),
        item("Snap corners of lines", LinesCommand::Snaps(!tool.snaps))
            .key(Key::S)
            .only("with the line tool", is_tool)
            .checked(tool.snaps),
        item("Delete the selected line", LinesCommand::Delete)
            .key(Key::Delete)
            .only("with the line tool", is_tool)
            .enabled(tool.selected_in(lines).is_some())
            .group(),
    ];
    if !tool.corners.is_empty() {
        items.push(
            item("End the line", LinesCommand::End(LineEnd::Open))
                .key(Key::Enter)
                .only("while a line is drawn", true),
        );
    }
    let add = CatalogItem::new(Menu::Tool, "Add lines…", Command::from(FileCommand::Ask(&ADD_LINES)));
    items.extend([add, item("Delete all lines", LinesCommand::RemoveAll).enabled(!lines.is_empty())]);
    items.into_iter().map(|item| item.in_menu(is_tool).above()).collect()
}

//! Lines in menus and in the palette.

use super::LinesCommand;
use super::files::ADD_LINES;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// Entries of the palette.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::Tool, title, command).in_menu(false);
    let has_lines = !state.session.document().settings().lines.is_empty();
    vec![
        item("Add lines…", Command::from(FileCommand::Ask(&ADD_LINES))),
        item("Delete all lines", Command::from(LinesCommand::RemoveAll)).enabled(has_lines),
    ]
}

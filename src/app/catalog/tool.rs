//! The tools in the menu Tool.

use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// Returns an entry for each tool. How they work is set by entries of their features.
pub fn tool(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let items = state.tools.all().iter().map(|&tool| {
        let item = CatalogItem::new(Menu::Tool, tool.name, Command::from(ShellCommand::Use(tool)));
        item.key(tool.key).checked(state.tools.tool == tool).above()
    });
    items.collect()
}

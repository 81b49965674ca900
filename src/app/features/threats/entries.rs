//! The threats in menus and in the palette.

use eframe::egui::Key;

use super::{THREATS, ThreatsCommand};
use crate::app::command::Command;
use crate::app::kit::{CatalogItem, FrameState, Menu};

/// The key deletes a threat only while the tool is selected.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    if state.tools.tool != &THREATS {
        return Vec::new();
    }
    let is_selected = state.features.threats.selected_in(state.session.document()).is_some();
    let delete = Command::Threats(ThreatsCommand::Delete);
    let item = CatalogItem::new(Menu::Tool, "Delete the selected threat", delete).key(Key::Delete).group();
    vec![item.enabled(is_selected)]
}

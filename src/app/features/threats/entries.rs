//! The threats in menus and in the palette.

use eframe::egui::Key;

use super::{OPEN_THREATS, SAVE_THREATS, THREATS, ThreatsCommand, threats_layer};
use crate::app::features::threats::ThreatEditor;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// The key deletes a threat only while the tool is selected.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let ask =
        |title: &str, request| CatalogItem::new(Menu::Tool, title, Command::from(FileCommand::Ask(request)));
    let has_threats = threats_layer(state.session.document()).is_some();
    let open = ask("Open table of threats…", &OPEN_THREATS).group();
    let save = ask("Save table of threats…", &SAVE_THREATS).enabled(has_threats);
    if state.tools.tool != &THREATS {
        // The menu has what the selected tool does.
        return vec![open.palette_only(), save.palette_only()];
    }
    let is_selected = state.feature::<ThreatEditor>().selected_in(state.session.document()).is_some();
    let delete = Command::from(ThreatsCommand::Delete);
    let item = CatalogItem::new(Menu::Tool, "Delete the selected threat", delete)
        .key(Key::Delete)
        .only("with the threats tool", true)
        .group();
    vec![item.enabled(is_selected), open, save]
}

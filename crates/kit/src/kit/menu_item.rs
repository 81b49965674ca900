//! An entry of a menu as it is shown.

use egui::accesskit::Toggled;
use egui::{self, Align2, Button, Rect, Response, Ui, vec2};

use super::CatalogItem;
use crate::kit::command::Command;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::Icon;

/// Shows an entry of a menu, which sends its command when it is clicked. Returns its button.
pub fn menu_item(ui: &mut Ui, item: &CatalogItem, commands: &mut Vec<Command>) -> Response {
    if item.begins_group {
        ui.separator();
    }
    // A title is one line: the menu is as wide as its longest.
    let mut button = Button::new(&item.title).wrap_mode(egui::TextWrapMode::Extend);
    let keys = item.keys_text();
    if !keys.is_empty() {
        button = button.shortcut_text(keys);
    }
    // Room for the mark of the current choice.
    ui.spacing_mut().button_padding.x = 26.0;
    let response = ui.add_enabled(item.enabled, button);
    if item.checked {
        let mark = Rect::from_center_size(response.rect.left_center() + vec2(13.0, 0.0), vec2(16.0, 16.0));
        let color = tokens(ui).accent;
        ui.painter().text(mark.center(), Align2::CENTER_CENTER, Icon::CHECK.glyph(), font::icon(16.0), color);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_toggled(Toggled::True));
    }
    if response.clicked() {
        commands.push(item.command.clone());
        ui.close();
    }
    response
}

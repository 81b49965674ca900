//! An entry of a menu as it is shown.

use egui::accesskit::Toggled;
use egui::{self, Align2, Button, Rect, Response, Ui, vec2};

use super::CatalogItem;
use crate::kit::command::Command;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::Icon;

/// Width of a menu in points, at least.
pub const MENU_WIDTH: f32 = 220.0;
/// Free space at the ends of an entry, in points: room for the mark of the current choice.
const ENTRY_PADDING: f32 = 26.0;

/// Shows the entries of a menu. Neighbours of one [`Submenu`](super::Submenu) are in a menu within it.
pub fn menu_items(ui: &mut Ui, items: &[&CatalogItem], commands: &mut Vec<Command>) {
    ui.set_min_width(MENU_WIDTH);
    for run in items.chunk_by(|a, b| a.submenu.is_some() && a.submenu == b.submenu) {
        let Some(submenu) = run[0].submenu else {
            menu_item(ui, run[0], commands);
            continue;
        };
        if run[0].begins_group {
            ui.separator();
        }
        ui.spacing_mut().button_padding.x = ENTRY_PADDING;
        ui.menu_button(submenu.title(), |ui| {
            ui.set_min_width(MENU_WIDTH);
            for (place, item) in run.iter().enumerate() {
                let title = submenu.title_within(&item.title).to_owned();
                let begins_group = item.begins_group && place > 0;
                menu_item(ui, &CatalogItem { title, begins_group, ..(*item).clone() }, commands);
            }
        });
    }
}

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
    ui.spacing_mut().button_padding.x = ENTRY_PADDING;
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

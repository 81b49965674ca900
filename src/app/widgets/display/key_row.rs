//! Rows with an action and its keys.

use eframe::egui::{Response, Role, Sense, Ui, WidgetInfo};

use super::paint;
use crate::app::theme::{font, tokens};

/// Shows an action at the left and its keys at the right.
pub fn key_row(ui: &mut Ui, title: &str, keys: &str) -> Response {
    let row = paint::row(ui);
    let response = ui.interact(row, ui.make_persistent_id(("key", title, keys)), Sense::hover());
    let spoken = format!("{title} {keys}");
    response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, &spoken));
    let room = row.width() - paint::shortcut_width(ui, keys) - 16.0;
    paint::at_left(ui, row, paint::elided(ui, title, font::body(), tokens(ui).text, room));
    // Room for the scroll bar.
    paint::shortcut_at_right(ui, row.with_max_x(row.right() - 12.0), keys);
    response
}

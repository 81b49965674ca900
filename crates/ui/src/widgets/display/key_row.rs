//! Rows with an action and its keys.

use egui::{Response, Role, Sense, Ui, WidgetInfo, vec2};

use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

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

/// Shows an action and its keys, to click on. `is_changed` marks keys that are not the default ones.
pub fn key_row_button(
    ui: &mut Ui,
    title: &str,
    keys: &[String],
    is_changed: bool,
    is_open: bool,
) -> Response {
    let row = paint::row(ui);
    let response = ui.interact(row, ui.make_persistent_id(("key row", title)), Sense::click());
    let spoken = format!("{title} {}", keys.join(", "));
    response
        .widget_info(|| WidgetInfo::selected(Role::ListItem, ui.is_enabled(), is_open, spoken.trim_end()));
    let t = tokens(ui);
    if response.hovered() || is_open {
        ui.painter().rect_filled(row.expand2(vec2(4.0, 0.0)), metrics::RADIUS_CONTROL, t.field);
    }
    paint::focus_ring(ui, &response, row, metrics::RADIUS_CONTROL);
    let mut right = row.right() - 12.0;
    for keys in keys.iter().rev() {
        paint::shortcut_at_right(ui, row.with_max_x(right), keys);
        right -= paint::shortcut_width(ui, keys) + 10.0;
    }
    let text = if is_changed { format!("{title} (changed)") } else { title.to_owned() };
    paint::at_left(ui, row, paint::elided(ui, &text, font::body(), t.text, right - row.left()));
    tips::explain(ui, response, "Opens the keys of this entry, to add, remove or reset them.")
}

//! A name and its value.

use eframe::egui::{Response, Role, Sense, Ui, WidgetInfo};

use super::paint;
use crate::app::theme::{font, tokens};

/// A grey name at the left, a bright monospaced value at the right.
///
/// Where both do not fit the value ends in `…`; a tooltip shows all of it. Tests find the row by its name and
/// read the value from it.
pub fn value_row(ui: &mut Ui, label: &str, value: &str) -> Response {
    let t = tokens(ui);
    let row = paint::row(ui);
    let response = ui.interact(row, ui.make_persistent_id(("value", label)), Sense::hover());
    response.widget_info(|| WidgetInfo {
        current_text_value: Some(value.to_owned()),
        ..WidgetInfo::labeled(Role::Definition, true, label)
    });
    let name = paint::elided(ui, label, font::body(), t.label, row.width() * 0.6);
    let number = paint::elided(ui, value, font::value(), t.value, row.width() - name.size().x - 8.0);
    let cut = number.elided || name.elided;
    paint::at_left(ui, row, name);
    paint::at_right(ui, row, number);
    if cut { response.on_hover_text(format!("{label}: {value}")) } else { response }
}

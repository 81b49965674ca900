//! Check boxes: values that are on or off.

use egui::{Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use super::{Icon, paint};
use crate::theme::{font, tokens};
use crate::widgets::{reveal, tips};

/// Shows a check box with its name; the whole row is the target. The response has `changed` when `on` did.
pub fn toggle_row(ui: &mut Ui, label: &str, on: &mut bool) -> Response {
    toggle_row_with_help(ui, label, tips::sentence(label), on)
}

/// [`toggle_row`] with a sentence of its own.
pub fn toggle_row_with_help(ui: &mut Ui, label: &str, help: &str, on: &mut bool) -> Response {
    let row = paint::row(ui);
    let mut response = ui.interact(row, ui.make_persistent_id(("toggle", label)), Sense::click());
    if response.clicked() {
        *on = !*on;
        response.mark_changed();
    }
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, ui.is_enabled(), *on, label));
    reveal::show_control(ui, row, label);
    let square = Rect::from_center_size(pos2(row.left() + 8.0, row.center().y), vec2(16.0, 16.0));
    paint_box(ui, square, &response, *on);
    let ink = if response.hovered() { tokens(ui).value } else { tokens(ui).text };
    let text = row.with_min_x(square.right() + 8.0);
    paint::at_left(ui, text, paint::elided(ui, label, font::body(), ink, text.width()));
    tips::explain(ui, response, help)
}

fn paint_box(ui: &Ui, rect: Rect, response: &Response, on: bool) {
    let t = tokens(ui);
    let (fill, edge) = match (on, response.hovered()) {
        (true, _) => (t.selected, t.selected),
        (false, true) => (t.hover, t.label),
        (false, false) => (t.field, t.faint),
    };
    ui.painter().rect(rect, 4.0, fill, Stroke::new(1.0, edge), StrokeKind::Inside);
    if on {
        paint::at_centre(ui, rect, paint::line(ui, Icon::CHECK.glyph(), font::icon(14.0), t.on_selected));
    }
    paint::focus_ring(ui, response, rect, 4);
}

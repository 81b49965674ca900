//! Work that takes longer than a frame.

use eframe::egui::{Role, Sense, Ui, WidgetInfo, vec2};

use super::paint;
use super::tool_button::ActionButton;
use crate::app::theme::{font, metrics, tokens};

/// What is done (`Refining`), how far it is (`1,126,079 triangles`) and a Cancel button; answers whether that was clicked.
///
/// There is no bar: how much there is to do is known only when it is done.
pub fn progress_row(ui: &mut Ui, what: &str, done: &str) -> bool {
    let (id, row) = ui.allocate_space(vec2(ui.available_width(), metrics::ROW));
    let button = row.with_min_x(row.right() - 70.0);
    let left = row.with_max_x(button.left() - 12.0);
    let response = ui.interact(left, id, Sense::hover());
    response.widget_info(|| WidgetInfo {
        current_text_value: Some(done.to_owned()),
        ..WidgetInfo::labeled(Role::ProgressIndicator, true, what)
    });
    let t = tokens(ui);
    let count = paint::line(ui, done, font::small_value(), t.value);
    let room = left.width() - count.size().x - 8.0;
    paint::at_left(ui, left, paint::elided(ui, what, font::body(), t.label, room));
    paint::at_right(ui, left, count);
    let mut child = ui.new_child(
        eframe::egui::UiBuilder::new()
            .max_rect(button)
            .layout(eframe::egui::Layout::right_to_left(eframe::egui::Align::Center)),
    );
    child.add(ActionButton::new("Cancel")).clicked()
}

//! Work that takes longer than a frame.

use egui::{self, Rect, Role, Sense, Ui, WidgetInfo, vec2};

use super::{format, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::ActionButton;

/// Shows the kind of work (`Refining`), its progress (`1,126,079 triangles`) and a Cancel button. Returns
/// whether that was clicked.
///
/// There is no bar: the amount of work is not known before it is done.
pub fn progress_row(ui: &mut Ui, what: &str, done: &str) -> bool {
    row(ui, what, done, None, "Cancel")
}

/// Shows a [`progress_row`] for the bytes of a file: the share that is done, also as a bar, or without a
/// `total` the number of megabytes. There may be several rows, so the button is named after its work.
pub fn bytes_row(ui: &mut Ui, what: &str, done: u64, total: Option<u64>) -> bool {
    let share = total.map(|total| (done as f64 / total.max(1) as f64).clamp(0.0, 1.0));
    let done = match share {
        Some(share) => format!("{} %", format::padded(&format::fixed((100.0 * share).floor(), 0), 3)),
        None => format!("{} MB", format::fixed(done as f64 / 1e6, 1)),
    };
    row(ui, what, &done, share, &format!("Cancel: {what}"))
}

fn row(ui: &mut Ui, what: &str, done: &str, share: Option<f64>, cancel: &str) -> bool {
    // As tall as its button.
    let (id, row) = ui.allocate_space(vec2(ui.available_width(), metrics::ROW + 4.0));
    let button = row.with_min_x(row.right() - 70.0);
    let left = row.with_max_x(button.left() - 12.0);
    let response = ui.interact(left, id, Sense::hover());
    response.widget_info(|| WidgetInfo {
        current_text_value: Some(done.to_owned()),
        value: share,
        ..WidgetInfo::labeled(Role::ProgressIndicator, true, what)
    });
    let t = tokens(ui);
    let count = paint::line(ui, done, font::small_value(), t.value);
    let room = left.width() - count.size().x - 8.0;
    paint::at_left(ui, left, paint::elided(ui, what, font::body(), t.label, room));
    paint::at_right(ui, left, count);
    if let Some(share) = share {
        paint_bar(ui, left, share as f32);
    }
    let mut child = ui.new_child(
        egui::UiBuilder::new().max_rect(button).layout(egui::Layout::right_to_left(egui::Align::Center)),
    );
    child.add(ActionButton::new("Cancel").named(cancel).vanishing()).clicked()
}

/// A thin bar along the lower side.
fn paint_bar(ui: &Ui, rect: Rect, share: f32) {
    let t = tokens(ui);
    let bar = rect.with_min_y(rect.bottom() - 3.0);
    ui.painter().rect_filled(bar, 1.5, t.field);
    ui.painter().rect_filled(bar.with_max_x(bar.left() + bar.width() * share), 1.5, t.accent);
}

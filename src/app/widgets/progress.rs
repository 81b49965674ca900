//! Work that takes longer than a frame.

use eframe::egui::{Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::tool_button::ActionButton;
use super::{format, paint};
use crate::app::theme::{font, metrics, tokens};

/// A thin bar with a count and a Cancel button; answers whether Cancel was clicked.
///
/// `what` says what is done (`Refining`), `done` how far it is. Without a `total` the bar stays empty and only the count
/// moves.
pub fn progress_row(ui: &mut Ui, what: &str, done: u64, total: Option<u64>) -> bool {
    let (id, row) = ui.allocate_space(vec2(ui.available_width(), metrics::ROW + 8.0));
    let button =
        Rect::from_min_max(pos2(row.right() - 70.0, row.top() + 2.0), pos2(row.right(), row.bottom() - 2.0));
    let left = row.with_max_x(button.left() - 12.0);
    let share = total.map_or(0.0, |total| (done as f64 / total.max(1) as f64).clamp(0.0, 1.0));
    let response = ui.interact(left, id, Sense::hover());
    response.widget_info(|| WidgetInfo {
        value: Some(share),
        ..WidgetInfo::labeled(Role::ProgressIndicator, true, what)
    });
    paint_bar(ui, left, share as f32);
    paint_count(ui, left, what, done, total);
    let mut child = ui.new_child(
        eframe::egui::UiBuilder::new()
            .max_rect(button)
            .layout(eframe::egui::Layout::right_to_left(eframe::egui::Align::Center)),
    );
    child.add(ActionButton::new("Cancel")).clicked()
}

fn paint_bar(ui: &Ui, rect: Rect, share: f32) {
    let t = tokens(ui);
    let bar =
        Rect::from_min_max(pos2(rect.left(), rect.bottom() - 6.0), pos2(rect.right(), rect.bottom() - 3.0));
    ui.painter().rect_filled(bar, 1.5, t.field);
    ui.painter().rect_filled(bar.with_max_x(bar.left() + bar.width() * share), 1.5, t.accent);
}

fn paint_count(ui: &Ui, rect: Rect, what: &str, done: u64, total: Option<u64>) {
    let t = tokens(ui);
    let text = rect.with_max_y(rect.bottom() - 8.0);
    let count = match total {
        Some(total) => {
            let total = format::count(total);
            format!("{} / {total}", format::padded(&format::count(done), total.len()))
        }
        None => format::count(done),
    };
    let count = paint::line(ui, &count, font::small_value(), t.value);
    let room = text.width() - count.size().x - 8.0;
    paint::at_left(ui, text, paint::elided(ui, what, font::body(), t.label, room));
    paint::at_right(ui, text, count);
}

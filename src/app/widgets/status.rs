//! A cell of the status bar.

use eframe::egui::{Response, Role, Sense, Ui, WidgetInfo, vec2};

use super::paint;
use crate::app::theme::{font, metrics, tokens};

/// A faint name and a bright monospaced value; takes room for at least `chars` characters of value, so that its
/// neighbours stay where they are when the number gets longer. The value stands at the left of its room.
pub fn status_cell(ui: &mut Ui, label: &str, value: &str, chars: usize) -> Response {
    let t = tokens(ui);
    let name = paint::line(ui, label, font::value(), t.faint);
    let number = paint::line(ui, value, font::value(), t.value);
    let digit = ui.fonts_mut(|fonts| fonts.glyph_width(&font::value(), '0'));
    let gap = if label.is_empty() || value.is_empty() { 0.0 } else { 8.0 };
    let width = name.size().x + gap + number.size().x.max(digit * chars as f32);
    let (rect, response) =
        ui.allocate_exact_size(vec2(width.ceil(), metrics::STATUS_BAR - 4.0), Sense::hover());
    response.widget_info(|| WidgetInfo {
        current_text_value: Some(value.to_owned()),
        ..WidgetInfo::labeled(Role::Definition, true, label)
    });
    let after_name = rect.with_min_x(rect.left() + name.size().x + gap);
    paint::at_left(ui, rect, name);
    paint::at_left(ui, after_name, number);
    response
}

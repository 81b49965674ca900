//! A cell of the status bar.

use egui::{Response, Role, Sense, Ui, WidgetInfo, vec2};

use super::paint;
use crate::theme::{font, metrics, tokens};

/// Space between a name and its value.
const GAP: f32 = 8.0;

/// A faint name and a bright monospaced value in the status bar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatusCell {
    label: &'static str,
    value: String,
    chars: usize,
}

impl StatusCell {
    /// Creates a cell with room for at least `chars` characters of value, so that its neighbours stay where
    /// they are when the number gets longer. The value is left-aligned.
    pub fn new(label: &'static str, value: impl Into<String>, chars: usize) -> Self {
        Self { label, value: value.into(), chars }
    }

    /// Returns the width in points.
    pub fn width(&self, ui: &Ui) -> f32 {
        let width = |text: &str| paint::line(ui, text, font::value(), tokens(ui).value).size().x;
        let digit = ui.fonts_mut(|fonts| fonts.glyph_width(&font::value(), '0'));
        (width(self.label) + GAP + width(&self.value).max(digit * self.chars as f32)).ceil()
    }

    /// Shows the cell.
    pub fn show(&self, ui: &mut Ui) -> Response {
        let t = tokens(ui);
        let name = paint::line(ui, self.label, font::value(), t.faint);
        let value = paint::line(ui, &self.value, font::value(), t.value);
        let size = vec2(self.width(ui), metrics::STATUS_BAR - 4.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(self.value.clone()),
            ..WidgetInfo::labeled(Role::Definition, true, self.label)
        });
        let after_name = rect.with_min_x(rect.left() + name.size().x + GAP);
        paint::at_left(ui, rect, name);
        paint::at_left(ui, after_name, value);
        response
    }
}

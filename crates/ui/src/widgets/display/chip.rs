//! A coloured dot with a number: a neighbour to go to, a pin.

use egui::{
    self, Align2, Color32, CursorIcon, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2,
    vec2,
};

use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// A chip: a coloured dot and a text, to click on.
#[must_use = "call `show`"]
pub struct Chip<'a> {
    color: Color32,
    text: &'a str,
    name: &'a str,
    help: &'a str,
    number: String,
    enabled: bool,
}

impl<'a> Chip<'a> {
    /// Creates a chip with a dot in `color`; tooltip, tests and screen readers use `name`, which says what a
    /// click does.
    pub fn new(color: Color32, text: &'a str, name: &'a str) -> Self {
        Self { color, text, name, help: name, number: String::new(), enabled: true }
    }

    /// Adds a number in the dot, for example the digit of the equivalent key.
    pub fn number(mut self, number: usize) -> Self {
        self.number = number.to_string();
        self
    }

    /// Returns a sentence for the tooltip, in place of the name.
    pub fn help(mut self, help: &'a str) -> Self {
        self.help = help;
        self
    }

    /// Returns whether it can be clicked; a neighbour that is the boundary cannot.
    pub fn enabled(mut self, enabled: bool) -> Self {
        self.enabled = enabled;
        self
    }

    /// Shows the chip. The response has `hovered`, and `clicked` by pointer, Enter or Space.
    pub fn show(self, ui: &mut Ui) -> Response {
        let t = tokens(ui);
        let ink = if self.enabled { t.value } else { t.faint };
        let label = paint::line(ui, self.text, font::value(), ink);
        let size = vec2(label.size().x.ceil() + self.text_left() + 8.0, metrics::ROW);
        let sense = if self.enabled { Sense::click() } else { Sense::hover() };
        let (rect, response) = ui.allocate_exact_size(size, sense);
        let enabled = self.enabled && ui.is_enabled();
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(self.text.to_owned()),
            ..WidgetInfo::labeled(Role::Button, enabled, self.name)
        });
        self.paint(ui, rect, &response);
        paint::at_left(ui, rect.with_min_x(rect.left() + self.text_left()), label);
        if self.enabled {
            return tips::explain(ui, response.on_hover_cursor(CursorIcon::PointingHand), self.help);
        }
        tips::explain(ui, response, self.help)
    }

    /// Returns the beginning of the text, in points from the left side.
    fn text_left(&self) -> f32 {
        if self.number.is_empty() { 22.0 } else { 27.0 }
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response) {
        let t = tokens(ui);
        let lit = self.enabled && response.hovered();
        let (fill, edge) = if lit { (t.hover, self.color) } else { (t.well, t.line) };
        ui.painter().rect(rect, metrics::RADIUS_CONTROL, fill, Stroke::new(1.0, edge), StrokeKind::Inside);
        let side = if self.number.is_empty() { 8.0 } else { 15.0 };
        let middle = pos2(rect.left() + 9.0 + side / 2.0, rect.center().y);
        let middle = if self.number.is_empty() { middle } else { middle - vec2(2.0, 0.0) };
        let opacity = if self.enabled { 1.0 } else { 0.4 };
        let dot = Rect::from_center_size(middle, vec2(side, side));
        ui.painter().rect_filled(dot, 3.0, self.color.gamma_multiply(opacity));
        ui.painter().text(middle, Align2::CENTER_CENTER, &self.number, font::caption(), t.panel);
        paint::focus_ring(ui, response, rect, metrics::RADIUS_CONTROL);
    }
}

/// Lays out chips in a row that wraps.
pub fn chips<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> egui::InnerResponse<R> {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing = vec2(6.0, 6.0);
        ui.horizontal_wrapped(contents).inner
    })
}

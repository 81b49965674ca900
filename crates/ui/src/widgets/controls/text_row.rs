//! A text field that shows an error and its place.

use egui::text::CCursor;
use egui::{
    self, Align2, FontId, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, TextEdit, Ui,
    WidgetInfo, pos2, vec2,
};

use super::message::message;
use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// A mistake in a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextError<'a> {
    /// A sentence.
    pub message: &'a str,
    /// The byte at which it is wrong, if the message is about a place.
    pub at: Option<usize>,
}

/// A name and a text field. An error is shown beside the panel or above the field, with a caret at its place.
///
/// `changed` on every edit, `lost_focus` when it is complete (Enter, Tab, a click elsewhere).
#[must_use = "call `show`"]
pub struct TextRow<'a> {
    label: &'a str,
    text: &'a mut String,
    hint: &'a str,
    error: Option<TextError<'a>>,
    help: &'a str,
    mark: Option<&'a str>,
    formula: bool,
    takes_focus: bool,
}

impl<'a> TextRow<'a> {
    /// Creates a field beside its name.
    pub fn new(label: &'a str, text: &'a mut String) -> Self {
        Self { label, text, hint: "", error: None, help: "", mark: None, formula: false, takes_focus: false }
    }

    /// Returns a field for a formula: monospaced, full width, below its name.
    pub fn formula(label: &'a str, text: &'a mut String) -> Self {
        Self { formula: true, ..Self::new(label, text) }
    }

    /// Shown while the field is empty.
    pub fn hint(mut self, hint: &'a str) -> Self {
        self.hint = hint;
        self
    }

    /// Shown when the pointer rests on the name.
    pub fn help(mut self, help: &'a str) -> Self {
        self.help = help;
        self
    }

    /// Returns a word or two about the present text, at the right of a formula's name.
    pub fn mark(mut self, mark: Option<&'a str>) -> Self {
        self.mark = mark;
        self
    }

    /// Returns all letters go into this field, also those typed before it is seen.
    pub fn take_focus(mut self, takes_focus: bool) -> Self {
        self.takes_focus = takes_focus;
        self
    }

    /// Sets the mistake in the present text, if there is one.
    pub fn error(mut self, error: Option<TextError<'a>>) -> Self {
        self.error = error;
        self
    }

    /// Shows the row, and the error.
    pub fn show(mut self, ui: &mut Ui) -> Response {
        let row = paint::row(ui);
        let place = if self.formula {
            paint::label(ui, row, self.label, self.help);
            self.paint_mark(ui, row);
            ui.allocate_space(vec2(ui.available_width(), metrics::ROW + 4.0)).1
        } else {
            let columns = paint::Columns::of(row);
            paint::label(ui, columns.label, self.label, self.help);
            columns.rest
        };
        let (response, error_at) = self.field(ui, place);
        if let Some(error) = self.error {
            let x = error_at.unwrap_or(place.left() + 8.0);
            paint_caret(ui, pos2(x, place.bottom()), error_at.is_some());
            message(ui, ui.make_persistent_id(("message", self.label)), place, error.message);
        }
        response
    }

    /// Shows the field in `rect`, and the x of the error.
    fn field(&mut self, ui: &mut Ui, rect: Rect) -> (Response, Option<f32>) {
        let id = ui.make_persistent_id(("text", self.label));
        if self.takes_focus {
            ui.memory_mut(|memory| memory.request_focus(id));
        }
        self.paint_ground(ui, rect, ui.memory(|memory| memory.has_focus(id)));
        let inner = rect.shrink2(vec2(8.0, 0.0));
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(inner));
        let label = self.label;
        let edit = TextEdit::singleline(self.text)
            .id(id)
            .font(if self.formula { font::value() } else { font::body() })
            .text_color(tokens(ui).value)
            .align(Align2::LEFT_CENTER)
            .frame(egui::Frame::NONE)
            .desired_width(inner.width())
            .min_size(inner.size());
        let output = child.name_inputs(label, |ui| edit.show(ui));
        child.ctx().accesskit_node_builder(id, |node| node.set_label(label));
        self.paint_hint(ui, inner);
        let index = self.error.and_then(|error| error.at).map(|byte| char_index(self.text, byte));
        let x = index.map(|index| {
            let x = output.galley_pos.x + output.galley.pos_from_cursor(CCursor::new(index)).center().x;
            x.clamp(inner.left(), inner.right())
        });
        let help = if self.help.is_empty() { tips::sentence(label) } else { self.help };
        let response = output.response.response;
        // The error is where the tooltip would be.
        (if self.error.is_some() { response } else { tips::explain(ui, response, help) }, x)
    }

    fn paint_ground(&self, ui: &Ui, rect: Rect, focused: bool) {
        let t = tokens(ui);
        let edge = match (self.error.is_some(), focused) {
            (true, _) => Stroke::new(1.0, t.danger),
            (false, true) => Stroke::new(1.0, t.accent),
            (false, false) => Stroke::NONE,
        };
        ui.painter().rect(rect, metrics::RADIUS_CONTROL, t.field, edge, StrokeKind::Inside);
    }

    fn paint_mark(&self, ui: &Ui, row: Rect) {
        let Some(mark) = self.mark else { return };
        let t = tokens(ui);
        let color = if self.error.is_some() { t.danger } else { t.label };
        let galley = paint::line(ui, mark, font::caption(), color);
        let place = row.with_min_x(row.right() - galley.size().x);
        let response = ui.interact(place, ui.scope_id().with(("mark", self.label)), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Status, true, mark));
        paint::at_right(ui, place, galley);
    }

    fn paint_hint(&self, ui: &Ui, rect: Rect) {
        if self.text.is_empty() {
            let font: FontId = if self.formula { font::value() } else { font::body() };
            paint::at_left(ui, rect, paint::elided(ui, self.hint, font, tokens(ui).label, rect.width()));
        }
    }
}

/// Returns the number of characters before `byte`; that of the whole text if `byte` is beyond it.
fn char_index(text: &str, byte: usize) -> usize {
    text.char_indices().take_while(|(start, _)| *start < byte).count()
}

/// A small mark below the field that points up to the error.
fn paint_caret(ui: &Ui, tip: Pos2, pointed: bool) {
    if pointed {
        let corners = vec![tip, tip + vec2(4.0, 6.0), tip + vec2(-4.0, 6.0)];
        ui.painter().add(Shape::convex_polygon(corners, tokens(ui).danger, Stroke::NONE));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_become_characters() {
        assert_eq!(char_index("abc", 1), 1);
        assert_eq!(char_index("θ + x", 2), 1);
        assert_eq!(char_index("θ", 99), 1);
        assert_eq!(char_index("", 0), 0);
    }
}

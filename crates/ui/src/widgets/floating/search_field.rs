//! A text field to search with.

use egui::{self, Align2, Id, Response, TextEdit, Ui, vec2};

use super::{Icon, paint};
use crate::theme::{font, metrics, tokens};

/// Space for the magnifier.
const GLASS: f32 = 36.0;

/// A field with a magnifier, as wide as its place.
#[must_use = "call `show`"]
pub struct SearchField<'a> {
    name: &'a str,
    hint: &'a str,
    takes_focus: bool,
}

impl<'a> SearchField<'a> {
    /// Creates a field by its name. `hint` is shown while it is empty.
    pub fn new(name: &'a str, hint: &'a str) -> Self {
        Self { name, hint, takes_focus: false }
    }

    /// Returns all letters go into this field, also those typed before it is seen.
    pub fn take_focus(mut self) -> Self {
        self.takes_focus = true;
        self
    }

    /// Shows the field; `changed` on every edit.
    pub fn show(self, ui: &mut Ui, query: &mut String) -> Response {
        let t = tokens(ui);
        let id = Id::unique(("search field", self.name));
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), 36.0));
        ui.painter().rect_filled(rect, metrics::RADIUS_CONTROL, t.field);
        let glass = paint::line(ui, Icon::SEARCH.glyph(), font::icon(18.0), t.label);
        paint::at_left(ui, rect.with_min_x(rect.left() + 10.0), glass);
        let inner = rect.with_min_x(rect.left() + GLASS).shrink2(vec2(4.0, 0.0));
        if self.takes_focus {
            // Before the field takes the input of this frame.
            ui.memory_mut(|memory| memory.request_focus(id));
        }
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(inner));
        let edit = TextEdit::singleline(query)
            .id(id)
            .font(egui::FontId::proportional(14.0))
            .text_color(t.value)
            .align(Align2::LEFT_CENTER)
            .frame(egui::Frame::NONE)
            .desired_width(inner.width())
            .min_size(inner.size());
        let response = child.add(edit);
        ui.ctx().accesskit_node_builder(id, |node| node.set_label(self.name));
        // The field's own hint hides the first letters for a frame, which is long where drawing is slow.
        if query.is_empty() {
            let hint = egui::FontId::proportional(14.0);
            paint::at_left(ui, inner, paint::elided(ui, self.hint, hint, t.label, inner.width()));
        }
        response
    }
}

//! A value with a place, and the question why it is so.

use egui::{CursorIcon, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::{ValueRow, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// The word that asks.
const WHY: &str = "why";
/// Space before it, in points.
const GAP: f32 = 8.0;

/// A row whose value is a link to a place, with the word *why* beside its name.
///
/// Tests and screen readers find the link by its name, and the word as `Why: name`.
#[must_use = "call `show`"]
pub struct AnswerRow<'a> {
    label: &'a str,
    value: &'a str,
    help: &'a str,
}

/// What was clicked in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AnswerClicks {
    /// The value: its place is wanted.
    pub goes: bool,
    /// The word *why*.
    pub asks_why: bool,
}

impl<'a> AnswerRow<'a> {
    /// Creates a row; `help` is shown when the pointer rests on it.
    pub fn new(label: &'a str, value: &'a str, help: &'a str) -> Self {
        Self { label, value, help }
    }

    /// Shows the row.
    pub fn show(self, ui: &mut Ui) -> AnswerClicks {
        let Self { label, value, help } = self;
        let t = *tokens(ui);
        let word = |ui: &Ui, color| paint::line(ui, WHY, font::caption(), color);
        let width = word(ui, t.label).size().x;
        let link = ValueRow::new(label, value).help(help).link().after_name(GAP + width).show(ui);
        let name = paint::elided(ui, label, font::body(), t.label, link.rect.width() - GAP - width);
        // The value can be in a line below the name.
        let corner = pos2(link.rect.left() + name.size().x + GAP, link.rect.top());
        let place = Rect::from_min_size(corner, vec2(width, metrics::ROW));
        let response = ui.interact(place, link.id.with(WHY), Sense::click());
        let spoken = format!("Why: {label}");
        response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), &spoken));
        let is_lit = response.hovered() || response.has_focus();
        let ink = if is_lit { t.accent } else { t.faint };
        ui.painter().hline(place.x_range(), place.center().y + 7.0, Stroke::new(1.0, ink));
        paint::at_left(ui, place, word(ui, ink));
        paint::focus_ring(ui, &response, place.expand2(vec2(3.0, 0.0)), 4);
        let help = "Goes to its triangle, and explains why that is in the mesh.";
        let response = tips::explain(ui, response.on_hover_cursor(CursorIcon::PointingHand), help);
        AnswerClicks { goes: link.clicked(), asks_why: response.clicked() }
    }
}

//! A name and its value.

use egui::{CursorIcon, Response, Role, Sense, Stroke, Ui, WidgetInfo};

use super::paint;
use crate::theme::{font, tokens};
use crate::widgets::{reveal, tips};

/// Least space between a name and its value, in points.
const GAP: f32 = 8.0;

/// A grey name at the left, a bright monospaced value at the right.
///
/// Where both do not fit side by side, the value has a line of its own; where that is too short, too, it
/// ends in `…`, and the tooltip shows all of it. Tests find the row by its name and read the value from it.
#[must_use = "call `show`"]
pub struct ValueRow<'a> {
    label: &'a str,
    value: &'a str,
    help: &'a str,
    /// Width of what another widget puts after the name, in points.
    after_name: f32,
    stands_out: bool,
    is_link: bool,
    /// The text that a click copies, if it copies one.
    copies: Option<&'a str>,
}

/// Shows a row that only shows its value.
pub fn value_row(ui: &mut Ui, label: &str, value: &str) -> Response {
    ValueRow::new(label, value).show(ui)
}

impl<'a> ValueRow<'a> {
    /// Creates a row.
    pub fn new(label: &'a str, value: &'a str) -> Self {
        Self { label, value, help: "", after_name: 0.0, stands_out: false, is_link: false, copies: None }
    }

    /// Shown when the pointer rests on the row; without it, the sentence known for its name.
    pub fn help(self, help: &'a str) -> Self {
        Self { help, ..self }
    }

    /// Leaves room after the name for what another widget puts there, in points.
    pub(super) fn after_name(self, width: f32) -> Self {
        Self { after_name: width, ..self }
    }

    /// Colours the value, where it needs attention.
    pub fn stands_out(self, stands_out: bool) -> Self {
        Self { stands_out, ..self }
    }

    /// Makes the row a button, which says so under the pointer.
    pub fn link(self) -> Self {
        Self { is_link: true, ..self }
    }

    /// Says that a click copies `exact`, the value in full, which the tooltip shows.
    pub fn copies(self, exact: &'a str) -> Self {
        Self { copies: Some(exact), ..self }
    }

    /// Shows the row. Where it is a link or copies, `clicked` says when to act.
    pub fn show(self, ui: &mut Ui) -> Response {
        let Self { label, value, help, after_name, stands_out, is_link, copies } = self;
        let t = tokens(ui);
        let ink = if stands_out { t.accent } else { t.value };
        let room = ui.available_width();
        let name = paint::elided(ui, label, font::body(), t.label, room - after_name);
        let number = paint::elided(ui, value, font::value(), ink, room);
        let is_long = !value.is_empty() && name.size().x + after_name + GAP + number.size().x > room;
        let first = paint::row(ui);
        let last = if is_long { paint::row(ui) } else { first };
        let row = first.union(last);
        reveal::show_control(ui, row, label);
        let sense = if is_link || copies.is_some() { Sense::click() } else { Sense::hover() };
        let role = if is_link { Role::Button } else { Role::Definition };
        let response = ui.interact(row, ui.make_persistent_id(("value", label)), sense);
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(value.to_owned()),
            ..WidgetInfo::labeled(role, true, label)
        });
        let cut = number.elided || name.elided;
        let is_lit = is_link || copies.is_some() && (response.hovered() || response.has_focus());
        if is_lit {
            let under = row.right() - number.size().x..=row.right();
            let width = if response.hovered() { 1.5 } else { 1.0 };
            let line = Stroke::new(width, if response.hovered() { ink } else { t.faint });
            ui.painter().hline(under, last.center().y + 8.0, line);
            paint::focus_ring(ui, &response, row, 4);
        }
        paint::at_left(ui, first, name);
        paint::at_right(ui, last, number);
        let response = if is_lit { response.on_hover_cursor(CursorIcon::PointingHand) } else { response };
        let help = if help.is_empty() { tips::sentence(label) } else { help };
        let all = if cut { format!("{label}: {value}") } else { String::new() };
        let copying = copies.map_or(String::new(), |exact| format!("A click copies {exact}."));
        let lines: Vec<&str> = [&all, help, &copying].into_iter().filter(|line| !line.is_empty()).collect();
        tips::explain(ui, response, &lines.join("\n"))
    }
}

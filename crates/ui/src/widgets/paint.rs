//! Drawing that the widgets share: text in a rectangle, the focus ring, a row's columns, keys.

use std::sync::Arc;

use egui::emath::GuiRounding as _;
use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{self, Color32, FontId, Galley, Pos2, Rect, Response, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::theme::{font, metrics, tokens};
use crate::widgets::{reveal, tips};

/// Returns one line of text.
pub(super) fn line(ui: &Ui, text: &str, font: FontId, color: Color32) -> Arc<Galley> {
    ui.painter().layout_no_wrap(text.to_owned(), font, color)
}

/// Returns one line of text, ended by `…` where it exceeds `width` points.
pub(super) fn elided(ui: &Ui, text: &str, font: FontId, color: Color32, width: f32) -> Arc<Galley> {
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = TextWrapping::truncate_at_width(width);
    ui.painter().layout_job(job)
}

/// Returns a title in small capitals: upper case, semi-bold, slightly spaced.
pub(super) fn small_caps(ui: &Ui, text: &str, color: Color32, width: f32) -> Arc<Galley> {
    let format =
        TextFormat { font_id: font::title(), extra_letter_spacing: 0.6, color, ..Default::default() };
    let mut job = LayoutJob::single_section(text.to_uppercase(), format);
    job.wrap = TextWrapping::truncate_at_width(width);
    ui.painter().layout_job(job)
}

/// Paints `galley` at the left of `rect`, centred vertically.
pub(super) fn at_left(ui: &Ui, rect: Rect, galley: Arc<Galley>) {
    at(ui, pos2(rect.left(), rect.center().y), 0.0, galley);
}

/// Paints `galley` at the right of `rect`, centred vertically.
pub(super) fn at_right(ui: &Ui, rect: Rect, galley: Arc<Galley>) {
    at(ui, pos2(rect.right(), rect.center().y), 1.0, galley);
}

/// Paints `galley` in the middle of `rect`.
pub(super) fn at_centre(ui: &Ui, rect: Rect, galley: Arc<Galley>) {
    at(ui, rect.center(), 0.5, galley);
}

/// Paints `galley` with the point `anchor` at the share `x` of its width and half its height.
fn at(ui: &Ui, anchor: Pos2, x: f32, galley: Arc<Galley>) {
    let corner = anchor - vec2(x, 0.5) * galley.size();
    let corner = corner.round_to_pixels(ui.pixels_per_point());
    ui.painter().galley(corner, galley, Color32::PLACEHOLDER);
}

/// A ring around the widget that has the focus.
pub(super) fn focus_ring(ui: &Ui, response: &Response, rect: Rect, radius: u8) {
    if response.has_focus() {
        let stroke = Stroke::new(1.5, tokens(ui).accent);
        ui.painter().rect_stroke(rect.expand(2.0), radius + 2, stroke, StrokeKind::Middle);
    }
}

/// A row of a panel: name, control, number.
pub(super) struct Columns {
    /// The name's column.
    pub label: Rect,
    /// The part between name and number.
    pub middle: Rect,
    /// The number's column, at the right edge.
    pub value: Rect,
    /// Both columns after the name.
    pub rest: Rect,
}

impl Columns {
    /// Divides `row` at the widths of [`metrics`].
    pub fn of(row: Rect) -> Self {
        let (left, right) = (row.left() + metrics::LABEL_WIDTH, row.right() - metrics::VALUE_WIDTH);
        let span = |from: f32, to: f32| Rect::from_x_y_ranges(from..=to.max(from), row.y_range());
        Self {
            label: span(row.left(), left - 8.0),
            middle: span(left, right - 8.0),
            value: span(right, row.right()),
            rest: span(left, row.right()),
        }
    }
}

impl Columns {
    /// Returns the columns for a longer name: the control gives up some width, in whole steps of the grid.
    pub fn widened_for(self, ui: &Ui, name: &str) -> Self {
        let name = line(ui, name, font::body(), Color32::PLACEHOLDER).size().x;
        let missing = (name - self.label.width()).clamp(0.0, self.middle.width() / 2.0);
        let by = (missing / metrics::GRID).ceil() * metrics::GRID;
        let longer = |rect: Rect| rect.with_min_x(rect.left() + by);
        Self {
            label: self.label.with_max_x(self.label.right() + by),
            middle: longer(self.middle),
            rest: longer(self.rest),
            ..self
        }
    }
}

/// Takes a row of a panel's full width.
pub(super) fn row(ui: &mut Ui) -> Rect {
    ui.allocate_space(vec2(ui.available_width(), metrics::ROW)).1
}

/// Paints the name of a value. A name that is too long ends in `…`; a tooltip shows all of it.
pub(super) fn label(ui: &Ui, rect: Rect, text: &str, help: &str) {
    let galley = elided(ui, text, font::body(), tokens(ui).label, rect.width());
    let cut = galley.elided;
    reveal::show_control(ui, rect, text);
    at_left(ui, rect, galley);
    if cut || !help.is_empty() {
        let response = ui.interact(rect, ui.scope_id().with(("label", text)), egui::Sense::hover());
        tips::explain(ui, response, if help.is_empty() { text } else { help });
    }
}

/// Returns the keys of a shortcut: `Ctrl+Shift+Z` is three, `Ctrl++` two.
pub(super) fn split_keys(shortcut: &str) -> Vec<&str> {
    let Some(before_plus) = shortcut.strip_suffix('+') else {
        return shortcut.split('+').filter(|key| !key.is_empty()).collect();
    };
    before_plus.split('+').filter(|key| !key.is_empty()).chain(["+"]).collect()
}

/// Height of a key's cap.
pub(super) const KEY_CAP: f32 = 18.0;

/// Returns the width of a key's cap.
pub(super) fn key_cap_width(ui: &Ui, key: &str) -> f32 {
    let text = line(ui, key, font::small_value(), Color32::PLACEHOLDER);
    (text.size().x.ceil() + 10.0).max(KEY_CAP)
}

/// Paints a key with its left edge at `left`, returns its right edge.
pub(super) fn key_cap(ui: &Ui, left: Pos2, key: &str) -> f32 {
    let t = tokens(ui);
    let size = vec2(key_cap_width(ui, key), KEY_CAP);
    let rect =
        Rect::from_min_size(left - vec2(0.0, KEY_CAP / 2.0), size).round_to_pixels(ui.pixels_per_point());
    let edge = Stroke::new(1.0, t.edge);
    ui.painter().rect(rect, 4.0, t.raised, edge, StrokeKind::Inside);
    at_centre(ui, rect, line(ui, key, font::small_value(), t.text));
    rect.right()
}

/// Returns the width of a shortcut drawn by [`shortcut_at_right`].
pub(super) fn shortcut_width(ui: &Ui, shortcut: &str) -> f32 {
    let keys = split_keys(shortcut);
    let caps: f32 = keys.iter().map(|key| key_cap_width(ui, key)).sum();
    caps + 4.0 * keys.len().saturating_sub(1) as f32
}

/// Paints the keys of `shortcut`, ending at the middle of `rect`'s right edge.
pub(super) fn shortcut_at_right(ui: &Ui, rect: Rect, shortcut: &str) {
    let mut left = pos2(rect.right() - shortcut_width(ui, shortcut), rect.center().y);
    for key in split_keys(shortcut) {
        left.x = key_cap(ui, left, key) + 4.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortcuts_split_into_keys() {
        assert_eq!(split_keys("Ctrl+Shift+Z"), ["Ctrl", "Shift", "Z"]);
        assert_eq!(split_keys("Ctrl++"), ["Ctrl", "+"]);
        assert_eq!(split_keys("+"), ["+"]);
        assert_eq!(split_keys("["), ["["]);
        assert!(split_keys("").is_empty());
    }

    #[test]
    fn columns_never_overlap() {
        for width in [40.0, 200.0, 272.0, 500.0] {
            let columns = Columns::of(Rect::from_min_size(Pos2::ZERO, vec2(width, 24.0)));
            assert!(columns.label.right() <= columns.middle.left());
            assert!(columns.middle.width() >= 0.0 && columns.value.width() >= 0.0);
        }
    }
}

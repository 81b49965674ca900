//! Tags and hints over the canvas.

use egui::emath::GuiRounding as _;
use egui::{
    Align2, Color32, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2,
};

use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::shown_keys::key_of;

/// A text at the left of `rect`, ended by `…` where it is too long.
pub fn elided_text(ui: &Ui, rect: Rect, text: &str, color: Color32) {
    paint::at_left(ui, rect, paint::elided(ui, text, font::caption(), color, rect.width()));
}

/// Returns a short text on its own ground over the canvas: `+2,418 triangles`. Takes no clicks.
///
/// `align` says which point of the tag is at `anchor`; it is moved to stay within `bounds`.
pub fn floating_tag(
    ui: &Ui,
    anchor: Pos2,
    align: Align2,
    bounds: Rect,
    text: &str,
    color: Color32,
) -> Response {
    let galley = paint::line(ui, text, font::value(), color);
    let size = tag_size(ui, text);
    let rect = within(align.anchor_size(anchor, size), bounds).round_to_pixels(ui.pixels_per_point());
    let response = ui.interact(rect, ui.scope_id().with("floating tag"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
    paint_floating(ui, rect);
    paint::at_centre(ui, rect, galley);
    response
}

/// Returns the size of a [`floating_tag`], in points.
pub fn tag_size(ui: &Ui, text: &str) -> Vec2 {
    let text = paint::line(ui, text, font::value(), Color32::PLACEHOLDER);
    (text.size() + vec2(20.0, 12.0)).ceil()
}

/// A part of a hint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hint<'a> {
    /// Words.
    Text(&'a str),
    /// A key or a shortcut, drawn as keys.
    Key(&'a str),
    /// The key of an entry of a menu, by the id of the entry. Without a key it is left out, and so are the
    /// words about it.
    KeyOf(&'a str),
}

/// Returns the next useful thing for the current tool, over the canvas: `Drag to paint risk · [ ] size · …`.
/// Takes no clicks.
///
/// `align` says which point of the pill is at `anchor`; it is moved to stay within `bounds`. Pieces that do
/// not fit into `bounds` are left out from the end.
pub fn hint_pill(ui: &Ui, anchor: Pos2, align: Align2, bounds: Rect, hints: &[Hint<'_>]) -> Response {
    let hints = with_keys(ui, hints);
    let hints: Vec<Hint<'_>> = hints.iter().map(HintPiece::as_hint).collect();
    let shown = fitting(ui, &hints, bounds.width() - 24.0);
    let size = vec2(width(ui, shown) + 24.0, 32.0).ceil();
    let rect = within(align.anchor_size(anchor, size), bounds).round_to_pixels(ui.pixels_per_point());
    let response = ui.interact(rect, ui.scope_id().with("hint pill"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken(shown)));
    if ui.rect_contains_pointer(rect) {
        // The pointer is there: show the mesh.
        return response;
    }
    paint_floating(ui, rect);
    let mut at = pos2(rect.left() + 12.0, rect.center().y);
    for (i, hint) in shown.iter().enumerate() {
        at.x += paint_piece(ui, at, hint);
        let gap = gap_after(hint);
        if gap == SEPARATION && i + 1 < shown.len() {
            ui.painter().circle_filled(at + vec2(gap / 2.0, 0.0), 1.25, tokens(ui).faint);
        }
        at.x += gap;
    }
    response
}

/// A part of a hint with the key that works now.
enum HintPiece<'a> {
    Text(&'a str),
    Key(String),
}

impl HintPiece<'_> {
    fn as_hint(&self) -> Hint<'_> {
        match self {
            Self::Text(text) => Hint::Text(text),
            Self::Key(key) => Hint::Key(key),
        }
    }
}

/// Returns the hints with the keys of entries. Words about entries none of which has a key are left out.
fn with_keys<'a>(ui: &Ui, hints: &[Hint<'a>]) -> Vec<HintPiece<'a>> {
    let mut pieces = Vec::new();
    let mut lacks_key = false;
    for hint in hints {
        match *hint {
            Hint::Text(_) if lacks_key && !matches!(pieces.last(), Some(HintPiece::Key(_))) => {
                lacks_key = false
            }
            Hint::Text(text) => {
                pieces.push(HintPiece::Text(text));
                lacks_key = false;
            }
            Hint::Key(key) => pieces.push(HintPiece::Key(key.to_owned())),
            Hint::KeyOf(entry) => match key_of(ui.ctx(), entry) {
                Some(key) => pieces.push(HintPiece::Key(key)),
                None => lacks_key = true,
            },
        }
    }
    pieces
}

/// Space between keys, and between a key and what it does.
const GAP: f32 = 5.0;
/// Space after words, before the next hint; a dot is in it.
const SEPARATION: f32 = 17.0;

fn gap_after(hint: &Hint<'_>) -> f32 {
    if matches!(hint, Hint::Text(_)) { SEPARATION } else { GAP }
}

/// The ground of a widget over the canvas.
pub fn paint_floating(ui: &Ui, rect: Rect) {
    let t = tokens(ui);
    let edge = Stroke::new(1.0, t.edge);
    ui.painter().add(t.tag_shadow().as_shape(rect, metrics::RADIUS_TAG));
    ui.painter().rect(rect, metrics::RADIUS_TAG, t.popup, edge, StrokeKind::Inside);
}

/// `rect` moved as little as needed to lie within `bounds`; its start wins where it is too large.
fn within(rect: Rect, bounds: Rect) -> Rect {
    let room = (bounds.size() - rect.size()).max(Vec2::ZERO);
    let corner = rect.min - bounds.min;
    Rect::from_min_size(bounds.min + corner.clamp(Vec2::ZERO, room), rect.size())
}

fn piece_width(ui: &Ui, hint: &Hint<'_>) -> f32 {
    match hint {
        Hint::Text(text) => paint::line(ui, text, font::body(), tokens(ui).label).size().x,
        Hint::Key(key) | Hint::KeyOf(key) => paint::shortcut_width(ui, key),
    }
}

fn width(ui: &Ui, hints: &[Hint<'_>]) -> f32 {
    let pieces: f32 = hints.iter().map(|hint| piece_width(ui, hint)).sum();
    let gaps: f32 = hints.iter().take(hints.len().saturating_sub(1)).map(gap_after).sum();
    pieces + gaps
}

/// Returns the first hints that fit into `room` points; the last one explains its keys.
fn fitting<'a, 'b>(ui: &Ui, hints: &'a [Hint<'b>], room: f32) -> &'a [Hint<'b>] {
    let mut end = hints.len();
    while end > 1 && (width(ui, &hints[..end]) > room || matches!(hints[end - 1], Hint::Key(_))) {
        end -= 1;
    }
    &hints[..end]
}

fn paint_piece(ui: &Ui, at: Pos2, hint: &Hint<'_>) -> f32 {
    let width = piece_width(ui, hint);
    let rect = Rect::from_min_size(at - vec2(0.0, 10.0), vec2(width, 20.0));
    match hint {
        Hint::Text(text) => paint::at_left(ui, rect, paint::line(ui, text, font::body(), tokens(ui).label)),
        Hint::Key(key) | Hint::KeyOf(key) => paint::shortcut_at_right(ui, rect, key),
    }
    width
}

fn spoken(hints: &[Hint<'_>]) -> String {
    let words: Vec<_> = hints
        .iter()
        .map(|hint| match hint {
            Hint::Text(text) | Hint::Key(text) | Hint::KeyOf(text) => *text,
        })
        .collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_stays_within_its_bounds() {
        let bounds = Rect::from_min_size(pos2(10.0, 10.0), vec2(100.0, 100.0));
        let tag = |x, y| Rect::from_min_size(pos2(x, y), vec2(40.0, 20.0));
        assert_eq!(within(tag(-50.0, 5.0), bounds).min, pos2(10.0, 10.0));
        assert_eq!(within(tag(90.0, 200.0), bounds).max, pos2(110.0, 110.0));
        assert_eq!(within(tag(30.0, 30.0), bounds), tag(30.0, 30.0));
        let wide = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 20.0));
        assert_eq!(within(wide, bounds).min, bounds.min);
    }
}

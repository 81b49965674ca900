//! Buttons that are an icon.

use egui::{self, Color32, Rect, Response, Role, Sense, Ui, Vec2, WidgetInfo, vec2};

use super::{Icon, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::shown_keys::{key_of, with_keys};
use crate::widgets::tips;
use crate::widgets::vanished::guard;

/// A square button with an icon, a name for tests and screen readers, and a tooltip with its key.
#[must_use = "call `show`"]
pub struct ToolButton<'a> {
    icon: Icon,
    name: &'a str,
    key: &'a str,
    entry: &'a str,
    selected: bool,
    size: f32,
}

impl<'a> ToolButton<'a> {
    /// Creates a button of the tool strip, 40 points wide.
    pub fn new(icon: Icon, name: &'a str) -> Self {
        Self { icon, name, key: "", entry: "", selected: false, size: metrics::TOOL }
    }

    /// Returns a button within a row, 24 points wide.
    pub fn small(icon: Icon, name: &'a str) -> Self {
        Self { size: metrics::ROW, ..Self::new(icon, name) }
    }

    /// Returns a key that nobody can change, for the tooltip: `Alt+↑`.
    pub fn key(mut self, key: &'a str) -> Self {
        self.key = key;
        self
    }

    /// Sets the entry of a menu that does the same, by its id or title: the tooltip shows its key.
    pub fn entry(mut self, entry: &'a str) -> Self {
        self.entry = entry;
        self
    }

    /// Returns whether this is the selected tool.
    pub fn selected(mut self, selected: bool) -> Self {
        self.selected = selected;
        self
    }

    /// Shows the button; the response has `clicked`.
    pub fn show(self, ui: &mut Ui) -> Response {
        let (rect, response) = ui.allocate_exact_size(Vec2::splat(self.size), Sense::click());
        response
            .widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), self.selected, self.name));
        self.paint(ui, rect, &response);
        let text = tips::sentence(self.name);
        let text = if text.is_empty() { self.name } else { text };
        tips::explain_with(ui, response, text, |ui| self.tooltip(ui))
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response) {
        let t = tokens(ui);
        let pressed = response.is_pointer_button_down_on();
        let (fill, ink) = match (self.selected, response.hovered()) {
            (true, _) => (t.selected, t.on_selected),
            (false, true) if pressed => (t.hover, t.value),
            (false, true) => (t.field, t.value),
            (false, false) => (Color32::TRANSPARENT, t.label),
        };
        let radius = if self.size < metrics::TOOL { metrics::RADIUS_CONTROL } else { metrics::RADIUS_PANEL };
        ui.painter().rect_filled(rect, radius, fill);
        let size = if self.size < metrics::TOOL { 16.0 } else { 22.0 };
        paint::at_centre(ui, rect, paint::line(ui, self.icon.glyph(), font::icon(size), ink));
        paint::focus_ring(ui, response, rect.shrink(1.0), radius);
    }

    fn tooltip(&self, ui: &mut Ui) {
        let name = paint::line(ui, self.name, font::body(), tokens(ui).text);
        let key = key_of(ui.ctx(), &self.entry.to_lowercase().replace(' ', "-"));
        let key = key.unwrap_or_else(|| self.key.to_owned());
        let keys = if key.is_empty() { 0.0 } else { 12.0 + paint::shortcut_width(ui, &key) };
        let (rect, _) = ui.allocate_exact_size(vec2(name.size().x + keys, 20.0), Sense::hover());
        paint::at_left(ui, rect, name);
        paint::shortcut_at_right(ui, rect, &key);
        let text = tips::sentence(self.name);
        if !text.is_empty() {
            let text = with_keys(ui.ctx(), text);
            ui.label(egui::RichText::new(text).color(tokens(ui).label));
        }
    }
}

/// The kinds of [`ActionButton`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ButtonKind {
    /// The most likely choice.
    Main,
    /// Everything else.
    Quiet,
    /// Destroys something.
    Danger,
}

/// A button with a word on it.
#[must_use = "add it to a `Ui`"]
pub struct ActionButton<'a> {
    text: &'a str,
    name: &'a str,
    kind: ButtonKind,
    vanishes: bool,
}

impl<'a> ActionButton<'a> {
    /// Creates a quiet button.
    pub fn new(text: &'a str) -> Self {
        Self { text, name: text, kind: ButtonKind::Quiet, vanishes: false }
    }

    /// Returns a longer name, for tests and screen readers, where the word alone is ambiguous.
    pub fn named(mut self, name: &'a str) -> Self {
        self.name = name;
        self
    }

    /// Says that the button disappears by itself, for example when work ends. Then its place takes no click
    /// for half a second.
    pub fn vanishing(mut self) -> Self {
        self.vanishes = true;
        self
    }

    /// How prominent it is.
    pub fn kind(mut self, kind: ButtonKind) -> Self {
        self.kind = kind;
        self
    }
}

impl egui::Widget for ActionButton<'_> {
    fn ui(self, ui: &mut Ui) -> Response {
        let t = tokens(ui);
        let ink = if self.kind == ButtonKind::Quiet { t.text } else { t.on_selected };
        let text = paint::line(ui, self.text, font::body(), ink);
        let size = vec2(text.size().x.ceil() + 24.0, metrics::ROW + 4.0);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), self.name));
        if self.vanishes {
            guard(&response);
        }
        let (rest, lit) = match self.kind {
            ButtonKind::Main => (t.selected, t.selected.lerp_to_gamma(t.value, 0.12)),
            ButtonKind::Danger => (t.danger_fill, t.danger_fill.lerp_to_gamma(Color32::BLACK, 0.15)),
            ButtonKind::Quiet => (t.field, t.hover),
        };
        ui.painter().rect_filled(rect, metrics::RADIUS_CONTROL, if response.hovered() { lit } else { rest });
        paint::at_centre(ui, rect, text);
        paint::focus_ring(ui, &response, rect, metrics::RADIUS_CONTROL);
        tips::explain(ui, response, tips::sentence(self.text))
    }
}

//! A row of a list of layers.

use egui::text::{CCursor, CCursorRange};
use egui::{
    self, Color32, Key, Rect, Response, Role, Sense, Stroke, StrokeKind, TextEdit, TextureHandle, Ui,
    UiBuilder, WidgetInfo, pos2, vec2,
};

use super::{Icon, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// Side of the small picture, in points.
const PICTURE: f32 = 26.0;
const BUTTON: f32 = metrics::ROW;

/// A layer: eye, small picture, sign of its kind, colour, name, how it is combined, lock.
///
/// ```text
/// | eye | picture | sign · dot · name …            combine | lock |
/// ```
///
/// The row is selected by a click and can be dragged. A double click asks to rename it, as does F2 while it
/// has the focus.
#[must_use = "call `show`"]
pub struct LayerRow<'a> {
    /// Tells rows of the same name apart.
    pub id: u32,
    /// The name of the layer, by which tests and screen readers find the row.
    pub name: &'a str,
    /// The sign of its kind.
    pub icon: Icon,
    /// The kind of the layer, in words.
    pub kind: &'a str,
    /// How it is combined, in a word.
    pub combine: &'a str,
    /// The colour of the layer in the overlay.
    pub color: Color32,
    /// A small picture of the layer's target diameters, once it is drawn.
    pub picture: Option<&'a TextureHandle>,
    /// Whether the eye is open.
    pub visible: bool,
    /// Whether the lock is closed.
    pub locked: bool,
    /// Whether it is the selected row.
    pub selected: bool,
    /// Whether the field for a new name takes the focus in this frame.
    pub begins_typing: bool,
}

/// The answer of [`LayerRow::show`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerRowAnswer {
    /// Nothing happened.
    None,
    /// The row was clicked.
    Selected,
    /// The row was double-clicked, or F2 was pressed.
    AsksName,
    /// The new name was entered.
    Named,
    /// Typing was given up.
    NotNamed,
    /// The eye was clicked: whether it opens.
    Shown(bool),
    /// The lock was clicked: whether it closes.
    Locked(bool),
}

impl LayerRow<'_> {
    /// Height of a row in points.
    pub const HEIGHT: f32 = 32.0;

    /// Shows the row, with a field in place of the name where a new one is being `typed`. The response is
    /// that of the row; it can be dragged.
    pub fn show(self, ui: &mut Ui, typed: Option<&mut String>) -> (Response, LayerRowAnswer) {
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), Self::HEIGHT));
        let response = ui.interact(rect, ui.make_persistent_id(("layer", self.id)), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(format!("{}, {}", self.kind, self.combine)),
            ..WidgetInfo::selected(Role::ListBoxOption, ui.is_enabled(), self.selected, self.name)
        });
        self.paint_ground(ui, rect, &response);
        let mut answer = self.answer_of_row(ui, &response);
        let eye = if self.visible { Icon::VISIBLE } else { Icon::HIDDEN };
        let eye_place = Rect::from_min_size(rect.min, vec2(BUTTON, rect.height()));
        if self.switch(ui, eye_place, eye, "visible", self.visible) {
            answer = LayerRowAnswer::Shown(!self.visible);
        }
        let lock = if self.locked { Icon::LOCKED } else { Icon::UNLOCKED };
        let lock_place = eye_place.translate(vec2(rect.width() - BUTTON, 0.0));
        if self.switch(ui, lock_place, lock, "locked", self.locked) {
            answer = LayerRowAnswer::Locked(!self.locked);
        }
        let rest = rect.with_min_x(eye_place.right() + 2.0).with_max_x(lock_place.left() - 4.0);
        let after_signs = self.paint_signs(ui, rest);
        match typed {
            Some(text) => answer = self.name_field(ui, after_signs, text).unwrap_or(answer),
            None => self.paint_name(ui, after_signs),
        }
        let response = tips::explain(ui, response, tips::sentence("Layer"));
        (response, answer)
    }

    fn answer_of_row(&self, ui: &Ui, response: &Response) -> LayerRowAnswer {
        let renames = response.has_focus() && ui.input(|input| input.key_pressed(Key::F2));
        if response.double_clicked() || renames {
            LayerRowAnswer::AsksName
        } else if response.clicked() || (response.drag_started() && !self.selected) {
            LayerRowAnswer::Selected
        } else {
            LayerRowAnswer::None
        }
    }

    fn paint_ground(&self, ui: &Ui, rect: Rect, response: &Response) {
        let t = tokens(ui);
        let (fill, edge) = match (self.selected, response.hovered()) {
            (true, _) => (t.raised, Stroke::new(1.0, t.accent)),
            (false, true) => (t.field, Stroke::NONE),
            (false, false) => (Color32::TRANSPARENT, Stroke::NONE),
        };
        let inner = rect.shrink2(vec2(0.0, 1.0));
        ui.painter().rect(inner, metrics::RADIUS_CONTROL, fill, edge, StrokeKind::Inside);
        paint::focus_ring(ui, response, inner.shrink(3.0), metrics::RADIUS_CONTROL);
    }

    /// Returns a small button that is on or off. Returns whether it was clicked.
    fn switch(&self, ui: &Ui, rect: Rect, icon: Icon, what: &str, on: bool) -> bool {
        let t = tokens(ui);
        let response = ui.interact(rect, ui.make_persistent_id((what, self.id)), Sense::click());
        let name = format!("{} {what}", self.name);
        response.widget_info(|| WidgetInfo::selected(Role::CheckBox, ui.is_enabled(), on, &name));
        // What is not as usual stands out: hidden layers and locked ones.
        let is_default = on == (what == "visible");
        let ink = match (response.hovered(), is_default) {
            (true, _) => t.value,
            (false, true) if what == "locked" => t.faint.gamma_multiply(0.6),
            (false, true) => t.label,
            (false, false) => t.accent,
        };
        paint::at_centre(ui, rect, paint::line(ui, icon.glyph(), font::icon(16.0), ink));
        paint::focus_ring(ui, &response, rect.shrink(4.0), 4);
        tips::explain(ui, response, tips::sentence(&format!("Layer/{what}"))).clicked()
    }

    /// Returns the small picture, the sign of the kind and the dot. Returns the room after them.
    fn paint_signs(&self, ui: &Ui, rest: Rect) -> Rect {
        let t = tokens(ui);
        let opacity = self.opacity();
        let place = pos2(rest.left() + PICTURE / 2.0, rest.center().y);
        let well = Rect::from_center_size(place, vec2(PICTURE, PICTURE));
        ui.painter().rect(well, 3.0, t.canvas, t.hairline(), StrokeKind::Inside);
        if let Some(picture) = self.picture {
            let size = picture.size_vec2();
            let inner = (PICTURE - 2.0) / size.max_elem() * size;
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let tint = Color32::WHITE.gamma_multiply(opacity);
            ui.painter().image(picture.id(), Rect::from_center_size(place, inner), whole, tint);
        }
        let sign = Rect::from_min_size(pos2(well.right() + 6.0, rest.top()), vec2(16.0, rest.height()));
        let ink = t.label.gamma_multiply(opacity);
        paint::at_centre(ui, sign, paint::line(ui, self.icon.glyph(), font::icon(15.0), ink));
        let dot = pos2(sign.right() + 8.0, rest.center().y);
        let edge = Stroke::new(1.0, self.color.lerp_to_gamma(t.value, 0.25).gamma_multiply(opacity));
        ui.painter().circle(dot, 4.0, self.color.gamma_multiply(opacity), edge);
        rest.with_min_x(dot.x + 10.0)
    }

    fn paint_name(&self, ui: &Ui, room: Rect) {
        let t = tokens(ui);
        let opacity = self.opacity();
        let combine = paint::line(ui, self.combine, font::caption(), t.label.gamma_multiply(opacity));
        let name = room.with_max_x(room.right() - combine.size().x - 8.0);
        let ink = if self.selected { t.value } else { t.text };
        let ink = ink.gamma_multiply(opacity);
        paint::at_left(ui, name, paint::elided(ui, self.name, font::body(), ink, name.width()));
        paint::at_right(ui, room, combine);
    }

    /// Hidden layers are faint.
    fn opacity(&self) -> f32 {
        if self.visible { 1.0 } else { 0.55 }
    }

    /// Shows the field for a new name. Returns how typing ended, if it did.
    fn name_field(&self, ui: &mut Ui, room: Rect, text: &mut String) -> Option<LayerRowAnswer> {
        let t = tokens(ui);
        let field = room.shrink2(vec2(0.0, 4.0)).expand2(vec2(4.0, 0.0));
        ui.painter().rect(field, 4.0, t.field, Stroke::new(1.0, t.accent), StrokeKind::Inside);
        let id = ui.make_persistent_id(("name of the layer", self.id));
        let mut child = ui.new_child(UiBuilder::new().max_rect(field.shrink2(vec2(4.0, 0.0))));
        let edit = TextEdit::singleline(text)
            .id(id)
            .font(font::body())
            .text_color(t.value)
            .align(egui::Align2::LEFT_CENTER)
            .frame(egui::Frame::NONE)
            .desired_width(room.width())
            .min_size(vec2(room.width(), field.height()));
        if self.begins_typing {
            ui.memory_mut(|memory| memory.request_focus(id));
        }
        let mut output = child.name_inputs("New name of the layer", |ui| edit.show(ui));
        child.ctx().accesskit_node_builder(id, |node| node.set_label("New name of the layer"));
        if self.begins_typing {
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
            output.state.cursor.set_char_range(Some(all));
            output.state.store(ui.ctx(), id);
        }
        let response = output.response.response;
        let response = tips::explain(ui, response, tips::sentence("New name of the layer"));
        if !response.lost_focus() {
            return None;
        }
        // Not by Escape, which may be gone from the input by now.
        let is_entered = ui.input(|input| {
            let by_key = input.key_pressed(Key::Enter) || input.key_pressed(Key::Tab);
            by_key || input.pointer.any_pressed() || input.pointer.any_click()
        });
        Some(if is_entered { LayerRowAnswer::Named } else { LayerRowAnswer::NotNamed })
    }
}

//! A number that is typed, dragged or turned by the wheel.

use std::time::Duration;

use egui::text::CCursorRange;
use egui::{
    self, Align, Align2, Color32, CursorIcon, Id, Key, Modifiers, PointerButton, Rect, Response, Role, Sense,
    Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};

use super::message::message;
use super::number_input::{Entered, NumberInput, PX_PER_STEP};
use super::number_menu::{WAYS, number_menu, pasted};
use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::degrees::metric_in_degrees;
use crate::widgets::shown_keys::with_keys;
use crate::widgets::tips;
use meshbrush_mesh::text::{LengthUnit, typed};

/// Seconds after the last turn of the wheel until its value is taken, so that a turn is one gesture.
const WHEEL_REST: f64 = 0.25;
/// Seconds after which a remark goes away by itself, and those that it stays at least.
const REMARK_SECONDS: f64 = 12.0;
const LEAST_REMARK_SECONDS: f64 = 0.5;
/// Points of a wheel event that are one step of the wheel.
const WHEEL_PX: f32 = 40.0;

/// A number within a control.
///
/// A click, a double click or Tab turns it into a text field with the whole number selected; the arrow keys
/// Up and Down change it there. Dragging it sideways changes it, with Shift ten times finer; so does the
/// wheel with Ctrl while the pointer is over it. A secondary click opens a menu with the default, Copy and
/// Paste. If a number could not be taken as it was typed, a sentence says so; [`Self::show_remark`] shows it
/// beside the panel.
pub(super) struct NumberCell<'a> {
    /// Keeps the focus while the cell moves.
    pub id: Id,
    /// The rectangle of the number, in points; its background is slightly larger.
    pub rect: Rect,
    /// Name for tests and screen readers.
    pub name: &'a str,
    /// The meaning of the number, in a sentence with its unit.
    pub help: &'a str,
    /// The number and what it may be.
    pub input: NumberInput<'a>,
    /// Left or right.
    pub align: Align,
    /// Whether the background is visible while the pointer is elsewhere.
    pub boxed: bool,
    /// Whether each movement of a drag is returned, and not only where it ends.
    pub live: bool,
}

/// A sentence about what was typed, in egui's memory. It goes away when the value changes, or a person goes
/// on.
#[derive(Clone, Debug)]
struct Remark {
    text: String,
    value: f64,
    /// When it was said, in seconds of egui's clock.
    since: f64,
}

/// A value that is being dragged or turned, in egui's memory.
#[derive(Clone, Copy, Debug)]
struct Moving {
    from: f64,
    px: f64,
    /// When the wheel was last turned.
    at: f64,
}

impl NumberCell<'_> {
    /// Shows the cell, and returns the number once it was changed.
    ///
    /// The response covers the cell's place. While a number is dragged it has the flags of the drag; it has
    /// none of those of the text field within, which changes with each key.
    pub fn show(&self, ui: &mut Ui) -> (Response, Option<f64>) {
        let around = ui.interact(self.ground(), self.id.with("cell"), Sense::hover());
        if ui.is_enabled() && self.is_edited(ui) {
            return (around, self.edit(ui));
        }
        self.take_up_editing(ui);
        // As many automatic ids as with a text field: else the next button changes its id while Tab leads to
        // it, and the focus is lost.
        ui.skip_ahead_auto_ids(1);
        let typed = self.finish(ui, false);
        let pasted = pasted(ui, self.id).and_then(|text| self.read(ui, &text));
        let (response, moved) = self.rest(ui);
        (around | response, typed.or(pasted).or(moved))
    }

    /// Lets the number of the cell `id` be typed from the next frame on: in this one, a click elsewhere would
    /// take the focus away again.
    pub fn edit_soon(ui: &Ui, id: Id) {
        ui.data_mut(|data| data.insert_temp(id.with("edit soon"), ()));
        ui.ctx().request_repaint();
    }

    /// Returns the number that is being typed in the cell `id`, if it can be read.
    pub fn typed_so_far(ui: &Ui, id: Id, unit: &str) -> Option<f64> {
        let text = ui.data(|data| data.get_temp::<String>(id))?;
        typed::number(&text, unit).ok().filter(|typed| typed.is_finite())
    }

    fn take_up_editing(&self, ui: &Ui) {
        let id = self.id.with("edit soon");
        if ui.input(|input| !input.pointer.any_click())
            && ui.data_mut(|data| data.remove_temp::<()>(id)).is_some()
        {
            ui.memory_mut(|memory| memory.request_focus(self.id));
        }
    }

    /// Returns whether a number is being typed.
    pub fn is_edited(&self, ui: &Ui) -> bool {
        ui.memory(|memory| memory.has_focus(self.id))
    }

    /// Shows the sentence about what was typed last, as long as the number is still `value`, until a person
    /// goes on with something else, and for some seconds at most.
    pub fn show_remark(ui: &Ui, id: Id, place: Rect, value: f64) {
        let remark_id = id.with("remark");
        let Some(remark) = ui.data(|data| data.get_temp::<Remark>(remark_id)) else { return };
        let is_typed = ui.memory(|memory| memory.has_focus(id));
        let (age, goes_on) = ui.input(|input| (input.time - remark.since, input.pointer.any_pressed()));
        let is_over = !is_typed && (age > REMARK_SECONDS || (goes_on && age > LEAST_REMARK_SECONDS));
        if remark.value != value || is_over {
            return ui.data_mut(|data| data.remove::<Remark>(remark_id));
        }
        message(ui, remark_id, place, &remark.text);
        let left = Duration::from_secs_f64((REMARK_SECONDS - age).max(0.0) + 0.1);
        ui.ctx().request_repaint_after(left);
    }

    fn keep_remark(&self, ui: &Ui, remark: Option<String>, value: f64) {
        let id = self.id.with("remark");
        match remark {
            Some(text) => {
                let since = ui.input(|input| input.time);
                ui.data_mut(|data| data.insert_temp(id, Remark { text, value, since }));
            }
            None => ui.data_mut(|data| data.remove::<Remark>(id)),
        }
    }

    /// Changes the number by pointer and wheel, while it is not typed.
    fn rest(&self, ui: &Ui) -> (Response, Option<f64>) {
        let response = ui
            .interact(self.ground(), self.id, Sense::click_and_drag())
            .on_hover_cursor(CursorIcon::ResizeHorizontal);
        if response.clicked() {
            response.request_focus();
        }
        let id = self.id.with("moving");
        let mut moving: Option<Moving> = ui.data(|data| data.get_temp(id));
        let done = self.drag(ui, &response, &mut moving) | self.turn(ui, &response, &mut moving);
        let shown = moving.map_or(self.input.value, |moving| self.input.moved(moving.from, moving.px));
        self.paint_rest(ui, &response, shown);
        let reset = number_menu(ui, &response, &self.input, Some(self.id));
        if reset.is_some() {
            self.keep_remark(ui, None, 0.0);
        }
        let response = self.explain(ui, response);
        let taken = moving.filter(|_| done || (self.live && response.dragged())).map(|_| shown);
        match moving.filter(|_| !done) {
            Some(moving) => drop(ui.data_mut(|data| data.insert_temp(id, moving))),
            None => ui.data_mut(|data| data.remove::<Moving>(id)),
        }
        (response, taken.or(reset).filter(|value| *value != self.input.value))
    }

    /// Adds the meaning of the number to its tooltip, and how it is changed. A remark is where the tooltip
    /// would be.
    fn explain(&self, ui: &Ui, response: Response) -> Response {
        if ui.data(|data| data.get_temp::<Remark>(self.id.with("remark"))).is_some() {
            return response;
        }
        let text = [self.help, WAYS].join(if self.help.is_empty() { "" } else { " " });
        tips::explain_with(ui, response, &text, |ui| {
            if !self.help.is_empty() {
                ui.label(with_keys(ui.ctx(), self.help));
            }
            ui.label(egui::RichText::new(WAYS).font(font::caption()).color(tokens(ui).label));
        })
    }

    /// Follows a drag; returns whether it ended.
    fn drag(&self, ui: &Ui, response: &Response, moving: &mut Option<Moving>) -> bool {
        if response.drag_started() {
            *moving = Some(Moving { from: self.input.value, px: 0.0, at: f64::INFINITY });
            self.keep_remark(ui, None, 0.0);
        }
        if let Some(moving) = moving.as_mut().filter(|_| response.dragged_by(PointerButton::Primary)) {
            let fine = if ui.input(|input| input.modifiers.shift) { 0.1 } else { 1.0 };
            moving.px += fine * f64::from(response.drag_delta().x);
        }
        response.drag_stopped()
    }

    /// Follows the wheel while Ctrl is held; returns whether it came to rest. Without Ctrl the wheel scrolls
    /// the panel, so that scrolling never changes a number.
    fn turn(&self, ui: &Ui, response: &Response, moving: &mut Option<Moving>) -> bool {
        let now = ui.input(|input| input.time);
        let steps = if response.hovered() { ui.input(wheel_steps) } else { 0.0 };
        if steps != 0.0 {
            let from = moving.unwrap_or(Moving { from: self.input.value, px: 0.0, at: now });
            *moving = Some(Moving { px: from.px + steps * PX_PER_STEP, at: now, ..from });
            self.keep_remark(ui, None, 0.0);
        }
        let turned = moving.is_some_and(|moving| moving.at.is_finite());
        let at_rest = moving.is_some_and(|moving| !response.hovered() || now - moving.at > WHEEL_REST);
        if turned && !at_rest {
            ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(WHEEL_REST));
        }
        turned && at_rest
    }

    fn paint_rest(&self, ui: &Ui, response: &Response, value: f64) {
        let t = tokens(ui);
        let shown = (self.input.show)(value);
        let enabled = ui.is_enabled();
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(shown.clone()),
            ..WidgetInfo::labeled(Role::TextInput, enabled, self.name)
        });
        let fill = match (response.hovered() || response.dragged(), self.boxed) {
            (true, _) => t.hover,
            (false, true) => t.field,
            (false, false) => Color32::TRANSPARENT,
        };
        ui.painter().rect_filled(self.ground(), metrics::RADIUS_CONTROL, fill);
        let text = paint::elided(ui, &shown, font::value(), t.value, self.rect.width());
        match self.align {
            Align::Max => paint::at_right(ui, self.rect, text),
            _ => paint::at_left(ui, self.rect, text),
        }
    }

    /// Edits the number while it is typed.
    fn edit(&self, ui: &mut Ui) -> Option<f64> {
        let kept = ui.data(|data| data.get_temp::<String>(self.id));
        let fresh = kept.is_none();
        let mut text = kept.unwrap_or_else(|| self.input.exact());
        if fresh {
            self.keep_remark(ui, None, 0.0);
            ui.data_mut(|data| data.insert_temp(self.untouched_id(), text.clone()));
        }
        let stepped = self.step(ui, &mut text);
        self.paint_edited_ground(ui, typed::number(&text, self.input.unit).is_ok());
        let response = self.text_edit(ui, &mut text, fresh || stepped);
        if response.changed() {
            self.keep_remark(ui, None, 0.0);
        }
        ui.data_mut(|data| data.insert_temp(self.id, text));
        if response.secondary_clicked() {
            response.surrender_focus();
        }
        // Opens with this click, and stays open while the number is no longer typed.
        let reset = number_menu(ui, &response, &self.input, Some(self.id));
        if response.lost_focus() { self.finish(ui, true) } else { reset }
    }

    /// Changes the typed number by the keys Up and Down, and by the wheel with Ctrl over it. Returns whether
    /// the text changed.
    fn step(&self, ui: &Ui, text: &mut String) -> bool {
        let is_under_pointer = ui.rect_contains_pointer(self.ground());
        let steps = ui.input_mut(|input| {
            let turned = if is_under_pointer { wheel_steps(input) } else { 0.0 };
            let mut count = |key| input.count_and_consume_key(Modifiers::NONE, key) as f64;
            turned + count(Key::ArrowUp) - count(Key::ArrowDown)
        });
        let Some(typed) = typed::number(text, self.input.unit).ok().filter(|_| steps != 0.0) else {
            return false;
        };
        *text = self.input.moved(typed, steps * PX_PER_STEP).to_string();
        true
    }

    fn text_edit(&self, ui: &mut Ui, text: &mut String, select_all: bool) -> Response {
        let mut child = ui.new_child(egui::UiBuilder::new().max_rect(self.rect));
        let edit = egui::TextEdit::singleline(text)
            .id(self.id)
            .font(font::value())
            .text_color(tokens(ui).value)
            .align(Align2([self.align, Align::Center]))
            .frame(egui::Frame::NONE)
            .desired_width(self.rect.width())
            .min_size(self.rect.size());
        let mut output = child.name_inputs(self.name, |ui| edit.show(ui));
        // The second click of a double click would select a part of the number.
        let untouched = *text == self.input.exact();
        if select_all || (untouched && output.response.response.double_clicked()) {
            output.state.cursor.set_char_range(Some(CCursorRange::select_all(&output.galley)));
            output.state.store(ui.ctx(), self.id);
        }
        output.response.response
    }

    fn paint_edited_ground(&self, ui: &Ui, valid: bool) {
        let t = tokens(ui);
        let edge = Stroke::new(1.0, if valid { t.accent } else { t.danger });
        ui.painter().rect(self.ground(), metrics::RADIUS_CONTROL, t.field, edge, StrokeKind::Inside);
    }

    /// Ends an edit. Returns the number that was typed, unless Escape was pressed.
    ///
    /// Where the text cannot be read, a sentence says so; after Enter the field keeps the focus and the text.
    fn finish(&self, ui: &Ui, in_field: bool) -> Option<f64> {
        let text = ui.data_mut(|data| data.remove_temp::<String>(self.id))?;
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        // The number may have changed elsewhere meanwhile, as by an undo.
        let untouched = ui.data_mut(|data| data.remove_temp::<String>(self.untouched_id()));
        if pressed(Key::Escape) || text == self.input.exact() || untouched.as_ref() == Some(&text) {
            return None;
        }
        match self.entered(ui, &text) {
            Err(problem) if in_field && pressed(Key::Enter) => {
                self.keep_remark(ui, Some(problem), self.input.value);
                ui.data_mut(|data| data.insert_temp(self.id, text));
                ui.memory_mut(|memory| memory.request_focus(self.id));
                None
            }
            _ => self.read(ui, &text),
        }
    }

    /// Returns the value that a text stands for, or a sentence that says what was not understood and, for a
    /// metric length in degrees, what to type.
    fn entered(&self, ui: &Ui, text: &str) -> Result<Entered, String> {
        let is_in_degrees = self.input.unit == LengthUnit::Degree.symbol();
        self.input.read(text).map_err(|problem| {
            let length = is_in_degrees.then(|| metric_in_degrees(ui.ctx(), text)).flatten();
            length.map_or(problem.clone(), |length| format!("{problem} {length}"))
        })
    }

    /// Reads a text as the number. Where it cannot be taken as it is, a sentence says so.
    fn read(&self, ui: &Ui, text: &str) -> Option<f64> {
        match self.entered(ui, text) {
            Ok(Entered { value, remark }) => {
                self.keep_remark(ui, remark, value);
                Some(value).filter(|value| *value != self.input.value)
            }
            Err(problem) => {
                let kept = (self.input.show)(self.input.value);
                let text = format!("{problem} {} is still {kept}.", self.input.name);
                self.keep_remark(ui, Some(text), self.input.value);
                None
            }
        }
    }

    /// Under it, egui's memory has the text with which an edit began.
    fn untouched_id(&self) -> Id {
        self.id.with("untouched text")
    }

    fn ground(&self) -> Rect {
        self.rect.expand2(vec2(if self.boxed { 8.0 } else { 6.0 }, 0.0))
    }
}

/// Returns the steps of the wheel with Ctrl held in this frame, up positive.
fn wheel_steps(input: &egui::InputState) -> f64 {
    let steps = input.events.iter().map(|event| match event {
        egui::Event::MouseWheel { unit, delta, modifiers, .. } if modifiers.command => match unit {
            egui::MouseWheelUnit::Point => delta.y / WHEEL_PX,
            egui::MouseWheelUnit::Line => delta.y,
            egui::MouseWheelUnit::Page => 10.0 * delta.y,
        },
        _ => 0.0,
    });
    f64::from(steps.sum::<f32>())
}

//! Numbers that can be typed: a cell within other widgets, and a row with a field.

use std::ops::RangeInclusive;

use eframe::egui::{
    self, Align, Align2, Color32, Id, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};
use egui::text::CCursorRange;

use super::{format, paint};
use crate::app::theme::{font, metrics, tokens};

/// A number that turns into a text field when clicked or reached by Tab.
pub(super) struct NumberCell<'a> {
    /// Keeps the focus while the cell moves.
    pub id: Id,
    /// Where the number is; its background is slightly larger.
    pub rect: Rect,
    /// Name for tests and screen readers.
    pub name: &'a str,
    /// The number as shown, with its unit.
    pub shown: &'a str,
    /// The number as offered for editing.
    pub exact: &'a str,
    /// The unit, which may be typed or left out.
    pub unit: &'a str,
    /// Left or right.
    pub align: Align,
    /// Whether the background is visible while the pointer is elsewhere.
    pub boxed: bool,
}

impl NumberCell<'_> {
    /// Shows the cell. The number is what was typed, once it is complete; wrong input is dropped.
    ///
    /// The response covers the cell's place and has none of the flags of the text field within, which changes
    /// with each key.
    pub fn show(self, ui: &mut Ui) -> (Response, Option<f64>) {
        let around = ui.interact(self.ground(), self.id.with("cell"), Sense::hover());
        if ui.is_enabled() && self.is_edited(ui) {
            return (around, self.edit(ui));
        }
        let typed = self.finish(ui);
        self.rest(ui);
        (around, typed)
    }

    /// Whether a number is being typed.
    pub fn is_edited(&self, ui: &Ui) -> bool {
        ui.memory(|memory| memory.has_focus(self.id))
    }

    /// The number while it is not edited.
    fn rest(&self, ui: &Ui) {
        let t = tokens(ui);
        let ground = self.ground();
        let response = ui.interact(ground, self.id, Sense::click()).on_hover_cursor(egui::CursorIcon::Text);
        if response.clicked() {
            response.request_focus();
        }
        let enabled = ui.is_enabled();
        response.widget_info(|| WidgetInfo {
            current_text_value: Some(self.shown.to_owned()),
            ..WidgetInfo::labeled(Role::TextInput, enabled, self.name)
        });
        let fill = match (response.hovered(), self.boxed) {
            (true, _) => t.hover,
            (false, true) => t.field,
            (false, false) => Color32::TRANSPARENT,
        };
        ui.painter().rect_filled(ground, metrics::RADIUS_CONTROL, fill);
        let text = paint::elided(ui, self.shown, font::value(), t.value, self.rect.width());
        match self.align {
            Align::Max => paint::at_right(ui, self.rect, text),
            _ => paint::at_left(ui, self.rect, text),
        }
    }

    /// The number while it is edited.
    fn edit(&self, ui: &mut Ui) -> Option<f64> {
        let kept = ui.data(|data| data.get_temp::<String>(self.id));
        let fresh = kept.is_none();
        let mut text = kept.unwrap_or_else(|| self.exact.to_owned());
        self.paint_edited_ground(ui, format::parse(&text, self.unit).is_some());
        let response = self.text_edit(ui, &mut text, fresh);
        ui.data_mut(|data| data.insert_temp(self.id, text));
        if response.lost_focus() { self.finish(ui) } else { None }
    }

    fn text_edit(&self, ui: &mut Ui, text: &mut String, fresh: bool) -> Response {
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
        if fresh {
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

    /// Ends an edit. Returns the number that was typed, unless Escape was pressed or the text is no number.
    fn finish(&self, ui: &Ui) -> Option<f64> {
        let text = ui.data_mut(|data| data.remove_temp::<String>(self.id))?;
        let cancelled = ui.input(|input| input.key_pressed(egui::Key::Escape));
        if cancelled || text == self.exact {
            return None;
        }
        format::parse(&text, self.unit)
    }

    fn ground(&self) -> Rect {
        self.rect.expand2(vec2(if self.boxed { 8.0 } else { 6.0 }, 0.0))
    }
}

/// A name and a number in a field, for values that have no useful slider: coordinates, limits, counts.
///
/// The number is in the caller's unit. The response has `changed` once a new number was typed.
#[must_use = "call `show`"]
pub struct NumberRow<'a> {
    label: &'a str,
    value: &'a mut f64,
    range: RangeInclusive<f64>,
    unit: &'a str,
    integer: bool,
    help: &'a str,
}

impl<'a> NumberRow<'a> {
    /// A row named `label`; any finite number is allowed.
    pub fn new(label: &'a str, value: &'a mut f64) -> Self {
        let range = f64::MIN..=f64::MAX;
        Self { label, value, range, unit: "", integer: false, help: "" }
    }

    /// Numbers outside `range` become its nearer end.
    pub fn range(mut self, range: RangeInclusive<f64>) -> Self {
        self.range = range;
        self
    }

    /// Shown after the number.
    pub fn unit(mut self, unit: &'a str) -> Self {
        self.unit = unit;
        self
    }

    /// Whole numbers only, grouped by thousands.
    pub fn integer(mut self) -> Self {
        self.integer = true;
        self
    }

    /// Shown when the pointer rests on the name.
    pub fn help(mut self, help: &'a str) -> Self {
        self.help = help;
        self
    }

    /// Shows the row.
    pub fn show(self, ui: &mut Ui) -> Response {
        let row = paint::row(ui);
        let columns = paint::Columns::of(row).widened_for(ui, self.label);
        paint::label(ui, columns.label, self.label, self.help);
        let (shown, exact) = (format::with_unit(&self.text(), self.unit), self.exact());
        let cell = NumberCell {
            id: ui.make_persistent_id(("number", self.label)),
            rect: columns.rest.shrink2(vec2(8.0, 0.0)),
            name: self.label,
            shown: &shown,
            exact: &exact,
            unit: self.unit,
            align: Align::Max,
            boxed: true,
        };
        let (mut response, typed) = cell.show(ui);
        if let Some(typed) = typed {
            let whole = if self.integer { typed.round() } else { typed };
            *self.value = whole.clamp(*self.range.start(), *self.range.end());
            response.mark_changed();
        }
        response
    }

    fn text(&self) -> String {
        if self.integer { format::fixed(*self.value, 0) } else { format::digits(*self.value, 6) }
    }

    fn exact(&self) -> String {
        if self.integer { format!("{:.0}", *self.value) } else { self.value.to_string() }
    }
}

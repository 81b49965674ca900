//! A row with a number.

use std::ops::RangeInclusive;

use egui::{Align, Response, Ui, vec2};

use super::number_cell::NumberCell;
use super::number_input::NumberInput;
use super::{format, paint};
use crate::widgets::tips;

/// A name and a number in a field, for values that have no useful slider: coordinates, limits, counts.
///
/// The number is in the caller's unit. The response has `changed` once a new number was entered; a drag or a
/// turn of the wheel is entered where it ends.
#[must_use = "call `show`"]
pub struct NumberRow<'a> {
    label: &'a str,
    /// The longest label of the column, which decides where the fields begin.
    longest_label: &'a str,
    value: &'a mut f64,
    range: RangeInclusive<f64>,
    unit: &'a str,
    integer: bool,
    default: Option<f64>,
    help: &'a str,
}

impl<'a> NumberRow<'a> {
    /// Creates a row named `label`; any finite number is allowed.
    pub fn new(label: &'a str, value: &'a mut f64) -> Self {
        let range = f64::MIN..=f64::MAX;
        Self { label, longest_label: label, value, range, unit: "", integer: false, default: None, help: "" }
    }

    /// Aligns the field with that of the row that has this label.
    pub fn aligned_with(mut self, other_label: &'a str) -> Self {
        self.longest_label = other_label;
        self
    }

    /// Sets the range: a number outside `range` becomes its nearer end, and a sentence beside the panel says
    /// so.
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

    /// Sets the value that the menu of the number restores.
    pub fn default(mut self, default: f64) -> Self {
        self.default = Some(default);
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
        let columns = paint::Columns::of(row).widened_for(ui, self.longest_label);
        paint::label(ui, columns.label, self.label, self.help);
        let show = |value| format::with_unit(&self.text(value), self.unit);
        let id = ui.make_persistent_id(("number", self.label));
        let cell = NumberCell {
            id,
            rect: columns.rest.shrink2(vec2(8.0, 0.0)),
            name: self.label,
            help: if self.help.is_empty() { tips::sentence(self.label) } else { self.help },
            input: NumberInput {
                name: self.label,
                value: *self.value,
                range: self.range.clone(),
                unit: self.unit,
                step: self.integer.then_some(1.0),
                logarithmic: *self.range.start() >= 0.0,
                default: self.default,
                show: &show,
            },
            align: Align::Max,
            boxed: true,
            live: false,
        };
        let (mut response, entered) = cell.show(ui);
        if let Some(entered) = entered {
            *self.value = entered;
            response.mark_changed();
        }
        NumberCell::show_remark(ui, id, columns.rest, *self.value);
        response
    }

    fn text(&self, value: f64) -> String {
        if self.integer { format::fixed(value, 0) } else { format::digits(value, 6) }
    }
}

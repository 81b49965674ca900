//! A knot of a curve: a value and a diameter.

use std::ops::RangeInclusive;

use egui::{Align, Id, Rect, Ui, UiBuilder, vec2};

use super::number_cell::NumberCell;
use super::number_input::NumberInput;
use super::tool_button::ToolButton;
use super::{Icon, format, paint};
use crate::theme::metrics;
use meshbrush_mesh::text::LengthUnit;

/// Width of the name.
const NAME: f32 = 56.0;
/// Space between the parts of a row.
const GAP: f32 = 8.0;
/// Free space at the ends of a number.
const PADDING: f32 = 8.0;

/// A row with the two numbers of a knot, and a button that deletes it.
#[must_use = "call `show`"]
pub struct KnotRow<'a> {
    /// The number of the knot, counted from one.
    pub number: usize,
    /// [value, diameter in the unit of the document]; a new number is written here.
    pub knot: &'a mut [f64; 2],
    /// The allowed values.
    pub values: RangeInclusive<f64>,
    /// The unit of the diameter.
    pub unit: LengthUnit,
    /// Whether the button works.
    pub can_delete: bool,
}

/// The change that a person made to a knot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KnotAnswer {
    /// No change.
    None,
    /// Entered another number.
    Changed,
    /// Deleted it.
    Deleted,
}

impl KnotRow<'_> {
    /// Shows the row.
    pub fn show(mut self, ui: &mut Ui) -> KnotAnswer {
        let row = paint::row(ui);
        let name = format!("Knot {}", self.number);
        paint::label(ui, row.with_max_x(row.left() + NAME), &name, "");
        let button = row.with_min_x(row.right() - metrics::ROW);
        let mut place = ui.new_child(UiBuilder::new().max_rect(button));
        let delete = format!("Delete knot {}", self.number);
        let delete = ToolButton::small(Icon::DELETE, &delete);
        let deleted = place.add_enabled_ui(self.can_delete, |ui| delete.show(ui)).inner.clicked();
        let numbers = Rect::from_x_y_ranges(row.left() + NAME + GAP..=button.left() - GAP, row.y_range());
        let changed = self.numbers(ui, numbers, &name);
        match (deleted, changed) {
            (true, _) => KnotAnswer::Deleted,
            (false, true) => KnotAnswer::Changed,
            (false, false) => KnotAnswer::None,
        }
    }

    /// Shows both numbers side by side. Returns whether one was entered.
    fn numbers(&mut self, ui: &mut Ui, room: Rect, name: &str) -> bool {
        let (left, right) = room.split_left_right_at_fraction(0.5);
        let unit = self.unit.symbol();
        let value = KnotNumber {
            name: format!("{name} value"),
            help: "A value of the raster, in the unit that the raster has.",
            rect: left.with_max_x(left.right() - GAP / 2.0),
            range: self.values.clone(),
            unit: "",
        };
        let diameter = KnotNumber {
            name: format!("{name} diameter"),
            help: "Target diameter where the raster has this value; between two knots it changes linearly.",
            rect: right.with_min_x(right.left() + GAP / 2.0),
            range: f64::MIN_POSITIVE..=f64::MAX,
            unit,
        };
        let [before, after] = [*self.knot, [value.show(ui, self.knot[0]), diameter.show(ui, self.knot[1])]];
        *self.knot = after;
        // Below the row, which is complete now.
        for (part, number) in [value, diameter].iter().zip(after) {
            NumberCell::show_remark(ui, part.id(ui), room, number);
        }
        before != after
    }
}

/// One of the two numbers.
struct KnotNumber<'a> {
    name: String,
    help: &'a str,
    rect: Rect,
    range: RangeInclusive<f64>,
    unit: &'a str,
}

impl KnotNumber<'_> {
    fn id(&self, ui: &Ui) -> Id {
        ui.make_persistent_id(&self.name)
    }

    /// Shows a number. Returns it, or the one that was entered in its place.
    fn show(&self, ui: &mut Ui, number: f64) -> f64 {
        let cell = NumberCell {
            id: self.id(ui),
            rect: self.rect.shrink2(vec2(PADDING, 0.0)),
            name: &self.name,
            help: self.help,
            input: NumberInput {
                name: &self.name,
                value: number,
                range: self.range.clone(),
                unit: self.unit,
                step: None,
                logarithmic: *self.range.start() > 0.0,
                default: None,
                show: &|number| format::with_unit(&format::digits(number, 4), self.unit),
            },
            align: Align::Max,
            boxed: true,
            live: false,
        };
        let (_, entered) = cell.show(ui);
        entered.unwrap_or(number)
    }
}

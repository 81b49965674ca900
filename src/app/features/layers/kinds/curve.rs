//! The curve from the values of a raster to target diameters.

use std::ops::RangeInclusive;

use eframe::egui::Ui;

use crate::app::kit::remark;
use crate::app::widgets::{ActionButton, KnotAnswer, KnotRow};
use meshbrush_core::layers::ValueCurve;
use meshbrush_mesh::text::LengthUnit;

/// Shows the knots of a curve. Returns the curve once it was changed.
pub fn curve_rows(ui: &mut Ui, curve: &ValueCurve, unit: LengthUnit) -> Option<ValueCurve> {
    ui.add_space(4.0);
    remark(
        ui,
        "Each knot gives the target diameter for a value of the raster; between two it changes linearly.",
    );
    let mut changed = None;
    for place in 0..curve.knots().len() {
        changed = changed.or(knot_row(ui, curve, place, unit));
    }
    let another = curve.with_another_knot();
    let add = ActionButton::new("Add knot");
    if ui.add_enabled_ui(another.is_some(), |ui| ui.add(add)).inner.clicked() {
        return another;
    }
    changed
}

fn knot_row(ui: &mut Ui, curve: &ValueCurve, place: usize, unit: LengthUnit) -> Option<ValueCurve> {
    let knots = curve.knots();
    let mut knot = knots[place];
    let (number, values, can_delete) = (place + 1, values_between(knots, place), knots.len() > 1);
    match (KnotRow { number, knot: &mut knot, values, unit, can_delete }).show(ui) {
        KnotAnswer::None => None,
        KnotAnswer::Changed => curve.with_knot(place, knot).ok(),
        KnotAnswer::Deleted => curve.without_knot(place).ok(),
    }
}

/// Returns the allowed values of a knot: knots stay in order.
fn values_between(knots: &[[f64; 2]], place: usize) -> RangeInclusive<f64> {
    let least = place.checked_sub(1).map_or(f64::MIN, |before| knots[before][0].next_up());
    let greatest = knots.get(place + 1).map_or(f64::MAX, |after| after[0].next_down());
    least..=greatest
}

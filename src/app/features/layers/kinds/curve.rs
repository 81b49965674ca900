//! The curve from the values of a raster to target diameters.

use std::ops::RangeInclusive;
use std::sync::{Arc, Weak};

use eframe::egui::{Id, Response, Ui};

use meshbrush_core::layers::{FineAt, RasterSource, ValueCurve};
use meshbrush_core::raster::RasterPyramid;
use meshbrush_kit::kit::{FrameState, remark};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::{ActionButton, CurveChange, CurvePlot, KnotAnswer, KnotRow};

/// Bars of the histogram.
const BARS: usize = 48;

/// A sample of the values of a raster, in egui's memory while its curve is shown.
#[derive(Clone)]
struct Sample {
    /// The raster that it is of.
    raster: Weak<RasterPyramid>,
    /// Finite values, in ascending order.
    sorted: Arc<Vec<f32>>,
    /// How often the values occur, from the least to the greatest: the highest is 1.
    histogram: Arc<Vec<f32>>,
}

impl Sample {
    fn of(ui: &Ui, raster: &Arc<RasterPyramid>) -> Self {
        let id = Id::unique("sample of the values of a raster");
        let kept = ui.data(|data| data.get_temp::<Self>(id));
        let is_current = |kept: &Self| kept.raster.upgrade().is_some_and(|kept| Arc::ptr_eq(&kept, raster));
        kept.filter(is_current).unwrap_or_else(|| {
            let sorted = raster.sorted_sample();
            let histogram = Arc::new(histogram(&sorted));
            let sample = Self { raster: Arc::downgrade(raster), sorted: Arc::new(sorted), histogram };
            ui.data_mut(|data| data.insert_temp(id, sample.clone()));
            sample
        })
    }
}

/// Returns how often values occur in equal parts of their range: the highest is 1.
fn histogram(sorted: &[f32]) -> Vec<f32> {
    let (Some(&least), Some(&greatest)) = (sorted.first(), sorted.last()) else { return Vec::new() };
    let [least, greatest] = [least, greatest].map(f64::from);
    let mut counts = [0.0f32; BARS];
    for &value in sorted {
        let share = (f64::from(value) - least) / (greatest - least).max(f64::MIN_POSITIVE);
        counts[((share * BARS as f64) as usize).min(BARS - 1)] += 1.0;
    }
    let highest = counts.iter().copied().fold(1.0, f32::max);
    counts.iter().map(|count| count / highest).collect()
}

/// Shows the plot of a curve. Returns the curve if it was changed, and a response that says when a gesture is
/// complete.
pub fn curve_plot(
    ui: &mut Ui,
    state: &FrameState<'_>,
    source: &RasterSource,
    curve: &ValueCurve,
) -> (Option<ValueCurve>, Response) {
    let sample = Sample::of(ui, &source.raster);
    let end = |value: Option<&f32>| value.map_or(0.0, |&value| f64::from(value));
    let values = [end(sample.sorted.first()), end(sample.sorted.last())];
    let mark = state.pointer.and_then(|point| source.raster.sample(point)).map(f64::from);
    let (knots, unit) = (curve.knots(), state.unit());
    let plot = CurvePlot { knots, values, histogram: &sample.histogram, mark, unit };
    let (change, response) = plot.show(ui);
    let changed = match change {
        Some(CurveChange::Moved(place, knot)) => curve.with_knot(place, knot).ok(),
        Some(CurveChange::Added(knot)) => curve.with_inserted(knot).ok(),
        Some(CurveChange::Removed(place)) => curve.without_knot(place).ok(),
        None => None,
    };
    (changed, response)
}

/// What was done with the buttons of the default curves.
#[derive(Default)]
pub struct DefaultCurves {
    /// The curve of the button that was clicked.
    pub chosen: Option<ValueCurve>,
    /// The curve of the button under the pointer.
    pub hovered: Option<ValueCurve>,
}

/// Shows buttons that make the default curves.
pub fn default_curves(ui: &mut Ui, state: &FrameState<'_>, source: &RasterSource) -> DefaultCurves {
    let transfer = state.session.document().settings().transfer;
    let mut done = DefaultCurves::default();
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        for (name, place) in [
            ("Fine at low", FineAt::Least),
            ("Fine near 0", FineAt::Zero),
            ("Fine at high", FineAt::Greatest),
        ] {
            let button = ui.add(ActionButton::new(name));
            if button.clicked() || button.hovered() {
                let sample = Sample::of(ui, &source.raster);
                let curve = ValueCurve::fine_at(place, &sample.sorted, transfer.h_min, transfer.h_max);
                if button.clicked() { done.chosen = curve } else { done.hovered = curve }
            }
        }
    });
    done
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_histogram_counts_values_in_equal_parts_of_their_range() {
        let bars = histogram(&[0.0, 0.0, 0.0, 0.0, 24.0, 48.0]);
        assert_eq!(bars.len(), BARS);
        assert_eq!((bars[0], bars[24], bars[47]), (1.0, 0.25, 0.25));
        assert_eq!(histogram(&[5.0])[0], 1.0, "one value");
        assert!(histogram(&[]).is_empty());
    }
}

//! The curve from the values of a raster to diameters, with knots that are dragged.

use std::ops::RangeInclusive;

use egui::Role;
use egui::{
    self, CursorIcon, Id, Key, Modifiers, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};

use super::grab;
use super::slider::key_steps;
use super::transfer_plot::{Axis, Plot, area_under};
use super::{format, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;
use meshbrush_mesh::text::LengthUnit;

/// Height of the plot, in points.
const HEIGHT: f32 = 132.0;
/// Width and height of the place where a knot is grabbed, in points.
const GRAB: Vec2 = vec2(18.0, 18.0);
/// Width of the numbers of the axis of diameters, in points.
const AXIS: f32 = 44.0;
/// Height of the numbers of the axis of values, in points.
const BELOW: f32 = 20.0;
/// Radius of a knot, in points.
const KNOT: f32 = 4.5;
/// The share of the height that the highest bar of the histogram takes.
const HIGHEST_BAR: f32 = 0.6;

/// The plot of a curve through knots: values to the right, diameters upwards on a logarithmic axis, and
/// behind it how often each value occurs.
#[must_use = "call `show`"]
pub struct CurvePlot<'a> {
    /// The knots as [value, diameter in the unit of the document], in increasing order of value.
    pub knots: &'a [[f64; 2]],
    /// The range of the values of the raster.
    pub values: [f64; 2],
    /// How often the values occur, from the least to the greatest: the highest is 1.
    pub histogram: &'a [f32],
    /// A value to mark, such as the one under the pointer on the canvas.
    pub mark: Option<f64>,
    /// The unit of the diameters.
    pub unit: LengthUnit,
}

/// The change that a person made in a [`CurvePlot`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveChange {
    /// The knot at a place, counted from 0, was moved to [value, diameter].
    Moved(usize, [f64; 2]),
    /// A knot was added.
    Added([f64; 2]),
    /// The knot at a place, counted from 0, was removed.
    Removed(usize),
}

/// The axes of the last frame, which stay while a knot is dragged.
#[derive(Clone, Copy)]
struct Axes {
    values: [f64; 2],
    diameters: Axis,
}

impl CurvePlot<'_> {
    /// Shows the plot over the full width. Returns the change, if there was one, and a response with which
    /// [`crate::widgets::edit_done`] says when a gesture is complete.
    pub fn show(self, ui: &mut Ui) -> (Option<CurveChange>, Response) {
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), HEIGHT));
        let id = ui.make_persistent_id("curve of values");
        let axes = ui.data(|data| data.get_temp::<Axes>(id)).unwrap_or_else(|| self.axes());
        let inner = Rect::from_min_max(
            pos2(rect.left() + AXIS, rect.top() + 12.0),
            pos2(rect.right() - 12.0, rect.bottom() - BELOW),
        );
        let plot = Plot { rect: inner, axis: axes.diameters };
        let mut response = ui.interact(rect, id, Sense::click());
        let knots: Vec<Response> =
            (0..self.knots.len()).map(|n| self.sense(ui, id, &plot, &axes, n)).collect();
        let change = (0..knots.len()).find_map(|n| self.change_of(ui, &plot, &axes, n, &knots[n]));
        let change = change.or_else(|| self.added(&response, &knots, &plot, &axes));
        self.paint(ui, rect, &plot, &axes, &knots);
        if knots.iter().any(Response::dragged) {
            ui.data_mut(|data| data.insert_temp(id, axes));
        } else {
            ui.data_mut(|data| data.remove::<Axes>(id));
        }
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Curve of the values"));
        response = tips::explain(ui, response, tips::sentence("Curve of the values"));
        let mut response = knots.into_iter().fold(response, |all, knot| all | knot);
        if change.is_some() {
            response.mark_changed();
        }
        (change, response)
    }

    /// Returns the axes that hold all knots and values.
    fn axes(&self) -> Axes {
        let diameters = self.knots.iter().map(|knot| knot[1]);
        let (finest, coarsest) = diameters.fold((f64::MAX, 0.0f64), |(a, b), d| (a.min(d), b.max(d)));
        let values = self.knots.iter().map(|knot| knot[0]);
        let [low, high] = values.fold(self.values, |[a, b], value| [a.min(value), b.max(value)]);
        let high = if high > low { high } else { low + low.abs().max(1.0) };
        Axes { values: [low, high], diameters: Axis::around(finest, coarsest) }
    }

    fn position(&self, plot: &Plot, axes: &Axes, number: usize) -> Pos2 {
        let [value, diameter] = self.knots[number];
        plot.point(axes.share(value), diameter)
    }

    /// Returns how the pointer and the keys meet a knot.
    fn sense(&self, ui: &Ui, id: Id, plot: &Plot, axes: &Axes, number: usize) -> Response {
        let place = Rect::from_center_size(self.position(plot, axes, number), GRAB);
        let response = ui.interact(place, id.with(("knot", number)), Sense::click_and_drag());
        let response = response.on_hover_cursor(CursorIcon::Grab);
        let [value, diameter] = self.knots[number];
        response.widget_info(|| {
            WidgetInfo::slider(ui.is_enabled(), diameter, format!("Curve knot {}", number + 1))
        });
        let (value, diameter) = (format::digits(value, 4), format::length(diameter, self.unit));
        let help = format!(
            "Diameter {diameter} where the value is {value}. Drag it; the arrow keys change its diameter; a double \
             click or Delete removes it."
        );
        tips::explain(ui, response, &help)
    }

    /// Returns what the pointer or the keys do to a knot.
    fn change_of(
        &self,
        ui: &Ui,
        plot: &Plot,
        axes: &Axes,
        number: usize,
        response: &Response,
    ) -> Option<CurveChange> {
        let knot = self.knots[number];
        let removes = |input: &mut egui::InputState| {
            input.consume_key(Modifiers::NONE, Key::Delete)
                || input.consume_key(Modifiers::NONE, Key::Backspace)
        };
        let is_removed = response.double_clicked() || response.has_focus() && ui.input_mut(removes);
        if is_removed && self.knots.len() > 1 {
            return Some(CurveChange::Removed(number));
        }
        let target = grab::target(ui, response.id, self.position(plot, axes, number), GRAB);
        let steps = key_steps(ui, response).clamp(-100.0, 100.0);
        let moved = match target {
            Some(at) => {
                let value = axes.value(f64::from(at.x - plot.rect.left()) / f64::from(plot.rect.width()));
                [value, format::rounded(plot.diameter_at(at.y), 3)]
            }
            None if steps != 0.0 => [knot[0], format::rounded(knot[1] * 1.05_f64.powf(steps), 3)],
            None => return None,
        };
        let between = self.values_between(number);
        // A drag that only moves a knot up or down keeps its value exactly.
        let is_same_place =
            (axes.share(moved[0]) - axes.share(knot[0])).abs() * f64::from(plot.rect.width()) < 0.5;
        let value = if is_same_place { knot[0] } else { moved[0].clamp(*between.start(), *between.end()) };
        let moved = [value, moved[1].max(f64::MIN_POSITIVE)];
        (moved != knot).then_some(CurveChange::Moved(number, moved))
    }

    /// Returns the allowed values of a knot: knots stay in order.
    fn values_between(&self, number: usize) -> RangeInclusive<f64> {
        let least = number.checked_sub(1).map_or(f64::MIN, |before| self.knots[before][0].next_up());
        let greatest = self.knots.get(number + 1).map_or(f64::MAX, |after| after[0].next_down());
        least..=greatest
    }

    /// Returns the knot that a click beside all knots adds.
    fn added(
        &self,
        response: &Response,
        knots: &[Response],
        plot: &Plot,
        axes: &Axes,
    ) -> Option<CurveChange> {
        let at = response.interact_pointer_pos().filter(|_| response.clicked())?;
        let is_free = plot.rect.contains(at) && !knots.iter().any(|knot| knot.rect.contains(at));
        let share = f64::from(at.x - plot.rect.left()) / f64::from(plot.rect.width());
        let knot = [format::rounded(axes.value(share), 4), format::rounded(plot.diameter_at(at.y), 3)];
        let is_new = self.knots.iter().all(|known| known[0] != knot[0]);
        (is_free && is_new).then_some(CurveChange::Added(knot))
    }

    fn paint(&self, ui: &Ui, rect: Rect, plot: &Plot, axes: &Axes, knots: &[Response]) {
        let t = tokens(ui);
        ui.painter().rect(rect, metrics::RADIUS_CONTROL, t.well, t.hairline(), StrokeKind::Inside);
        self.paint_axes(ui, rect, plot, axes);
        self.paint_histogram(ui, plot, axes);
        let inner = (0..knots.len()).map(|number| self.position(plot, axes, number));
        let ends = |x: f32, number: usize| pos2(x, self.position(plot, axes, number).y);
        let last = knots.len().saturating_sub(1);
        let line: Vec<Pos2> = std::iter::once(ends(plot.rect.left(), 0))
            .chain(self.line_points(plot, axes).into_iter().chain(inner.skip(last)))
            .chain([ends(plot.rect.right(), last)])
            .collect();
        ui.painter().add(area_under(&line, plot.rect.bottom(), t.accent.gamma_multiply(0.12)));
        ui.painter().line(line, Stroke::new(2.0, t.accent));
        if let Some(value) = self.mark.filter(|value| value.is_finite()) {
            let x = plot.point(axes.share(value), 1.0).x;
            ui.painter().vline(x, plot.rect.y_range(), Stroke::new(1.0, t.label));
        }
        for (number, response) in knots.iter().enumerate() {
            let at = self.position(plot, axes, number);
            let radius = if response.hovered() || response.dragged() { KNOT + 1.0 } else { KNOT };
            ui.painter().circle(at, radius, t.thumb, Stroke::new(1.0, t.thumb_edge));
            if response.has_focus() {
                ui.painter().circle_stroke(at, radius + 3.0, Stroke::new(1.5, t.accent));
            }
        }
    }

    /// Returns points along the curve: a straight line between knots is bent on the logarithmic axis.
    fn line_points(&self, plot: &Plot, axes: &Axes) -> Vec<Pos2> {
        const PIECES: u32 = 16;
        let pieces = self.knots.windows(2).flat_map(|ends| {
            (0..PIECES).map(move |piece| {
                let share = f64::from(piece) / f64::from(PIECES);
                [0, 1].map(|part| ends[0][part] + share * (ends[1][part] - ends[0][part]))
            })
        });
        pieces.map(|[value, diameter]| plot.point(axes.share(value), diameter)).collect()
    }

    fn paint_axes(&self, ui: &Ui, rect: Rect, plot: &Plot, axes: &Axes) {
        let t = tokens(ui);
        plot.paint_decades(ui, rect.left(), 6.0, t.label);
        let row = Rect::from_x_y_ranges(plot.rect.x_range(), plot.rect.bottom() + 2.0..=rect.bottom() - 2.0);
        let [low, high] = axes.values.map(|value| format::digits(value, 4));
        paint::at_left(ui, row, paint::line(ui, &low, font::axis(), t.label));
        paint::at_right(ui, row, paint::line(ui, &high, font::axis(), t.label));
        paint::at_centre(ui, row, paint::line(ui, "value", font::axis(), t.label));
    }

    fn paint_histogram(&self, ui: &Ui, plot: &Plot, axes: &Axes) {
        let color = tokens(ui).label.gamma_multiply(0.28);
        let bars = self.histogram.len().max(1) as f64;
        let place = |bar: usize| {
            let value = self.values[0] + (self.values[1] - self.values[0]) * bar as f64 / bars;
            plot.point(axes.share(value), 1.0).x
        };
        for (bar, &height) in self.histogram.iter().enumerate().filter(|(_, height)| **height > 0.0) {
            let top = plot.rect.bottom() - (HIGHEST_BAR * plot.rect.height() * height).max(1.0);
            let bar = Rect::from_x_y_ranges(place(bar)..=place(bar + 1), top..=plot.rect.bottom());
            ui.painter().rect_filled(bar, 0.0, color);
        }
    }
}

impl Axes {
    /// Returns the place of a value, 0 at the left end and 1 at the right one.
    fn share(&self, value: f64) -> f64 {
        let [low, high] = self.values;
        // Halves, as the difference of two large values may overflow.
        ((0.5 * value - 0.5 * low) / (0.5 * high - 0.5 * low)).clamp(0.0, 1.0)
    }

    /// Returns the value at a place.
    fn value(&self, share: f64) -> f64 {
        let [low, high] = self.values;
        low * (1.0 - share) + high * share
    }
}

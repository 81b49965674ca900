//! The curve from risk to diameter, with handles.

use std::ops::RangeInclusive;

use egui::accesskit::Action;
use egui::{
    self, Align, Color32, CursorIcon, Id, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, Vec2,
    WidgetInfo, vec2,
};

use super::grab;
use super::number_cell::NumberCell;
use super::number_input::NumberInput;
use super::number_menu::number_menu;
use super::slider::{key_steps, requested_value};
use super::transfer_plot::{Axis, Plot, area_under};
use super::{format, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::{reveal, tips};
use meshbrush_mesh::text::LengthUnit;

/// Identifies the curve in its panel.
const ID: &str = "transfer curve";
/// Height of the plot; the numbers are in a row below it.
const HEIGHT: f32 = 104.0;
/// Space between the two numbers below the plot.
const NUMBER_GAP: f32 = 16.0;
/// Space between the name of an end point and its number, and around the number, in points.
const NAME_GAP: f32 = 8.0;
const NUMBER_PADDING: f32 = 8.0;
/// Width and height of the place where a handle is grabbed.
const GRAB: Vec2 = vec2(20.0, 20.0);
/// Width of the axis' numbers.
const AXIS: f32 = 44.0;
/// Radius of a handle.
const HANDLE: f32 = 5.0;
/// Number of segments that the curve is drawn with.
const PIECES: usize = 64;

/// The values that the curve editor edits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveValues {
    /// Diameter at risk 0, in world units.
    pub h_max: f64,
    /// Diameter at risk 1, in world units; at most `h_max`.
    pub h_risk: f64,
    /// The shape of the curve, positive; the caller's formula says what it means.
    pub shape: f64,
}

/// A diameter of the curve that can be typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveField {
    /// That at risk 0.
    Largest,
    /// That at risk 1.
    AtRiskOne,
}

/// Diameter over risk: risk 0 to 1 from left to right, the diameter on a logarithmic axis of whole decades.
///
/// The end points change `h_max` and `h_risk`, the middle the shape; their numbers can be typed; a focused
/// handle follows the arrow keys. `curve` gives the diameter of a [`CurveValues`] at a risk; it must be
/// monotone in the shape. The axis stays as it is while a handle is dragged.
#[must_use = "call `show`"]
pub struct TransferCurve<'a> {
    value: &'a mut CurveValues,
    curve: &'a dyn Fn(&CurveValues, f64) -> f64,
    limits: RangeInclusive<f64>,
    shapes: RangeInclusive<f64>,
    mark: Option<f64>,
    unit: LengthUnit,
    defaults: Option<CurveValues>,
}

#[derive(Clone, Copy, PartialEq)]
enum Handle {
    Max,
    Shape,
    Min,
}

impl<'a> TransferCurve<'a> {
    /// Creates an editor whose handles keep the diameters within `limits` and the shape within `shapes`, both
    /// positive. Any positive diameter can be typed.
    pub fn new(
        value: &'a mut CurveValues,
        curve: &'a dyn Fn(&CurveValues, f64) -> f64,
        limits: RangeInclusive<f64>,
        shapes: RangeInclusive<f64>,
    ) -> Self {
        let (unit, defaults) = (LengthUnit::None, None);
        Self { value, curve, limits, shapes, mark: None, unit, defaults }
    }

    /// Returns the diameter that is being typed in this place, if it can be read.
    pub fn typed_so_far(ui: &Ui, unit: &str) -> Option<(CurveField, f64)> {
        let id = ui.make_persistent_id(ID);
        let typed = |handle| NumberCell::typed_so_far(ui, number_id(id, handle), unit);
        let largest = typed(Handle::Max).map(|typed| (CurveField::Largest, typed));
        largest.or_else(|| typed(Handle::Min).map(|typed| (CurveField::AtRiskOne, typed)))
    }

    /// Marks a risk on the curve, such as that under the pointer on the canvas.
    pub fn mark(mut self, risk: Option<f64>) -> Self {
        self.mark = risk;
        self
    }

    /// Returns the unit of the diameters.
    pub fn unit(mut self, unit: LengthUnit) -> Self {
        self.unit = unit;
        self
    }

    /// Sets the values that the menus of the handles and their numbers restore.
    pub fn defaults(mut self, defaults: CurveValues) -> Self {
        self.defaults = Some(defaults);
        self
    }

    /// Shows the editor over the full width. The response has `changed` when a value did;
    /// [`crate::widgets::edit_done`] says when a gesture is complete.
    pub fn show(mut self, ui: &mut Ui) -> Response {
        let before = *self.value;
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), HEIGHT));
        let id = ui.make_persistent_id(ID);
        let mut response = ui.interact(rect, id, Sense::hover());
        let inner = rect.shrink2(vec2(12.0, 14.0));
        let plot = Plot { rect: inner.with_min_x(rect.left() + AXIS), axis: self.axis(ui, id) };
        let hovered_risk = response.hover_pos().map(|pointer| plot.risk_at(pointer.x));
        self.paint_ground(ui, rect, &plot);
        let handles =
            [Handle::Max, Handle::Shape, Handle::Min].map(|handle| self.handle(ui, id, &plot, handle));
        self.paint_curve(ui, &plot);
        self.paint_mark(ui, &plot, self.mark.or(hovered_risk));
        for (handle, felt) in [Handle::Max, Handle::Shape, Handle::Min].into_iter().zip(&handles) {
            self.paint_handle(ui, &plot, handle, felt);
        }
        self.paint_caption(ui, &plot, hovered_risk);
        response |= self.numbers(ui, id);
        self.keep_axis(ui, id, &plot, handles.iter().any(Response::dragged));
        let mut response = handles.into_iter().fold(response, |all, one| all | one);
        if *self.value != before {
            response.mark_changed();
        }
        response
    }

    /// Returns the axis of the last frame while a handle is dragged, else the whole decades around the
    /// values.
    fn axis(&self, ui: &Ui, id: Id) -> Axis {
        let kept = ui.data(|data| data.get_temp::<Axis>(id));
        kept.unwrap_or_else(|| Axis::around(self.value.h_risk, self.value.h_max))
    }

    fn keep_axis(&self, ui: &Ui, id: Id, plot: &Plot, dragged: bool) {
        if dragged {
            ui.data_mut(|data| data.insert_temp(id, plot.axis));
        } else {
            ui.data_mut(|data| data.remove::<Axis>(id));
        }
    }

    /// Lets pointer and keys move a handle.
    fn handle(&mut self, ui: &Ui, id: Id, plot: &Plot, handle: Handle) -> Response {
        let number = (handle != Handle::Shape).then(|| number_id(id, handle));
        let id = id.with(handle.name());
        let position = self.position(plot, handle);
        let place = Rect::from_center_size(position, GRAB);
        let target = grab::target(ui, id, position, GRAB);
        let response =
            ui.interact(place, id, Sense::click_and_drag()).on_hover_cursor(CursorIcon::ResizeVertical);
        if let Some(target) = target {
            self.set(handle, plot.diameter_at(target.y));
        }
        let steps = key_steps(ui, &response);
        if steps != 0.0 {
            self.nudge(handle, steps.clamp(-100.0, 100.0));
        }
        if let Some(value) = requested_value(ui, response.id) {
            self.assign(handle, value);
        }
        if let Some(number) = number.filter(|_| response.double_clicked()) {
            NumberCell::edit_soon(ui, number);
        }
        let reset = self.with_input(handle, |input| number_menu(ui, &response, &input, number));
        if let Some(default) = reset {
            self.enter(handle, default);
        }
        self.declare(ui, handle, &response);
        tips::explain(ui, response, tips::sentence(handle.name()))
    }

    fn declare(&self, ui: &Ui, handle: Handle, response: &Response) {
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), self.number_of(handle), handle.name()));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            let range = if handle == Handle::Shape { &self.shapes } else { &self.limits };
            node.set_min_numeric_value(*range.start());
            node.set_max_numeric_value(*range.end());
            node.add_action(Action::SetValue);
        });
    }

    /// Returns the value that a handle changes.
    fn number_of(&self, handle: Handle) -> f64 {
        match handle {
            Handle::Max => self.value.h_max,
            Handle::Shape => self.value.shape,
            Handle::Min => self.value.h_risk,
        }
    }

    /// Puts a handle at a diameter.
    fn set(&mut self, handle: Handle, diameter: f64) {
        match handle {
            Handle::Shape => self.value.shape = format::rounded(self.shape_through(diameter), 3),
            _ => self.assign(handle, format::rounded(diameter, 3)),
        }
    }

    /// Sets what a handle changes, within its limits; `h_risk` never exceeds `h_max`.
    fn assign(&mut self, handle: Handle, value: f64) {
        let (low, high) = (*self.limits.start(), *self.limits.end());
        match handle {
            Handle::Max => self.value.h_max = value.clamp(low, high).max(self.value.h_risk),
            Handle::Min => self.value.h_risk = value.clamp(low, high).min(self.value.h_max),
            Handle::Shape => self.value.shape = value.clamp(*self.shapes.start(), *self.shapes.end()),
        }
    }

    /// Returns the diameters that can be typed for an end point.
    fn typed_range(&self, handle: Handle) -> RangeInclusive<f64> {
        match handle {
            Handle::Max => self.value.h_risk..=f64::MAX,
            Handle::Min => f64::MIN_POSITIVE..=self.value.h_max,
            Handle::Shape => self.shapes.clone(),
        }
    }

    /// Sets what a handle changes to a value of [`Self::typed_range`].
    fn enter(&mut self, handle: Handle, value: f64) {
        let range = self.typed_range(handle);
        let value = value.clamp(*range.start(), *range.end());
        match handle {
            Handle::Max => self.value.h_max = value,
            Handle::Min => self.value.h_risk = value,
            Handle::Shape => self.value.shape = value,
        }
    }

    fn default_of(&self, handle: Handle) -> Option<f64> {
        let defaults = self.defaults?;
        Some(match handle {
            Handle::Max => defaults.h_max,
            Handle::Shape => defaults.shape,
            Handle::Min => defaults.h_risk,
        })
    }

    /// Calls `use_input` with the rules of what a handle changes.
    fn with_input<R>(&self, handle: Handle, use_input: impl FnOnce(NumberInput<'_>) -> R) -> R {
        let unit = if handle == Handle::Shape { LengthUnit::None } else { self.unit };
        use_input(NumberInput {
            name: handle.name(),
            value: self.number_of(handle),
            range: self.typed_range(handle),
            unit: unit.symbol(),
            step: None,
            logarithmic: true,
            default: self.default_of(handle),
            show: &|value| format::length(value, unit),
        })
    }

    /// Moves a handle by the keyboard, about five per cent a step.
    fn nudge(&mut self, handle: Handle, steps: f64) {
        let factor = 1.05_f64.powf(if handle == Handle::Shape { steps * self.rising() } else { steps });
        self.assign(handle, format::rounded(self.number_of(handle) * factor, 3));
    }

    /// 1 if a larger shape lifts the curve's middle, else −1.
    fn rising(&self) -> f64 {
        let (low, high) = (self.middle(*self.shapes.start()), self.middle(*self.shapes.end()));
        if high >= low { 1.0 } else { -1.0 }
    }

    /// Returns the diameter at risk ½ with another shape.
    fn middle(&self, shape: f64) -> f64 {
        (self.curve)(&CurveValues { shape, ..*self.value }, 0.5)
    }

    /// Returns the shape whose curve passes nearest to `diameter` at risk ½, by 40 halvings of the range's
    /// logarithm.
    fn shape_through(&self, diameter: f64) -> f64 {
        let (mut low, mut high) = (self.shapes.start().ln(), self.shapes.end().ln());
        let rising = self.rising();
        for _ in 0..40 {
            let half = (low + high) / 2.0;
            if (self.middle(half.exp()) - diameter) * rising < 0.0 { low = half } else { high = half }
        }
        ((low + high) / 2.0).exp()
    }

    fn position(&self, plot: &Plot, handle: Handle) -> Pos2 {
        let risk = handle.risk();
        plot.point(risk, (self.curve)(self.value, risk))
    }

    /// The background, with a line for each decade and as many numbers as fit.
    fn paint_ground(&self, ui: &Ui, rect: Rect, plot: &Plot) {
        let t = tokens(ui);
        ui.painter().rect(rect, metrics::RADIUS_CONTROL, t.well, t.hairline(), StrokeKind::Inside);
        plot.paint_decades(ui, rect.left(), 8.0, t.faint);
    }

    fn paint_curve(&self, ui: &Ui, plot: &Plot) {
        let accent = tokens(ui).accent;
        let points: Vec<Pos2> = (0..=PIECES)
            .map(|i| i as f64 / PIECES as f64)
            .map(|risk| plot.point(risk, (self.curve)(self.value, risk)))
            .collect();
        ui.painter().add(area_under(&points, plot.rect.bottom(), accent.gamma_multiply(0.16)));
        ui.painter().line(points, Stroke::new(2.0, accent));
    }

    /// A hair line at a risk, with the diameter there.
    fn paint_mark(&self, ui: &Ui, plot: &Plot, risk: Option<f64>) {
        let Some(risk) = risk.filter(|risk| (0.0..=1.0).contains(risk)) else {
            return;
        };
        let t = tokens(ui);
        let diameter = (self.curve)(self.value, risk);
        let point = plot.point(risk, diameter);
        ui.painter().vline(point.x, plot.rect.y_range(), Stroke::new(1.0, t.faint.gamma_multiply(0.6)));
        ui.painter().circle_filled(point, 3.0, t.accent);
    }

    fn paint_handle(&self, ui: &Ui, plot: &Plot, handle: Handle, response: &Response) {
        let t = tokens(ui);
        let place = self.position(plot, handle);
        let active = response.hovered() || response.dragged();
        let radius =
            HANDLE + if active { 1.0 } else { 0.0 } - if handle == Handle::Shape { 1.0 } else { 0.0 };
        let (fill, edge) = if handle == Handle::Shape && !active {
            (t.well, Stroke::new(2.0, t.accent))
        } else {
            (t.thumb, Stroke::new(1.0, t.thumb_edge))
        };
        ui.painter().circle(place, radius, fill, edge);
        if response.has_focus() {
            ui.painter().circle_stroke(place, radius + 3.0, Stroke::new(1.5, t.accent));
        }
    }

    /// Writes the diameter for the risk under the pointer into the corner that the curve leaves free.
    fn paint_caption(&self, ui: &Ui, plot: &Plot, risk: Option<f64>) {
        let caption = match risk {
            Some(risk) => {
                let diameter = format::length((self.curve)(self.value, risk), self.unit);
                format!("{} → {diameter}", format::fixed(risk, 2))
            }
            None => "risk 0 → 1".to_owned(),
        };
        let text = paint::line(ui, &caption, font::small_value(), tokens(ui).faint);
        let row = Rect::from_min_size(plot.rect.min - vec2(0.0, 8.0), vec2(plot.rect.width(), 16.0));
        // The line of a decade would strike the text through.
        let ground = row.with_min_x(row.right() - text.size().x).expand2(vec2(4.0, 0.0));
        ui.painter().rect_filled(ground, 0.0, tokens(ui).well);
        paint::at_right(ui, row, text);
    }

    /// Shows the numbers of both end points below the curve, which can be typed: side by side, or where they
    /// are too long for that, each in a row of its own.
    fn numbers(&mut self, ui: &mut Ui, id: Id) -> Response {
        let ends = [Handle::Max, Handle::Min];
        let widest = ends.map(|handle| self.number_width(ui, handle)).into_iter().fold(0.0, f32::max);
        let first = paint::row(ui);
        let half = (first.width() - NUMBER_GAP) / 2.0;
        let places = match widest <= half {
            true => [first.with_max_x(first.left() + half), first.with_min_x(first.right() - half)],
            false => [first, paint::row(ui)],
        };
        let [left, right] = places;
        let response = self.number(ui, id, left, Handle::Max) | self.number(ui, id, right, Handle::Min);
        for handle in ends {
            let rows = first.union(right);
            NumberCell::show_remark(ui, number_id(id, handle), rows, self.number_of(handle));
        }
        response
    }

    /// Returns the width that the name and the number of an end point need.
    fn number_width(&self, ui: &Ui, handle: Handle) -> f32 {
        let shown = self.with_input(handle, |input| (input.show)(input.value));
        let width = |text: &str, font| paint::line(ui, text, font, Color32::PLACEHOLDER).size().x.ceil();
        let name = width(handle.name(), font::small_value());
        name + NAME_GAP + 2.0 * NUMBER_PADDING + width(&shown, font::value())
    }

    /// Shows the name and number of an end point.
    fn number(&mut self, ui: &mut Ui, id: Id, rect: Rect, handle: Handle) -> Response {
        let name = paint::line(ui, handle.name(), font::small_value(), tokens(ui).label);
        let cell = rect.with_min_x(rect.left() + name.size().x + NAME_GAP).shrink2(vec2(NUMBER_PADDING, 0.0));
        reveal::show_control(ui, rect, handle.name());
        paint::at_left(ui, rect, name);
        let (name, help) = (format!("{} value", handle.name()), tips::sentence(handle.name()));
        let (response, entered) = self.with_input(handle, |input| {
            let (id, align) = (number_id(id, handle), Align::Max);
            NumberCell { id, rect: cell, name: &name, help, input, align, boxed: true, live: true }.show(ui)
        });
        if let Some(entered) = entered {
            self.enter(handle, entered);
        }
        response
    }
}

/// Returns the cell of a handle's number, from the id of the editor.
fn number_id(id: Id, handle: Handle) -> Id {
    id.with((handle.name(), "number"))
}

impl Handle {
    fn name(self) -> &'static str {
        match self {
            Self::Max => "h_max",
            Self::Shape => "Curve shape",
            Self::Min => "h_risk",
        }
    }

    fn risk(self) -> f64 {
        match self {
            Self::Max => 0.0,
            Self::Shape => 0.5,
            Self::Min => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn power(value: &CurveValues, risk: f64) -> f64 {
        value.h_max * (value.h_risk / value.h_max).powf(risk.powf(value.shape))
    }

    #[test]
    fn the_shape_is_found_for_a_point_of_the_curve() {
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..200 {
            let h_max = 1e-3 + random.f64();
            let mut value = CurveValues { h_max, h_risk: h_max * (0.001 + 0.9 * random.f64()), shape: 1.0 };
            let curve = TransferCurve::new(&mut value, &power, 1e-9..=2.0, 0.1..=10.0);
            let shape = 0.1 * 100_f64.powf(random.f64());
            let through = curve.middle(shape);
            assert!((curve.shape_through(through) - shape).abs() < 1e-6, "{through} {shape}");
        }
        let mut value = CurveValues { h_max: 0.2, h_risk: 0.002, shape: 1.0 };
        let curve = TransferCurve::new(&mut value, &power, 1e-4..=1.0, 0.1..=10.0);
        assert!(curve.shape_through(10.0) > 9.99, "beyond the range its end is nearest");
    }

    #[test]
    fn diameters_keep_their_order_and_limits() {
        let mut value = CurveValues { h_max: 0.2, h_risk: 0.002, shape: 1.0 };
        let mut curve = TransferCurve::new(&mut value, &power, 1e-4..=1.0, 0.1..=10.0);
        curve.assign(Handle::Min, 0.5);
        curve.assign(Handle::Max, 1e-9);
        assert_eq!(value, CurveValues { h_max: 0.2, h_risk: 0.2, shape: 1.0 });
    }
}

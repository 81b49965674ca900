//! A value on a track: name, slim track with a round thumb, number that can be typed.

use std::ops::RangeInclusive;

use egui::accesskit::{Action, ActionData};
use egui::{self, Align, Event, EventFilter, Id, Key, Rect, Response, Sense, Ui, WidgetInfo, pos2, vec2};

use super::number_cell::NumberCell;
use super::number_input::NumberInput;
use super::number_menu::number_menu;
use super::{format, paint};
use crate::theme::{font, metrics, tokens};
use crate::widgets::tips;

/// Radius of the thumb.
const THUMB: f32 = 6.0;
/// Width below which a row has its name and its number on the track, in points.
const NARROW: f32 = 200.0;
/// Share of the track that an arrow key moves.
const KEY_STEP: f64 = 0.01;

/// Maps values to places on a track.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl Scale {
    /// Creates a scale over `range`; logarithmic only where all of it is positive.
    fn new(range: &RangeInclusive<f64>, logarithmic: bool) -> Self {
        let (low, high) = (*range.start(), *range.end());
        Self { low, high, logarithmic: logarithmic && low > 0.0 }
    }

    /// Returns the place of `value`, from 0 to 1.
    fn share(self, value: f64) -> f64 {
        let share = if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Returns the value at `share` of the track.
    fn value(self, share: f64) -> f64 {
        let share = share.clamp(0.0, 1.0);
        let value = if self.logarithmic {
            self.low * (self.high / self.low).powf(share)
        } else {
            self.low + share * (self.high - self.low)
        };
        value.clamp(self.low, self.high)
    }
}

/// A row with a name, a slider and its number. In a narrow place, as on the strip above the canvas, the name
/// and the number are on the track.
///
/// Values are in the caller's unit. A drag sets the number that is shown; typed numbers are kept exactly.
/// Arrow keys move by a hundredth of the track (with Shift by a tenth, Home and End to its
/// ends), dragging with Shift is ten times finer. The response has `changed` whenever the value did;
/// [`crate::widgets::edit_done`] says when a gesture is complete.
#[must_use = "call `show`"]
pub struct SliderRow<'a> {
    label: &'a str,
    value: &'a mut f64,
    range: RangeInclusive<f64>,
    logarithmic: bool,
    step: Option<f64>,
    unit: &'a str,
    typed_range: Option<RangeInclusive<f64>>,
    default: Option<f64>,
    help: &'a str,
}

impl<'a> SliderRow<'a> {
    /// Creates a linear slider named `label` over `range`. The name must be unique in its section.
    pub fn new(label: &'a str, value: &'a mut f64, range: RangeInclusive<f64>) -> Self {
        Self {
            label,
            value,
            range,
            logarithmic: false,
            step: None,
            unit: "",
            typed_range: None,
            default: None,
            help: "",
        }
    }

    /// Gives each factor of ten the same length. The range must be positive.
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// The value is a multiple of `step` above the range's start.
    pub fn step(mut self, step: f64) -> Self {
        self.step = Some(step);
        self
    }

    /// Shown after the number, and may be typed.
    pub fn unit(mut self, unit: &'a str) -> Self {
        self.unit = unit;
        self
    }

    /// Returns the numbers that can be typed, where they reach beyond the track.
    pub fn typed_range(mut self, range: RangeInclusive<f64>) -> Self {
        self.typed_range = Some(range);
        self
    }

    /// Sets the value that the menu of the track and of the number restores.
    pub fn default(mut self, default: f64) -> Self {
        self.default = Some(default);
        self
    }

    /// Shown when the pointer rests on the name.
    pub fn help(mut self, help: &'a str) -> Self {
        self.help = help;
        self
    }

    /// Returns the number that is being typed for the slider named `label` in this place, if it can be read.
    pub fn typed_so_far(ui: &Ui, label: &str, unit: &str) -> Option<f64> {
        NumberCell::typed_so_far(ui, number_id(ui.make_persistent_id(("slider", label))), unit)
    }

    /// Shows the row.
    pub fn show(mut self, ui: &mut Ui) -> Response {
        let row = paint::row(ui);
        let id = ui.make_persistent_id(("slider", self.label));
        let before = *self.value;
        let is_narrow = row.width() < NARROW;
        let (track, number) = if is_narrow { narrow_parts(row) } else { self.named_parts(ui, row) };
        let mut response = self.track(ui, id, track, is_narrow);
        let (cell, entered) = self.number(ui, id, number);
        if let Some(entered) = entered {
            *self.value = entered;
        }
        self.declare(ui, &response);
        response = tips::explain(ui, response, self.help);
        response |= cell;
        if *self.value != before {
            response.mark_changed();
        }
        NumberCell::show_remark(ui, number_id(id), row, *self.value);
        response
    }

    fn scale(&self) -> Scale {
        Scale::new(&self.range, self.logarithmic)
    }

    /// `value` as a drag may set it: a multiple of the step, or just the digits that are shown.
    fn snapped(&self, value: f64) -> f64 {
        let (low, high) = (*self.range.start(), *self.range.end());
        let value = match self.step {
            Some(step) => low + ((value - low) / step).round() * step,
            None if self.logarithmic => format::rounded(value, 3),
            None => {
                let unit = 10_f64.powi(self.decimals() as i32);
                (value * unit).round() / unit
            }
        };
        value.clamp(low, high)
    }

    /// Decimals of a linear slider: enough to tell hundredths of the range, or steps, apart.
    fn decimals(&self) -> usize {
        format::decimals_for(self.step.unwrap_or((self.range.end() - self.range.start()) / 100.0))
    }

    fn shown(&self, value: f64) -> String {
        let number = if self.logarithmic {
            format::significant(value, 3)
        } else {
            format::fixed(value, self.decimals())
        };
        format::with_unit(&number, self.unit)
    }

    /// Returns the track: pointer and keys change the value, then it is painted.
    fn track(&mut self, ui: &Ui, id: Id, rect: Rect, is_narrow: bool) -> Response {
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let range = rect.left() + THUMB..=rect.right() - THUMB;
        if let Some(share) = self.pointed_share(ui, &response, &range) {
            *self.value = self.snapped(self.scale().value(share));
        }
        self.keys(ui, &response);
        if response.double_clicked() {
            NumberCell::edit_soon(ui, number_id(id));
        }
        let reset = self.with_input(|input| number_menu(ui, &response, &input, Some(number_id(id))));
        *self.value = reset.unwrap_or(*self.value);
        if is_narrow {
            self.paint_narrow(ui, &response, rect);
        } else {
            self.paint_track(ui, &response, rect);
        }
        response
    }

    /// Names a row of a panel, and returns the places of its track and of its number.
    fn named_parts(&self, ui: &Ui, row: Rect) -> (Rect, Rect) {
        let columns = paint::Columns::of(row);
        paint::label(ui, columns.label, self.label, self.help);
        (columns.middle, columns.value)
    }

    /// Paints a field with the name in it, and below it a line up to the value.
    fn paint_narrow(&self, ui: &Ui, response: &Response, rect: Rect) {
        let t = tokens(ui);
        let ground = if response.hovered() || response.dragged() { t.hover } else { t.field };
        ui.painter().rect_filled(rect, metrics::RADIUS_CONTROL, ground);
        let inner = rect.shrink2(vec2(f32::from(metrics::RADIUS_CONTROL), 0.0));
        let x = egui::lerp(inner.x_range(), self.scale().share(*self.value) as f32);
        let line = Rect::from_min_max(pos2(inner.left(), rect.bottom() - 3.0), pos2(x, rect.bottom() - 1.0));
        ui.painter().rect_filled(line, 1.0, t.accent);
        let name = rect.with_min_x(rect.left() + 8.0);
        paint::at_left(ui, name, paint::line(ui, self.label, font::body(), t.label));
        paint::focus_ring(ui, response, rect, metrics::RADIUS_CONTROL);
    }

    /// Returns the position that the pointer gives the thumb: at its own place, or with Shift held a tenth of
    /// its movement away.
    fn pointed_share(&self, ui: &Ui, response: &Response, range: &RangeInclusive<f32>) -> Option<f64> {
        let held = ui.input(|input| input.pointer.primary_down());
        if !response.is_pointer_button_down_on() || !held {
            return None;
        }
        let width = f64::from((range.end() - range.start()).max(1.0));
        let moved = f64::from(response.drag_delta().x);
        if ui.input(|input| input.modifiers.shift) {
            return (moved != 0.0).then(|| self.scale().share(*self.value) + 0.1 * moved / width);
        }
        let pointer = response.interact_pointer_pos()?;
        Some(f64::from(pointer.x - range.start()) / width)
    }

    /// Arrow keys, Home, End, and what assistive technology asks for.
    fn keys(&mut self, ui: &Ui, response: &Response) {
        let asked = requested_value(ui, response.id);
        if let Some(value) = asked {
            *self.value = value.clamp(*self.range.start(), *self.range.end());
        }
        let steps = key_steps(ui, response);
        if steps != 0.0 {
            let moved = self.scale().value(self.scale().share(*self.value) + steps * KEY_STEP);
            *self.value = self.moved_at_least_a_step(moved, steps);
        }
    }

    /// `moved`, or the next step in the direction of `steps` if rounding would undo the move.
    fn moved_at_least_a_step(&self, moved: f64, steps: f64) -> f64 {
        let snapped = self.snapped(moved);
        match self.step {
            Some(step) if snapped == *self.value => self.snapped(*self.value + step * steps.signum()),
            _ => snapped,
        }
    }

    fn paint_track(&self, ui: &Ui, response: &Response, rect: Rect) {
        let t = tokens(ui);
        let share = self.scale().share(*self.value) as f32;
        let x = egui::lerp(rect.left() + THUMB..=rect.right() - THUMB, share);
        let y = rect.center().y;
        let rail = Rect::from_min_max(pos2(rect.left(), y - 2.0), pos2(rect.right(), y + 2.0));
        let fill = Rect::from_min_max(rail.min, pos2(x, rail.bottom()));
        ui.painter().rect_filled(rail, 2.0, t.field);
        ui.painter().rect_filled(fill, 2.0, t.accent);
        let active = response.hovered() || response.dragged();
        let radius = if active { THUMB + 1.0 } else { THUMB };
        ui.painter().circle(pos2(x, y), radius, t.thumb, egui::Stroke::new(1.0, t.thumb_edge));
        if response.has_focus() {
            ui.painter().circle_stroke(pos2(x, y), radius + 3.0, egui::Stroke::new(1.5, t.accent));
        }
    }

    fn number(&self, ui: &mut Ui, id: Id, rect: Rect) -> (Response, Option<f64>) {
        let name = format!("{} value", self.label);
        self.with_input(|input| {
            let (help, align) = (self.help, Align::Max);
            let id = number_id(id);
            NumberCell { id, rect, name: &name, help, input, align, boxed: false, live: true }.show(ui)
        })
    }

    /// Calls `use_input` with the rules of the number.
    fn with_input<R>(&self, use_input: impl FnOnce(NumberInput<'_>) -> R) -> R {
        use_input(NumberInput {
            name: self.label,
            value: *self.value,
            range: self.typed_range.clone().unwrap_or_else(|| self.range.clone()),
            unit: self.unit,
            step: self.step,
            logarithmic: self.logarithmic,
            default: self.default,
            show: &|value| self.shown(value),
        })
    }

    /// Reports value and range to tests and screen readers.
    fn declare(&self, ui: &Ui, response: &Response) {
        response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), *self.value, self.label));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_min_numeric_value(*self.range.start());
            node.set_max_numeric_value(*self.range.end());
            node.set_value(self.shown(*self.value));
            node.add_action(Action::SetValue);
            node.add_action(Action::Increment);
            node.add_action(Action::Decrement);
        });
    }
}

/// Returns the place of the track and of the number in a narrow row: the track is all of it.
fn narrow_parts(row: Rect) -> (Rect, Rect) {
    let number = row.with_min_x(row.right() - metrics::VALUE_WIDTH.min(0.5 * row.width()));
    (row, number.with_max_x(row.right() - 6.0))
}

/// Returns the cell of the number beside a slider.
fn number_id(slider: Id) -> Id {
    slider.with("number")
}

/// Returns the number that assistive technology set.
pub(super) fn requested_value(ui: &Ui, id: Id) -> Option<f64> {
    ui.input(|input| {
        let numbers =
            input.accesskit_action_requests(id, Action::SetValue).filter_map(|request| match request.data {
                Some(ActionData::NumericValue(value)) => Some(value),
                _ => None,
            });
        numbers.last()
    })
}

/// Returns the number of steps pressed on the keyboard. While focused it takes the arrow keys, which would
/// otherwise move the focus.
pub(super) fn key_steps(ui: &Ui, response: &Response) -> f64 {
    let requests = ui.input(|input| {
        input.num_accesskit_action_requests(response.id, Action::Increment) as f64
            - input.num_accesskit_action_requests(response.id, Action::Decrement) as f64
    });
    if !response.has_focus() {
        return requests;
    }
    let filter = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    requests + ui.input(|input| input.events.iter().map(steps_of).sum::<f64>())
}

fn steps_of(event: &Event) -> f64 {
    let Event::Key { key, pressed: true, modifiers, .. } = event else {
        return 0.0;
    };
    let size = if modifiers.shift { 10.0 } else { 1.0 };
    match key {
        Key::ArrowRight | Key::ArrowUp => size,
        Key::ArrowLeft | Key::ArrowDown => -size,
        Key::PageUp => 10.0,
        Key::PageDown => -10.0,
        Key::Home => -1e6,
        Key::End => 1e6,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_a_narrow_slider_takes_half_of_it_at_most() {
        for width in [60.0, 100.0, 400.0] {
            let row = Rect::from_min_size(pos2(10.0, 5.0), vec2(width, 20.0));
            let (track, number) = narrow_parts(row);
            assert_eq!(track, row);
            assert_eq!(number.right(), row.right() - 6.0);
            assert_eq!(row.right() - number.left(), metrics::VALUE_WIDTH.min(width / 2.0), "{width}");
        }
    }

    #[test]
    fn a_scale_and_back_is_the_identity() {
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..2_000 {
            let logarithmic = random.bool();
            let low = if logarithmic { 1e-6 + random.f64() } else { 40.0 * random.f64() - 20.0 };
            let range = low..=low + 1e-3 + 1e3 * random.f64().powi(4);
            let scale = Scale::new(&range, logarithmic);
            let [share, other] = [(); 2].map(|()| random.f64());
            assert!((scale.share(scale.value(share)) - share).abs() < 1e-9, "{range:?} {share}");
            assert!(
                (share < other) == (scale.value(share) < scale.value(other)),
                "{range:?} {share} {other}"
            );
            assert!((scale.value(0.0) - low).abs() < 1e-9 && scale.share(low - 1.0) == 0.0, "{range:?}");
            assert!(
                (scale.value(1.0) / range.end() - 1.0).abs() < 1e-9 || range.end().abs() < 1e-3,
                "{range:?}"
            );
        }
    }

    #[test]
    fn a_scale_handles_degenerate_values() {
        let scale = Scale::new(&(0.0..=0.0), false);
        assert_eq!(scale.share(f64::NAN), 0.0);
        assert_eq!(scale.value(0.5), 0.0);
        assert_eq!(Scale::new(&(1e-3..=1.0), true).share(-1.0), 0.0);
    }

    #[test]
    fn a_drag_sets_what_is_shown() {
        let mut value = 0.0;
        assert_eq!(SliderRow::new("a", &mut value, 0.0..=1.0).snapped(0.12345), 0.12);
        assert_eq!(SliderRow::new("a", &mut value, 1e-3..=1.0).logarithmic().snapped(0.012345), 0.0123);
        assert_eq!(SliderRow::new("a", &mut value, 0.0..=54.0).step(1.0).snapped(7.4), 7.0);
    }
}

//! A small histogram.

use egui::{Align2, CursorIcon, EventFilter, Key, Rect, Response, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::{format, paint};
use crate::theme::{font, tokens};

/// Height of the bars, and of the text below them, in points.
const HEIGHT: f32 = 36.0;
const TICKS: f32 = 13.0;
/// The least height of a bar that counts anything: few bad ones among millions are seen.
const LEAST: f32 = 2.0;
/// The greatest width of a bar, and the space between two, in points.
const WIDEST: f32 = 40.0;
const GAP: f32 = 1.0;

/// A class of a histogram.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HistogramBar {
    /// The class, as in `45° to 50°`.
    pub class: String,
    /// How many it has.
    pub count: u64,
    /// Whether the class is a bad one, and stands out.
    pub is_bad: bool,
}

/// Bars side by side, linear in the count. A bar can be clicked; with the focus on one, the arrow keys lead
/// to the others.
#[must_use = "call `show`"]
pub struct Histogram<'a> {
    name: &'a str,
    bars: &'a [HistogramBar],
    nouns: [&'a str; 2],
    ends: [&'a str; 2],
}

impl<'a> Histogram<'a> {
    /// Its height in points.
    pub const HEIGHT: f32 = HEIGHT + TICKS;

    /// Creates a histogram. `name` names it for tests and screen readers, `nouns` are words for one and for
    /// many of what is counted.
    pub fn new(name: &'a str, bars: &'a [HistogramBar], nouns: [&'a str; 2]) -> Self {
        Self { name, bars, nouns, ends: [""; 2] }
    }

    /// Sets the texts below the first and the last bar.
    pub fn ends(mut self, ends: [&'a str; 2]) -> Self {
        self.ends = ends;
        self
    }

    /// Shows it in the full width, and returns the bar that was clicked.
    pub fn show(self, ui: &mut Ui) -> Option<usize> {
        let (_, rect) = ui.allocate_space(vec2(ui.available_width(), HEIGHT + TICKS));
        let well = rect.with_max_y(rect.top() + HEIGHT);
        let pitch = (well.width() / self.bars.len().max(1) as f32).min(WIDEST);
        let place = |bar: usize| {
            let left = well.left() + pitch * bar as f32;
            Rect::from_min_size(pos2(left, well.top()), vec2(pitch, well.height()))
        };
        let responses: Vec<_> = (0..self.bars.len()).map(|bar| self.sense(ui, place(bar), bar)).collect();
        self.follow_keys(ui, &responses);
        let most = self.bars.iter().map(|bar| bar.count).max().unwrap_or(0).max(1) as f32;
        for (number, (bar, response)) in self.bars.iter().zip(&responses).enumerate() {
            paint_bar(ui, place(number), bar, most, response);
        }
        let end = well.left() + pitch * self.bars.len() as f32;
        ui.painter().hline(well.left()..=end, well.bottom(), (1.0, tokens(ui).line));
        let [first, last] = self.ends;
        let text = |x: f32, align: Align2, text: &str| {
            ui.painter().text(pos2(x, well.bottom() + 2.0), align, text, font::axis(), tokens(ui).label)
        };
        let first = text(well.left(), Align2::LEFT_TOP, first);
        // Below few bars both may not fit.
        let last_at = end.max(first.right() + 12.0);
        if end - well.left() > 2.0 * first.width() {
            text(end, Align2::RIGHT_TOP, last);
        } else if !last.is_empty() {
            text(last_at, Align2::LEFT_TOP, last);
        }
        responses.iter().position(Response::clicked)
    }

    /// Registers a bar for pointer and keyboard, tests and screen readers. Tab stops once, at the bar that
    /// had the focus last.
    fn sense(&self, ui: &Ui, rect: Rect, number: usize) -> Response {
        let stop = ui.data(|data| data.get_temp(self.stop_id(ui))).unwrap_or(0).min(self.bars.len() - 1);
        let sense = if number == stop { Sense::click() } else { Sense::CLICK };
        let response = ui.interact(rect, ui.scope_id().with(("bar", self.name, number)), sense);
        let HistogramBar { class, count, .. } = &self.bars[number];
        let [one, many] = self.nouns;
        let noun = if *count == 1 { one } else { many };
        let name = format!("{} {class}: {} {noun}", self.name, format::count(*count));
        response.widget_info(|| WidgetInfo::labeled(Role::ListItem, ui.is_enabled(), &name));
        if *count == 0 {
            return response.on_hover_text_at_pointer(name);
        }
        let help = format!("{name}\nA click goes to the worst of them.");
        response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text_at_pointer(help)
    }

    /// Lets the arrow keys go from bar to bar.
    fn follow_keys(&self, ui: &Ui, responses: &[Response]) {
        let Some(place) = responses.iter().position(Response::has_focus) else { return };
        let filter = EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(responses[place].id, filter));
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        let next = match (pressed(Key::ArrowLeft), pressed(Key::ArrowRight)) {
            (true, false) => place.checked_sub(1),
            (false, true) => Some(place + 1).filter(|next| *next < responses.len()),
            _ => None,
        };
        if let Some(next) = next {
            ui.data_mut(|data| data.insert_temp(self.stop_id(ui), next));
            ui.memory_mut(|memory| memory.request_focus(responses[next].id));
        }
    }

    /// Under it, egui's memory has the bar at which Tab stops.
    fn stop_id(&self, ui: &Ui) -> egui::Id {
        ui.scope_id().with(("stop of Tab", self.name))
    }
}

fn paint_bar(ui: &Ui, place: Rect, bar: &HistogramBar, most: f32, response: &Response) {
    let t = tokens(ui);
    let is_lit = response.hovered() || response.has_focus();
    if is_lit {
        ui.painter().rect_filled(place, 2.0, t.field);
    }
    if bar.count > 0 {
        let height = (place.height() * bar.count as f32 / most).max(LEAST);
        let fill = match (is_lit, bar.is_bad) {
            (true, _) => t.value,
            (false, true) => t.danger,
            (false, false) => t.accent,
        };
        let at = Rect::from_min_max(pos2(place.left(), place.bottom() - height), place.max);
        ui.painter().rect_filled(at.shrink2(vec2(GAP / 2.0, 0.0)), 1.0, fill);
    }
    paint::focus_ring(ui, response, place, 2);
}

//! One of a few choices, side by side.

use egui::{
    self, Color32, EventFilter, Key, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};

use super::paint;
use crate::theme::{font, metrics, tokens};
use crate::widgets::{reveal, tips};

/// Segments side by side, one of them chosen: `Risk | Diameter`. Takes the full width.
///
/// `choices` are values with their names; `name` names the group for screen readers. The left and right arrow
/// keys choose the next one. The response has `changed` when `value` did.
pub fn segmented<T: PartialEq + Copy>(
    ui: &mut Ui,
    name: &str,
    value: &mut T,
    choices: &[(T, &str)],
) -> Response {
    let (id, rect) = ui.allocate_space(vec2(ui.available_width(), metrics::ROW + 4.0));
    let mut group = ui.interact(rect, id, Sense::hover());
    group.widget_info(|| WidgetInfo::labeled(Role::RadioGroup, ui.is_enabled(), name));
    reveal::show_control(ui, rect, name);
    paint_well(ui, rect);
    let before = *value;
    let places = segment_places(ui, rect, choices.iter().map(|(_, label)| *label));
    for (i, ((choice, label), place)) in choices.iter().zip(places).enumerate() {
        let response = segment(ui, place, name, label, *choice == before);
        if response.clicked() {
            *value = *choice;
        }
        if let Some(next) = neighbour_by_key(ui, &response, i, choices.len()) {
            *value = choices[next].0;
            ui.memory_mut(|memory| memory.request_focus(segment_id(ui, name, choices[next].1)));
        }
    }
    if *value != before {
        group.mark_changed();
    }
    group
}

fn paint_well(ui: &Ui, rect: Rect) {
    let t = tokens(ui);
    ui.painter().rect(rect, metrics::RADIUS_CONTROL, t.well, t.hairline(), StrokeKind::Inside);
}

/// Free space at each end of a name, in points.
const PADDING: f32 = 4.0;

/// Returns the places of the segments: equally wide where each has room for its name, or else as wide as the
/// names ask for.
fn segment_places<'a>(ui: &Ui, rect: Rect, labels: impl Iterator<Item = &'a str>) -> Vec<Rect> {
    let inner = rect.shrink(3.0);
    let text = |label| paint::line(ui, label, font::body(), Color32::PLACEHOLDER).size().x.ceil();
    let widths: Vec<f32> = labels.map(|label| text(label) + 2.0 * PADDING).collect();
    let equal = inner.width() / widths.len() as f32;
    let fits = widths.iter().all(|width| *width <= equal);
    let spare = (inner.width() - widths.iter().sum::<f32>()) / widths.len() as f32;
    let mut left = inner.left();
    let place = |width: f32| {
        let right = left + if fits { equal } else { width + spare };
        let place = Rect::from_x_y_ranges(left..=right, inner.y_range());
        left = right;
        place
    };
    widths.into_iter().map(place).collect()
}

fn segment_id(ui: &Ui, group: &str, label: &str) -> egui::Id {
    ui.make_persistent_id(("segment", group, label))
}

fn segment(ui: &Ui, rect: Rect, group: &str, label: &str, chosen: bool) -> Response {
    let t = tokens(ui);
    let response = ui.interact(rect, segment_id(ui, group, label), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, ui.is_enabled(), chosen, label));
    if chosen {
        let edge = Stroke::new(1.0, t.edge);
        ui.painter().rect(rect, metrics::RADIUS_CONTROL - 2, t.raised, edge, StrokeKind::Inside);
    }
    let ink = match (chosen, response.hovered()) {
        (true, _) => t.value,
        (false, true) => t.text,
        (false, false) => t.label,
    };
    paint::focus_ring(ui, &response, rect.shrink(2.0), metrics::RADIUS_CONTROL - 3);
    paint::at_centre(ui, rect, paint::elided(ui, label, font::body(), ink, rect.width() - 2.0 * PADDING));
    tips::explain(ui, response, tips::sentence(&format!("{group}/{label}")))
}

/// Returns the segment that an arrow key asks for while segment `index` of `count` has the focus.
fn neighbour_by_key(ui: &Ui, response: &Response, index: usize, count: usize) -> Option<usize> {
    if !response.has_focus() {
        return None;
    }
    let filter = EventFilter { horizontal_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (left, right) =
        ui.input(|input| (input.key_pressed(Key::ArrowLeft), input.key_pressed(Key::ArrowRight)));
    match (left, right) {
        (true, false) => index.checked_sub(1),
        (false, true) => Some(index + 1).filter(|next| *next < count),
        _ => None,
    }
}

//! Pins on the canvas: numbered marks, and the values of the one under the pointer.

use eframe::egui::{Color32, Pos2, Rect, Role, Sense, Stroke, WidgetInfo, pos2, vec2};
use glam::DVec2;

use super::table::nearest_pin;
use crate::app::features::pins::Pins;
use meshbrush_kit::kit::marks::paint_number;
use meshbrush_kit::kit::readout::{Quantity, Readout, TriangleReadout};
use meshbrush_kit::kit::{FrameState, GRIP_POINTS, OverMesh};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::theme::NUMBER_DISC;
use meshbrush_ui::theme::font;
use meshbrush_ui::widgets::{format, paint_floating};

/// The most pins that are drawn: more would hide the mesh.
const MOST_DRAWN: usize = 2_000;
/// Distance of a number's middle from its pin, in points.
const NUMBER_OFFSET: f32 = 11.0;

/// Draws the pins in view. With the query tool, the one under the pointer stands out, with its values beside
/// it.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let pins = &state.session.document().settings().pins;
    if pins.is_empty() {
        return;
    }
    let selected = state.feature::<Pins>().selected_of(pins);
    let hovered = hovered(state, pins, over);
    let view = over.painter.clip_rect().expand(2.0 * NUMBER_OFFSET);
    let places = pins.iter().map(|&pin| (over.screen_from_world)(pin)).enumerate();
    for (number, at) in places.filter(|(_, at)| view.contains(*at)).take(MOST_DRAWN) {
        paint_pin(over, at, number, Some(number) == hovered, Some(number) == selected);
    }
    if let Some(number) = hovered {
        show_values(over, state, number, pins[number]);
    }
}

fn hovered(state: &FrameState<'_>, pins: &[DVec2], over: &OverMesh<'_>) -> Option<usize> {
    over.pointer.filter(|_| state.tools.tool.queries)?;
    let point = state.pointer?;
    let px = (over.screen_from_world)(point + DVec2::X).distance((over.screen_from_world)(point));
    nearest_pin(pins, point, GRIP_POINTS / f64::from(px))
}

fn paint_pin(over: &OverMesh<'_>, at: Pos2, number: usize, is_hovered: bool, is_selected: bool) {
    let radius = if is_hovered || is_selected { 5.5 } else { 4.0 };
    let (fill, rim) = (Color32::from_rgb(0xff, 0x5c, 0x8a), Color32::WHITE);
    over.painter.circle_filled(at, radius + 2.5, Color32::from_black_alpha(200));
    over.painter.circle(at, radius, fill, Stroke::new(if is_selected { 2.0 } else { 1.2 }, rim));
    let font = if is_hovered || is_selected { font::strong() } else { font::caption() };
    let middle = at + vec2(NUMBER_OFFSET, -NUMBER_OFFSET);
    paint_number(over.painter, middle, number + 1, font, Color32::WHITE, NUMBER_DISC);
}

/// The values of a pin on a ground beside it.
fn show_values(over: &OverMesh<'_>, state: &FrameState<'_>, number: usize, pin: DVec2) {
    let (ui, canvas, at) = (over.ui, over.canvas, (over.screen_from_world)(pin));
    let quantity = state.view.quantity;
    let triangle = Readout::triangle_at(pin, state.session, quantity);
    let text = values(state, number, triangle.as_ref());
    let galley = ui.painter().layout_no_wrap(text.clone(), font::small_value(), ui.visuals().text_color());
    let size = galley.size() + vec2(16.0, 12.0);
    let left = if at.x + 24.0 + size.x > canvas.right() { at.x - 16.0 - size.x } else { at.x + 24.0 };
    let top = (at.y + 8.0).min(canvas.bottom() - size.y - 8.0);
    let place = Rect::from_min_size(pos2(left, top), size);
    paint_floating(ui, place);
    ui.painter_at(canvas).galley(place.min + vec2(8.0, 6.0), galley, Color32::PLACEHOLDER);
    let response = ui.interact(place, ui.scope_id().with("values of a pin"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &text));
}

/// Triangle, level, ζ, the interpolated and the true value, in lines.
fn values(state: &FrameState<'_>, number: usize, triangle: Option<&TriangleReadout>) -> String {
    let Some(triangle) = triangle else { return format!("Pin {}: in no triangle", number + 1) };
    let (name, unit) = match state.view.quantity {
        Quantity::TargetDiameter => ("h̄", state.unit()),
        Quantity::Risk => ("Risk", LengthUnit::None),
    };
    let id = match state.session.has_file_numbers() {
        true => format::count(triangle.id.index() as u64),
        false => "…".into(),
    };
    let [a, b, c] = triangle.zeta.map(|zeta| format::fixed(zeta, 3));
    let [interpolated, exact] =
        [triangle.interpolated, triangle.exact].map(|value| unit.after(&format::significant(value, 4)));
    format!(
        "Pin {} · triangle {id} · level {}\nζ {a} {b} {c}\n{name} {interpolated} · true {exact}",
        number + 1,
        triangle.level
    )
}

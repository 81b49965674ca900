//! The coordinate frame along two sides of the canvas, and the scale bar.

use eframe::egui::{Align2, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2};
use glam::{DVec2, dvec2};

use super::graticule;
use meshbrush_core::earth::{DegreeStyle, EarthPlane};
use meshbrush_kit::kit::{FrameState, marks};
use meshbrush_mesh::text::{LengthUnit, tick_step};
use meshbrush_render::render::furniture::ScaleBar;
use meshbrush_render::render::north_arrow::north_arrow;
use meshbrush_render::scene::Camera;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::degrees::KM_PER_DEGREE;
use meshbrush_ui::widgets::{format, paint_floating};

/// Width that the scale bar and its distance from other things take, in points.
pub const BAR_ROOM: f32 = LONGEST_BAR + 2.0 * BAR_MARGIN.x + 8.0;
/// Least space between two labels, in points.
const LABEL_GAP: f32 = 28.0;
/// Least space between two labelled ticks, in points.
const TICK_GAP: f32 = 88.0;
/// Lengths of labelled ticks and of those between them, in points.
const TICKS: [f32; 2] = [7.0, 4.0];
/// Greatest length of the scale bar, in points.
const LONGEST_BAR: f32 = 132.0;
/// Space around the scale bar in its box, in points.
const BAR_MARGIN: Vec2 = vec2(10.0, 7.0);

/// A side of the canvas with ticks.
#[derive(Clone, Copy)]
enum Side {
    Top,
    Left,
}

impl Side {
    /// Returns the way from the side into the canvas.
    fn inwards(self, length: f32) -> Vec2 {
        match self {
            Self::Top => vec2(0.0, length),
            Self::Left => vec2(length, 0.0),
        }
    }
}

/// Ticks with labels along the upper and the left side of the canvas, where they are shown. They take no
/// clicks.
pub fn paint_frame(ui: &Ui, rect: Rect, camera: &Camera, state: &FrameState<'_>) {
    if !state.view.aids.coordinates {
        return;
    }
    if let Some((plane, style)) = state.geographic_plane() {
        return paint_degrees(ui, rect, camera, plane, style);
    }
    let unit = state.unit();
    let per_point = f64::from(ui.pixels_per_point()) / camera.px_per_world();
    let visible = camera.visible_world();
    for (side, from, to) in
        [(Side::Top, visible.min.x, visible.max.x), (Side::Left, visible.min.y, visible.max.y)]
    {
        let widest = [from, to].map(|end| label_size(ui, &label(end, per_point * 64.0, unit)).x);
        let room = match side {
            Side::Top => (widest[0].max(widest[1]) + LABEL_GAP).max(TICK_GAP),
            Side::Left => TICK_GAP,
        };
        let (step, parts) = tick_step(f64::from(room) * per_point);
        paint_side(ui, rect, side, [from, to], Ticks { step, parts, unit });
    }
}

/// Ticks where meridians leave the canvas at the top and parallels at the left.
fn paint_degrees(ui: &Ui, rect: Rect, camera: &Camera, plane: EarthPlane, style: DegreeStyle) {
    let (screen, visible) = (camera.screen_map(), camera.visible_world());
    for line in graticule::lines_across(ui, plane, visible, style).iter() {
        let side = if line.is_meridian { Side::Top } else { Side::Left };
        let (axis, value) = match side {
            Side::Top => (1, visible.max.y),
            Side::Left => (0, visible.min.x),
        };
        let at = |world: DVec2| marks::point_from_px(rect, screen(world), ui.pixels_per_point());
        let start = line.crossings(axis, value).map(at).find(|at| rect.expand(0.5).contains(*at));
        if let Some(start) = start {
            paint_tick(ui, start, side, TICKS[0]);
            paint_tick_label(ui, rect, start, side, &line.label);
        }
    }
}

struct Ticks {
    step: f64,
    parts: u32,
    unit: LengthUnit,
}

fn paint_side(ui: &Ui, rect: Rect, side: Side, [from, to]: [f64; 2], ticks: Ticks) {
    let minor = ticks.step / f64::from(ticks.parts);
    let (first, last) = ((from / minor).ceil() as i64, (to / minor).floor() as i64);
    // At the deepest zoom coordinates can be too coarse for ticks.
    if last - first > 10_000 {
        return;
    }
    for number in first..=last {
        let value = number as f64 * minor;
        let share = ((value - from) / (to - from)) as f32;
        let major = number % i64::from(ticks.parts) == 0;
        let start = match side {
            Side::Top => pos2(rect.left() + share * rect.width(), rect.top()),
            Side::Left => pos2(rect.left(), rect.bottom() - share * rect.height()),
        };
        paint_tick(ui, start, side, TICKS[usize::from(!major)]);
        if major {
            paint_tick_label(ui, rect, start, side, &label(value, ticks.step, ticks.unit));
        }
    }
}

/// A tick from a side of the canvas.
fn paint_tick(ui: &Ui, start: Pos2, side: Side, length: f32) {
    let t = tokens(ui);
    let end = start + side.inwards(length);
    // On a ground of the canvas's colour, ticks are visible on any mesh.
    ui.painter().line_segment([start, end], Stroke::new(3.0, t.canvas.gamma_multiply(0.6)));
    ui.painter().line_segment([start, end], Stroke::new(1.0, t.faint));
}

fn paint_tick_label(ui: &Ui, rect: Rect, start: Pos2, side: Side, text: &str) {
    let (gap, align) = match side {
        Side::Top => (1.0, Align2::CENTER_TOP),
        Side::Left => (3.0, Align2::LEFT_CENTER),
    };
    paint_label(ui, rect, start + side.inwards(TICKS[0] + gap), align, text);
}

/// Returns a coordinate with the digits that tell labels apart.
fn label(value: f64, step: f64, unit: LengthUnit) -> String {
    unit.after(&format::fixed(value, format::decimals_for(step)))
}

fn label_size(ui: &Ui, text: &str) -> Vec2 {
    ui.painter().layout_no_wrap(text.to_owned(), font::axis(), tokens(ui).faint).size()
}

/// Writes a label on a ground of its own.
pub fn paint_label(ui: &Ui, rect: Rect, anchor: Pos2, align: Align2, text: &str) {
    let t = tokens(ui);
    let place = align.anchor_size(anchor, label_size(ui, text));
    // A label that the other side's labels or the edge of the canvas would cut is left out.
    let corner = Rect::from_min_size(rect.min, vec2(44.0, 22.0));
    if !rect.contains_rect(place) || corner.intersects(place) {
        return;
    }
    ui.painter().rect_filled(place.expand2(vec2(3.0, 0.0)), 3.0, t.canvas.gamma_multiply(0.72));
    ui.painter().text(place.min, Align2::LEFT_TOP, text, font::axis(), t.label);
}

/// A bar of a round length in the lower right corner of `inner`, and above it in the plane of a projection an
/// arrow to the north. Both are those in the middle of the view. They take no clicks.
pub fn show_scale_bar(ui: &Ui, inner: Rect, camera: &Camera, state: &FrameState<'_>) {
    let px_per_point = f64::from(ui.pixels_per_point());
    let (center, domain) = (camera.visible_world().center(), &state.session.document().settings().domain);
    let points_per_length = domain.in_plane(camera.px_per_world() / px_per_point, center);
    let Some(bar) = ScaleBar::new(points_per_length, LONGEST_BAR.into(), state.unit()) else { return };
    let text = bar_text(&bar, state.unit(), center.y);
    let t = tokens(ui);
    let text_size = ui.painter().layout_no_wrap(text.clone(), font::small_value(), t.label).size();
    let bar = bar.length_px as f32;
    let size = vec2(bar.max(text_size.x), text_size.y + 8.0) + 2.0 * BAR_MARGIN;
    let place = Rect::from_min_size(inner.right_bottom() - size, size);
    if let Some(north) = domain.projection.and_then(|projection| projection.north_at(center)) {
        let in_space = state.view.space_view();
        let north = in_space.map_or(north, |view| view.camera.turned_direction(north));
        show_north(ui, place.right_top() - vec2(0.0, 8.0), north);
    }
    let response = ui.interact(place, ui.scope_id().with("scale bar"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Scale: {text}")));
    paint_floating(ui, place);
    let within = place.shrink2(BAR_MARGIN);
    ui.painter().text(within.left_top(), Align2::LEFT_TOP, &text, font::small_value(), t.value);
    let (left, right, y) = (within.left(), within.left() + bar, within.bottom() - 2.0);
    let stroke = Stroke::new(1.5, t.value);
    ui.painter().hline(left..=right, y, stroke);
    for x in [left, right] {
        ui.painter().vline(x, y - 4.0..=y, stroke);
    }
}

/// Length of the arrow to the north, in points.
const NORTH_ARROW: f32 = 26.0;

/// An arrow to the north, given as a direction in the plane, above and to the left of a corner.
fn show_north(ui: &Ui, corner: Pos2, north: DVec2) {
    let t = tokens(ui);
    let place = Rect::from_min_max(corner - Vec2::splat(1.9 * NORTH_ARROW), corner);
    let response = ui.interact(place, ui.scope_id().with("north"), Sense::hover());
    let clockwise = north.x.atan2(north.y).to_degrees().round();
    response.widget_info(|| {
        WidgetInfo::labeled(Role::Label, true, format!("North: {clockwise}° clockwise from up"))
    });
    paint_floating(ui, place);
    let center = place.center();
    let lines = north_arrow(dvec2(center.x.into(), center.y.into()), NORTH_ARROW.into(), north);
    for line in lines {
        let points = line.iter().map(|at| pos2(at.x as f32, at.y as f32)).collect();
        ui.painter().add(Shape::line(points, Stroke::new(1.5, t.value)));
    }
}

/// Returns the length of a bar, and for degrees about how many kilometres it is along a parallel at a
/// latitude.
fn bar_text(ScaleBar { text, length, .. }: &ScaleBar, unit: LengthUnit, latitude: f64) -> String {
    if unit != LengthUnit::Degree || latitude.abs() > 89.0 {
        return text.clone();
    }
    let km = length * KM_PER_DEGREE * latitude.to_radians().cos();
    let ground = if km < 1.0 {
        format::length(format::rounded(1000.0 * km, 2), LengthUnit::Metre)
    } else {
        format::length(format::rounded(km, 2), LengthUnit::Kilometre)
    };
    format!("{text} ≈ {ground}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_degree_is_also_given_in_kilometres_at_the_latitude() {
        let text = |length: f64, unit, latitude| {
            bar_text(&ScaleBar::new(1.0 / length, 1.0, unit).unwrap(), unit, latitude)
        };
        assert_eq!(text(1.0, LengthUnit::Degree, 0.0), "1° ≈ 110 km");
        assert_eq!(text(0.001, LengthUnit::Degree, 60.0), "0.001° ≈ 56 m");
        assert_eq!(text(2.0, LengthUnit::Kilometre, 60.0), "2 km");
        assert_eq!(text(50_000.0, LengthUnit::Metre, 0.0), "50 km");
        assert_eq!(text(500.0, LengthUnit::Metre, 0.0), "500 m");
    }
}

//! The legend of what is drawn over the mesh.

use eframe::egui::{Align2, Color32, Rect, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};

use super::level_legend;
use super::overlay_legend::{SpokenLegend, legend_of};
use crate::app::features::paths::{ALTERNATIVE_COLOR, CORRIDOR_COLOR, Paths};
use crate::app::features::statistics::Statistics;
use crate::app::features::stepping::{Stepping, Steps};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_kit::kit::{FrameState, light_level};
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use meshbrush_render::render::furniture::{LegendBody, LegendRow, LegendScale};
use meshbrush_study::steps::StepPlayer;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{elided_text, format, paint_floating};

/// Width of the box and of a swatch, in points.
const WIDTH: f32 = 124.0;
const SWATCH: f32 = 18.0;
/// Heights of the title and of a row with text, in points.
pub(super) const TITLE: f32 = 20.0;
pub(super) const ROW: f32 = 14.0;
const LAYER_ROW: f32 = 18.0;
pub(super) const MARGIN: Vec2 = vec2(10.0, 7.0);

/// Shows the legend of the overlay, of the contour lines or of the levels in the upper right corner of
/// `inner`, and that of the paths below it. Returns the place that takes clicks, which is that of the levels.
///
/// While a step is shown, that is the legend of its levels, where it covers nothing of the mesh: `mesh` is
/// where that is on the screen.
pub fn show(
    ui: &Ui,
    inner: Rect,
    mesh: Rect,
    state: &FrameState<'_>,
    commands: &mut Vec<Command>,
) -> Option<Rect> {
    let inner = inner.with_min_y(inner.top() + 12.0);
    let player = state.feature::<Stepping>().steps().and_then(Steps::player);
    let of_overlay = |kind| {
        let smallest = match kind {
            FieldOverlay::TimeStep => state.feature::<Statistics>().smallest_time_step(state.session),
            _ => None,
        };
        let found = legend_of(kind, state.session, &palette_of(state), smallest)?;
        Some(show_legend(ui, inner, &found))
    };
    let mut levels = None;
    let content = match state.view.overlay {
        _ if player.is_some() => {
            let counts = player.map(StepPlayer::level_counts).unwrap_or_default();
            levels = level_legend::show(ui, inner, Some(mesh), &counts, state, commands);
            levels.map(|(place, _)| place)
        }
        FieldOverlay::None if state.view.space.is_on => None,
        _ if state.view.space.is_on => Some(plan_only(ui, inner)),
        FieldOverlay::None if state.view.aids.contours => of_overlay(FieldOverlay::Target),
        FieldOverlay::None if state.view.aids.levels => {
            levels = level_legend::show(ui, inner, None, &state.session.level_counts(), state, commands);
            levels.map(|(place, _)| place)
        }
        FieldOverlay::None => None,
        kind => of_overlay(kind),
    };
    let top = content.map_or(inner.top(), |content| content.bottom() + MARGIN.y + 8.0);
    path_legend(ui, inner.with_min_y(top), state);
    // Also when the legend is hidden: then it lights no level.
    light_level(ui, "canvas", levels.and_then(|(_, hovered)| hovered), state, commands);
    levels.map(|(place, _)| place)
}

/// Returns the colours of overlays as they are drawn.
fn palette_of(state: &FrameState<'_>) -> OverlayPalette {
    OverlayPalette::new(state.view.ground, state.view.level_colors(state.session.follower().settings()))
}

/// Returns the place of the box of a legend with content of this size, in points.
pub(super) fn place_of(inner: Rect, content: Vec2) -> Rect {
    let size = content + vec2(0.0, TITLE) + 2.0 * MARGIN;
    Rect::from_min_size(inner.right_top() - vec2(size.x, 0.0), size)
}

/// Draws the box of a legend with its title, and returns the place for its content of this size, in points.
pub(super) fn boxed(ui: &Ui, inner: Rect, content: Vec2, title: &str, spoken: &str) -> Rect {
    let place = place_of(inner, content);
    let response = ui.interact(place, ui.scope_id().with(("legend", title)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, spoken));
    paint_floating(ui, place);
    let within = place.shrink2(MARGIN);
    ui.painter().text(within.min, Align2::LEFT_TOP, title, font::caption(), tokens(ui).label);
    within.with_min_y(within.top() + TITLE)
}

/// Shows a legend in the upper right corner of `inner`, and returns the place of its content.
fn show_legend(ui: &Ui, inner: Rect, SpokenLegend { legend, spoken }: &SpokenLegend) -> Rect {
    match &legend.body {
        LegendBody::Scale(LegendScale { colors, ends, note }) => {
            let has_note = if note.is_empty() { 0.0 } else { ROW };
            let place = boxed(ui, inner, vec2(WIDTH, 30.0 + has_note), &legend.title, spoken);
            scale(ui, place, colors, ends);
            below_scale(ui, place, note);
            place
        }
        LegendBody::Missing(reason) => {
            let place = boxed(ui, inner, vec2(WIDTH, ROW), &legend.title, spoken);
            ui.painter().text(place.min, Align2::LEFT_TOP, reason, font::axis(), tokens(ui).label);
            place
        }
        LegendBody::Rows(rows) if rows.iter().all(|row| row.texts.len() == 1) => {
            let most = ((inner.height() * 0.7 - TITLE) / LAYER_ROW).max(1.0) as usize;
            let shown = &rows[..rows.len().min(most)];
            let size = vec2(WIDTH, LAYER_ROW * shown.len() as f32);
            let place = boxed(ui, inner, size, &legend.title, spoken);
            name_rows(ui, place, shown);
            place
        }
        LegendBody::Rows(rows) => {
            let room = (inner.height() * 0.7 - TITLE - 2.0 * MARGIN.y).max(ROW);
            let height = (room / rows.len() as f32).min(ROW);
            let size = vec2(WIDTH, height * rows.len() as f32);
            let place = boxed(ui, inner, size, &legend.title, spoken);
            number_rows(ui, place, rows, height);
            place
        }
    }
}

/// Shows colours with a name each.
fn name_rows(ui: &Ui, place: Rect, rows: &[LegendRow]) {
    for (number, row) in rows.iter().enumerate() {
        let top = place.top() + LAYER_ROW * number as f32;
        let swatch = Rect::from_min_size(pos2(place.left(), top + 3.0), vec2(SWATCH, LAYER_ROW - 6.0));
        ui.painter().rect_filled(swatch, 2.0, opaque(row.color));
        let room = Rect::from_min_max(pos2(swatch.right() + 6.0, top), pos2(place.right(), top + LAYER_ROW));
        elided_text(ui, room, &row.texts[0], tokens(ui).value);
    }
}

/// Shows colours with two numbers each, in rows of a height.
fn number_rows(ui: &Ui, place: Rect, rows: &[LegendRow], height: f32) {
    // Where rows are too low for text, only some have one.
    let every = (ROW / height).ceil() as usize;
    let t = tokens(ui);
    for (number, row) in rows.iter().enumerate() {
        let top = place.top() + height * number as f32;
        let swatch = Rect::from_min_size(pos2(place.left(), top), vec2(SWATCH, height));
        ui.painter().rect_filled(swatch, 0.0, opaque(row.color));
        if number % every > 0 {
            continue;
        }
        let columns = [(swatch.right() + 22.0, t.label), (place.right(), t.value)];
        for ((x, ink), text) in columns.into_iter().zip(&row.texts) {
            let at = pos2(x, swatch.center().y);
            ui.painter().text(at, Align2::RIGHT_CENTER, text, font::axis(), ink);
        }
    }
}

fn opaque([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

/// Shows a row of text below a scale.
fn below_scale(ui: &Ui, place: Rect, text: &str) {
    let at = place.left_top() + vec2(0.0, 32.0);
    ui.painter().text(at, Align2::LEFT_TOP, text, font::axis(), tokens(ui).label);
}

/// Says that the view in space has no overlay.
fn plan_only(ui: &Ui, inner: Rect) -> Rect {
    let place = boxed(ui, inner, vec2(WIDTH, ROW), "Overlay", "Legend: overlays are shown in the plan");
    ui.painter().text(place.min, Align2::LEFT_TOP, "shown in the plan", font::axis(), tokens(ui).label);
    place
}

/// Cells of colours side by side, with text below the left, the middle and the right.
fn scale(ui: &Ui, place: Rect, colors: &[[u8; 3]], texts: &[String; 3]) {
    let t = tokens(ui);
    let bar = place.with_max_y(place.top() + 12.0);
    let width = bar.width() / colors.len() as f32;
    for (cell, &color) in colors.iter().enumerate() {
        let left = bar.left() + width * cell as f32;
        let cell = Rect::from_min_size(pos2(left, bar.top()), vec2(width, bar.height()));
        ui.painter().rect_filled(cell, 0.0, opaque(color));
    }
    let places = [
        (bar.left(), Align2::LEFT_TOP),
        (bar.center().x, Align2::CENTER_TOP),
        (bar.right(), Align2::RIGHT_TOP),
    ];
    for ((x, align), text) in places.into_iter().zip(texts) {
        ui.painter().text(pos2(x, bar.bottom() + 3.0), align, text, font::axis(), t.label);
    }
}

/// Shows the legend of the lines that are drawn beside the paths.
fn path_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>) {
    let paths = &state.feature::<Paths>().finder;
    let mut rows = Vec::new();
    if !paths.corridor.lines().is_empty() {
        let percent = format::digits(100.0 * paths.corridor.share, 3);
        rows.push((CORRIDOR_COLOR, format!("within {percent} %"), LAYER_ROW - 6.0));
    }
    if !paths.alternatives.paths().is_empty() {
        rows.push((ALTERNATIVE_COLOR, "alternatives".into(), 2.0));
    }
    if rows.is_empty() {
        return;
    }
    let texts: Vec<&str> = rows.iter().map(|(_, text, _)| text.as_str()).collect();
    let spoken = format!("Legend: paths {}", texts.join(", "));
    let place = boxed(ui, inner, vec2(WIDTH, LAYER_ROW * rows.len() as f32), "Paths", &spoken);
    let t = tokens(ui);
    for (row, (color, text, height)) in rows.iter().enumerate() {
        let top = place.top() + LAYER_ROW * row as f32;
        let middle = pos2(place.left() + SWATCH / 2.0, top + LAYER_ROW / 2.0);
        ui.painter().rect_filled(Rect::from_center_size(middle, vec2(SWATCH, *height)), 1.0, *color);
        let left = place.left() + SWATCH + 6.0;
        let room = Rect::from_min_max(pos2(left, top), pos2(place.right(), top + LAYER_ROW));
        elided_text(ui, room, text, t.value);
    }
}

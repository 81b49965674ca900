//! The legend of what is drawn over the mesh.

use eframe::egui::{Align2, Color32, Rect, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};

use super::overlay_palette::{MOST_ERROR, MOST_SLACK, OLD_AGE, Opaque, OverlayPalette};
use super::quality_colors::measure_of;
use super::{level_legend, quality_legend};
use crate::app::features::paths::{ALTERNATIVE_COLOR, CORRIDOR_COLOR, Paths};
use crate::app::features::stepping::{Stepping, Steps};
use meshbrush_core::layers::{DepthSurface, SurfaceNorm};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::view::{FieldOverlay, deepest_level};
use meshbrush_kit::kit::{FrameState, light_level};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_study::relief::isobath_interval;
use meshbrush_study::steps::StepPlayer;
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{elided_text, format, paint_floating};

/// Width of the box and of a swatch, in points.
pub(super) const WIDTH: f32 = 124.0;
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
    let palette = &palette_of(state);
    let mut levels = None;
    let content = match state.view.overlay {
        _ if player.is_some() => {
            let counts = player.map(StepPlayer::level_counts).unwrap_or_default();
            levels = level_legend::show(ui, inner, Some(mesh), &counts, state, commands);
            levels.map(|(place, _)| place)
        }
        FieldOverlay::None if state.view.space.is_on => None,
        _ if state.view.space.is_on => Some(plan_only(ui, inner)),
        FieldOverlay::Risk => Some(risk_legend(ui, inner, palette)),
        FieldOverlay::Target => Some(target_legend(ui, inner, state)),
        FieldOverlay::Layer => Some(layer_legend(ui, inner, state, palette)),
        FieldOverlay::Slack => Some(slack_legend(ui, inner, palette)),
        FieldOverlay::Forced => Some(forced_legend(ui, inner, palette)),
        FieldOverlay::Age => Some(age_legend(ui, inner, palette)),
        FieldOverlay::Depth => Some(depth_legend(ui, inner, state, palette)),
        FieldOverlay::DepthError => Some(depth_error_legend(ui, inner, state, palette)),
        FieldOverlay::Surface => Some(surface_legend(ui, inner, state, palette)),
        FieldOverlay::SurfaceError => Some(surface_error_legend(ui, inner, state, palette)),
        FieldOverlay::SmallestAngle
        | FieldOverlay::LargestAngle
        | FieldOverlay::EdgeRatio
        | FieldOverlay::TargetRatio
        | FieldOverlay::TimeStep
        | FieldOverlay::Valence => measure_of(state.view.overlay)
            .map(|measure| quality_legend::show(ui, inner, state, palette, measure)),
        FieldOverlay::None if state.view.aids.contours => Some(target_legend(ui, inner, state)),
        FieldOverlay::None if state.view.aids.levels => {
            levels = level_legend::show(ui, inner, None, &state.session.level_counts(), state, commands);
            levels.map(|(place, _)| place)
        }
        FieldOverlay::None => None,
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

/// Returns risk from 0 to 1, a cell for each sixteenth.
fn risk_legend(ui: &Ui, inner: Rect, palette: &OverlayPalette) -> Rect {
    let place = boxed(ui, inner, vec2(WIDTH, 30.0), "Risk", "Legend: risk 0 to 1");
    let colors = (0..=16_u8).map(|i| palette.risk((f32::from(i) / 16.0 * 255.0) as u8));
    scale(ui, place, colors, ["0", "0.5", "1"].map(str::to_owned));
    place
}

/// Returns how often the mesh could be halved less.
fn slack_legend(ui: &Ui, inner: Rect, palette: &OverlayPalette) -> Rect {
    let place = boxed(ui, inner, vec2(WIDTH, 30.0), "Slack h̄ / h", "Legend: slack 1 to 16");
    let steps = 16u16;
    let color = |step| palette.slack((f32::from(step) + 0.5) / f32::from(steps) * MOST_SLACK);
    scale(ui, place, (0..steps).map(color), ["1", "4", "≥ 16"].map(str::to_owned));
    place
}

/// Shows the legend of ages, from the last edit to old triangles, with a cell for each edit.
fn age_legend(ui: &Ui, inner: Rect, palette: &OverlayPalette) -> Rect {
    let place = boxed(ui, inner, vec2(WIDTH, 30.0), "Edits ago", "Legend: edits ago, 0 to 10");
    let colors = (0..OLD_AGE + 1).map(|age| palette.age(Some(age)));
    scale(ui, place, colors, ["0".into(), (OLD_AGE / 2).to_string(), format!("≥ {OLD_AGE}")]);
    place
}

/// Returns depths from the shore to the deepest place, and the metres between isobaths.
fn depth_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>, palette: &OverlayPalette) -> Rect {
    let Some(surface) = DepthSurface::of(&state.session.document().settings().layers) else {
        return no_layer(ui, inner, "Depth", "no layer of depths");
    };
    let deepest = surface.deepest();
    let metres = |depth: f64| LengthUnit::Metre.after(&format::significant(depth, 3));
    let spoken = format!("Legend: depth 0 to {}", metres(deepest));
    let place = boxed(ui, inner, vec2(WIDTH, 30.0 + ROW), "Depth", &spoken);
    let steps = 16_u8;
    let share = |step: u8| (f32::from(step) / f32::from(steps)).powi(2);
    scale(
        ui,
        place,
        (0..=steps).map(|step| palette.water(share(step))),
        ["0".into(), format::significant(0.25 * deepest, 3), metres(deepest)],
    );
    below_scale(ui, place, format!("isobaths every {}", metres(isobath_interval(deepest))));
    place
}

/// Returns how much deeper the mesh is, as a share of the depth.
fn depth_error_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>, palette: &OverlayPalette) -> Rect {
    if DepthSurface::of(&state.session.document().settings().layers).is_none() {
        return no_layer(ui, inner, "Depth", "no layer of depths");
    }
    let percent = format::digits(f64::from(100.0 * MOST_ERROR), 3);
    let spoken = format!("Legend: depth error −{percent} % to {percent} %");
    let place = boxed(ui, inner, vec2(WIDTH, 30.0 + ROW), "Depth error", &spoken);
    let steps = 8_i8;
    let color = |step: i8| palette.depth_error(MOST_ERROR * f32::from(step) / f32::from(steps));
    let ends = [format!("−{percent} %"), "0".into(), format!("{percent} %")];
    scale(ui, place, (-steps..=steps).map(color), ends);
    below_scale(ui, place, "shallower, deeper".into());
    place
}

/// Shows heights from the lowest to the highest sample, and how far contour lines are apart.
fn surface_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>, palette: &OverlayPalette) -> Rect {
    let range = state.session.follower().surface().and_then(|rule| rule.samples().height_range());
    let Some([lowest, highest]) = range else {
        return no_layer(ui, inner, "Surface", "no layer of a surface");
    };
    let ends = [lowest, lowest.midpoint(highest), highest].map(|height| format::significant(height, 3));
    let spoken = format!("Legend: surface {} to {}", ends[0], ends[2]);
    let place = boxed(ui, inner, vec2(WIDTH, 30.0 + ROW), "Surface", &spoken);
    let steps = 16_u8;
    let color = |step: u8| palette.height(f32::from(step) / f32::from(steps));
    scale(ui, place, (0..=steps).map(color), ends);
    let interval = isobath_interval((highest - lowest).max(f64::MIN_POSITIVE));
    below_scale(ui, place, format!("contours every {}", format::significant(interval, 3)));
    place
}

/// Returns how much higher the mesh is than the surface, up to the error that is allowed.
fn surface_error_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>, palette: &OverlayPalette) -> Rect {
    let Some(rule) = state.session.follower().surface() else {
        return no_layer(ui, inner, "Surface error", "no layer of a surface");
    };
    let errors: Vec<f64> = rule.errors().map(|(_, error)| error).collect();
    let is_summed = SurfaceNorm::ALL[1..].iter().any(|norm| rule.error_of(*norm).is_some());
    let is_varied = rule.has_errors_of_layers();
    let ends = match errors[..] {
        _ if is_summed => ["−largest", "0", "largest"].map(str::to_owned),
        [first, ..] if !is_varied && first.is_finite() && errors.iter().all(|error| *error == first) => {
            let error = format::significant(first, 3);
            [format!("−{error}"), "0".into(), error]
        }
        // Several errors are allowed.
        _ => ["−100 %", "0", "100 %"].map(str::to_owned),
    };
    let spoken = format!("Legend: surface error {} to {}", ends[0], ends[2]);
    let place = boxed(ui, inner, vec2(WIDTH, 30.0 + ROW), "Surface error", &spoken);
    let steps = 8_i8;
    let color = |step: i8| palette.surface_error(f32::from(step) / f32::from(steps));
    scale(ui, place, (-steps..=steps).map(color), ends);
    below_scale(ui, place, "mesh lower, higher".into());
    place
}

/// Shows a row of text below a scale.
pub(super) fn below_scale(ui: &Ui, place: Rect, text: String) {
    let at = place.left_top() + vec2(0.0, 32.0);
    ui.painter().text(at, Align2::LEFT_TOP, text, font::axis(), tokens(ui).label);
}

/// Says that the view in space has no overlay.
fn plan_only(ui: &Ui, inner: Rect) -> Rect {
    let place = boxed(ui, inner, vec2(WIDTH, ROW), "Overlay", "Legend: overlays are shown in the plan");
    ui.painter().text(place.min, Align2::LEFT_TOP, "shown in the plan", font::axis(), tokens(ui).label);
    place
}

/// Says which layer is missing.
pub(super) fn no_layer(ui: &Ui, inner: Rect, title: &str, text: &str) -> Rect {
    let place = boxed(ui, inner, vec2(WIDTH, ROW), title, &format!("Legend: {text}"));
    ui.painter().text(place.min, Align2::LEFT_TOP, text, font::axis(), tokens(ui).label);
    place
}

/// Cells of colours side by side, with text below the left, the middle and the right.
pub(super) fn scale(ui: &Ui, place: Rect, colors: impl ExactSizeIterator<Item = Opaque>, texts: [String; 3]) {
    let t = tokens(ui);
    let bar = place.with_max_y(place.top() + 12.0);
    let width = bar.width() / colors.len() as f32;
    for (cell, [r, g, b, _]) in colors.enumerate() {
        let left = bar.left() + width * cell as f32;
        let cell = Rect::from_min_size(pos2(left, bar.top()), vec2(width, bar.height()));
        ui.painter().rect_filled(cell, 0.0, Color32::from_rgb(r, g, b));
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

/// Returns the colour of triangles that only compatibility asked for.
fn forced_legend(ui: &Ui, inner: Rect, palette: &OverlayPalette) -> Rect {
    let spoken = "Legend: triangles that only compatibility asked for";
    let place = boxed(ui, inner, vec2(WIDTH, LAYER_ROW), "Cause", spoken);
    let swatch = Rect::from_min_size(place.min + vec2(0.0, 3.0), vec2(SWATCH, LAYER_ROW - 6.0));
    let [r, g, b, _] = palette.forced(true);
    ui.painter().rect_filled(swatch, 2.0, Color32::from_rgb(r, g, b));
    let room = Rect::from_min_max(pos2(swatch.right() + 6.0, place.top()), place.right_bottom());
    elided_text(ui, room, "compatibility", tokens(ui).value);
    place
}

/// Returns the visible layers in their colours, from the top.
fn layer_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>, palette: &OverlayPalette) -> Rect {
    let layers = &state.session.follower().settings().layers;
    let visible: Vec<_> = layers.iter().rev().filter(|layer| layer.visible).collect();
    let rows = ((inner.height() * 0.7 - TITLE) / LAYER_ROW).max(1.0) as usize;
    let shown = visible.len().min(rows);
    let names: Vec<&str> = visible.iter().map(|layer| layer.name.as_str()).collect();
    let spoken = format!("Legend: layers {}", names.join(", "));
    let place = boxed(ui, inner, vec2(WIDTH, LAYER_ROW * shown as f32), "Deciding layer", &spoken);
    let t = tokens(ui);
    for (row, layer) in visible.iter().take(shown).enumerate() {
        let top = place.top() + LAYER_ROW * row as f32;
        let swatch = Rect::from_min_size(pos2(place.left(), top + 3.0), vec2(SWATCH, LAYER_ROW - 6.0));
        let [r, g, b, _] = palette.layer(Some(layer.id));
        ui.painter().rect_filled(swatch, 2.0, Color32::from_rgb(r, g, b));
        let room = Rect::from_min_max(pos2(swatch.right() + 6.0, top), pos2(place.right(), top + LAYER_ROW));
        elided_text(ui, room, &layer.name, t.value);
    }
    place
}

/// Returns the levels that h̄ can ask for, with the diameters of their triangles.
fn target_legend(ui: &Ui, inner: Rect, state: &FrameState<'_>) -> Rect {
    let settings = state.session.follower().settings();
    let levels = u32::from(deepest_level(settings)) + 1;
    let room = (inner.height() * 0.7 - TITLE - 2.0 * MARGIN.y).max(ROW);
    let row = (room / levels as f32).min(ROW);
    let spoken = format!("Legend: diameters of levels 0 to {}", levels - 1);
    let place = boxed(ui, inner, vec2(WIDTH, row * levels as f32), "h̄ by level", &spoken);
    // Where rows are too low for text, only some have one.
    let every = (ROW / row).ceil() as u32;
    let (t, colors) = (tokens(ui), state.view.level_colors(settings));
    for level in 0..levels {
        let top = place.top() + row * level as f32;
        let swatch = Rect::from_min_size(pos2(place.left(), top), vec2(SWATCH, row));
        let [r, g, b, _] = colors.of(level as u8);
        ui.painter().rect_filled(swatch, 0.0, Color32::from_rgb(r, g, b));
        if level % every == 0 {
            let y = swatch.center().y;
            let number = level.to_string();
            ui.painter().text(
                pos2(swatch.right() + 22.0, y),
                Align2::RIGHT_CENTER,
                number,
                font::axis(),
                t.label,
            );
            let diameter = format::length(state.session.mesh().diameter(level), state.unit());
            ui.painter().text(pos2(place.right(), y), Align2::RIGHT_CENTER, diameter, font::axis(), t.value);
        }
    }
    place
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

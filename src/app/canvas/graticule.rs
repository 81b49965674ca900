//! Meridians and parallels over the mesh, in documents on the Earth.

use std::sync::Arc;

use eframe::egui::{Align2, Id, Pos2, Rect, Ui};
use glam::DVec2;

use super::coordinates::paint_label;
use meshbrush_core::earth::{DegreeStyle, EarthPlane, GraticuleLine, graticule};
use meshbrush_kit::kit::{FrameState, marks};
use meshbrush_mesh::geometry::Rect as WorldRect;
use meshbrush_render::scene::Camera;
use meshbrush_ui::theme::tokens;

/// Distance of the labels from the sides of the canvas, in points: below are hints.
const FROM_SIDES: [f32; 2] = [6.0, 54.0];

/// Draws the lines, with labels where they leave the canvas at the right and below. They take no clicks.
pub fn paint(ui: &Ui, rect: Rect, camera: &Camera, state: &FrameState<'_>) {
    let settings = state.session.document().settings();
    let plane = EarthPlane::new(settings.domain.projection, settings.unit);
    let Some(plane) = plane.filter(|_| state.view.aids.graticule) else { return };
    let style = state.geographic_plane().map_or(DegreeStyle::Minutes, |(_, style)| style);
    let (painter, screen, t) = (ui.painter_at(rect), camera.screen_map(), tokens(ui));
    let at = |world| marks::point_from_px(rect, screen(world), ui.pixels_per_point());
    let lines = lines_across(ui, plane, camera.visible_world(), style);
    let lines: Vec<_> = lines
        .iter()
        .map(|line| (line.points.iter().map(|&point| at(point)).collect::<Vec<Pos2>>(), line))
        .collect();
    for (points, _) in &lines {
        let colors = [t.canvas.gamma_multiply(0.35), t.value.gamma_multiply(0.38)];
        marks::paint_quiet_line(&painter, points.iter().copied(), colors);
    }
    let from_corner = FROM_SIDES.map(|points| f64::from(points * ui.pixels_per_point()));
    let corner = camera.size_px().map(f64::from);
    let side = camera.world_from_screen(DVec2::from(corner) - DVec2::from(from_corner));
    for (_, line) in &lines {
        let (axis, align) = match line.is_meridian {
            true => (1, Align2::CENTER_BOTTOM),
            false => (0, Align2::RIGHT_CENTER),
        };
        if let Some(place) = line.crossings(axis, side[axis]).next() {
            paint_label(ui, rect, at(place), align, &line.label);
        }
    }
}

/// Returns the meridians and parallels across an area. They are found once for a view: lines and rulers share
/// them, and they stay while the view does.
pub fn lines_across(
    ui: &Ui,
    plane: EarthPlane,
    area: WorldRect,
    style: DegreeStyle,
) -> Arc<Vec<GraticuleLine>> {
    type Key = (EarthPlane, WorldRect, DegreeStyle);
    let (id, key): (Id, Key) = (Id::unique("lines of the graticule"), (plane, area, style));
    let kept: Option<(Key, Arc<Vec<GraticuleLine>>)> = ui.data(|data| data.get_temp(id));
    if let Some((of, lines)) = kept
        && of == key
    {
        return lines;
    }
    let lines = Arc::new(graticule(plane, area, style));
    ui.data_mut(|data| data.insert_temp(id, (key, lines.clone())));
    lines
}

//! Paths through triangles: the walk of point location, and the trail of neighbours.

use eframe::egui::{Color32, Pos2, Rect, Stroke, vec2};
use glam::DVec2;

use super::Inspector;
use meshbrush_kit::kit::marks::{paint_line, paint_number};
use meshbrush_kit::kit::{FrameState, OverMesh};
use meshbrush_ui::theme::NUMBER_DISC;
use meshbrush_ui::theme::font;

/// The colour of the walk.
const WALK: Color32 = Color32::from_rgb(0x7c, 0xd8, 0xff);
/// The colour of the trail.
const TRAIL: Color32 = Color32::from_rgb(0xff, 0xc8, 0x57);
/// Dots and numbers nearer to each other than this many points are left out.
const SMALLEST_DISTANCE: f32 = 5.0;
const SMALLEST_DISTANCE_OF_NUMBERS: f32 = 18.0;

/// Draws the walk, where it is shown: a line through the middles of the triangles visited, to the point.
pub fn paint_walk(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let arrived_at = state.feature::<Inspector>().arrived_at;
    let is_walked = |point| state.view.aids.walk && arrived_at != Some(point);
    let Some(readout) = state.readout.filter(|readout| is_walked(readout.point)) else { return };
    let point = readout.point;
    let mesh = state.session.mesh();
    let path = mesh.walk_path(point);
    if path.len() < 2 {
        return;
    }
    let middles = path.iter().map(|&id| mesh.view().world_corners(id).iter().sum::<DVec2>() / 3.0);
    let points: Vec<Pos2> = middles.map(|middle| (over.screen_from_world)(middle)).collect();
    let to_point = [(over.screen_from_world)(point)];
    paint_line(over.painter, points.iter().chain(&to_point).copied(), WALK, 1.5);
    for at in apart(&points, SMALLEST_DISTANCE) {
        over.painter.circle(points[at], 2.2, WALK, Stroke::new(1.0, Color32::from_black_alpha(200)));
    }
    let start = Rect::from_center_size(points[0], vec2(8.0, 8.0));
    over.painter.rect_filled(start.expand(1.5), 2.0, Color32::from_black_alpha(200));
    over.painter.rect_filled(start, 1.0, WALK);
}

/// Draws the trail: a line with a number at each triangle.
pub fn paint_trail(over: &OverMesh<'_>, trail: &[DVec2]) {
    if trail.len() < 2 {
        return;
    }
    let points: Vec<Pos2> = trail.iter().map(|&middle| (over.screen_from_world)(middle)).collect();
    paint_line(over.painter, points.iter().copied(), TRAIL, 2.0);
    for at in apart(&points, SMALLEST_DISTANCE_OF_NUMBERS) {
        paint_number(over.painter, points[at], at + 1, font::caption(), TRAIL, NUMBER_DISC);
    }
}

/// Returns the places of points that are at least so far from the last one taken, in points of the screen.
fn apart(points: &[Pos2], distance: f32) -> Vec<usize> {
    let mut taken: Vec<usize> = Vec::new();
    for (at, point) in points.iter().enumerate() {
        if taken.last().is_none_or(|&last| points[last].distance(*point) >= distance) {
            taken.push(at);
        }
    }
    taken
}

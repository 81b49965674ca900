//! Marks of the area in which the selected layer counts, and of the shapes that it measures the distance to.

use eframe::egui::{Color32, Pos2, Stroke};
use glam::DVec2;

use meshbrush_core::layers::{DistanceLayer, ShapeList};
use meshbrush_kit::kit::{FrameState, OverMesh, marks};
use meshbrush_ui::theme::tokens;

/// Width of the outline of a mask and of shapes, in points.
const WIDTH: f32 = 1.5;
/// Radius of a point among shapes, in points.
const POINT: f32 = 3.5;
/// Most points that are drawn: more would hide the mesh.
const MOST_POINTS: usize = 2_000;

/// Draws the mask of the selected layer in the accent colour, and the shapes of a layer of distances in
/// white. A hidden layer has neither.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let Some(layer) = state.session.document().active_layer().filter(|layer| layer.visible) else { return };
    if let Some(DistanceLayer { to, .. }) = layer.kind.get()
        && let Some(shapes) = to.shapes()
    {
        paint_shapes(over, shapes.list());
    }
    if let Some(mask) = &layer.mask {
        for ring in mask.polygons().iter().flatten() {
            marks::paint_rimmed_line(over.painter, closed(over, ring), tokens(over.ui).accent, WIDTH);
        }
    }
}

fn paint_shapes(over: &OverMesh<'_>, ShapeList { points, lines, polygons }: &ShapeList) {
    for ring in polygons.iter().flatten() {
        marks::paint_line(over.painter, closed(over, ring), Color32::WHITE, WIDTH);
    }
    for line in lines {
        let along = over.line(line.iter().copied()).into_iter();
        marks::paint_line(over.painter, along, Color32::WHITE, WIDTH);
    }
    let view = over.painter.clip_rect().expand(POINT);
    let places = points.iter().map(|&point| (over.screen_from_world)(point));
    for place in places.filter(|&place| view.contains(place)).take(MOST_POINTS) {
        over.painter.circle(place, POINT, Color32::WHITE, Stroke::new(1.5, Color32::from_black_alpha(200)));
    }
}

/// Returns the corners of a ring in points, with the first one again at the end.
fn closed(over: &OverMesh<'_>, ring: &[DVec2]) -> impl Iterator<Item = Pos2> {
    over.line(ring.iter().chain(ring.first()).copied()).into_iter()
}

//! The regions that paths stay out of, hatched over the mesh.

use eframe::egui::{Color32, Pos2, Shape, Stroke};

use meshbrush_core::layers::Mask;
use meshbrush_kit::kit::{FrameState, OverMesh, hatching, marks};

/// The colour of hatching and outline.
const COLOR: Color32 = Color32::from_rgb(0xff, 0x6b, 0x5a);
/// Width of the outline, in points.
const WIDTH: f32 = 1.5;

/// Hatches all regions.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    for region in state.session.document().settings().paths.keep_out.iter() {
        paint_region(over, &region.mask);
    }
}

fn paint_region(over: &OverMesh<'_>, mask: &Mask) {
    let rings: Vec<Vec<Pos2>> = mask
        .polygons()
        .iter()
        .flatten()
        .map(|ring| ring.iter().map(|&corner| (over.screen_from_world)(corner)).collect())
        .collect();
    let lines = hatching(&rings, over.painter.clip_rect());
    for stroke in [Stroke::new(3.0, Color32::from_black_alpha(90)), Stroke::new(1.2, COLOR)] {
        over.painter.extend(lines.iter().map(|&ends| Shape::line_segment(ends, stroke)));
    }
    for ring in &rings {
        let closed = ring.iter().chain(ring.first()).copied();
        marks::paint_line(over.painter, closed, COLOR, WIDTH);
    }
}

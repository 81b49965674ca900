//! What the region tool draws over the mesh.

use eframe::egui::{Color32, Pos2, Rect as ScreenRect, Shape, Stroke};
use glam::DVec2;

use super::RegionTarget;
use crate::app::features::regions::RegionTool;
use meshbrush_core::document::DrawnPart;
use meshbrush_core::layers::Mask;
use meshbrush_kit::kit::{FrameState, OverMesh, hatching, marks};
use meshbrush_mesh::geometry::Rect;

/// The hatching where a layer does not count.
const OUTSIDE: Stroke = Stroke { width: 1.2, color: Color32::from_rgba_premultiplied(0, 0, 0, 150) };
/// A light rim, so that it shows on dark colours too.
const RIM: Stroke = Stroke { width: 3.0, color: Color32::from_rgba_premultiplied(45, 45, 45, 45) };

/// Hatches what the mask of the selected layer leaves out, and draws areas that have not reached the document
/// and the open polygon. The outlines of masks, regions and shapes are drawn with any tool.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let tool = state.tools.settings::<RegionTool>();
    let at = over.screen_from_world;
    if tool.target == RegionTarget::Mask
        && let Some(mask) = state.session.document().active_layer().and_then(|layer| layer.mask.as_ref())
    {
        let Rect { min, max } = state.session.document().settings().domain.bounds;
        paint_outside(over, mask, ScreenRect::from_two_pos(at(min), at(max)));
    }
    for area in state.session.pending_cuts(|part| part != DrawnPart::Domain) {
        marks::paint_cut_shape(over.painter, area, at);
    }
    let corners: Vec<Pos2> = tool.corners.iter().map(|&corner| at(corner)).collect();
    marks::paint_open_polygon(over.painter, &corners, over.pointer);
}

/// Hatches what a mask leaves out of the frame of the domain, which is given in points.
fn paint_outside(over: &OverMesh<'_>, mask: &Mask, frame: ScreenRect) {
    let view = over.painter.clip_rect().intersect(frame);
    if !view.is_positive() {
        return;
    }
    let on_screen = |ring: &Vec<DVec2>| ring.iter().map(|&corner| (over.screen_from_world)(corner)).collect();
    let mut rings: Vec<Vec<Pos2>> = mask.polygons().iter().flatten().map(on_screen).collect();
    // With a ring around the view, the inside of all rings is what the mask leaves out.
    let around = view.expand(view.width() + view.height());
    rings.push(vec![around.left_top(), around.right_top(), around.right_bottom(), around.left_bottom()]);
    let lines = hatching(&rings, view);
    for stroke in [RIM, OUTSIDE] {
        let painter = over.painter.with_clip_rect(view);
        painter.extend(lines.iter().map(|&ends| Shape::line_segment(ends, stroke)));
    }
}

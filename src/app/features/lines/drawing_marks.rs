//! What the line tool draws over the mesh: the line that is being drawn, handles, and where a corner snaps.

use eframe::egui::{Color32, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2};

use super::LineToolMode;
use super::snap::{SNAP_POINTS, SnapPlace, snap_place, snaps_now};
use crate::app::features::lines::LineTool;
use meshbrush_kit::kit::{FrameState, OverMesh, marks};
use meshbrush_ui::theme::tokens;

/// Half the side of the mark where a corner snaps, in points.
const SNAP_MARK: f32 = 7.0;

/// Draws the open line to the pointer, or the handles of the selected one, and a mark where a corner snaps.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let tool = state.tools.settings::<LineTool>();
    let at = over.screen_from_world;
    let lines = &state.session.document().settings().lines;
    let snap = snap_under_pointer(state, over);
    if let (LineToolMode::Edit, Some(number)) = (tool.mode, tool.selected_in(lines)) {
        let corners: Vec<Pos2> = lines[number].points.iter().map(|&corner| at(corner)).collect();
        paint_handles(over, &corners);
        if let Some((_, corner)) = tool.corner_in(lines) {
            over.painter.circle_filled(corners[corner], 3.5, tokens(over.ui).accent);
        }
    }
    let corners: Vec<Pos2> = tool.corners.iter().chain(&tool.way_from).map(|&corner| at(corner)).collect();
    let to = snap.map(|snap| at(snap.at)).or(over.pointer);
    marks::paint_open_line(over.painter, &corners, to);
    if let Some(snap) = snap {
        paint_snap(over, at(snap.at), snap.is_corner);
    }
}

/// Handles in view: a line of a file can have very many corners.
fn paint_handles(over: &OverMesh<'_>, corners: &[Pos2]) {
    let view = over.painter.clip_rect().expand(8.0);
    let in_view: Vec<Pos2> = corners.iter().copied().filter(|corner| view.contains(*corner)).collect();
    marks::paint_handles(over.painter, &in_view);
}

/// Returns what the next corner, or the one that is dragged, snaps to.
fn snap_under_pointer(state: &FrameState<'_>, over: &OverMesh<'_>) -> Option<SnapPlace> {
    let tool = state.tools.settings::<LineTool>();
    let (alt, is_down) = over.ui.input(|input| (input.modifiers.alt, input.pointer.primary_down()));
    let point = state.pointer.filter(|_| over.pointer.is_some() && snaps_now(state.tools, alt))?;
    let without = match tool.mode {
        LineToolMode::Corners | LineToolMode::FreeHand | LineToolMode::DeepestWay => None,
        LineToolMode::Edit if is_down => Some(tool.selected?),
        LineToolMode::Edit | LineToolMode::Rectangle | LineToolMode::Circle => return None,
    };
    let px_per_point = f64::from(over.painter.pixels_per_point());
    let reach = SNAP_POINTS * px_per_point * state.view.world_per_px();
    snap_place(state.session, point, reach, without)
}

/// A square where there is a corner, and a diamond on a segment.
fn paint_snap(over: &OverMesh<'_>, at: Pos2, is_corner: bool) {
    for stroke in [Stroke::new(4.5, Color32::from_black_alpha(170)), Stroke::new(2.0, tokens(over.ui).accent)]
    {
        if is_corner {
            let square = Rect::from_center_size(at, Vec2::splat(2.0 * SNAP_MARK));
            over.painter.rect_stroke(square, 1.0, stroke, StrokeKind::Middle);
        } else {
            let diamond = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
            let corners = diamond.map(|[x, y]| at + SNAP_MARK * Vec2::new(x, y)).to_vec();
            over.painter.add(Shape::closed_line(corners, stroke));
        }
    }
}

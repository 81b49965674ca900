//! Corners snap to lines and to the outline of the domain.

use eframe::egui::Pos2;
use glam::DVec2;

use crate::app::features::lines::LineTool;
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_kit::kit::Pointer;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::tools::Tools;
use meshbrush_mesh::geometry::nearest_on_segment;

/// How far something is at most to which a corner snaps, in points.
pub const SNAP_POINTS: f64 = 8.0;

/// Where a corner snaps to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapPlace {
    /// In world units: exactly those of the corner, or the nearest point of the segment.
    pub at: DVec2,
    /// Whether there is a corner.
    pub is_corner: bool,
}

/// Returns whether corners snap now: Alt swaps what is set.
pub fn snaps_now(tools: &Tools, alt: bool) -> bool {
    tools.settings::<LineTool>().snaps != alt
}

/// Returns where a corner goes that is set at a position in points. It does not snap to the line numbered
/// `without`.
pub fn place_of(pointer: &Pointer<'_>, at: Pos2, without: Option<usize>) -> DVec2 {
    let point = pointer.world(at);
    if !snaps_now(pointer.tools, pointer.modifiers.alt) {
        return point;
    }
    let reach = SNAP_POINTS * pointer.px_per_point / pointer.camera.px_per_world();
    snap_place(pointer.session, point, reach, without).map_or(point, |place| place.at)
}

/// Returns what a corner at a point snaps to, at most `reach` away, in world units: the nearest corner, or
/// else the nearest segment.
pub fn snap_place(session: &Session, point: DVec2, reach: f64, without: Option<usize>) -> Option<SnapPlace> {
    let lines = session.document().settings().lines.iter().enumerate();
    let lines = || lines.clone().filter(|(number, _)| Some(*number) != without).map(|(_, line)| line);
    let pieces = session.boundary_pieces();
    let on_outline = pieces.and_then(|pieces| pieces.nearest(point, reach));
    let corners = lines().flat_map(|line| line.points.iter().copied());
    let of_outline = on_outline.zip(pieces).map(|((piece, _), pieces)| corners_of(pieces, piece));
    let corners = corners.chain(of_outline.into_iter().flatten());
    if let Some(at) = nearest(point, reach, corners) {
        return Some(SnapPlace { at, is_corner: true });
    }
    let on_segments = lines().flat_map(|line| line.edges()).map(|ends| nearest_on_segment(point, ends));
    let on_segments = on_segments.chain(on_outline.map(|(_, at)| at));
    nearest(point, reach, on_segments).map(|at| SnapPlace { at, is_corner: false })
}

fn corners_of(pieces: &BoundaryPieces, piece: usize) -> impl Iterator<Item = DVec2> {
    pieces.list()[piece].points.iter().copied()
}

fn nearest(point: DVec2, reach: f64, places: impl Iterator<Item = DVec2>) -> Option<DVec2> {
    let near = places.map(|at| (at, at.distance(point))).filter(|(_, distance)| *distance <= reach);
    near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(at, _)| at)
}

//! The lines over the mesh, and where they are not on edges.

use eframe::egui::{Color32, Stroke};

use meshbrush_kit::kit::{FrameState, OverMesh, marks};
use meshbrush_ui::theme::tokens;

/// Width of a line, in points.
const WIDTH: f32 = 1.6;
/// Radius of the mark where a line is not on edges, in points.
const MARK: f32 = 6.0;
/// The most marks of a line that are drawn.
const MOST_MARKS: usize = 500;

/// Draws the lines of the document, and a ring around each place where the derived mesh has no edges for
/// them.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let at = over.screen_from_world;
    for line in state.session.document().settings().lines.iter() {
        let closing = line.points.first().filter(|_| line.closed);
        let points = line.points.iter().chain(closing).map(|&point| at(point));
        marks::paint_rimmed_line(over.painter, points, tokens(over.ui).accent, WIDTH);
    }
    let Some(derived) = state.session.derived() else { return };
    for fit in &derived.line_fits {
        for part in fit.unresolved.iter().take(MOST_MARKS) {
            let place = at(part.place);
            over.painter.circle_stroke(place, MARK, Stroke::new(4.0, Color32::from_black_alpha(140)));
            over.painter.circle_stroke(place, MARK, Stroke::new(2.0, tokens(over.ui).danger));
        }
    }
}

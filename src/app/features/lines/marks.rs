//! The lines over the mesh: which parts of them are on edges, and why others are not.

use eframe::egui::{Color32, Pos2, Rect, Role, Sense, Stroke, WidgetInfo, pos2, vec2};

use super::LINE;
use super::places::{fit_in, reason};
use crate::app::features::lines::LineTool;
use meshbrush_core::domain::Line;
use meshbrush_core::outline::{LineFit, UnresolvedPlace};
use meshbrush_kit::kit::{FrameState, GRIP_POINTS, OverMesh, marks, nearest_within};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::paint_floating;

/// Width of a line, and of the selected one, in points.
const WIDTHS: [f32; 2] = [1.6, 3.0];
/// Radius of the mark where a line is not on edges, in points.
const MARK: f32 = 6.0;
/// The most marks of a line that are drawn.
const MOST_MARKS: usize = 500;

/// Draws the lines of the document: solid where they are on edges of the mesh that files get, and dashed,
/// with a ring, where they are not. The ring under the pointer says why.
pub fn paint(state: &FrameState<'_>, over: &OverMesh<'_>) {
    let lines = &state.session.document().settings().lines;
    let is_tool = state.tools.tool == &LINE;
    let selected = state.tools.settings::<LineTool>().selected_in(lines).filter(|_| is_tool);
    for (number, line) in lines.iter().enumerate() {
        let width = WIDTHS[usize::from(selected == Some(number))];
        paint_line(state, over, line, fit_in(state.session, number), width);
    }
    let parts =
        |number| fit_in(state.session, number).into_iter().flat_map(|fit| &fit.unresolved).take(MOST_MARKS);
    let parts: Vec<&UnresolvedPlace> = (0..lines.len()).flat_map(parts).collect();
    for part in &parts {
        let place = (over.screen_from_world)(part.place);
        over.painter.circle_stroke(place, MARK, Stroke::new(4.0, Color32::from_black_alpha(140)));
        over.painter.circle_stroke(place, MARK, Stroke::new(2.0, tokens(over.ui).danger));
    }
    let explains = is_tool || state.tools.tool.queries;
    if let Some(pointer) = over.pointer.filter(|_| explains) {
        let distances =
            parts.iter().map(|part| (over.screen_from_world)(part.place).distance(pointer).into());
        if let Some(part) = nearest_within(distances, GRIP_POINTS) {
            explain(over, (over.screen_from_world)(parts[part].place), &reason(parts[part], state.unit()));
        }
    }
}

fn paint_line(state: &FrameState<'_>, over: &OverMesh<'_>, line: &Line, fit: Option<&LineFit>, width: f32) {
    let (at, accent) = (over.screen_from_world, tokens(over.ui).accent);
    let closing = line.points.first().filter(|_| line.closed);
    let points = line.points.iter().chain(closing).map(|&point| at(point));
    let Some(fit) = fit.filter(|fit| !fit.unresolved.is_empty()) else {
        return marks::paint_rimmed_line(over.painter, points, accent, width);
    };
    marks::paint_dashed_line(over.painter, points, tokens(over.ui).danger, width);
    let lattice = state.session.mesh().lattice();
    let at = |p| at(lattice.world_from_lattice(p));
    for run in fit.edges.chunk_by(|a, b| a[1] == b[0]) {
        let points = run.iter().take(1).map(|edge| edge[0]).chain(run.iter().map(|edge| edge[1]));
        marks::paint_rimmed_line(over.painter, points.map(at), accent, width);
    }
}

/// A sentence on a ground beside a mark.
fn explain(over: &OverMesh<'_>, at: Pos2, text: &str) {
    let (ui, canvas) = (over.ui, over.canvas);
    let color = ui.visuals().text_color();
    let galley = ui.painter().layout(text.to_owned(), font::body(), color, 260.0);
    let size = galley.size() + vec2(16.0, 12.0);
    let left = if at.x + 16.0 + size.x > canvas.right() { at.x - 16.0 - size.x } else { at.x + 16.0 };
    let top = (at.y + 10.0).min(canvas.bottom() - size.y - 8.0);
    let place = Rect::from_min_size(pos2(left, top), size);
    paint_floating(ui, place);
    ui.painter_at(canvas).galley(place.min + vec2(8.0, 6.0), galley, Color32::PLACEHOLDER);
    let response = ui.interact(place, ui.scope_id().with("why a line is not on edges"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
}

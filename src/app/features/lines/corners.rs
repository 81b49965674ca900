//! Corners of lines of the document are moved with the pointer.

use eframe::egui::Pos2;

use super::LinesCommand;
use super::snap::place_of;
use crate::app::features::lines::LineTool;
use meshbrush_core::domain::Line;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CLICK_SLACK, GRIP_POINTS, Gesture, Pointer, Press, nearest_within};
use meshbrush_mesh::geometry::nearest_on_segment;

/// Takes hold of a corner of the selected line, or of a place on it, where another corner will be. Elsewhere
/// it selects the line under the pointer, or none.
pub fn press_to_edit(
    press: &Press,
    pointer: &Pointer<'_>,
    commands: &mut Vec<Command>,
) -> Option<Box<dyn Gesture>> {
    let lines = &pointer.session.document().settings().lines;
    if let Some(number) = pointer.tools.settings::<LineTool>().selected_in(lines) {
        let line = &lines[number];
        let corner = corner_at(line, press.at, pointer);
        let edge = edge_at(line, press.at, pointer).filter(|_| corner.is_none());
        if let Some(index) = corner.or(edge.map(|edge| edge + 1)) {
            commands.push(Command::from(LinesCommand::TakeCorner(corner)));
            let (is_new, from) = (corner.is_none(), press.at);
            return Some(Box::new(LineCornerDrag { line: number, index, is_new, from, has_moved: false }));
        }
    }
    let under = lines.iter().position(|line| edge_at(line, press.at, pointer).is_some());
    commands.push(Command::from(LinesCommand::Select(under)));
    None
}

fn corner_at(line: &Line, at: Pos2, pointer: &Pointer<'_>) -> Option<usize> {
    let px = pointer.px(at);
    let distances = line.points.iter().map(|&corner| pointer.camera.screen_from_world(corner).distance(px));
    nearest_within(distances, GRIP_POINTS * pointer.px_per_point)
}

/// Returns the number of the edge under the pointer.
fn edge_at(line: &Line, at: Pos2, pointer: &Pointer<'_>) -> Option<usize> {
    let px = pointer.px(at);
    let on_screen = |ends: [glam::DVec2; 2]| ends.map(|end| pointer.camera.screen_from_world(end));
    let distances = line.edges().map(|ends| nearest_on_segment(px, on_screen(ends)).distance(px));
    nearest_within(distances, GRIP_POINTS * pointer.px_per_point)
}

/// Moving a corner of the selected line, which begins with the first move beyond a click.
#[derive(Debug)]
struct LineCornerDrag {
    /// The number of the line, to whose own corners it does not snap.
    line: usize,
    /// The number of the corner.
    index: usize,
    /// Whether the corner is still to be set.
    is_new: bool,
    /// The point where the pointer went down, in points.
    from: Pos2,
    has_moved: bool,
}

impl Gesture for LineCornerDrag {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.has_moved |= at.distance(self.from) > CLICK_SLACK;
        if !self.has_moved {
            return;
        }
        let place = place_of(pointer, at, Some(self.line));
        commands.push(Command::from(match std::mem::take(&mut self.is_new) {
            true => LinesCommand::InsertCorner(self.index, place),
            false => LinesCommand::DragCorner(self.index, place),
        }));
    }

    fn changes_settings(&self) -> bool {
        true
    }
}

//! Gestures of tools that draw areas and lines: strokes of a brush, and polygons and lines corner by corner.

use egui::Pos2;
use glam::DVec2;

use super::{CLICK_SLACK, GRIP_POINTS, Gesture, Pointer, Press, nearest_within};
use crate::kit::command::Command;
use meshbrush_core::domain::CutShape;

/// The commands of a tool that draws areas, or lines.
#[derive(Debug)]
pub struct DrawingCommands {
    /// Adds an area (`true`) or cuts it away. Further areas join the gesture.
    pub draw: fn(CutShape, bool) -> Command,
    /// The area that such a command adds or cuts away.
    pub drawn: fn(&mut Command) -> Option<&mut CutShape>,
    /// Adds a line that was drawn by free hand. `None` where only areas are drawn.
    pub draw_line: Option<fn(Vec<DVec2>) -> Command>,
    /// Sets the next corner of the open polygon.
    pub add_corner: fn(DVec2) -> Command,
    /// Moves one of its corners.
    pub move_corner: fn(usize, DVec2) -> Command,
    /// Joins its last corner to the first.
    pub close: fn() -> Command,
    /// Ends it with its last corner. For an area this closes it, too.
    pub end: fn() -> Command,
    /// Where a corner goes that is set at a position in points: in world units.
    pub place: fn(&Pointer<'_>, Pos2) -> DVec2,
}

/// Where corners go that are set with the pointer: under it.
pub const UNDER_POINTER: fn(&Pointer<'_>, Pos2) -> DVec2 = |pointer, at| pointer.world(at);

impl DrawingCommands {
    /// Ends the polygon with these `corners` so far. Returns whether one was begun.
    pub fn end_if_begun(&self, corners: &[DVec2], sent: &mut Vec<Command>) -> bool {
        let is_begun = !corners.is_empty();
        sent.extend(is_begun.then(self.end));
        is_begun
    }
}

/// Begins a stroke of the brush, which adds or cuts away.
pub fn press_brush(
    commands: &'static DrawingCommands,
    press: &Press,
    pointer: &Pointer<'_>,
    adds: bool,
    sent: &mut Vec<Command>,
) -> Box<dyn Gesture> {
    let stroke = BrushDrawing { last: pointer.world(press.at), adds, commands };
    sent.push(stroke.along(vec![stroke.last], pointer));
    Box::new(stroke)
}

/// Drawing with the brush.
#[derive(Debug)]
struct BrushDrawing {
    /// The last position of the brush, in world units.
    last: DVec2,
    adds: bool,
    commands: &'static DrawingCommands,
}

impl BrushDrawing {
    fn along(&self, path: Vec<DVec2>, pointer: &Pointer<'_>) -> Command {
        (self.commands.draw)(CutShape::Stroke { path, radius: pointer.tools.radius }, self.adds)
    }
}

impl Gesture for BrushDrawing {
    /// Draws from where the brush was; all moves of one frame are one area.
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        let point = pointer.world(at);
        if let Some(CutShape::Stroke { path, .. }) = commands.last_mut().and_then(self.commands.drawn) {
            path.push(point);
        } else if point != self.last {
            commands.push(self.along(vec![self.last, point], pointer));
        }
        self.last = point;
    }

    fn changes_settings(&self) -> bool {
        true
    }
}

/// Takes hold of the corner under the pointer, or sets a new one.
pub fn press_corner(
    commands: &'static DrawingCommands,
    press: &Press,
    pointer: &Pointer<'_>,
    corners: &[DVec2],
    sent: &mut Vec<Command>,
) -> Box<dyn Gesture> {
    let at = pointer.px(press.at);
    let distances = corners.iter().map(|&corner| pointer.camera.screen_from_world(corner).distance(at));
    let nearest = nearest_within(distances, GRIP_POINTS * pointer.px_per_point);
    let index = nearest.unwrap_or(corners.len());
    if nearest.is_none() {
        sent.push((commands.add_corner)((commands.place)(pointer, press.at)));
    }
    let clicked = match nearest {
        Some(index) if index + 1 == corners.len() => Some(commands.end),
        Some(0) => Some(commands.close),
        _ => None,
    };
    Box::new(MovingCorner { index, from: press.at, moved: false, clicked, commands })
}

/// Moving a corner of the open polygon. A click on its first corner closes it. One on the last corner ends
/// it, and so does a double click, whose second click meets the corner that the first one set.
#[derive(Debug)]
struct MovingCorner {
    index: usize,
    /// The point where the pointer went down, in points.
    from: Pos2,
    moved: bool,
    /// What a click on the corner does.
    clicked: Option<fn() -> Command>,
    commands: &'static DrawingCommands,
}

impl Gesture for MovingCorner {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.moved |= at.distance(self.from) > CLICK_SLACK;
        if self.moved {
            let place = (self.commands.place)(pointer, at);
            commands.push((self.commands.move_corner)(self.index, place));
        }
    }

    fn released(&self, _at: Pos2, _pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if let Some(clicked) = self.clicked.filter(|_| !self.moved) {
            commands.push(clicked());
        }
    }
}

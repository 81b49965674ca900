//! Gestures of tools that draw areas: strokes of a brush, and polygons corner by corner.

use egui::Pos2;
use glam::DVec2;

use super::{CLICK_SLACK, GRIP_POINTS, Gesture, Pointer, Press, nearest_within};
use crate::kit::command::Command;
use meshbrush_core::domain::CutShape;

/// The commands of a tool that draws areas.
#[derive(Debug)]
pub struct DrawingCommands {
    /// Adds an area (`true`) or cuts it away. Further areas join the gesture.
    pub draw: fn(CutShape, bool) -> Command,
    /// The area that such a command adds or cuts away.
    pub drawn: fn(&mut Command) -> Option<&mut CutShape>,
    /// Sets the next corner of the open polygon.
    pub add_corner: fn(DVec2) -> Command,
    /// Moves one of its corners.
    pub move_corner: fn(usize, DVec2) -> Command,
    /// Closes it.
    pub close: fn() -> Command,
}

impl DrawingCommands {
    /// Closes the polygon with these `corners` so far. Returns whether one was begun.
    pub fn close_if_begun(&self, corners: &[DVec2], sent: &mut Vec<Command>) -> bool {
        let is_begun = !corners.is_empty();
        sent.extend(is_begun.then(self.close));
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
        sent.push((commands.add_corner)(pointer.world(press.at)));
    }
    let ends = index == 0 || index + 1 == corners.len();
    let closes = nearest.is_some() && ends;
    Box::new(MovingCorner { index, from: press.at, moved: false, closes, commands })
}

/// Moving a corner of the open polygon. A click on its first or last corner closes it, and so does a double
/// click, whose second click meets the corner that the first one set.
#[derive(Debug)]
struct MovingCorner {
    index: usize,
    /// The point where the pointer went down, in points.
    from: Pos2,
    moved: bool,
    closes: bool,
    commands: &'static DrawingCommands,
}

impl Gesture for MovingCorner {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.moved |= at.distance(self.from) > CLICK_SLACK;
        if self.moved {
            commands.push((self.commands.move_corner)(self.index, pointer.world(at)));
        }
    }

    fn released(&self, _at: Pos2, _pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if self.closes && !self.moved {
            commands.push((self.commands.close)());
        }
    }
}

//! Areas and lines that are drawn in one drag: a rectangle, a circle, an outline or a line by free hand.

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2};
use glam::DVec2;

use super::{CLICK_SLACK, DrawingCommands, Gesture, Pointer, Press, marks};
use crate::kit::command::{Command, EditCommand};
use meshbrush_core::domain::{CutShape, Ring, corners};
use meshbrush_mesh::geometry::{Rect as WorldRect, corners_that_stay};

/// What a drag draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DraggedShape {
    /// A rectangle from corner to corner; a square with Shift.
    Rectangle,
    /// A circle from its centre to its rim.
    Circle,
    /// The outline that the pointer follows; its end is joined to its beginning.
    Lasso,
    /// The line that the pointer follows.
    Trail,
}

/// Corners of a circle. The polygon deviates from the circle by a 1,800th of the radius at most.
const CIRCLE_CORNERS: u32 = 96;
/// Least distance between corners of a lasso, in points: a hand is no steadier.
const LASSO_STEP: f32 = 2.0;
/// How far corners that are left out are from a line by free hand, in points at most. Each corner of a line
/// asks for a node of the mesh.
const THINNING: f32 = 2.0;

/// Begins a shape, which adds or cuts away once the button is released.
pub fn press_shape(
    commands: &'static DrawingCommands,
    shape: DraggedShape,
    press: &Press,
    adds: bool,
) -> Box<dyn Gesture> {
    let is_square = press.modifiers.shift;
    Box::new(ShapeDrag { shape, trail: vec![press.at], to: press.at, is_square, adds, commands })
}

/// A shape that is being drawn.
#[derive(Debug)]
struct ShapeDrag {
    shape: DraggedShape,
    /// The corners of a lasso or a line so far, in points; of another shape only the point where the button
    /// went down.
    trail: Vec<Pos2>,
    /// The position of the pointer, in points.
    to: Pos2,
    is_square: bool,
    adds: bool,
    commands: &'static DrawingCommands,
}

impl ShapeDrag {
    /// Returns the corner of the rectangle that lies opposite of the first one, in points.
    fn opposite(&self) -> Pos2 {
        let (from, across) = (self.trail[0], self.to - self.trail[0]);
        if !self.is_square {
            return self.to;
        }
        let side = across.abs().max_elem();
        from + Vec2::new(side.copysign(across.x), side.copysign(across.y))
    }

    /// Returns whether the drag was large enough to be meant: a click draws nothing.
    fn has_size(&self) -> bool {
        let from = self.trail[0];
        match self.shape {
            DraggedShape::Rectangle => (self.opposite() - from).abs().min_elem() > CLICK_SLACK,
            DraggedShape::Circle => from.distance(self.to) > CLICK_SLACK,
            DraggedShape::Lasso => {
                let around = Rect::from_points(&self.trail);
                self.trail.len() >= 3 && around.width().max(around.height()) > CLICK_SLACK
            }
            DraggedShape::Trail => self.trail.iter().any(|at| at.distance(from) > CLICK_SLACK),
        }
    }

    /// Returns the corners of the shape, in world units.
    fn ring(&self, pointer: &Pointer<'_>) -> Ring {
        let from = self.trail[0];
        match self.shape {
            DraggedShape::Rectangle => {
                let ends = [from, self.opposite()].map(|at| pointer.rounded_world(at));
                corners(&WorldRect::spanning(ends[0], ends[1]))
            }
            DraggedShape::Circle => {
                let middle = pointer.rounded_world(from);
                circle(middle, middle.distance(pointer.world(self.to)))
            }
            DraggedShape::Lasso | DraggedShape::Trail => {
                self.trail.iter().map(|&at| pointer.world(at)).collect()
            }
        }
    }

    /// Returns the corners of a line by free hand, in world units.
    fn line(&self, at: Pos2, pointer: &Pointer<'_>) -> Vec<DVec2> {
        let mut trail = self.trail.clone();
        // The last point of the trail, unless it is the first, gives way to where the button was released.
        if trail.len() > 1 && trail[trail.len() - 1].distance(at) < LASSO_STEP {
            trail.pop();
        }
        trail.push(at);
        let corners = thinned(&trail, THINNING);
        let mut line: Vec<DVec2> = corners.iter().map(|&at| pointer.world(at)).collect();
        let last = line.len() - 1;
        for end in [0, last] {
            line[end] = (self.commands.place)(pointer, corners[end]);
        }
        line
    }

    /// Returns the outline on the screen, in points.
    fn outline(&self) -> Vec<Pos2> {
        let from = self.trail[0];
        match self.shape {
            DraggedShape::Rectangle => {
                let frame = Rect::from_two_pos(from, self.opposite());
                vec![frame.left_top(), frame.right_top(), frame.right_bottom(), frame.left_bottom()]
            }
            DraggedShape::Circle => {
                let radius = from.distance(self.to);
                let at = |corner: DVec2| from + radius * Vec2::new(corner.x as f32, corner.y as f32);
                circle(DVec2::ZERO, 1.0).into_iter().map(at).collect()
            }
            DraggedShape::Lasso | DraggedShape::Trail => self.trail.clone(),
        }
    }
}

/// Returns a line without the corners that are at most a distance from it.
fn thinned(line: &[Pos2], most: f32) -> Vec<Pos2> {
    let points: Vec<DVec2> = line.iter().map(|at| DVec2::new(at.x.into(), at.y.into())).collect();
    let stays = corners_that_stay(&points, most.into(), |_| true);
    line.iter().zip(stays).filter(|(_, stays)| *stays).map(|(&at, _)| at).collect()
}

fn circle(middle: DVec2, radius: f64) -> Ring {
    let angle = |corner: u32| std::f64::consts::TAU * f64::from(corner) / f64::from(CIRCLE_CORNERS);
    (0..CIRCLE_CORNERS).map(|corner| middle + radius * DVec2::from_angle(angle(corner))).collect()
}

impl Gesture for ShapeDrag {
    fn moved(&mut self, at: Pos2, _pointer: &Pointer<'_>, _commands: &mut Vec<Command>) {
        self.to = at;
        let is_corner = self.trail.last().is_some_and(|last| last.distance(at) >= LASSO_STEP);
        if matches!(self.shape, DraggedShape::Lasso | DraggedShape::Trail) && is_corner {
            self.trail.push(at);
        }
    }

    fn released(&self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        if !self.has_size() {
            return;
        }
        if self.shape == DraggedShape::Trail {
            commands.extend(self.commands.draw_line.map(|draw| draw(self.line(at, pointer))));
        } else {
            let area = CutShape::Ring(self.ring(pointer));
            commands.extend([(self.commands.draw)(area, self.adds), Command::from(EditCommand::EndGesture)]);
        }
    }

    /// Nothing is drawn where the window lost the pointer.
    fn interrupted(&self, _commands: &mut Vec<Command>) {}

    fn ends_on_escape(&self) -> bool {
        true
    }

    fn paint(&self, painter: &Painter) {
        let outline = self.outline();
        if self.shape == DraggedShape::Circle {
            marks::paint_line_preview(painter, self.trail[0], self.to);
        }
        for stroke in [Stroke::new(3.5, Color32::from_black_alpha(130)), Stroke::new(1.5, Color32::WHITE)] {
            let is_open = matches!(self.shape, DraggedShape::Lasso | DraggedShape::Trail);
            let line = outline.clone();
            painter.add(if is_open { Shape::line(line, stroke) } else { Shape::closed_line(line, stroke) });
        }
        if let (DraggedShape::Lasso, Some(&last)) = (self.shape, outline.last()) {
            marks::paint_line_preview(painter, last, outline[0]);
        }
    }
}

//! Gestures: actions of the pointer between press and release.

use std::fmt::Debug;

use egui::{CursorIcon, Modifiers, Painter, PointerButton, Pos2, Rect};
use glam::{DVec2, dvec2};

use crate::kit::command::{Command, EditCommand};
use crate::kit::heights::SpaceSight;
use crate::kit::session::Session;
use crate::kit::tools::Tools;
use meshbrush_render::scene::Camera;

/// A press of the primary button on the canvas.
pub struct Press {
    /// Where, in points.
    pub at: Pos2,
    /// The modifiers held.
    pub modifiers: Modifiers,
}

/// A gesture on the canvas, from press to release. It changes nothing itself: it emits commands.
pub trait Gesture: Debug + Send {
    /// Returns the button that ends it when released.
    fn button(&self) -> PointerButton {
        PointerButton::Primary
    }

    /// The pointer moved to `at`, in points.
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>);

    /// Returns whether its moves change settings of the document. They are then one undo step, and Escape
    /// takes them back.
    fn changes_settings(&self) -> bool {
        false
    }

    /// The button was released at `at`, in points.
    fn released(&self, _at: Pos2, _pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.interrupted(commands);
    }

    /// The window lost the pointer. What was done so far stays.
    fn interrupted(&self, commands: &mut Vec<Command>) {
        if self.changes_settings() {
            commands.push(Command::from(EditCommand::EndGesture));
        }
    }

    /// Returns whether Escape ends the gesture.
    fn ends_on_escape(&self) -> bool {
        self.changes_settings()
    }

    /// Returns the cursor meanwhile, if not the tool's.
    fn cursor(&self) -> Option<CursorIcon> {
        None
    }

    /// Returns the middle of the brush ring, in points, where that is not the pointer.
    fn ring_center(&self) -> Option<Pos2> {
        None
    }

    /// Draws over the mesh.
    fn paint(&self, _painter: &Painter) {}
}

/// Points that a drag must exceed: what is smaller was a click.
pub const CLICK_SLACK: f32 = 4.0;

/// How far from something on the canvas a press still takes hold of it, in points.
pub const GRIP_POINTS: f64 = 9.0;

/// Dragging something that is part of the settings.
#[derive(Debug)]
pub struct SettingsDrag {
    /// The point where the pointer went down, in points.
    from: Pos2,
    has_moved: bool,
    /// The command that a move to a point of the world sends.
    command: fn(DVec2) -> Command,
}

impl SettingsDrag {
    /// Creates a press at `from`, in points.
    pub fn new(from: Pos2, command: fn(DVec2) -> Command) -> Self {
        Self { from, has_moved: false, command }
    }
}

impl Gesture for SettingsDrag {
    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        self.has_moved |= at.distance(self.from) > CLICK_SLACK;
        if self.has_moved {
            commands.push((self.command)(pointer.world(at)));
        }
    }

    fn changes_settings(&self) -> bool {
        true
    }
}

/// The canvas as gestures see it.
pub struct Pointer<'a> {
    /// The rectangle of the canvas, in points.
    pub rect: Rect,
    /// The camera of the plan. In space its middle and its scale are those of the view.
    pub camera: Camera,
    /// The view in space, where the canvas shows it.
    pub space: Option<SpaceSight<'a>>,
    /// The selected tool and its settings.
    pub tools: &'a Tools,
    /// The document and its mesh.
    pub session: &'a Session,
    /// The modifiers held.
    pub modifiers: Modifiers,
    /// Physical pixels for a point.
    pub px_per_point: f64,
}

impl Pointer<'_> {
    /// Canvas pixels of a position in points.
    pub fn px(&self, at: Pos2) -> DVec2 {
        let offset = at - self.rect.min;
        dvec2(f64::from(offset.x), f64::from(offset.y)) * self.px_per_point
    }

    /// [`GRIP_POINTS`] in world units.
    pub fn grip_reach(&self) -> f64 {
        GRIP_POINTS * self.px_per_point / self.camera.px_per_world()
    }

    /// World coordinates of a position in points.
    pub fn world(&self, at: Pos2) -> DVec2 {
        match &self.space {
            Some(space) => space.world(self.px(at)),
            None => self.camera.world_from_screen(self.px(at)),
        }
    }

    /// Returns the world coordinates of a position in points, with no more digits than a pixel can tell
    /// apart.
    pub fn rounded_world(&self, at: Pos2) -> DVec2 {
        let unit = 10_f64.powf((1.0 / self.camera.px_per_world()).log10().ceil());
        let inverse = (1.0 / unit).round();
        let world = self.world(at);
        if unit < 1.0 { (world * inverse).round() / inverse } else { (world / unit).round() * unit }
    }
}

/// Returns the number of the least distance that is at most `reach`.
pub fn nearest_within(distances: impl Iterator<Item = f64>, reach: f64) -> Option<usize> {
    let near = distances.enumerate().filter(|&(_, distance)| distance <= reach);
    near.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(number, _)| number)
}

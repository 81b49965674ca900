//! The pan tool. Space or the middle button pan with every tool. In space they turn the view, and pan with
//! Shift.

use egui::{CursorIcon, Key, PointerButton, Pos2};
use glam::dvec2;

use crate::kit::command::{Command, SpaceCommand, ViewCommand};
use crate::kit::{Gesture, Pointer, Press, ToolSpec};
use meshbrush_ui::widgets::Hint::{self, KeyOf, Text};
use meshbrush_ui::widgets::Icon;

/// Moves the view.
pub static PAN: ToolSpec = ToolSpec {
    place: 9,
    cursor: CursorIcon::Grab,
    hint: |_| HINT,
    in_space: true,
    press: |press, pointer, commands| Some(move_view(press, PointerButton::Primary, pointer, commands)),
    ..ToolSpec::new("Pan", Key::H, Icon::PAN)
};

const HINT: &[Hint] =
    &[Text("Drag to move, wheel to zoom"), KeyOf("fit-domain"), Text("fits"), KeyOf("brush"), Text("brush")];

/// Degrees that the view turns, and that the viewer rises, for each point that the pointer moves.
const DEGREES_PER_POINT: [f32; 2] = [0.4, 0.3];

/// Begins to move the view with a button: in space to turn it, or with Shift to pan.
pub fn move_view(
    press: &Press,
    button: PointerButton,
    pointer: &Pointer<'_>,
    commands: &mut Vec<Command>,
) -> Box<dyn Gesture> {
    let Some(space) = pointer.space.as_ref().filter(|_| !press.modifiers.shift) else {
        return Box::new(Panning { last: press.at, button });
    };
    // About what is in the middle of the canvas.
    if let Some(height) = space.height_at_px(space.camera.plan().half_size_px()) {
        commands.push(Command::from(ViewCommand::Space(SpaceCommand::About(height))));
    }
    Box::new(Turning { last: press.at, button })
}

/// Turning the view in space: the surface follows the pointer.
#[derive(Debug)]
struct Turning {
    /// The last position of the pointer, in points.
    last: Pos2,
    /// The button held.
    button: PointerButton,
}

impl Gesture for Turning {
    fn button(&self) -> PointerButton {
        self.button
    }

    fn moved(&mut self, at: Pos2, _: &Pointer<'_>, commands: &mut Vec<Command>) {
        let by = at - self.last;
        let [turn, rise] = DEGREES_PER_POINT;
        let by = dvec2(f64::from(turn * by.x), f64::from(rise * by.y));
        commands.push(Command::from(ViewCommand::Space(SpaceCommand::Turn(by))));
        self.last = at;
    }

    fn cursor(&self) -> Option<CursorIcon> {
        Some(CursorIcon::Grabbing)
    }
}

/// Moving the view.
#[derive(Debug)]
pub struct Panning {
    /// The last position of the pointer, in points.
    pub last: Pos2,
    /// The button held.
    pub button: PointerButton,
}

impl Gesture for Panning {
    fn button(&self) -> PointerButton {
        self.button
    }

    fn moved(&mut self, at: Pos2, pointer: &Pointer<'_>, commands: &mut Vec<Command>) {
        commands.push(Command::from(ViewCommand::Pan(pointer.px(at) - pointer.px(self.last))));
        self.last = at;
    }

    fn cursor(&self) -> Option<CursorIcon> {
        Some(CursorIcon::Grabbing)
    }
}

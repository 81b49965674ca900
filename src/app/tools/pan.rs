//! The pan tool. Space or the middle button pan with every tool.

use eframe::egui::{CursorIcon, Key, PointerButton, Pos2};

use crate::app::command::{Command, ViewCommand};
use crate::app::kit::{Gesture, Pointer, ToolSpec};
use crate::app::widgets::Hint::{self, KeyOf, Text};
use crate::app::widgets::Icon;

/// Moves the view.
pub static PAN: ToolSpec = ToolSpec {
    place: 8,
    cursor: CursorIcon::Grab,
    hint: |_| HINT,
    press: |press, _, _| Some(Box::new(Panning { last: press.at, button: PointerButton::Primary })),
    ..ToolSpec::new("Pan", Key::H, Icon::PAN)
};

const HINT: &[Hint] =
    &[Text("Drag to move, wheel to zoom"), KeyOf("fit-domain"), Text("fits"), KeyOf("brush"), Text("brush")];

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
        commands.push(Command::View(ViewCommand::Pan(pointer.px(at) - pointer.px(self.last))));
        self.last = at;
    }

    fn cursor(&self) -> Option<CursorIcon> {
        Some(CursorIcon::Grabbing)
    }
}

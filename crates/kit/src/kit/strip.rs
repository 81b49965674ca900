//! The options of a tool, as the strip above the canvas shows them.

use egui::Ui;

use super::FrameState;
use crate::kit::command::Command;

/// An option of a tool, or a value that belongs to it.
pub struct StripItem {
    /// Its least width on the strip, in points.
    pub width: f32,
    /// Whether it gets wider where the strip has room: it shows a number with many digits and a unit, or a
    /// name.
    pub stretches: bool,
    /// Its importance: where the strip is too narrow for all, those with the highest numbers are in the popup
    /// at the end of the strip. Items without a place on the strip are always there.
    pub rank: Option<u8>,
    /// Whether there is anything to show now.
    pub is_shown: fn(&FrameState<'_>) -> bool,
    /// Draws it: one row, as wide as the `Ui`.
    pub show: fn(&mut Ui, &FrameState<'_>, &mut Vec<Command>),
}

/// Draws an option, one row, as wide as the `Ui`.
type Show = fn(&mut Ui, &FrameState<'_>, &mut Vec<Command>);

impl StripItem {
    /// Creates an option that is always shown.
    pub const fn new(width: f32, rank: u8, show: Show) -> Self {
        Self { width, stretches: false, rank: Some(rank), is_shown: |_| true, show }
    }

    /// Creates an option that is rarely needed: it is in the popup.
    pub const fn rare(show: Show) -> Self {
        Self { width: 0.0, stretches: false, rank: None, is_shown: |_| true, show }
    }

    /// Shows the option only where `is_shown` says so.
    pub const fn only(self, is_shown: fn(&FrameState<'_>) -> bool) -> Self {
        Self { is_shown, ..self }
    }

    /// Lets the option get wider where the strip has room.
    pub const fn stretching(self) -> Self {
        Self { stretches: true, ..self }
    }
}

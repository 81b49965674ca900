//! Pins: points of the document whose triangles and values are followed.

mod command;
mod entries;
mod execute;
mod files;
mod load;
mod marks;
mod panel;
mod table;
#[cfg(test)]
mod tests;

pub use command::PinsCommand;
use entries::{entries, entries_at};
use glam::DVec2;
pub use panel::PINS;
use table::PinReader;

/// The window's state of pins; their positions are in the document.
#[derive(Default)]
pub struct Pins {
    /// Their values.
    reader: PinReader,
    /// The number of the selected pin, from 0.
    selected: Option<usize>,
    /// The offset of the pin that is dragged from the pointer, in world units.
    grip: Option<DVec2>,
}

impl Pins {
    /// Returns the number of the selected pin. An undo can have removed it.
    pub fn selected_of(&self, pins: &[DVec2]) -> Option<usize> {
        self.selected.filter(|number| *number < pins.len())
    }
}

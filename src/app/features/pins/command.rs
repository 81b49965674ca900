//! Commands about pins.

use std::path::PathBuf;

use meshbrush_kit::kit::command::CommandSet;

use glam::DVec2;

/// One thing to do with pins. Points and lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum PinsCommand {
    /// Takes hold of the pin at a point, at most `reach` away, or queries the point.
    Press {
        /// Where.
        at: DVec2,
        /// How far from a pin still counts.
        reach: f64,
    },
    /// Moves the pin that was taken hold of. Further moves join this gesture until [`Command::EndGesture`].
    DragTo(DVec2),
    /// Pins the queried point.
    Pin,
    /// Pins a point.
    Add(DVec2),
    /// Selects a pin by its number from 0, queries it, and puts it in sight.
    Select(usize),
    /// Removes the selected pin.
    Delete,
    /// Removes all pins.
    DeleteAll,
    /// Reads a table of points, and adds a pin at each.
    Open(PathBuf),
    /// Pins points that were read.
    AddAll(Vec<DVec2>),
    /// Reads the values of pins for some milliseconds.
    Read,
    /// Makes the table of the pins, and copies it.
    Copy,
    /// Copies the table, which was made for so many pins.
    Copied(String, usize),
    /// Writes the table, and asks before another file is replaced.
    ExportAs(PathBuf),
    /// Writes the table.
    Export(PathBuf),
}

impl CommandSet for PinsCommand {}

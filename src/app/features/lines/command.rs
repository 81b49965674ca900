//! Commands about lines.

use std::path::PathBuf;

use meshbrush_core::domain::Line;
use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with lines.
#[derive(Clone, Debug, PartialEq)]
pub enum LinesCommand {
    /// Reads the lines and polygons of a file, and adds them.
    Open(PathBuf),
    /// Adds lines that were read, with notes for a person.
    Add(Vec<Line>, Vec<String>),
    /// Removes a line by its number from 0.
    Remove(usize),
    /// Removes all lines.
    RemoveAll,
}

impl CommandSet for LinesCommand {}

//! Commands about lines.

use std::path::PathBuf;

use glam::DVec2;

use meshbrush_core::domain::Line;
use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with lines. Numbers are from 0, and points are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum LinesCommand {
    /// Reads the lines and polygons of a file, and adds them.
    Open(PathBuf),
    /// Adds lines that were read, with notes for a person.
    Add(Vec<Line>, Vec<String>),
    /// Removes a line by its number.
    Remove(usize),
    /// Removes all lines.
    RemoveAll,
    /// Selects the tool and what a press does with it.
    Mode(LineToolMode),
    /// Sets whether corners snap to what is near.
    Snaps(bool),
    /// Sets the next corner of the line that is being drawn.
    AddCorner(DVec2),
    /// Moves one of its corners.
    MoveCorner(usize, DVec2),
    /// Removes its last corner.
    RemoveCorner,
    /// Ends it, and adds it to the document.
    End(LineEnd),
    /// Adds a line that was drawn in one drag.
    Draw(Vec<DVec2>, LineEnd),
    /// Sets the first end of the deepest way, or the other one and begins to look for it.
    WayAt(DVec2),
    /// Adds a deepest way that was found.
    AddWay(Vec<DVec2>),
    /// Selects a line of the document, or none.
    Select(Option<usize>),
    /// Names a line.
    Rename(usize, String),
    /// Shows a place where the selected line is not on edges, by its number along the line.
    ShowPlace(usize),
    /// Takes hold of a corner of the selected line, or of none.
    TakeCorner(Option<usize>),
    /// Moves a corner of the selected line. Further moves join this gesture.
    DragCorner(usize, DVec2),
    /// Sets another corner of the selected line, with this number. Moves join this gesture.
    InsertCorner(usize, DVec2),
    /// Deletes the corner that was taken hold of last, or else the selected line.
    Delete,
}

impl CommandSet for LinesCommand {}

/// How a line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineEnd {
    /// With its last corner.
    Open,
    /// Where it began: the last corner is joined to the first.
    Closed,
}

/// What a press does with the line tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineToolMode {
    /// It sets the next corner of a line.
    #[default]
    Corners,
    /// It begins a line by free hand.
    FreeHand,
    /// It begins a rectangle, from corner to corner.
    Rectangle,
    /// It begins a circle, from its centre.
    Circle,
    /// It sets an end of the deepest way.
    DeepestWay,
    /// It selects a line, and moves the corners of the selected one.
    Edit,
}

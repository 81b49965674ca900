//! Commands about the threats of the selected layer.

use std::path::PathBuf;

use meshbrush_kit::kit::command::CommandSet;

use glam::DVec2;

/// One thing to do with the threats of the selected layer. Points and lengths are in world units.
#[derive(Clone, Debug, PartialEq)]
pub enum ThreatsCommand {
    /// Takes hold of the threat at a point, or places one there.
    Press {
        /// Where.
        at: DVec2,
        /// How far from the middle or the ring of a threat still counts.
        reach: f64,
        /// Whether to place one even where there is a threat.
        places: bool,
    },
    /// Moves what was taken hold of. Further moves join this gesture until [`Command::EndGesture`].
    DragTo(DVec2),
    /// Places a threat, as a gesture of its own.
    Place(DVec2),
    /// Selects a threat by its number from 0, and puts it in sight.
    Select(usize),
    /// Removes the selected threat.
    Delete,
    /// Reads a table of threats in place of those of the selected layer, or as a new layer if that is of
    /// another kind.
    Open(PathBuf),
    /// Writes the threats of the selected layer as a table, and asks before another file is replaced.
    SaveAs(PathBuf),
    /// Writes the threats of the selected layer as a table.
    Save(PathBuf),
}

impl CommandSet for ThreatsCommand {}

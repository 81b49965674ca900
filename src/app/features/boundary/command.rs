//! Commands about the boundary.

use glam::DVec2;

use super::{BoundaryToolMode, OpenedBoundary};
use meshbrush_io::io::settings::SavedOpen;
use meshbrush_kit::kit::command::CommandSet;

/// The commands of the boundary tool.
#[derive(Clone, Debug, PartialEq)]
pub enum BoundaryCommand {
    /// Selects or splits the piece at a point in world units, at most so far away.
    Click(DVec2, f64),
    /// Selects the piece at a point of the boundary.
    Select(DVec2),
    /// Selects the tool and what a click does.
    Mode(BoundaryToolMode),
    /// Joins the selected piece with the next one.
    Join,
    /// Opens all of the boundary that lies somewhere.
    Open(SavedOpen),
    /// Takes over a boundary that was opened.
    SetOpened(Box<OpenedBoundary>),
    /// Sets the depth beyond which the boundary is opened, in metres.
    Level(f64),
}

impl CommandSet for BoundaryCommand {}

//! Commands about the boundary.

use glam::DVec2;

use super::BoundaryToolMode;

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
}

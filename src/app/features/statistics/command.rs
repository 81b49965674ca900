//! Commands about the figures of the mesh.

use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with the figures of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StatisticsCommand {
    /// Computes the figures of the mesh.
    Measure,
    /// Shows time steps for this Courant number.
    SetCourant(f64),
}

impl CommandSet for StatisticsCommand {}

//! Commands about the figures of the mesh.

use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with the figures of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatisticsCommand {
    /// Computes the figures of the mesh.
    Measure,
}

impl CommandSet for StatisticsCommand {}

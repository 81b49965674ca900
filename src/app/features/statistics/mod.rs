//! The figures of the mesh, and its triangles by level.

mod command;
mod figures;
mod levels;
mod panel;
#[cfg(test)]
mod tests;

pub use command::StatisticsCommand;
use figures::Measured;

use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::Slot;

/// Measures meshes, and keeps the figures of the last one.
#[derive(Default)]
pub struct Statistics(Slot<MeasuredMesh, Measured>);

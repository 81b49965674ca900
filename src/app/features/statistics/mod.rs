//! The figures of the mesh, and its triangles by level.

mod command;
mod figures;
mod levels;
mod panel;
#[cfg(test)]
mod tests;

pub use command::StatisticsCommand;
use figures::Measured;

use crate::app::derivation::MeasuredMesh;
use crate::app::jobs::Slot;

/// Measures meshes, and keeps the figures of the last one.
#[derive(Default)]
pub struct Statistics(Slot<MeasuredMesh, Measured>);

//! The figures of the mesh, how good its triangles are, and its triangles by level.

mod command;
mod figures;
mod levels;
mod measuring;
mod panel;
mod preflight;
mod quality;
mod repair;
#[cfg(test)]
mod tests;

pub use command::StatisticsCommand;
pub use measuring::NoTimeStep;
use measuring::{Measured, Measuring};
use preflight::Preflight;
use repair::Repair;

use meshbrush_kit::kit::derivation::MeasuredMesh;
use meshbrush_kit::kit::jobs::Slot;

/// Measures meshes, and keeps the figures of the last one.
pub struct Statistics {
    figures: Slot<MeasuredMesh, Measured>,
    /// The Courant number that time steps are shown for.
    courant: f64,
    /// The rules of a solver.
    preflight: Preflight,
    /// Layers that ask for smaller triangles where a rule is broken.
    repair: Repair,
}

//! Why there is no mesh by the error.

use meshbrush_core::build::BuildError;
use meshbrush_fem::fem::FemError;
use meshbrush_mesh::text::Grouped;

/// Why there is no solution, or no mesh with the error that is asked for.
#[derive(Debug, thiserror::Error)]
pub enum MeshByErrorFailure {
    /// The problem has no solution.
    #[error(transparent)]
    Problem(#[from] FemError),
    /// A triangle cannot be bisected.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A limit is reached before the bound is.
    #[error("A bound of {asked} is not reached: it is {bound} with {} triangles. {error}", Grouped(*triangles))]
    Limit {
        /// The bound that is asked for.
        asked: f64,
        /// The bound that is reached.
        bound: f64,
        /// How many triangles there are.
        triangles: usize,
        /// What stands against more.
        error: BuildError,
    },
    /// Nobody wants the result any more.
    #[error("Cancelled.")]
    Cancelled,
}

//! A surface that the mesh is to be close to, with values linear over its triangles.

use super::RasterSource;
use crate::field::Formula;
use crate::text::{Grouped, Number};

/// A surface, and how close the mesh is to be to it. Clones share the pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Where its values come from.
    pub source: SurfaceSource,
    /// How close the mesh is to be.
    pub goal: SurfaceGoal,
}

/// Where the values of a surface come from.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceSource {
    /// A raster: its samples are at the centres of pixels, and it is linear between them.
    Raster(RasterSource),
    /// A formula in x and y. Its samples are on a grid over the coarse cells.
    Formula(Formula),
}

/// How close a mesh is to be to a surface. The error of a triangle is the largest difference, of either sign,
/// between a sample in the closed triangle and the plane through the surface at its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceGoal {
    /// The error of each triangle is at most this, in the unit of the values; the mesh is the smallest such
    /// one.
    Within(f64),
    /// The mesh has at most so many triangles, and the least error that is possible with them.
    AtMost(usize),
}

/// Why a goal cannot be met by any mesh.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceGoalError {
    /// No error is as small.
    #[error("An error of at most {} cannot be met: it must be positive and finite.", Number(*.0))]
    Error(f64),
    /// A mesh has a triangle at least.
    #[error("A mesh of at most {} triangles cannot be made: it has one at least.", Grouped(*.0))]
    Triangles(usize),
}

impl SurfaceGoal {
    /// Checks the number.
    ///
    /// # Errors
    /// Fails when the error is not positive and finite, or the number of triangles is 0.
    pub fn check(self) -> Result<(), SurfaceGoalError> {
        match self {
            Self::Within(error) if !(error > 0.0 && error.is_finite()) => Err(SurfaceGoalError::Error(error)),
            Self::AtMost(0) => Err(SurfaceGoalError::Triangles(0)),
            Self::Within(_) | Self::AtMost(_) => Ok(()),
        }
    }
}

impl SurfaceSource {
    /// Returns the raster, if the values come from one.
    pub fn raster(&self) -> Option<&RasterSource> {
        match self {
            Self::Raster(source) => Some(source),
            Self::Formula(_) => None,
        }
    }
}

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
    /// Which error the goal is about.
    pub norm: SurfaceNorm,
}

/// Where the values of a surface come from.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceSource {
    /// A raster: its samples are at the centres of pixels, and it is linear between them.
    Raster(RasterSource),
    /// A formula in x and y. Its samples are on a grid over the coarse cells.
    Formula(Formula),
}

/// How close a mesh is to be to a surface, by a [`SurfaceNorm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceGoal {
    /// The error is at most this.
    Within(f64),
    /// The mesh has at most so many triangles, and the least error that is found with them.
    AtMost(usize),
}

/// How the differences of a mesh from a surface become one number. A difference is one between a sample and
/// the plane through the surface at the corners of the triangle that the sample is in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SurfaceNorm {
    /// The largest difference, of either sign, in the unit of the values. The mesh within an error is the
    /// smallest one, and that of a number of triangles has the least error: both are exact.
    #[default]
    Largest,
    /// The root of the mean of the squares of the differences, in the unit of the values: the norm of L² over
    /// the root of the area. The mesh is near the smallest one: the number of its triangles falls with the
    /// error at the best rate that is possible.
    RootMeanSquare,
    /// The root of the mean of the squares of the differences of the gradients, in the unit of the values by
    /// world unit: the seminorm of H¹ over the root of the area. The mesh is near the smallest one, too.
    Gradient,
}

impl SurfaceNorm {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Largest, Self::RootMeanSquare, Self::Gradient];

    /// Returns the power of the number of triangles by which the error falls where the surface is smooth, or
    /// where the triangles follow what is not.
    pub fn best_rate(self) -> f64 {
        match self {
            Self::Largest | Self::RootMeanSquare => -1.0,
            Self::Gradient => -0.5,
        }
    }
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

//! Why refinement and updates stop.

use std::error::Error;
use std::fmt;

use glam::DVec2;

use super::{MemoryLimit, bisection_edge_length};
use crate::geometry::{Lattice, LatticePoint};
use crate::text::{Bytes, Grouped, Number};

/// A rule met a target diameter that no mesh can satisfy, or that is no number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvalidTarget {
    /// Where, in world coordinates.
    pub at: DVec2,
    /// The value met there.
    pub value: f64,
}

impl fmt::Display for InvalidTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "The target diameter is {} at x = {}, y = {}: it must be a positive number everywhere in the domain.",
            Number(self.value),
            Number(self.at.x),
            Number(self.at.y)
        )
    }
}

impl Error for InvalidTarget {}

/// Why refinement stopped before every triangle was satisfied. The mesh conforms nevertheless.
#[derive(Clone, Debug, PartialEq)]
pub enum RefineError {
    /// The rule met a bad target.
    InvalidTarget(InvalidTarget),
    /// The next call would pass the triangle budget.
    TooManyTriangles {
        /// [`Limits::max_triangles`](crate::mesh::Limits::max_triangles).
        limit: usize,
    },
    /// The next call would pass the memory budget.
    TooMuchMemory {
        /// The triangles that there is room for.
        limit: usize,
        /// [`Limits::max_memory`](crate::mesh::Limits::max_memory).
        memory: MemoryLimit,
    },
    /// The system has no more memory.
    OutOfMemory {
        /// The size of the array.
        bytes: usize,
    },
    /// The target is smaller than the lattice can resolve.
    TooFine {
        /// A vertex of the triangle that could not be bisected, in world coordinates.
        at: DVec2,
        /// The smallest diameter that the lattice allows, in world units.
        smallest: f64,
        /// Its level.
        level: u32,
    },
}

impl fmt::Display for RefineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InvalidTarget(error) => error.fmt(f),
            Self::TooManyTriangles { limit } => {
                write!(f, "The mesh needs more than {} triangles, which is the limit.", Grouped(*limit))
            }
            Self::TooMuchMemory { limit, memory } => write!(
                f,
                "The mesh needs more than {} triangles, and {} of memory, which is the limit, has room for no more.",
                Grouped(*limit),
                Bytes(memory.bytes)
            ),
            Self::OutOfMemory { bytes } => write!(
                f,
                "Memory ran out: the mesh needs an array of {}, which the system does not have. Close other programs, \
                 or make the mesh coarser.",
                Bytes(*bytes)
            ),
            Self::TooFine { at, smallest, level } => write!(
                f,
                "The target diameter near x = {}, y = {} is too small: below {smallest:.3e} (level {level}) nodes would \
                 leave the lattice.",
                Number(at.x),
                Number(at.y)
            ),
        }
    }
}

impl Error for RefineError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::InvalidTarget(error) => error.source(),
            _ => None,
        }
    }
}

impl From<InvalidTarget> for RefineError {
    fn from(error: InvalidTarget) -> Self {
        Self::InvalidTarget(error)
    }
}

impl RefineError {
    /// A triangle with a vertex at `at` is at the deepest level of the lattice and exceeds its target.
    pub(in crate::mesh) fn too_fine(lattice: &Lattice, at: LatticePoint) -> Self {
        let level = lattice.deepest_level();
        let smallest = bisection_edge_length(lattice.spacing(), level);
        Self::TooFine { at: lattice.world_from_lattice(at), smallest, level }
    }

    /// Whether the mesh would be too large for its limits or for the memory of the system.
    pub fn is_over_budget(&self) -> bool {
        matches!(self, Self::TooManyTriangles { .. } | Self::TooMuchMemory { .. } | Self::OutOfMemory { .. })
    }
}

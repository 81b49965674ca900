//! Why refinement and updates stop.

use glam::DVec2;

use super::{MemoryLimit, bisection_edge_length};
use crate::geometry::{Lattice, LatticePoint};
use crate::text::{Bytes, Grouped, Number};

/// A rule met a target diameter that no mesh can satisfy, or that is no number.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "The target diameter is {} at x = {}, y = {}: it must be a positive number everywhere in the domain.",
    Number(*value), Number(at.x), Number(at.y)
)]
pub struct InvalidTarget {
    /// Where, in world coordinates.
    pub at: DVec2,
    /// The value met there.
    pub value: f64,
}

/// Why refinement stopped before every triangle was satisfied. The mesh conforms nevertheless.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RefineError {
    /// The rule met a bad target.
    #[error(transparent)]
    InvalidTarget(#[from] InvalidTarget),
    /// The next call would pass the triangle budget.
    #[error(
        "The mesh needs more than {} triangles, which is the limit.",
        Grouped(*limit)
    )]
    TooManyTriangles {
        /// [`Limits::max_triangles`](crate::mesh::Limits::max_triangles).
        limit: usize,
    },
    /// The next call would pass the memory budget.
    #[error(
        "The mesh needs more than {} triangles, and {} of memory, which is the limit, has room for no more.",
        Grouped(*limit), Bytes(memory.bytes)
    )]
    TooMuchMemory {
        /// The triangles that there is room for.
        limit: usize,
        /// [`Limits::max_memory`](crate::mesh::Limits::max_memory).
        memory: MemoryLimit,
    },
    /// The system has no more memory.
    #[error(
        "Memory ran out: the mesh needs an array of {}, which the system does not have. Close other programs, or make the \
         mesh coarser.",
        Bytes(*bytes)
    )]
    OutOfMemory {
        /// The size of the array.
        bytes: usize,
    },
    /// The target is smaller than the lattice can resolve.
    #[error(
        "The target diameter near x = {}, y = {} is too small: below {smallest:.3e} (level {level}) nodes would leave the \
         lattice.",
        Number(at.x), Number(at.y)
    )]
    TooFine {
        /// A vertex of the triangle that could not be bisected, in world coordinates.
        at: DVec2,
        /// The smallest diameter that the lattice allows, in world units.
        smallest: f64,
        /// Its level.
        level: u32,
    },
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

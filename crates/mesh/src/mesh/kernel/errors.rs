//! Why refinement and updates stop.

use std::convert::Infallible;
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
///
/// `E` is the error of the rule: any type ([`Answer`](crate::mesh::Answer)), or [`Infallible`] where the rule
/// always knows an answer. The rules of this library have [`InvalidTarget`].
#[derive(Clone, Debug, PartialEq)]
pub enum RefineError<E = InvalidTarget> {
    /// The rule could not answer.
    Rule(E),
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
        /// The level of the triangle.
        level: u32,
    },
}

/// A [`RefineError`] that is none of the rule.
pub(in crate::mesh) type LimitError = RefineError<Infallible>;

impl<E: fmt::Display> fmt::Display for RefineError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rule(error) => error.fmt(f),
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

impl<E: Error> Error for RefineError<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Rule(error) => error.source(),
            _ => None,
        }
    }
}

impl<E> From<E> for RefineError<E> {
    fn from(error: E) -> Self {
        Self::Rule(error)
    }
}

impl LimitError {
    /// Returns the same for a rule with any error.
    #[cold]
    pub(in crate::mesh) fn with_rule<E>(self) -> RefineError<E> {
        self.map_rule(|never| match never {})
    }
}

impl<E> RefineError<E> {
    /// Returns the same with another error of the rule.
    pub fn map_rule<F>(self, map: impl FnOnce(E) -> F) -> RefineError<F> {
        match self {
            Self::Rule(error) => RefineError::Rule(map(error)),
            Self::TooManyTriangles { limit } => RefineError::TooManyTriangles { limit },
            Self::TooMuchMemory { limit, memory } => RefineError::TooMuchMemory { limit, memory },
            Self::OutOfMemory { bytes } => RefineError::OutOfMemory { bytes },
            Self::TooFine { at, smallest, level } => RefineError::TooFine { at, smallest, level },
        }
    }

    /// Returns the error for a triangle with a vertex at `at` that exceeds its target at the deepest level of
    /// the lattice.
    pub fn too_fine(lattice: &Lattice, at: LatticePoint) -> Self {
        let level = lattice.deepest_level();
        let smallest = bisection_edge_length(lattice.spacing(), level);
        Self::TooFine { at: lattice.world_from_lattice(at), smallest, level }
    }

    /// Returns whether the mesh would be too large for its limits or for the memory of the system.
    pub fn is_over_budget(&self) -> bool {
        matches!(self, Self::TooManyTriangles { .. } | Self::TooMuchMemory { .. } | Self::OutOfMemory { .. })
    }
}

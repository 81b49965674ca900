//! Islands of triangles that are changed for themselves, kept in step with a mesh that changes where it is.
//!
//! Along lines and along the outline, triangles around *seeds* are changed ([`IslandRule`]): those that a
//! line touches, and defects. The seeds and some rings around them fall into *islands* without a node in
//! common. What becomes of an island depends on its triangles, on which of its nodes have all their triangles
//! in it, and on the targets that it asks for. All of that is decided by places on the lattice.
//!
//! ```text
//!   ···□···□···■───■───■···□···□···□···■───■···□···    ■ island   □ as before
//!              kept  ▲                 kept
//!                    fresh triangles: the islands with one of their nodes are collected and changed again
//! ```
//!
//! So an island stays ([`KeptIslands`]) while none of its triangles is gone, no fresh triangle has one of its
//! nodes, and no target changes where it asked for one. All others are dissolved. New ones are collected
//! around the fresh triangles and those of dissolved islands, by walks from triangle to triangle
//! ([`LoadedMesh`]). Where these come to a node of an island that was to stay, it is dissolved, too.
//!
//! Triangles are those of a [`PieceSource`]: the mesh, the nodes on its outline, or other islands. They are
//! known by the places of their corners, as the entries of a mesh move.

mod collect;
mod kept;
mod loaded;
mod source;
mod written;

use super::angles::Angles;
use super::local::LocalMesh;
use super::quality::BoundaryCensus;
use crate::geometry::{LatticePoint, LatticeRect};
use crate::mesh::NodeId;
pub(super) use collect::ChangeBelow;
pub(super) use kept::KeptIslands;
pub(super) use source::{LayeredPieces, PieceSource, PlainPieces};
pub(super) use written::in_groups;

/// What is done with islands.
pub(super) trait IslandRule: Sync {
    /// Rings of triangles around a seed.
    const RINGS: usize;
    /// Whether seeds and islands depend on all triangles at their nodes, also on those beside the island.
    const COUNTS: bool;

    fn angles(&self) -> &Angles;

    /// Returns whether a triangle, by its nodes and their places, is changed with those around it. If
    /// [`Self::COUNTS`], `census` must have all triangles at its nodes.
    fn is_seed(&self, nodes: [NodeId; 3], corners: [LatticePoint; 3], census: &BoundaryCensus) -> bool;

    /// Returns whether a triangle far from the boundary can be one for which [`Self::is_seed`] is true.
    fn may_be_seed(&self, corners: [LatticePoint; 3]) -> bool;

    /// Returns whether a place is on the outline of the domain.
    fn is_on_outline(&self, p: LatticePoint) -> bool;

    /// Changes an island. If [`Self::COUNTS`], `census` must have all triangles at its nodes.
    fn changed(&self, start: LocalMesh, census: &BoundaryCensus) -> ChangedIsland;
}

/// An island as it was and as it is, and the area in which targets were asked for.
pub(super) struct ChangedIsland {
    pub(super) start: LocalMesh,
    pub(super) now: LocalMesh,
    pub(super) asked: Option<LatticeRect>,
}

/// The islands of a mesh that is derived from scratch.
#[derive(Default)]
pub(super) struct DerivedIslands {
    /// For a better boundary.
    pub(super) better: Option<Vec<ChangedIsland>>,
    /// Along lines.
    pub(super) lines: Option<Vec<ChangedIsland>>,
}

/// Returns the corners of a triangle, anticlockwise, from the lowest one on.
fn from_lowest(corners: [LatticePoint; 3]) -> ([LatticePoint; 3], usize) {
    let lowest = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
    ([0, 1, 2].map(|i| corners[(lowest + i) % 3]), lowest)
}

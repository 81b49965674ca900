//! Making and changing a mesh: coarse grid, bisection, refinement, update in place, coarsening.

mod answer;
mod bisect;
mod bitset;
mod blocks;
mod changes;
mod classify;
mod coarse;
mod coarsen;
mod copy;
mod element;
mod errors;
mod ids;
mod limits;
mod memory;
mod questions;
mod refine;
mod search;
mod tree;
mod triangle;
mod update;
mod walk;

use std::f64::consts::SQRT_2;

use glam::DVec2;

use crate::geometry::{LATTICE_BITS, Lattice, LatticePoint};

pub use answer::Answer;
pub use blocks::{BlockRefiner, LevelsWithin, RuleAnswers, SharedRule};
pub use changes::Changes;
pub use coarse::CoarseError;
pub use copy::MeshCopy;
pub use element::{Element, Progress};
pub(in crate::mesh) use errors::LimitError;
pub use errors::{InvalidTarget, RefineError};
pub use ids::{Neighbour, NodeId, TriangleId};
pub use limits::{Limits, MOST_TRIANGLES, MemoryLimit};
pub use memory::ProgramAllocator;
pub use refine::Refiner;
pub use tree::TreeTriangle;
pub use triangle::{Orientation, Triangle};
pub use update::{ChangedArea, Falloff, TargetChange, Updater};

use coarse::CoarseIndex;

pub(in crate::mesh) use bitset::Bitset;
pub(in crate::mesh) use element::Diameters;
pub(in crate::mesh) use memory::{append_pieces, make_room};
pub(in crate::mesh) use questions::{Questions, any_exceeds, ask_all};
pub(in crate::mesh) use search::{RectSearch, WalkStarts};
pub(in crate::mesh) use triangle::LevelAndSide;
pub(in crate::mesh) use walk::WalkEnd;

/// The deepest level of any lattice.
pub(in crate::mesh) const DEEPEST_LEVEL: usize = 2 * LATTICE_BITS as usize;

/// A conforming triangulation of a domain, refined from a coarse grid (T of the report).
///
/// Invariants, each with a [`Violation`](crate::mesh::Violation) that names it; [`Mesh::violations`] lists
/// all that are broken:
///
/// 1. *Right size*: a triangle is right-angled and isosceles on the lattice, with the bisection edge of its
///    level (Eq. 1).
/// 2. *Orientation*: vertices run the way that the triangle says.
/// 3. *Neighbours*: edge j is shared with neighbour j and with no other triangle; the other triangle says the
///    same.
/// 4. *Compatible* (conforming): an edge without a neighbour belongs to one triangle only and has no hanging
///    node in its middle.
/// 5. *Graded*: neighbours differ by at most one level.
/// 6. *Area*: the triangles cover exactly the coarse triangles that were kept.
/// 7. *Nodes*: every node is a vertex of some triangle, and no two nodes coincide.
/// 8. *Buckets*: the entry with a coarse triangle's index lies in that coarse triangle.
/// 9. *Ledgers*: the triangle noted for a node has that node, and the triangles of each level and side of the
///    boundary are counted right.
///
/// The tenth, that no triangle exceeds its target (Eq. 14), needs the rule: [`Mesh::unsatisfied`].
#[derive(Debug)]
pub struct Mesh {
    pub(in crate::mesh) lattice: Lattice,
    pub(in crate::mesh) nodes: Vec<LatticePoint>,
    pub(in crate::mesh) triangles: Vec<Triangle>,
    /// For each node one of the triangles around it.
    pub(in crate::mesh) triangle_at: Vec<TriangleId>,
    pub(in crate::mesh) counts: LevelAndSideCounts,
    pub(in crate::mesh) coarse: CoarseIndex,
}

impl Mesh {
    /// Returns the grid and lattice that the mesh was refined from.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns the triangles of the domain (𝒯), in the order of their ids.
    ///
    /// Triangles outside a fitted domain are left out; [`Self::raw_triangles`] has them.
    pub fn triangles(&self) -> impl Iterator<Item = (TriangleId, &Triangle)> + Clone {
        let all = self.triangles.iter().enumerate();
        all.filter(|(_, triangle)| !triangle.is_outside())
            .map(|(index, triangle)| (TriangleId::from_index(index), triangle))
    }

    /// Returns the nodes of the domain (𝒩) in lattice coordinates, in the order of their ids.
    ///
    /// Nodes that only triangles outside a fitted domain have are left out; [`Self::raw_nodes`] has them.
    /// Where there are triangles outside, this goes through all triangles first.
    pub fn nodes(&self) -> impl Iterator<Item = (NodeId, LatticePoint)> {
        let used = (self.outside_count() > 0).then(|| self.used_nodes());
        let all = self.nodes.iter().enumerate();
        all.filter(move |(index, _)| used.as_ref().is_none_or(|used| used[*index]))
            .map(|(index, &node)| (NodeId::from_index(index), node))
    }

    /// Returns for each entry of [`Self::raw_nodes`] whether a triangle of the domain has it.
    pub(in crate::mesh) fn used_nodes(&self) -> Vec<bool> {
        let mut used = vec![false; self.nodes.len()];
        for vertex in self.triangles().flat_map(|(_, triangle)| triangle.vertices) {
            used[vertex.index()] = true;
        }
        used
    }

    /// Returns the array of nodes in lattice coordinates, those of the coarse grid first. It includes nodes
    /// that only triangles outside a fitted domain have.
    pub fn raw_nodes(&self) -> &[LatticePoint] {
        &self.nodes
    }

    /// Returns the array of triangles, those outside a fitted domain included ([`Triangle::is_outside`]).
    pub fn raw_triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Returns how many entries [`Self::raw_triangles`] has: what memory and limits count.
    pub fn raw_triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the triangle with the given id.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    #[inline]
    pub fn triangle(&self, id: TriangleId) -> &Triangle {
        &self.triangles[id.index()]
    }

    /// Returns the lattice coordinates of a node.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    #[inline]
    pub fn node(&self, id: NodeId) -> LatticePoint {
        self.nodes[id.index()]
    }

    /// Returns one of the triangles around a node, which may lie outside the domain.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    #[inline]
    pub(in crate::mesh) fn raw_triangle_at(&self, id: NodeId) -> TriangleId {
        self.triangle_at[id.index()]
    }

    /// Returns the world coordinates of a node.
    #[inline]
    pub fn world(&self, id: NodeId) -> DVec2 {
        self.lattice.world_from_lattice(self.node(id))
    }

    /// Returns the vertices of a triangle in lattice coordinates, in the triangle's order.
    #[inline]
    pub fn corners(&self, id: TriangleId) -> [LatticePoint; 3] {
        self.triangle(id).vertices.map(|v| self.node(v))
    }

    /// Returns the vertices of a triangle in world coordinates, in the triangle's order.
    pub fn world_corners(&self, id: TriangleId) -> [DVec2; 3] {
        self.triangle(id).vertices.map(|v| self.world(v))
    }

    /// Returns how many triangles of the domain there are at each level, from level 0 to the deepest.
    pub fn level_counts(&self) -> Vec<usize> {
        let inside = &self.counts.0[..DEEPEST_LEVEL + 1];
        let deepest = inside.iter().rposition(|&n| n > 0);
        inside[..deepest.map_or(0, |level| level + 1)].iter().map(|&n| n as usize).collect()
    }

    /// Returns the length of the bisection edge of a triangle at `level`, in world units (Eq. 1).
    #[inline]
    pub fn diameter(&self, level: u32) -> f64 {
        bisection_edge_length(self.lattice.spacing(), level)
    }
}

/// Triangles by level and side of the boundary, kept up to date with every bisection and every merger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::mesh) struct LevelAndSideCounts(pub(in crate::mesh) [u32; LevelAndSide::COUNT]);

impl LevelAndSideCounts {
    /// Returns the counts of a mesh of this many coarse triangles.
    fn coarse(triangles: usize) -> Self {
        let mut counts = [0; LevelAndSide::COUNT];
        counts[0] = triangles as u32;
        Self(counts)
    }

    /// Counts the bisection of a parent.
    #[inline]
    fn bisected(&mut self, parent: LevelAndSide) {
        self.0[parent.index()] -= 1;
        self.0[parent.finer().index()] += 2;
    }

    /// Counts the merger of two children, which may be on either side of the boundary, into their parent.
    #[inline]
    fn merged(&mut self, children: [LevelAndSide; 2], parent: LevelAndSide) {
        for child in children {
            self.0[child.index()] -= 1;
        }
        self.0[parent.index()] += 1;
    }

    /// Returns the triangles outside the domain, by level.
    fn outside(&self) -> impl Iterator<Item = u32> {
        self.0[LevelAndSide::COUNT / 2..].iter().copied()
    }

    /// Counts one more triangle.
    fn add(&mut self, triangle: LevelAndSide) {
        self.0[triangle.index()] += 1;
    }

    /// Counts `count` more triangles of one level and side.
    fn add_many(&mut self, triangles: LevelAndSide, count: u32) {
        self.0[triangles.index()] += count;
    }

    /// Counts triangles that changed sides: `moves` says how many more there are of each level and side.
    fn add_moves(&mut self, moves: &[i32; LevelAndSide::COUNT]) {
        for (count, moves) in self.0.iter_mut().zip(moves) {
            *count = count.wrapping_add_signed(*moves);
        }
    }
}

impl Default for LevelAndSideCounts {
    /// Returns the counts of a mesh without triangles.
    fn default() -> Self {
        Self([0; LevelAndSide::COUNT])
    }
}

impl Clone for Mesh {
    fn clone(&self) -> Self {
        Self {
            lattice: self.lattice,
            nodes: self.nodes.clone(),
            triangles: self.triangles.clone(),
            triangle_at: self.triangle_at.clone(),
            counts: self.counts,
            coarse: self.coarse.clone(),
        }
    }

    /// Keeps the memory of the arrays: to build again, copy the coarse mesh into the old one.
    fn clone_from(&mut self, source: &Self) {
        self.lattice = source.lattice;
        self.nodes.clone_from(&source.nodes);
        self.triangles.clone_from(&source.triangles);
        self.triangle_at.clone_from(&source.triangle_at);
        self.counts = source.counts;
        self.coarse.clone_from(&source.coarse);
    }
}

/// Returns the length ℓ_b of the bisection edge of a triangle at `level` (Eq. 1).
///
/// `spacing` is the side δ of a coarse cell; both lengths are in world units. Each level divides by √2; at
/// odd levels the result is `spacing` times a power of two, and exactly that.
///
/// ```
/// # use meshbrush_mesh::mesh::bisection_edge_length;
/// assert_eq!(bisection_edge_length(1.0, 1), 1.0);
/// assert_eq!(bisection_edge_length(1.0, 3), 0.5);
/// ```
#[inline]
pub fn bisection_edge_length(spacing: f64, level: u32) -> f64 {
    // 1 / 2ⁿ by its exponent: exact, and faster than a division.
    let halved = spacing * f64::from_bits(u64::from(1023 - (level / 2).min(63)) << 52);
    if level.is_multiple_of(2) { SQRT_2 * halved } else { halved }
}

/// Returns the smallest level whose bisection edge is no longer than `target` (ℓ_b⁻¹ of the report).
///
/// Both lengths are in world units. Zero for targets above √2 · `spacing`, where the report's formula turns
/// negative; `None` where no level up to 63 is fine enough, or `target` is NaN.
pub fn level_for_diameter(spacing: f64, target: f64) -> Option<u32> {
    (0..64).find(|&level| bisection_edge_length(spacing, level) <= target)
}

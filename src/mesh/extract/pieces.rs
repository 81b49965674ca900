//! The triangles of a patch as arrays of their own, to be drawn over the mesh.

use std::collections::HashMap;
use std::ops::Range;

use super::{Extract, MeshPatch};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Changes, Mesh, Neighbour, NodeId, Triangle, TriangleId};

/// What is drawn in place of some triangles of a mesh: the pieces of a [`MeshPatch`].
///
/// ```text
///   mesh        o---o---o        pieces    nodes and triangles of their own; the triangles of the mesh
///               | \ | / |                  that they replace are not drawn
///               o---o---o
/// ```
///
/// The mesh may change before the patch is derived again. Entries that changed are then drawn as the mesh has
/// them, and the pieces in their place are *retired* ([`Self::retire`]).
#[derive(Clone, Debug, Default)]
pub struct PatchPieces {
    nodes: Vec<LatticePoint>,
    /// A neighbour says whether the domain ends there, and nothing else.
    triangles: Vec<Triangle>,
    /// In ascending order, with their parts of `triangles`.
    replaced: Vec<(TriangleId, Range<usize>)>,
    is_retired: Vec<bool>,
}

impl PatchPieces {
    /// The pieces of a patch; `extract` must be [`Mesh::extract_with`] of it.
    pub fn new(mesh: &Mesh, patch: &MeshPatch, extract: &Extract) -> Self {
        let mut pieces = Self { is_retired: vec![false; patch.changed.len()], ..Self::default() };
        let mut numbers: HashMap<NodeId, NodeId> = HashMap::new();
        let mut place = 0;
        let mut next_unchanged = 0;
        for (id, range) in &patch.changed {
            // The extract has one triangle for each entry of the domain between two changed ones.
            let between = &mesh.triangles[next_unchanged..id.index()];
            place += between.iter().filter(|triangle| !triangle.is_outside()).count();
            next_unchanged = id.index() + 1;
            let first = pieces.triangles.len();
            for triangle in &extract.triangles()[place..place + range.len()] {
                pieces.push(extract, triangle, &mut numbers);
            }
            place += range.len();
            pieces.replaced.push((*id, first..pieces.triangles.len()));
        }
        pieces
    }

    fn push(&mut self, extract: &Extract, triangle: &Triangle, numbers: &mut HashMap<NodeId, NodeId>) {
        let own = Neighbour::from(TriangleId::from_index(self.triangles.len()));
        let mut piece = *triangle;
        piece.vertices = triangle.vertices.map(|node| {
            *numbers.entry(node).or_insert_with(|| {
                self.nodes.push(extract.node(node));
                NodeId::from_index(self.nodes.len() - 1)
            })
        });
        piece.raw_neighbours = triangle.raw_neighbours.map(|n| if n.triangle().is_some() { own } else { n });
        self.triangles.push(piece);
    }

    /// The nodes of the pieces.
    pub fn nodes(&self) -> &[LatticePoint] {
        &self.nodes
    }

    /// The pieces, in the order of the triangles that they replace. Retired ones are marked as outside.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The triangles of the mesh that are not drawn, in ascending order.
    pub fn replaced(&self) -> impl Iterator<Item = TriangleId> {
        self.replacements().map(|(id, _)| id)
    }

    /// [`Self::replaced`], each with its part of [`Self::triangles`]. The part is empty where nothing is
    /// drawn in place of the triangle.
    pub fn replacements(&self) -> impl Iterator<Item = (TriangleId, Range<usize>)> {
        let active = self.replaced.iter().zip(&self.is_retired).filter(|(_, is_retired)| !**is_retired);
        active.map(|((id, pieces), _)| (*id, pieces.clone()))
    }

    /// Retires the pieces in place of entries that changed, and of those that the mesh no longer has. Returns
    /// these entries, each with its part of [`Self::triangles`].
    pub fn retire(&mut self, mesh: &Mesh, changes: &Changes) -> Vec<(TriangleId, Range<usize>)> {
        let mut retired = Vec::new();
        let gone = mesh.raw_triangle_count()..usize::MAX;
        for ids in changes.triangles.iter().chain(std::iter::once(&gone)) {
            let first = self.replaced.partition_point(|(id, _)| id.index() < ids.start);
            let in_range = self.replaced[first..].iter().take_while(|(id, _)| id.index() < ids.end);
            for (index, (id, pieces)) in (first..).zip(in_range) {
                if !std::mem::replace(&mut self.is_retired[index], true) {
                    self.triangles[pieces.clone()].iter_mut().for_each(|piece| piece.set_outside(true));
                    retired.push((*id, pieces.clone()));
                }
            }
        }
        retired
    }
}

//! Where the nodes and triangles of an extract come from.

use super::MeshPatch;
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Mesh, TriangleId};

impl Mesh {
    /// Returns for each node of [`Mesh::extract_with`] its place before a patch moved it; `None` for one that
    /// the patch added.
    ///
    /// The place says when bisection made the node, and between which two others.
    ///
    /// # Panics
    /// Panics when the patch is of another mesh.
    pub fn homes_with(&self, patch: &MeshPatch) -> Vec<Option<LatticePoint>> {
        if patch.is_empty() && self.outside_count() == 0 {
            return self.nodes.iter().copied().map(Some).collect();
        }
        let mut is_used = vec![false; self.nodes.len() + patch.added.len()];
        let mut is_kept: Vec<bool> = self.triangles.iter().map(|triangle| !triangle.is_outside()).collect();
        patch.changed.iter().for_each(|(id, _)| is_kept[id.index()] = false);
        let kept = self.triangles.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
        let kept = kept.flat_map(|(triangle, _)| triangle.vertices);
        let parts = patch.changed.iter().map(|(_, part)| part.clone());
        let pieces = parts.flat_map(|part| &patch.pieces[part]).flat_map(|piece| piece.corners);
        kept.chain(pieces).for_each(|node| is_used[node.index()] = true);
        let home = |node: usize| self.nodes.get(node).copied();
        is_used.iter().enumerate().filter(|(_, is_used)| **is_used).map(|(node, _)| home(node)).collect()
    }

    /// Returns for each triangle of [`Mesh::extract_with`] the triangle of the mesh that it is, or replaces.
    ///
    /// # Panics
    /// Panics when the patch is of another mesh.
    pub fn sources_with(&self, patch: &MeshPatch) -> Vec<TriangleId> {
        let mut sources = Vec::with_capacity(self.triangle_count());
        let mut changed = patch.changed.iter().peekable();
        for (index, triangle) in self.triangles.iter().enumerate() {
            let id = TriangleId::from_index(index);
            match changed.next_if(|(of, _)| *of == id) {
                Some((_, pieces)) => sources.extend(pieces.clone().map(|_| id)),
                None if triangle.is_outside() => {}
                None => sources.push(id),
            }
        }
        sources
    }
}

//! A mesh with a patch, as triangles and positions.

use rayon::prelude::*;

use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, MeshPatch, NodeId, TriangleId};

/// A triangle of a mesh with a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::outline) struct PatchedTriangle {
    pub(in crate::outline) owner: TriangleId,
    pub(in crate::outline) corners: [NodeId; 3],
}

/// A mesh with a patch, as an array of triangles and positions.
pub(in crate::outline) struct PatchedMesh<'a> {
    pub(in crate::outline) mesh: &'a Mesh,
    pub(in crate::outline) patch: &'a MeshPatch,
    pub(in crate::outline) points: Vec<LatticePoint>,
    is_changed: Vec<bool>,
}

impl<'a> PatchedMesh<'a> {
    pub(in crate::outline) fn new(mesh: &'a Mesh, patch: &'a MeshPatch) -> Self {
        let mut points: Vec<LatticePoint> = mesh.raw_nodes().iter().chain(&patch.added).copied().collect();
        patch.moved.iter().for_each(|&(id, at)| points[id.index()] = at);
        let mut is_changed = vec![false; mesh.raw_triangle_count()];
        patch.changed.iter().for_each(|(id, _)| is_changed[id.index()] = true);
        Self { mesh, patch, points, is_changed }
    }

    /// Returns the triangles that take the place of one of the mesh.
    pub(in crate::outline) fn pieces_of(
        &self,
        owner: TriangleId,
    ) -> impl Iterator<Item = PatchedTriangle> + '_ {
        let is_changed = self.is_changed[owner.index()];
        let whole = (!is_changed && self.mesh.is_in_domain(owner)).then(|| PatchedTriangle {
            owner,
            corners: self.mesh.triangle(owner).edge_nodes().map(|(v, _)| v),
        });
        let found = is_changed.then(|| self.patch.changed.binary_search_by_key(&owner, |(id, _)| *id));
        let pieces = found.and_then(Result::ok).map_or(0..0, |n| self.patch.changed[n].1.clone());
        let pieces = self.patch.pieces[pieces].iter();
        whole.into_iter().chain(pieces.map(move |piece| PatchedTriangle { owner, corners: piece.corners }))
    }

    /// Returns the triangles for which `counts` is true, in the order of the mesh. All threads work on it.
    pub(in crate::outline) fn triangles(
        &self,
        counts: impl Fn(&PatchedTriangle) -> bool + Sync,
    ) -> Vec<PatchedTriangle> {
        let all = (0..self.mesh.raw_triangle_count()).into_par_iter().with_min_len(1 << 12);
        let found = all
            .flat_map_iter(|n| self.pieces_of(TriangleId::from_index(n)).filter(&counts).collect::<Vec<_>>());
        found.collect()
    }

    pub(in crate::outline) fn corners(&self, triangle: &PatchedTriangle) -> [LatticePoint; 3] {
        triangle.corners.map(|v| self.points[v.index()])
    }
}

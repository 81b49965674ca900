//! The pieces of the boundary along the edges of each triangle.

use meshbrush_core::domain::MeshBoundary;
use meshbrush_mesh::mesh::Extract;

/// The pieces by triangle, for rows that are made in any order.
pub(super) struct TrianglePieces<'a> {
    /// The triangle of each boundary edge, in ascending order.
    triangles: Vec<usize>,
    /// The piece of each boundary edge.
    pieces: &'a [u32],
}

impl<'a> TrianglePieces<'a> {
    /// Finds the pieces at the triangles of a mesh, from its boundary.
    pub(super) fn new(mesh: &Extract, boundary: &'a MeshBoundary) -> Self {
        let triangles = mesh.boundary_edges().map(|edge| edge.triangle).collect();
        Self { triangles, pieces: boundary.piece_of_edge() }
    }

    /// Returns the number of the piece of each boundary edge of a triangle, in the order of its edges.
    pub(super) fn of(&self, triangle: usize) -> impl Iterator<Item = u32> + '_ {
        let first = self.triangles.partition_point(|&other| other < triangle);
        let own = self.triangles[first..].iter().zip(&self.pieces[first..]);
        own.take_while(move |(other, _)| **other == triangle).map(|(_, &piece)| piece)
    }
}

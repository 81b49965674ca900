//! Where islands find triangles.

use super::KeptIslands;
use crate::geometry::LatticePoint;
use crate::mesh::{DrawnPiece, Mesh, Replacement, TriangleId};

/// Triangles that take the place of those of a mesh.
pub(in crate::outline) trait PieceSource: Sync {
    /// Returns what takes the place of a triangle of the mesh.
    fn replacement(&self, mesh: &Mesh, id: TriangleId) -> Replacement;

    /// Returns the triangles in its place, itself if nothing replaces it.
    fn pieces(&self, mesh: &Mesh, id: TriangleId) -> Vec<DrawnPiece> {
        let Replacement { nodes, pieces, .. } = self.replacement(mesh, id);
        pieces.unwrap_or_else(|| match mesh.is_in_domain(id) {
            true => vec![self.whole(mesh, id, nodes)],
            false => Vec::new(),
        })
    }

    /// Returns a triangle of the mesh that nothing replaces, with its nodes at places.
    fn whole(&self, mesh: &Mesh, id: TriangleId, nodes: [LatticePoint; 3]) -> DrawnPiece {
        let triangle = mesh.triangle(id);
        let place = |v| triangle.vertices.iter().position(|&other| other == v).unwrap_or(0);
        let corners = triangle.edge_nodes().map(|(from, _)| nodes[place(from)]);
        let on_boundary =
            triangle.raw_neighbours.map(|across| across.triangle().is_none_or(|t| self.is_empty(mesh, t)));
        DrawnPiece { corners, on_boundary }
    }

    /// Returns whether nothing takes the place of a triangle of the mesh.
    fn is_empty(&self, mesh: &Mesh, id: TriangleId) -> bool;

    /// Returns whether a triangle of the mesh may have a node on the boundary, or one that moved.
    fn is_near_boundary(&self, mesh: &Mesh, id: TriangleId) -> bool;
}

/// The triangles of the mesh themselves.
pub(in crate::outline) struct PlainPieces;

impl PieceSource for PlainPieces {
    fn replacement(&self, mesh: &Mesh, id: TriangleId) -> Replacement {
        Replacement { id, nodes: mesh.corners(id), pieces: None }
    }

    fn is_empty(&self, mesh: &Mesh, id: TriangleId) -> bool {
        !mesh.is_in_domain(id)
    }

    fn is_near_boundary(&self, _: &Mesh, _: TriangleId) -> bool {
        true
    }
}

/// Triangles with islands in place of some of them.
pub(in crate::outline) struct LayeredPieces<'a> {
    pub(in crate::outline) below: &'a dyn PieceSource,
    pub(in crate::outline) islands: &'a KeptIslands,
}

impl PieceSource for LayeredPieces<'_> {
    fn replacement(&self, mesh: &Mesh, id: TriangleId) -> Replacement {
        let below = self.below.replacement(mesh, id);
        let nodes = below.nodes.map(|at| self.islands.moved_to(at));
        let pieces = match self.islands.replaces(id) {
            true => Some(self.islands.pieces_of(id, self.below.pieces(mesh, id))),
            false => below.pieces,
        };
        Replacement { id, nodes, pieces }
    }

    /// Islands change no boundary.
    fn is_empty(&self, mesh: &Mesh, id: TriangleId) -> bool {
        self.below.is_empty(mesh, id)
    }

    fn is_near_boundary(&self, mesh: &Mesh, id: TriangleId) -> bool {
        self.islands.owner(id).is_some() || self.below.is_near_boundary(mesh, id)
    }
}

use glam::DVec2;

use super::Extract;
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::kernel::{Mesh, Neighbour, NodeId, Triangle, TriangleId};

/// Read access to the arrays of a mesh or of an extract, for drawing.
///
/// Ids are indices into these arrays. The ids of an extract are the numbers in files.
#[derive(Clone, Copy, Debug)]
pub struct MeshView<'a> {
    lattice: &'a Lattice,
    nodes: &'a [LatticePoint],
    triangles: &'a [Triangle],
}

impl Mesh {
    /// Returns all entries of the mesh; those outside the domain are marked.
    pub fn view(&self) -> MeshView<'_> {
        MeshView { lattice: &self.lattice, nodes: &self.nodes, triangles: &self.triangles }
    }
}

impl Extract<'_> {
    /// Returns the nodes and triangles of the extract.
    pub fn view(&self) -> MeshView<'_> {
        MeshView { lattice: &self.lattice, nodes: &self.nodes, triangles: &self.triangles }
    }
}

impl<'a> MeshView<'a> {
    /// Returns the grid and lattice that the mesh was refined from.
    pub fn lattice(&self) -> &'a Lattice {
        self.lattice
    }

    /// Returns all nodes in lattice coordinates.
    pub fn nodes(&self) -> &'a [LatticePoint] {
        self.nodes
    }

    /// Returns all triangles; those outside the domain are marked.
    pub fn triangles(&self) -> &'a [Triangle] {
        self.triangles
    }

    /// Returns a triangle; `None` where there is none with this id.
    pub fn get(&self, id: TriangleId) -> Option<&'a Triangle> {
        self.triangles.get(id.index())
    }

    /// Returns a triangle.
    ///
    /// # Panics
    /// Panics when there is no such triangle, as the following.
    pub fn triangle(&self, id: TriangleId) -> &'a Triangle {
        &self.triangles[id.index()]
    }

    /// Returns the lattice coordinates of a node.
    pub fn node(&self, id: NodeId) -> LatticePoint {
        self.nodes[id.index()]
    }

    /// Returns the world coordinates of a node.
    pub fn world(&self, id: NodeId) -> DVec2 {
        self.lattice.world_from_lattice(self.node(id))
    }

    /// Returns the vertices of a triangle in lattice coordinates, in the triangle's order.
    pub fn corners(&self, id: TriangleId) -> [LatticePoint; 3] {
        self.triangle(id).vertices.map(|v| self.node(v))
    }

    /// Returns the vertices of a triangle in world coordinates, in the triangle's order.
    pub fn world_corners(&self, id: TriangleId) -> [DVec2; 3] {
        self.triangle(id).vertices.map(|v| self.world(v))
    }

    /// Returns the vertices of a triangle as files list them: anticlockwise, the first two the ends of the
    /// bisection edge.
    pub fn file_vertices(&self, id: TriangleId) -> [NodeId; 3] {
        self.triangle(id).edge_nodes().map(|(from, _)| from)
    }

    /// Returns the triangles of the domain across the edges of one, its bisection neighbour first,
    /// anticlockwise.
    pub fn neighbours(&self, id: TriangleId) -> [Neighbour; 3] {
        self.triangle(id).raw_neighbours.map(|across| match across.triangle() {
            Some(other) if !self.triangle(other).is_outside() => across,
            _ => Neighbour::BOUNDARY,
        })
    }

    /// Returns the longest edge of a triangle, in world units.
    pub fn diameter(&self, id: TriangleId) -> f64 {
        let [a, b, c] = self.world_corners(id);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }
}

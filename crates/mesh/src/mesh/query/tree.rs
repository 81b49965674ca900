//! Finds triangles of the bisection tree in a mesh.

use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Mesh, TreeTriangle, TriangleId, WalkEnd};

impl Mesh {
    /// Returns whether a triangle of the tree was bisected: whether its halves, or parts of them, are in the
    /// mesh.
    ///
    /// Time grows with the number of levels only. The triangle must lie in the domain.
    pub fn is_bisected(&self, triangle: &TreeTriangle) -> bool {
        triangle.level() < self.lattice().deepest_level() && {
            let midpoint = triangle.midpoint();
            let found = self.triangle_near(triangle, midpoint);
            found.is_some_and(|id| self.corners(id).contains(&midpoint))
        }
    }

    /// Returns the entry of a triangle of the tree, if it is in the mesh.
    pub fn entry_of(&self, triangle: &TreeTriangle) -> Option<TriangleId> {
        // The apex belongs to neighbours as well; a point strictly inside belongs to one triangle.
        let [apex, p, q] = triangle.corners().map(LatticePoint::as_dvec2);
        let (_, start) = triangle.coarse_entry(self)?;
        match self.walk(start, 0.5 * apex + 0.25 * (p + q)) {
            WalkEnd::Found(id, _) => TreeTriangle::from_mesh(self, id).is_same(triangle).then_some(id),
            WalkEnd::Blocked => None,
        }
    }

    /// Returns a triangle of the mesh with a point in it, in the coarse triangle of `triangle`.
    fn triangle_near(&self, triangle: &TreeTriangle, point: LatticePoint) -> Option<TriangleId> {
        let (_, start) = triangle.coarse_entry(self)?;
        match self.walk(start, point.as_dvec2()) {
            WalkEnd::Found(id, _) => Some(id),
            WalkEnd::Blocked => None,
        }
    }
}

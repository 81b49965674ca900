//! Steps from triangle to triangle: towards a point (Algorithm 15), and around a node.

use glam::DVec2;

use super::{Mesh, NodeId, TriangleId};
use crate::geometry::{Side, side_of_edge};

/// How a walk ended.
#[derive(Clone, Copy)]
pub(in crate::mesh) enum WalkEnd {
    /// The walk ended in a triangle that contains the point. For each edge, the side on which the point is:
    /// never strictly to the right.
    Found(TriangleId, [Side; 3]),
    /// The walk ended at an edge of the boundary, with the point strictly beyond it.
    Blocked,
}

impl Mesh {
    /// Returns the steps from triangle to triangle towards `p` in lattice coordinates, across the first edge
    /// that has it strictly beyond.
    ///
    /// With exact tests such a walk in a Delaunay triangulation comes strictly nearer (in power distance) at
    /// every step, so it visits no triangle twice. All angles are at most 90°, so every mesh of this method
    /// is Delaunay. No random order of edges and no memory of the previous triangle are needed to end;
    /// skipping the edge just crossed only saves a test.
    #[inline]
    pub(in crate::mesh) fn walk(&self, start: TriangleId, p: DVec2) -> WalkEnd {
        self.walk_through(start, p, |_| {})
    }

    /// Walks as [`Self::walk`] does, and visits every triangle on the way, the first and the last included.
    #[inline]
    pub(in crate::mesh) fn walk_through(
        &self,
        start: TriangleId,
        p: DVec2,
        mut visit: impl FnMut(TriangleId),
    ) -> WalkEnd {
        let mut id = start;
        let mut previous = None;
        'step: loop {
            visit(id);
            let triangle = self.triangle(id);
            let mut sides = [Side::Left; 3];
            for (j, (from, to)) in triangle.edge_nodes().into_iter().enumerate() {
                let across = triangle.raw_neighbours[j].triangle();
                if across.is_some() && across == previous {
                    continue; // the point is strictly on this side: the edge was just crossed
                }
                sides[j] = side_of_edge(self.node(from), self.node(to), p);
                if sides[j] == Side::Right {
                    let Some(next) = across else { return WalkEnd::Blocked };
                    previous = Some(id);
                    id = next;
                    continue 'step;
                }
            }
            return WalkEnd::Found(id, sides);
        }
    }

    /// Returns the triangles of the domain around `node`, at most eight.
    ///
    /// Where only a corner joins two parts of the coarse grid, those of one part.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    pub fn triangles_around(&self, node: NodeId) -> impl Iterator<Item = TriangleId> + '_ {
        self.all_triangles_around(node).filter(|&id| self.is_in_domain(id))
    }

    /// Returns the triangles around `node` as [`Self::triangles_around`] does, those outside a fitted domain
    /// included.
    ///
    /// # Panics
    /// Panics when the id is not of this mesh.
    pub fn all_triangles_around(&self, node: NodeId) -> impl Iterator<Item = TriangleId> + '_ {
        self.raw_triangles_around(node, self.raw_triangle_at(node))
    }

    /// Returns the triangles around `node` that can be reached from `start` (one of them) across edges,
    /// `start` first, those outside the domain included.
    ///
    /// At most eight. Where only a corner joins two parts of the domain, the other part is not reached.
    #[inline]
    pub(in crate::mesh) fn raw_triangles_around(
        &self,
        node: NodeId,
        start: TriangleId,
    ) -> impl Iterator<Item = TriangleId> + '_ {
        let mut id = Some(start);
        let mut clockwise = false;
        std::iter::from_fn(move || {
            let current = id?;
            id = self.turn(node, current, clockwise);
            if id.is_none() && !clockwise {
                clockwise = true;
                id = self.turn(node, start, true);
            } else if id == Some(start) {
                id = None;
            }
            Some(current)
        })
        .take(8)
    }

    /// Returns the next triangle around `node`, `None` at the boundary.
    #[inline]
    fn turn(&self, node: NodeId, id: TriangleId, clockwise: bool) -> Option<TriangleId> {
        let triangle = self.triangle(id);
        // Anticlockwise edges: the one that ends in the node is crossed to turn anticlockwise around it.
        let crossed =
            triangle.edge_nodes().iter().position(|&(from, to)| node == if clockwise { from } else { to })?;
        triangle.raw_neighbours[crossed].triangle()
    }
}

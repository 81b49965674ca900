//! The same part of the plane with triangles half as large.

use std::borrow::Cow;

use super::patch::join;
use super::{Extract, PatchTriangle};
use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::kernel::{Neighbour, NodeId, Triangle};

impl Extract<'_> {
    /// Returns the extract with each triangle bisected twice, into four, by the midpoints of its edges.
    /// Triangles of the report stay what they are, and four pieces of a triangle at the outline are similar
    /// to it or to its halves.
    ///
    /// All nodes keep their numbers and places; a new one follows for each edge. So the nodes of a mesh are
    /// those of the refined one, whatever the outline did to them. A midpoint between two points of the
    /// lattice is rounded.
    ///
    /// `None` where an edge is too short for a point of the lattice between its ends, and where nodes have
    /// other coordinates ([`Self::with_coordinates`]).
    pub fn refined(&self) -> Option<Extract<'static>> {
        if self.coordinates.is_some() {
            return None;
        }
        let mut nodes = self.nodes.to_vec();
        let mut middles: NumberMap<(NodeId, NodeId), NodeId> = NumberMap::default();
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for triangle in self.triangles.iter() {
            let edges = triangle.edge_nodes();
            let [of_ab, of_bc, of_ca] = edges.map(|(from, to)| {
                let key = (from.min(to), from.max(to));
                let middle = *middles.entry(key).or_insert_with(|| NodeId::from_index(nodes.len()));
                if middle.index() == nodes.len() {
                    nodes.push(between(nodes[from.index()], nodes[to.index()]));
                }
                middle
            });
            let [(a, b), (_, c), _] = edges;
            let level = triangle.level() + 2;
            // The halves have the edges from b to c and from c to a as bisection edges.
            let corners = [[a, of_ab, of_ca], [of_ab, c, of_ca], [of_ab, b, of_bc], [c, of_ab, of_bc]];
            triangles.extend(corners.map(|corners| PatchTriangle { corners, level }.triangle()));
        }
        let has_area = |triangle: &Triangle| {
            let [p, q, r] = triangle.vertices.map(|vertex| nodes[vertex.index()]);
            p != q && q != r && r != p
        };
        if !triangles.iter().all(has_area) {
            return None;
        }
        let edges = (0..triangles.len()).flat_map(|index| (0..3).map(move |edge| (index, edge)));
        join(&mut triangles, edges);
        let before = self.places.as_ref().map_or(self.triangles.len(), Vec::len);
        Some(Extract {
            lattice: self.lattice,
            nodes: Cow::Owned(nodes),
            triangles: Cow::Owned(triangles),
            places: Some(vec![Neighbour::BOUNDARY; before]),
            is_patched: true,
            coordinates: None,
        })
    }

    /// Returns how many triangles there are after so many refinements; `None` for too many to count.
    pub fn triangles_refined(&self, times: u32) -> Option<usize> {
        self.triangles.len().checked_mul(4_usize.checked_pow(times)?)
    }
}

/// Returns the point halfway between two, rounded down.
fn between(p: LatticePoint, q: LatticePoint) -> LatticePoint {
    LatticePoint { x: (p.x + q.x) / 2, y: (p.y + q.y) / 2 }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{Lattice, Rect};
    use crate::mesh::kernel::{Limits, Mesh, TriangleId};

    #[test]
    fn each_triangle_becomes_four_and_nodes_stay() {
        let limits = Limits::default();
        let lattice = Lattice::covering(Rect::UNIT, 0.25, limits.max_triangles).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &limits).unwrap();
        let first = mesh.extract();
        let second = first.refined().unwrap();
        assert_eq!(second.triangles().len(), first.triangles_refined(1).unwrap());
        assert_eq!(second.nodes()[..first.nodes().len()], *first.nodes());
        assert_eq!(second.nodes().len(), first.nodes().len() + first.edges().count());
        // Neighbours are mutual, and the boundary has twice the edges.
        assert_eq!(second.boundary_edges().count(), 2 * first.boundary_edges().count());
        assert_eq!(second.level_counts(), [0, 0, 4 * first.triangles().len()]);
        assert!((second.area() - first.area()).abs() < 1e-12);
        for (id, cell) in second.cells().enumerate() {
            for across in cell.opposite.into_iter().flatten() {
                assert!(second.cell(TriangleId::from_index(across)).opposite.contains(&Some(id)));
            }
        }
        let third = second.refined().unwrap();
        assert!(
            third
                .extreme_angles()
                .iter()
                .all(|(angle, _)| [45.0, 90.0].iter().any(|a| (angle - a).abs() < 1e-9))
        );
        assert_eq!(first.triangles_refined(40), None);
    }
}

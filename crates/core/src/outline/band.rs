//! The triangles of the mesh near the outline.

use super::triangulation::{NONE, Triangulation};
use crate::domain::RegionOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Mesh, NodeId, TriangleId};

/// Number of rings of triangles, around those that the outline divides, that may change.
const RINGS: usize = 4;

/// The triangles of a mesh near the outline of a region, inside and outside.
///
/// Nodes and triangles are numbered by their positions on the lattice, not by their entries in the mesh. So
/// everything that is derived from them depends on mesh and outline only, not on the order of edits.
pub(super) struct Band {
    pub(super) triangles: Triangulation,
    /// The entries of the triangles in the mesh.
    pub(super) ids: Vec<TriangleId>,
    /// The entries of the nodes in the mesh.
    pub(super) node_ids: Vec<NodeId>,
    /// The nodes, in ascending order.
    pub(super) points: Vec<LatticePoint>,
    /// For each node, whether it lies in the closed region.
    pub(super) inside: Vec<bool>,
    /// For each node, whether the outline crosses an edge there, between nodes inside and outside.
    pub(super) active: Vec<bool>,
}

/// Returns, for each node of a mesh, whether it lies in the closed region.
pub(super) fn signs(mesh: &Mesh, region: &RegionOnLattice) -> Vec<bool> {
    mesh.raw_nodes().iter().map(|&node| region.contains(node)).collect()
}

impl Band {
    pub(super) fn new(mesh: &Mesh, signs: &[bool]) -> Self {
        let active = nodes_at_outline(mesh, signs);
        let (mut near, mut ids) = (active.clone(), Vec::new());
        for _ in 0..RINGS {
            ids = triangles_at(mesh, &near);
            for v in ids.iter().flat_map(|&id| mesh.triangle(id).vertices) {
                near[v.index()] = true;
            }
        }
        let mut node_ids: Vec<NodeId> =
            (0..near.len()).filter(|&n| near[n]).map(NodeId::from_index).collect();
        if ids.is_empty() {
            node_ids.clear();
        }
        node_ids.sort_unstable_by_key(|&id| mesh.node(id));
        let of_node = |flags: &[bool]| node_ids.iter().map(|id| flags[id.index()]).collect();
        Self {
            points: node_ids.iter().map(|&id| mesh.node(id)).collect(),
            inside: of_node(signs),
            active: of_node(&active),
            triangles: numbered(mesh, &mut ids, &node_ids),
            ids,
            node_ids,
        }
    }

    /// Returns the marks of the corners of a triangle, beginning with the corner at position `i`.
    pub(super) fn starting_at<T: Copy>(&self, triangle: u32, i: usize, of: &[T]) -> [T; 3] {
        self.triangles.starting_at(triangle, i).map(|v| of[v as usize])
    }
}

/// Returns, for each node of the mesh, whether it is a corner of a triangle that has corners inside and
/// outside.
fn nodes_at_outline(mesh: &Mesh, signs: &[bool]) -> Vec<bool> {
    let mut active = vec![false; signs.len()];
    for triangle in mesh.raw_triangles() {
        let [a, b, c] = triangle.vertices.map(|v| signs[v.index()]);
        if a != b || b != c {
            for v in triangle.vertices {
                active[v.index()] = true;
            }
        }
    }
    active
}

fn triangles_at(mesh: &Mesh, nodes: &[bool]) -> Vec<TriangleId> {
    let triangles = mesh.raw_triangles().iter().enumerate();
    let near = triangles.filter(|(_, triangle)| triangle.vertices.iter().any(|v| nodes[v.index()]));
    near.map(|(index, _)| TriangleId::from_index(index)).collect()
}

/// Sorts the triangles by their corners, and numbers corners and neighbours.
fn numbered(mesh: &Mesh, ids: &mut Vec<TriangleId>, node_ids: &[NodeId]) -> Triangulation {
    let mut number_of_node = vec![NONE; mesh.raw_nodes().len()];
    for (n, id) in node_ids.iter().enumerate() {
        number_of_node[id.index()] = n as u32;
    }
    let mut entries: Vec<([u32; 3], [u32; 3], TriangleId)> = ids
        .iter()
        .map(|&id| {
            let triangle = mesh.triangle(id);
            let corners = triangle.edge_nodes().map(|(from, _)| number_of_node[from.index()]);
            // Edge j joins corner j to the next one.
            let [first, second, third] =
                triangle.raw_neighbours.map(|n| n.triangle().map_or(NONE, |id| id.index() as u32));
            let across = [second, third, first];
            let lowest = (0..3).min_by_key(|&i| corners[i]).expect("three corners");
            let turned = |of: [u32; 3]| [of[lowest], of[(lowest + 1) % 3], of[(lowest + 2) % 3]];
            (turned(corners), turned(across), id)
        })
        .collect();
    entries.sort_unstable();
    let mut number = vec![NONE; mesh.raw_triangle_count()];
    for (n, (_, _, id)) in entries.iter().enumerate() {
        number[id.index()] = n as u32;
    }
    ids.clear();
    ids.extend(entries.iter().map(|(_, _, id)| *id));
    let across = |raw: [u32; 3]| raw.map(|n| if n == NONE { NONE } else { number[n as usize] });
    let corners = entries.iter().map(|(corners, _, _)| *corners).collect();
    Triangulation::new(node_ids.len(), corners, entries.iter().map(|(_, raw, _)| across(*raw)).collect())
}

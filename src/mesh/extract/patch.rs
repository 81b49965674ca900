//! A mesh with some of its triangles replaced by others.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

use super::Extract;
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Kind, Mesh, Neighbour, NodeId, Orientation, Triangle, TriangleId};

/// What is changed in a mesh before it leaves the program. All ids are those of the mesh's own arrays
/// ([`Mesh::raw_nodes`], [`Mesh::raw_triangles`]); added nodes follow the mesh's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshPatch {
    /// Nodes that lie elsewhere, in ascending order.
    pub moved: Vec<(NodeId, LatticePoint)>,
    /// Further nodes.
    pub added: Vec<LatticePoint>,
    /// Changed triangles in ascending order, each with its part of `pieces`; an empty part for one that is
    /// gone. All others are as in the mesh.
    pub changed: Vec<(TriangleId, Range<usize>)>,
    /// What takes the place of the changed triangles.
    pub pieces: Vec<PatchTriangle>,
}

/// A triangle of a [`MeshPatch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchTriangle {
    /// Nodes, anticlockwise, the first two the ends of the longest edge.
    pub corners: [NodeId; 3],
    /// The level of the triangle of the mesh that it takes the place of.
    pub level: u32,
}

impl MeshPatch {
    /// Whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        self.moved.is_empty() && self.added.is_empty() && self.changed.is_empty()
    }

    /// Whether no triangle is left of a mesh with the patch.
    pub fn leaves_nothing_of(&self, mesh: &Mesh) -> bool {
        let replaced = self.changed.iter().filter(|(id, _)| mesh.is_in_domain(*id)).count();
        self.pieces.is_empty() && replaced == mesh.triangle_count()
    }
}

impl PatchTriangle {
    /// The triangle without neighbours.
    fn triangle(&self) -> Triangle {
        let [a, b, c] = self.corners;
        // So that the first edge joins a to b.
        let vertices = if self.level.is_multiple_of(2) { [b, c, a] } else { [a, b, c] };
        Triangle::new(
            vertices,
            [Neighbour::BOUNDARY; 3],
            Orientation::Anticlockwise,
            Kind::inside(self.level),
        )
    }
}

impl Mesh {
    /// The part of the mesh that belongs to the domain, with the changes of a patch. Pieces are at the
    /// place of the triangles that they replace.
    ///
    /// # Panics
    /// When the patch is of another mesh.
    pub fn extract_with(&self, patch: &MeshPatch) -> Extract<'_> {
        let mut assembly = Assembly::new(self, patch);
        let mut changed = patch.changed.iter().peekable();
        for (index, triangle) in self.triangles.iter().enumerate() {
            if let Some((_, pieces)) = changed.next_if(|(id, _)| id.index() == index) {
                patch.pieces[pieces.clone()].iter().for_each(|piece| assembly.push_piece(piece));
            } else if !triangle.is_outside() {
                assembly.push_unchanged(triangle);
            }
        }
        let Assembly { places, mut triangles, .. } = assembly;
        let (nodes, numbers) = used_nodes(self, patch, &triangles);
        for triangle in &mut triangles {
            triangle.vertices = triangle.vertices.map(|v| numbers[v.index()]);
        }
        Extract {
            lattice: self.lattice,
            nodes: Cow::Owned(nodes),
            triangles: Cow::Owned(triangles),
            places: Some(places),
            is_patched: !patch.is_empty(),
        }
    }
}

/// Triangles with their neighbours by their numbers in the extract, and nodes by their ids in the mesh.
struct Assembly {
    /// For each triangle of the mesh its number, if it is in the domain and unchanged.
    places: Vec<Neighbour>,
    /// For each triangle of the mesh whether it is changed.
    is_changed: Vec<bool>,
    triangles: Vec<Triangle>,
    /// Edges of which one triangle is known, each with that triangle and its edge.
    open: HashMap<(NodeId, NodeId), (usize, usize)>,
}

impl Assembly {
    fn new(mesh: &Mesh, patch: &MeshPatch) -> Self {
        let mut is_changed = vec![false; mesh.triangles.len()];
        patch.changed.iter().for_each(|(id, _)| is_changed[id.index()] = true);
        let mut places = vec![Neighbour::BOUNDARY; mesh.triangles.len()];
        let (mut changed, mut count) = (patch.changed.iter().peekable(), 0);
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            if let Some((_, pieces)) = changed.next_if(|(id, _)| id.index() == index) {
                count += pieces.len();
            } else if !triangle.is_outside() {
                places[index] = TriangleId::from_index(count).into();
                count += 1;
            }
        }
        Self { places, is_changed, triangles: Vec::with_capacity(count), open: HashMap::new() }
    }

    fn push_unchanged(&mut self, triangle: &Triangle) {
        let mut renumbered = *triangle;
        renumbered.raw_neighbours =
            triangle.raw_neighbours.map(|n| n.triangle().map_or(n, |id| self.places[id.index()]));
        self.triangles.push(renumbered);
        for (j, across) in triangle.raw_neighbours.into_iter().enumerate() {
            if across.triangle().is_some_and(|id| self.is_changed[id.index()]) {
                self.join(j);
            }
        }
    }

    fn push_piece(&mut self, piece: &PatchTriangle) {
        self.triangles.push(piece.triangle());
        (0..3).for_each(|j| self.join(j));
    }

    /// Joins the last triangle to the one that has its edge `j` in the other direction, once that one is
    /// known.
    fn join(&mut self, j: usize) {
        let index = self.triangles.len() - 1;
        let (from, to) = self.triangles[index].edge_nodes()[j];
        match self.open.remove(&(to, from)) {
            Some((other, k)) => {
                self.triangles[index].raw_neighbours[j] = TriangleId::from_index(other).into();
                self.triangles[other].raw_neighbours[k] = TriangleId::from_index(index).into();
            }
            None => {
                self.open.insert((from, to), (index, j));
            }
        }
    }
}

/// The nodes that the triangles use, in the order of their ids, and for each id its number among them.
fn used_nodes(mesh: &Mesh, patch: &MeshPatch, triangles: &[Triangle]) -> (Vec<LatticePoint>, Vec<NodeId>) {
    let mut points: Vec<LatticePoint> = mesh.nodes.iter().chain(&patch.added).copied().collect();
    patch.moved.iter().for_each(|&(id, point)| points[id.index()] = point);
    let mut used = vec![false; points.len()];
    for vertex in triangles.iter().flat_map(|triangle| triangle.vertices) {
        used[vertex.index()] = true;
    }
    let (mut nodes, mut numbers) = (Vec::new(), Vec::with_capacity(points.len()));
    for (point, used) in points.into_iter().zip(used) {
        numbers.push(NodeId::from_index(nodes.len()));
        nodes.extend(used.then_some(point));
    }
    (nodes, numbers)
}

//! The triangles of a patch as arrays of their own, to be drawn over the mesh.

use std::collections::HashMap;
use std::ops::Range;

use super::{Extract, MeshPatch};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::{Changes, Mesh, Neighbour, NodeId, Triangle, TriangleId};

/// The triangles that are drawn in place of some triangles of a mesh: the pieces of a [`MeshPatch`].
///
/// ```text
///   mesh        o---o---o        pieces    nodes and triangles of their own; the triangles of the mesh
///               | \ | / |                  that they replace are not drawn
///               o---o---o
/// ```
///
/// The mesh may change before the patch is derived again. The pieces in place of changed entries are then
/// *retired* ([`Self::retire`]), and the entries themselves are drawn. Where such an entry has a node that
/// the patch moved, a *provisional* piece is drawn instead, with the node where the patch has it: the mesh
/// has no gaps beside the other pieces.
#[derive(Clone, Debug, Default)]
pub struct PatchPieces {
    nodes: Vec<LatticePoint>,
    /// A neighbour only tells whether the edge is on the boundary of the domain.
    triangles: Vec<Triangle>,
    /// The replaced triangles in ascending order, with their ranges in `triangles`.
    replaced: Vec<(TriangleId, Range<usize>)>,
    is_retired: Vec<bool>,
    provisional: HashMap<TriangleId, Range<usize>>,
    /// Nodes that the patch moved, in ascending order: where the mesh has them, and the patch.
    moved: Vec<(NodeId, [LatticePoint; 2])>,
}

impl PatchPieces {
    /// Returns the pieces of a patch; `extract` must be [`Mesh::extract_with`] of it.
    pub fn new(mesh: &Mesh, patch: &MeshPatch, extract: &Extract) -> Self {
        let moved = patch.moved.iter().map(|&(id, point)| (id, [mesh.node(id), point])).collect();
        let mut pieces = Self { is_retired: vec![false; patch.changed.len()], moved, ..Self::default() };
        let mut numbers: HashMap<NodeId, NodeId> = HashMap::new();
        let mut place = 0;
        let mut next_unchanged = 0;
        for (id, range) in &patch.changed {
            // The extract has one triangle for each entry of the domain between two changed ones.
            let between = &mesh.triangles[next_unchanged..id.index()];
            place += between.iter().filter(|triangle| !triangle.is_outside()).count();
            next_unchanged = id.index() + 1;
            let first = pieces.triangles.len();
            for triangle in &extract.triangles()[place..place + range.len()] {
                pieces.push(extract, triangle, &mut numbers);
            }
            place += range.len();
            pieces.replaced.push((*id, first..pieces.triangles.len()));
        }
        pieces
    }

    fn push(&mut self, extract: &Extract, triangle: &Triangle, numbers: &mut HashMap<NodeId, NodeId>) {
        let own = Neighbour::from(TriangleId::from_index(self.triangles.len()));
        let mut piece = *triangle;
        piece.vertices = triangle.vertices.map(|node| {
            *numbers.entry(node).or_insert_with(|| {
                self.nodes.push(extract.node(node));
                NodeId::from_index(self.nodes.len() - 1)
            })
        });
        piece.raw_neighbours = triangle.raw_neighbours.map(|n| if n.triangle().is_some() { own } else { n });
        self.triangles.push(piece);
    }

    /// Returns the nodes of the pieces.
    pub fn nodes(&self) -> &[LatticePoint] {
        &self.nodes
    }

    /// Returns the pieces. Retired ones are marked as outside.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Returns the triangles of the mesh that are not drawn.
    pub fn replaced(&self) -> impl Iterator<Item = TriangleId> {
        self.replacements().map(|(id, _)| id)
    }

    /// [`Self::replaced`], each with its part of [`Self::triangles`]. The part is empty where nothing is
    /// drawn in place of the triangle.
    pub fn replacements(&self) -> impl Iterator<Item = (TriangleId, Range<usize>)> {
        let active = self.replaced.iter().zip(&self.is_retired).filter(|(_, is_retired)| !**is_retired);
        let active = active.map(|((id, pieces), _)| (*id, pieces.clone()));
        active.chain(self.provisional.iter().map(|(id, pieces)| (*id, pieces.clone())))
    }

    /// Returns the part of [`Self::triangles`] that is drawn in place of a triangle of the mesh; `None` where
    /// the triangle itself is drawn.
    pub fn replacement(&self, id: TriangleId) -> Option<Range<usize>> {
        if let Some(pieces) = self.provisional.get(&id) {
            return Some(pieces.clone());
        }
        let index = self.replaced.binary_search_by_key(&id, |(replaced, _)| *replaced).ok()?;
        (!self.is_retired[index]).then(|| self.replaced[index].1.clone())
    }

    /// Retires the pieces in place of entries that changed or no longer exist, and appends provisional
    /// pieces. Returns the entries whose [`Self::replacement`] changed, each with a part of
    /// [`Self::triangles`] that changed.
    pub fn retire(&mut self, mesh: &Mesh, changes: &Changes) -> Vec<(TriangleId, Range<usize>)> {
        let mut touched = Vec::new();
        let count = mesh.raw_triangle_count();
        for ids in changes.triangles.iter().chain(std::iter::once(&(count..usize::MAX))) {
            self.retire_replaced(ids, &mut touched);
            self.retire_provisional(ids, &mut touched);
        }
        if !self.moved.is_empty() {
            for id in changes.triangles.iter().flat_map(|ids| ids.start..ids.end.min(count)) {
                self.push_provisional(mesh, TriangleId::from_index(id), &mut touched);
            }
        }
        touched
    }

    fn retire_replaced(&mut self, ids: &Range<usize>, touched: &mut Vec<(TriangleId, Range<usize>)>) {
        let first = self.replaced.partition_point(|(id, _)| id.index() < ids.start);
        let in_range = self.replaced[first..].iter().take_while(|(id, _)| id.index() < ids.end);
        for (index, (id, pieces)) in (first..).zip(in_range) {
            if !std::mem::replace(&mut self.is_retired[index], true) {
                self.triangles[pieces.clone()].iter_mut().for_each(|piece| piece.set_outside(true));
                touched.push((*id, pieces.clone()));
            }
        }
    }

    fn retire_provisional(&mut self, ids: &Range<usize>, touched: &mut Vec<(TriangleId, Range<usize>)>) {
        let triangles = &mut self.triangles;
        self.provisional.retain(|id, pieces| {
            let stays = !ids.contains(&id.index());
            if !stays {
                triangles[pieces.clone()].iter_mut().for_each(|piece| piece.set_outside(true));
                touched.push((*id, pieces.clone()));
            }
            stays
        });
    }

    /// Appends a piece for a triangle of the mesh that has a moved node.
    fn push_provisional(
        &mut self,
        mesh: &Mesh,
        id: TriangleId,
        touched: &mut Vec<(TriangleId, Range<usize>)>,
    ) {
        let triangle = mesh.triangle(id);
        let shown = triangle.vertices.map(|node| self.shown_at(mesh, node));
        if triangle.is_outside() || shown == mesh.corners(id) {
            return;
        }
        let index = self.triangles.len();
        let own = Neighbour::from(TriangleId::from_index(index));
        let mut piece = *triangle;
        piece.raw_neighbours = mesh.neighbours(id).map(|n| if n.triangle().is_some() { own } else { n });
        piece.vertices = shown.map(|point| {
            self.nodes.push(point);
            NodeId::from_index(self.nodes.len() - 1)
        });
        self.triangles.push(piece);
        self.provisional.insert(id, index..index + 1);
        touched.push((id, index..index + 1));
    }

    /// Returns where a node of the mesh is drawn: where the patch has it, if it is still the node that was
    /// moved.
    fn shown_at(&self, mesh: &Mesh, node: NodeId) -> LatticePoint {
        let home = mesh.node(node);
        match self.moved.binary_search_by_key(&node, |(id, _)| *id) {
            Ok(index) if self.moved[index].1[0] == home => self.moved[index].1[1],
            _ => home,
        }
    }
}

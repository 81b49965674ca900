//! The triangles of a patch as arrays of their own, to be drawn over the mesh.

use std::ops::Range;

use super::{Extract, MeshPatch, PatchTriangle};
use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::kernel::{Changes, Mesh, Neighbour, NodeId, Triangle, TriangleId};

/// The triangles that are drawn in place of some triangles of a mesh: the pieces of a [`MeshPatch`].
///
/// ```text
///   mesh        o---o---o        pieces    nodes and triangles of their own; the triangles of the mesh
///               | \ | / |                  that they replace are not drawn
///               o---o---o
/// ```
///
/// The mesh may change before the patch is derived again. Whoever keeps a patch in step with the mesh
/// replaces the former pieces by those of the new patch ([`Self::replace`]). Otherwise, the pieces in place
/// of changed entries are *retired* ([`Self::retire`]), and the entries themselves are drawn. Where such an
/// entry has a node that the patch moved, a *provisional* piece is drawn instead, with the node where the
/// patch has it: the mesh has no gaps beside the other pieces.
#[derive(Clone, Debug, Default)]
pub struct PatchPieces {
    nodes: Vec<LatticePoint>,
    /// A neighbour only tells whether the edge is on the boundary of the domain.
    triangles: Vec<Triangle>,
    /// The replaced triangles in ascending order, with their ranges in `triangles`.
    replaced: Vec<(TriangleId, Range<usize>)>,
    is_retired: Vec<bool>,
    /// Triangles that were replaced later, and provisional pieces.
    later: NumberMap<TriangleId, Range<usize>>,
    /// Nodes that the patch moved, in ascending order: where the mesh has them, and the patch.
    moved: Vec<(NodeId, [LatticePoint; 2])>,
    /// The same for the corners of triangles that were replaced later.
    moved_later: NumberMap<NodeId, [LatticePoint; 2]>,
}

/// What is drawn in place of one triangle of a mesh, for [`PatchPieces::replace`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// The triangle of the mesh.
    pub id: TriangleId,
    /// Where its three nodes are drawn, in the order of [`Triangle::vertices`].
    pub nodes: [LatticePoint; 3],
    /// The triangles in its place; `None` if it is drawn itself.
    pub pieces: Option<Vec<DrawnPiece>>,
}

/// A triangle that is drawn in place of one of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnPiece {
    /// Anticlockwise, the first two the ends of the longest edge.
    pub corners: [LatticePoint; 3],
    /// Whether the edges from each corner to the next are on the boundary of the domain.
    pub on_boundary: [bool; 3],
}

impl PatchPieces {
    /// Returns the pieces of a patch; `extract` must be [`Mesh::extract_with`] of it.
    pub fn new(mesh: &Mesh, patch: &MeshPatch, extract: &Extract) -> Self {
        let moved = patch.moved.iter().map(|&(id, point)| (id, [mesh.node(id), point])).collect();
        let mut pieces = Self { is_retired: vec![false; patch.changed.len()], moved, ..Self::default() };
        let mut numbers: NumberMap<NodeId, NodeId> = NumberMap::default();
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

    fn push(&mut self, extract: &Extract, triangle: &Triangle, numbers: &mut NumberMap<NodeId, NodeId>) {
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
        active.chain(self.later.iter().map(|(id, pieces)| (*id, pieces.clone())))
    }

    /// Returns the part of [`Self::triangles`] that is drawn in place of a triangle of the mesh; `None` where
    /// the triangle itself is drawn.
    pub fn replacement(&self, id: TriangleId) -> Option<Range<usize>> {
        if let Some(pieces) = self.later.get(&id) {
            return Some(pieces.clone());
        }
        let index = self.replaced.binary_search_by_key(&id, |(replaced, _)| *replaced).ok()?;
        (!self.is_retired[index]).then(|| self.replaced[index].1.clone())
    }

    /// Retires the pieces in place of entries that changed or no longer exist, and appends provisional
    /// pieces. Returns the entries whose [`Self::replacement`] changed, each with a part of
    /// [`Self::triangles`] that changed.
    pub fn retire(&mut self, mesh: &Mesh, changes: &Changes) -> Vec<(TriangleId, Range<usize>)> {
        let mut touched = self.retire_changed(mesh, changes);
        if !(self.moved.is_empty() && self.moved_later.is_empty()) {
            let count = mesh.raw_triangle_count();
            for id in changes.triangles.iter().flat_map(|ids| ids.start..ids.end.min(count)) {
                self.push_provisional(mesh, TriangleId::from_index(id), &mut touched);
            }
        }
        touched
    }

    /// Draws other pieces in place of some triangles, after `changes` of the mesh; pieces in place of other
    /// changed entries are retired. The result is that of [`Self::retire`].
    pub fn replace(
        &mut self,
        mesh: &Mesh,
        changes: &Changes,
        replacements: impl IntoIterator<Item = Replacement>,
    ) -> Vec<(TriangleId, Range<usize>)> {
        let mut touched = self.retire_changed(mesh, changes);
        for Replacement { id, nodes, pieces } in replacements {
            self.retire_entry(id, &mut touched);
            for (&node, shown) in mesh.triangle(id).vertices.iter().zip(nodes) {
                if self.shown_at(mesh, node) != shown {
                    self.moved_later.insert(node, [mesh.node(node), shown]);
                }
            }
            let Some(pieces) = pieces else { continue };
            let (first, level) = (self.triangles.len(), mesh.triangle(id).level());
            pieces.iter().for_each(|piece| self.push_drawn(piece, level));
            self.later.insert(id, first..self.triangles.len());
            touched.push((id, first..self.triangles.len()));
        }
        touched
    }

    /// Retires the pieces in place of entries that changed or no longer exist.
    fn retire_changed(&mut self, mesh: &Mesh, changes: &Changes) -> Vec<(TriangleId, Range<usize>)> {
        let mut touched = Vec::new();
        let gone = mesh.raw_triangle_count()..usize::MAX;
        for ids in changes.triangles.iter().chain(std::iter::once(&gone)) {
            for id in self.replaced_within(ids) {
                self.retire_entry(id, &mut touched);
            }
        }
        touched
    }

    /// Returns the triangles of a range that may be replaced. Takes time proportional to the range or to the
    /// number of replaced triangles, whichever is smaller.
    fn replaced_within(&self, ids: &Range<usize>) -> Vec<TriangleId> {
        let first = self.replaced.partition_point(|(id, _)| id.index() < ids.start);
        let earlier = self.replaced[first..].iter().map(|(id, _)| *id);
        let mut found: Vec<TriangleId> = earlier.take_while(|id| id.index() < ids.end).collect();
        if ids.len() < self.later.len() {
            found.extend(ids.clone().map(TriangleId::from_index).filter(|id| self.later.contains_key(id)));
        } else {
            found.extend(self.later.keys().filter(|id| ids.contains(&id.index())));
        }
        found
    }

    /// Retires the pieces in place of an entry.
    fn retire_entry(&mut self, id: TriangleId, touched: &mut Vec<(TriangleId, Range<usize>)>) {
        let earlier = self.replaced.binary_search_by_key(&id, |(replaced, _)| *replaced).ok();
        let earlier = earlier.filter(|&n| !std::mem::replace(&mut self.is_retired[n], true));
        let earlier = earlier.map(|n| self.replaced[n].1.clone());
        for pieces in self.later.remove(&id).into_iter().chain(earlier) {
            self.triangles[pieces.clone()].iter_mut().for_each(|piece| piece.set_outside(true));
            touched.push((id, pieces));
        }
    }

    fn push_drawn(&mut self, piece: &DrawnPiece, level: u32) {
        let own = Neighbour::from(TriangleId::from_index(self.triangles.len()));
        let corners = piece.corners.map(|point| {
            self.nodes.push(point);
            NodeId::from_index(self.nodes.len() - 1)
        });
        let mut triangle = PatchTriangle { corners, level }.triangle();
        triangle.raw_neighbours =
            piece.on_boundary.map(|is_on_boundary| if is_on_boundary { Neighbour::BOUNDARY } else { own });
        self.triangles.push(triangle);
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
        self.later.insert(id, index..index + 1);
        touched.push((id, index..index + 1));
    }

    /// Returns where a node of the mesh is drawn: where the patch has it, if it is still the node that was
    /// moved.
    fn shown_at(&self, mesh: &Mesh, node: NodeId) -> LatticePoint {
        let home = mesh.node(node);
        if let Some([_, at]) = self.moved_later.get(&node).filter(|[former, _]| *former == home) {
            return *at;
        }
        match self.moved.binary_search_by_key(&node, |(id, _)| *id) {
            Ok(index) if self.moved[index].1[0] == home => self.moved[index].1[1],
            _ => home,
        }
    }
}

//! A mesh with some of its triangles replaced by others.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::Extract;
use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::kernel::{
    LevelAndSide, Mesh, Neighbour, NodeId, Orientation, Triangle, TriangleId, append_pieces,
};

/// What changes in a mesh when it is exported. All ids are indices into the mesh's own arrays
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
    /// The triangles that replace the changed ones.
    pub pieces: Vec<PatchTriangle>,
}

/// A triangle of a [`MeshPatch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchTriangle {
    /// Nodes, anticlockwise, the first two the ends of the longest edge.
    pub corners: [NodeId; 3],
    /// The level of the triangle of the mesh that it replaces.
    pub level: u32,
}

impl MeshPatch {
    /// Returns whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        self.moved.is_empty() && self.added.is_empty() && self.changed.is_empty()
    }

    /// Returns the position of a node of the mesh with the patch.
    pub fn node(&self, mesh: &Mesh, node: NodeId) -> LatticePoint {
        if let Some(added) = node.index().checked_sub(mesh.raw_nodes().len()) {
            return self.added[added];
        }
        let moved = self.moved.binary_search_by_key(&node, |(moved, _)| *moved);
        moved.map_or_else(|_| mesh.node(node), |n| self.moved[n].1)
    }

    /// Returns whether a mesh with the patch has no triangle left.
    pub fn leaves_nothing_of(&self, mesh: &Mesh) -> bool {
        let replaced = self.changed.iter().filter(|(id, _)| mesh.is_in_domain(*id)).count();
        self.pieces.is_empty() && replaced == mesh.triangle_count()
    }
}

impl PatchTriangle {
    /// Returns the triangle without neighbours.
    pub(super) fn triangle(&self) -> Triangle {
        let [a, b, c] = self.corners;
        // So that the first edge joins a to b.
        let vertices = if self.level.is_multiple_of(2) { [b, c, a] } else { [a, b, c] };
        Triangle::new(
            vertices,
            [Neighbour::BOUNDARY; 3],
            Orientation::Anticlockwise,
            LevelAndSide::inside(self.level),
        )
    }
}

impl Mesh {
    /// Returns the part of the mesh that belongs to the domain, with the changes of a patch. Pieces take the
    /// place of the triangles that they replace. All threads work on it.
    ///
    /// # Panics
    /// Panics when the patch is of another mesh.
    pub fn extract_with(&self, patch: &MeshPatch) -> Extract<'_> {
        if patch.is_empty() && self.outside_count() == 0 {
            return self.extract();
        }
        let chunks = chunks(self, patch);
        let places = places(self, &chunks);
        let mut triangles = assemble(self, patch, &chunks, &places);
        let (nodes, numbers) = used_nodes(self, patch, &triangles);
        triangles.par_iter_mut().for_each(|triangle| {
            triangle.vertices = triangle.vertices.map(|v| numbers[v.index()]);
        });
        Extract {
            lattice: self.lattice,
            nodes: Cow::Owned(nodes),
            triangles: Cow::Owned(triangles),
            places: Some(places),
            is_patched: !patch.is_empty(),
            coordinates: None,
        }
    }
}

/// Entries of an array that one thread handles at a time.
const CHUNK: usize = 1 << 13;

/// Triangles of the mesh, one after the other.
struct ExtractChunk<'a> {
    /// The number of the first one in the mesh.
    first: usize,
    triangles: &'a [Triangle],
    changed: &'a [(TriangleId, Range<usize>)],
    /// Number of triangles of the extract before the triangles of the chunk.
    before: usize,
    /// Triangles of the extract that take their place.
    count: usize,
}

/// The form of a triangle in the extract.
enum Fate<'a> {
    Kept(&'a Triangle),
    /// These pieces replace the triangle.
    Changed(Range<usize>),
    /// The triangle is not in the domain.
    LeftOut,
}

impl Fate<'_> {
    fn count(&self) -> usize {
        match self {
            Self::Kept(_) => 1,
            Self::Changed(pieces) => pieces.len(),
            Self::LeftOut => 0,
        }
    }
}

impl<'a> ExtractChunk<'a> {
    /// Returns the form of each triangle of the mesh in the extract.
    fn fates(&self) -> impl Iterator<Item = Fate<'a>> {
        let mut changed = self.changed.iter().peekable();
        let numbered = (self.first..).zip(self.triangles);
        numbered.map(move |(index, triangle)| match changed.next_if(|(id, _)| id.index() == index) {
            Some((_, pieces)) => Fate::Changed(pieces.clone()),
            None if triangle.is_outside() => Fate::LeftOut,
            None => Fate::Kept(triangle),
        })
    }
}

/// Returns the whole mesh in chunks.
fn chunks<'a>(mesh: &'a Mesh, patch: &'a MeshPatch) -> Vec<ExtractChunk<'a>> {
    let mut chunks = Vec::new();
    let chunk = |(n, triangles): (usize, &'a [Triangle])| {
        let first = CHUNK * n;
        let [begin, end] = [first, first + triangles.len()]
            .map(|index| patch.changed.partition_point(|(id, _)| id.index() < index));
        let mut chunk =
            ExtractChunk { first, triangles, changed: &patch.changed[begin..end], before: 0, count: 0 };
        chunk.count = chunk.fates().map(|fate| fate.count()).sum();
        chunk
    };
    mesh.triangles.par_chunks(CHUNK).enumerate().map(chunk).collect_into_vec(&mut chunks);
    let mut before = 0;
    for chunk in &mut chunks {
        chunk.before = before;
        before += chunk.count;
    }
    chunks
}

/// Returns for each triangle of the mesh its number in the extract, if it is in the domain and unchanged.
fn places(mesh: &Mesh, chunks: &[ExtractChunk]) -> Vec<Neighbour> {
    let mut places = vec![Neighbour::BOUNDARY; mesh.triangles.len()];
    places.par_chunks_mut(CHUNK).zip(chunks).for_each(|(places, chunk)| {
        let mut next = chunk.before;
        for (place, fate) in places.iter_mut().zip(chunk.fates()) {
            if matches!(fate, Fate::Kept(_)) {
                *place = TriangleId::from_index(next).into();
            }
            next += fate.count();
        }
    });
    places
}

/// Returns the triangles with their neighbours by their numbers in the extract, and nodes by their ids in the
/// mesh.
fn assemble(mesh: &Mesh, patch: &MeshPatch, chunks: &[ExtractChunk], places: &[Neighbour]) -> Vec<Triangle> {
    let mut is_changed = vec![false; mesh.triangles.len()];
    patch.changed.iter().for_each(|(id, _)| is_changed[id.index()] = true);
    let (mut triangles, mut unjoined) = (Vec::new(), Vec::new());
    append_pieces(&mut triangles, chunks.iter().map(|chunk| chunk.count), |_, parts| {
        let parts = parts.par_iter_mut().zip(chunks);
        let assembled = parts.map(|(part, chunk)| {
            let assembly = Assembly::of(chunk, patch, places, &is_changed);
            part.extend(assembly.triangles.into_iter());
            assembly.unjoined
        });
        assembled.collect_into_vec(&mut unjoined);
    });
    join(&mut triangles, unjoined.into_iter().flatten());
    triangles
}

/// The triangles of a chunk.
struct Assembly {
    triangles: Vec<Triangle>,
    /// Edges at which pieces lie: the number of a triangle in the extract, and its edge.
    unjoined: Vec<(usize, usize)>,
}

impl Assembly {
    fn of(chunk: &ExtractChunk, patch: &MeshPatch, places: &[Neighbour], is_changed: &[bool]) -> Self {
        let (mut triangles, mut unjoined) = (Vec::with_capacity(chunk.count), Vec::new());
        for fate in chunk.fates() {
            match fate {
                Fate::LeftOut => {}
                Fate::Kept(triangle) => {
                    let mut renumbered = *triangle;
                    for (j, across) in renumbered.raw_neighbours.iter_mut().enumerate() {
                        let Some(id) = across.triangle() else { continue };
                        *across = places[id.index()];
                        if is_changed[id.index()] {
                            unjoined.push((chunk.before + triangles.len(), j));
                        }
                    }
                    triangles.push(renumbered);
                }
                Fate::Changed(pieces) => {
                    for piece in &patch.pieces[pieces] {
                        unjoined.extend((0..3).map(|j| (chunk.before + triangles.len(), j)));
                        triangles.push(piece.triangle());
                    }
                }
            }
        }
        Self { triangles, unjoined }
    }
}

/// Links triangles that share an edge, in opposite directions, as neighbours.
pub(super) fn join(triangles: &mut [Triangle], edges: impl Iterator<Item = (usize, usize)>) {
    // Edges with one known triangle.
    let mut open: NumberMap<(NodeId, NodeId), (usize, usize)> = NumberMap::default();
    for (index, j) in edges {
        let (from, to) = triangles[index].edge_nodes()[j];
        match open.remove(&(to, from)) {
            Some((other, k)) => {
                triangles[index].raw_neighbours[j] = TriangleId::from_index(other).into();
                triangles[other].raw_neighbours[k] = TriangleId::from_index(index).into();
            }
            None => {
                open.insert((from, to), (index, j));
            }
        }
    }
}

/// Returns the nodes that the triangles use, in the order of their ids, and for each id its number among
/// them.
fn used_nodes(mesh: &Mesh, patch: &MeshPatch, triangles: &[Triangle]) -> (Vec<LatticePoint>, Vec<NodeId>) {
    let mut points: Vec<LatticePoint> = mesh.nodes.iter().chain(&patch.added).copied().collect();
    patch.moved.iter().for_each(|&(id, point)| points[id.index()] = point);
    let mut used = Vec::new();
    used.resize_with(points.len(), AtomicBool::default);
    triangles.par_iter().flat_map_iter(|triangle| triangle.vertices).for_each(|vertex| {
        // Only ever set, and read after all threads have joined.
        used[vertex.index()].store(true, Ordering::Relaxed);
    });
    let (mut nodes, mut numbers) = (Vec::new(), Vec::with_capacity(points.len()));
    for (point, used) in points.into_iter().zip(used) {
        numbers.push(NodeId::from_index(nodes.len()));
        nodes.extend(used.into_inner().then_some(point));
    }
    (nodes, numbers)
}

//! Numbers the triangles and nodes of blocks, and writes them.
//!
//! ```text
//!   triangles   first ones of all blocks │ others of block 0 │ others of block 1 │ …
//!   nodes       those of the skeleton    │ of block 0        │ of block 1        │ …
//! ```
//!
//! So the entry with the index of a triangle of the skeleton lies in that triangle, as after bisections one
//! by one. Nodes within an edge belong to the block with the lower number.

use std::ops::Range;

use rayon::prelude::*;

use super::skeleton::{Blocks, edge_shared_with};
use super::template::{Side, Template, nodes_within};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::memory::{Piece, append_pieces};
use crate::mesh::kernel::{
    KindCounts, LimitError, Limits, Mesh, Neighbour, NodeId, Progress, Triangle, TriangleId,
};

/// About so many triangles are a chunk, which is written by one thread.
const CHUNK_TRIANGLES: usize = 1 << 14;
/// The fewest chunks of a slice for each thread.
const CHUNKS_PER_THREAD: usize = 2;
/// Entries of the skeleton that are copied in the time of a visit.
const COPIES_PER_VISIT: usize = 8;

/// Writes blocks to the arrays of a mesh, in slices.
#[derive(Clone, Debug)]
pub(super) struct Writer {
    blocks: Blocks,
    /// The numbers of the first blocks, as far as they are assigned.
    numbers: Vec<Numbers>,
    /// The next numbers that are free.
    free: Free,
    counts: KindCounts,
    /// How many entries of the skeleton are in the mesh.
    copied: usize,
    chunks: Vec<Chunk>,
    /// The first chunk that is not written.
    next: usize,
}

/// The first numbers that no block has.
#[derive(Clone, Copy, Debug)]
struct Free {
    triangle: u32,
    node: u32,
}

/// The indices of the triangles and nodes of a block in the mesh.
#[derive(Clone, Copy, Debug)]
struct Numbers {
    /// The index of the first triangle of the block if the block's triangles were consecutive; the first one
    /// is elsewhere.
    triangles: u32,
    /// The index of the block's first own node: the nodes within the edges that belong to it come first, in
    /// the order of the edges, then the nodes inside.
    nodes: u32,
}

/// Consecutive blocks.
#[derive(Clone, Debug)]
struct Chunk {
    blocks: Range<usize>,
    /// Number of triangles without the first ones of the blocks.
    triangles: usize,
    nodes: usize,
}

impl Writer {
    /// Creates the work of writing blocks, with nothing written yet.
    pub fn new(blocks: Blocks) -> Self {
        let skeleton = &blocks.mesh;
        let free = Free { triangle: skeleton.triangles.len() as u32, node: skeleton.nodes.len() as u32 };
        let (numbers, counts, chunks) = Default::default();
        Self { numbers, free, counts, copied: 0, chunks, next: 0, blocks }
    }

    /// Numbers about `visits` blocks, or writes about as many triangles, or more to occupy all threads.
    ///
    /// # Errors
    /// Fails when the system has no more memory.
    pub fn advance(
        &mut self,
        mesh: &mut Mesh,
        limits: &Limits,
        visits: usize,
    ) -> Result<Progress, LimitError> {
        if self.numbers.len() < self.blocks.depths.len() {
            self.number(visits);
            return Ok(Progress::More);
        }
        if self.copied < self.blocks.mesh.triangles.len().max(self.blocks.mesh.nodes.len()) {
            self.copy_skeleton(mesh, limits, visits)?;
            return Ok(Progress::More);
        }
        let count = (visits / CHUNK_TRIANGLES).max(CHUNKS_PER_THREAD * rayon::current_num_threads());
        let chunks = &self.chunks[self.next..];
        self.write(mesh, &chunks[..count.min(chunks.len())]);
        self.next += count.min(chunks.len());
        Ok(if self.next == self.chunks.len() { Progress::Done } else { Progress::More })
    }

    /// Puts the skeleton in place of the contents of `mesh`, and makes room for the triangles of all blocks.
    fn copy_skeleton(&mut self, mesh: &mut Mesh, limits: &Limits, visits: usize) -> Result<(), LimitError> {
        let skeleton = &self.blocks.mesh;
        if self.copied == 0 {
            mesh.triangles.clear();
            mesh.nodes.clear();
            mesh.triangle_at.clear();
            mesh.make_room(self.free.triangle as usize, limits.most_triangles())?;
            mesh.counts = self.counts;
        }
        let end = visits.max(1).saturating_mul(COPIES_PER_VISIT).saturating_add(self.copied);
        let part = |length: usize| self.copied.min(length)..end.min(length);
        let nodes = part(skeleton.nodes.len());
        mesh.triangles.extend_from_slice(&skeleton.triangles[part(skeleton.triangles.len())]);
        mesh.nodes.extend_from_slice(&skeleton.nodes[nodes.clone()]);
        let nodes = nodes.into_par_iter().map(NodeId::from_index);
        mesh.triangle_at.par_extend(nodes.map(|node| self.triangle_at_corner(node)));
        self.copied = end;
        Ok(())
    }

    fn write(&self, mesh: &mut Mesh, chunks: &[Chunk]) {
        let nodes = |chunk: &Chunk| chunk.nodes;
        append_chunks(&mut mesh.nodes, chunks, nodes, |chunk, piece| self.write_nodes(chunk, piece));
        let places = &mut mesh.triangle_at;
        append_chunks(places, chunks, nodes, |chunk, piece| self.write_triangles_at(chunk, piece));
        let triangles = |chunk: &Chunk| chunk.triangles;
        let first = append_chunks(&mut mesh.triangles, chunks, triangles, |chunk, piece| {
            self.write_triangles(chunk, piece)
        });
        for (chunk, first) in chunks.iter().zip(first) {
            mesh.triangles[chunk.blocks.clone()].copy_from_slice(&first);
        }
    }

    /// Gives the triangles and nodes of the next blocks their numbers, and divides the blocks into chunks.
    fn number(&mut self, visits: usize) {
        let first = self.numbers.len();
        let end = first.saturating_add(visits).min(self.blocks.depths.len());
        for block in first..end {
            let before = self.free;
            self.number_block(block);
            let triangles = (self.free.triangle - before.triangle) as usize;
            let nodes = (self.free.node - before.node) as usize;
            match self.chunks.last_mut().filter(|chunk| chunk.triangles < CHUNK_TRIANGLES) {
                Some(chunk) => {
                    chunk.blocks.end = block + 1;
                    chunk.triangles += triangles;
                    chunk.nodes += nodes;
                }
                None => self.chunks.push(Chunk { blocks: block..block + 1, triangles, nodes }),
            }
        }
    }

    fn number_block(&mut self, block: usize) {
        let depth = u32::from(self.blocks.depths[block]);
        let kind = self.blocks.mesh.triangles[block].kind();
        self.counts.add_many(kind.finer_by(depth), 1 << depth);
        self.numbers.push(Numbers { triangles: self.free.triangle - 1, nodes: self.free.node });
        self.free.triangle += (1 << depth) - 1;
        let own: usize = self.own_slots(block).map(|slots| slots.len()).sum();
        self.free.node += own as u32;
    }

    /// Returns where the nodes within the first edges of a block, up to this one, begin that belong to it.
    fn own_nodes_within(&self, block: usize, edge: usize) -> u32 {
        let depth = u32::from(self.blocks.depths[block]);
        let before = (0..edge).filter(|&edge| self.owner(block, edge).is_none());
        self.numbers[block].nodes + before.map(|edge| nodes_within(depth, edge)).sum::<u32>()
    }

    /// Returns the other block that the nodes within an edge belong to, and its number of the edge; `None`
    /// where they belong to this one.
    #[inline]
    fn owner(&self, block: usize, edge: usize) -> Option<(TriangleId, usize)> {
        let skeleton = &self.blocks.mesh;
        let across = skeleton.triangles[block].raw_neighbours[edge].triangle()?;
        let id = TriangleId::from_index(block);
        (across < id).then(|| (across, edge_shared_with(skeleton, across, id)))
    }

    #[inline]
    fn template(&self, block: usize) -> &'static Template {
        Template::of(&self.blocks.mesh.triangles[block], u32::from(self.blocks.depths[block]))
    }

    /// Returns the number of a triangle of a block in the mesh.
    #[inline]
    fn triangle(&self, block: TriangleId, triangle: u32) -> TriangleId {
        if triangle == 0 { block } else { TriangleId(self.numbers[block.index()].triangles + triangle) }
    }

    /// Returns a triangle around a node of the skeleton.
    fn triangle_at_corner(&self, node: NodeId) -> TriangleId {
        let block = self.blocks.mesh.triangle_at[node.index()];
        let vertices = self.blocks.mesh.triangle(block).vertices;
        let corner = vertices.iter().position(|&vertex| vertex == node).expect("the triangle has the node");
        self.triangle(block, self.template(block.index()).triangle_at[corner])
    }

    /// Returns the slots of the nodes that belong to a block, without its corners.
    fn own_slots(&self, block: usize) -> impl Iterator<Item = Range<usize>> {
        let template = self.template(block);
        let mut first = 3;
        let on_edges = (0..3).filter_map(move |edge| {
            let slots = first..first + template.nodes_within(edge) as usize;
            first = slots.end;
            self.owner(block, edge).is_none().then_some(slots)
        });
        on_edges.chain([template.inner_slots()])
    }

    fn write_nodes(&self, chunk: &Chunk, nodes: &mut Piece<LatticePoint>) {
        for block in chunk.blocks.clone() {
            let (template, corners) =
                (self.template(block), self.blocks.mesh.corners(TriangleId::from_index(block)));
            for slots in self.own_slots(block) {
                nodes.extend(slots.map(|slot| template.point(slot, corners)));
            }
        }
    }

    fn write_triangles_at(&self, chunk: &Chunk, triangle_at: &mut Piece<TriangleId>) {
        for block in chunk.blocks.clone() {
            let (template, id) = (self.template(block), TriangleId::from_index(block));
            for slots in self.own_slots(block) {
                triangle_at.extend(slots.map(|slot| self.triangle(id, template.triangle_at[slot])));
            }
        }
    }

    /// Returns the first triangles of the blocks.
    fn write_triangles(&self, chunk: &Chunk, piece: &mut Piece<Triangle>) -> Vec<Triangle> {
        let mut first = Vec::with_capacity(chunk.blocks.len());
        let (mut nodes, mut triangles) = (Vec::new(), Vec::new());
        for block in chunk.blocks.clone() {
            self.node_ids(block, &mut nodes);
            self.triangles(block, &nodes, &mut triangles);
            first.push(triangles[0]);
            piece.extend(triangles[1..].iter().copied());
        }
        first
    }

    /// The nodes of all slots of a block.
    fn node_ids(&self, block: usize, ids: &mut Vec<NodeId>) {
        let template = self.template(block);
        let mut own = self.numbers[block].nodes;
        ids.clear();
        ids.extend(self.blocks.mesh.triangles[block].vertices);
        for edge in 0..3 {
            let count = template.nodes_within(edge);
            match self.owner(block, edge) {
                None => {
                    ids.extend((own..own + count).map(NodeId));
                    own += count;
                }
                Some(_) if count == 0 => {}
                Some((owner, edge)) => {
                    // The other block passes along the edge in the other direction.
                    let first = self.own_nodes_within(owner.index(), edge);
                    ids.extend((first..first + count).rev().map(NodeId));
                }
            }
        }
        ids.extend((own..).take(template.inner_slots().len()).map(NodeId));
    }

    /// The triangles of a block with these nodes.
    fn triangles(&self, block: usize, nodes: &[NodeId], triangles: &mut Vec<Triangle>) {
        let (skeleton, template) = (&self.blocks.mesh, self.template(block));
        let (places, kind) = (self.numbers[block].triangles, skeleton.triangles[block].kind());
        let kind = kind.finer_by(u32::from(self.blocks.depths[block]));
        triangles.clear();
        triangles.extend(template.triangles.iter().map(|triangle| {
            let vertices = triangle.vertices.map(|slot| nodes[slot.index()]);
            triangle.renumbered(vertices, triangle.raw_neighbours.map(|n| n.behind(places)), kind)
        }));
        let id = TriangleId::from_index(block);
        for side in &template.around_first {
            triangles[side.triangle as usize].raw_neighbours[usize::from(side.edge)] = id.into();
        }
        for edge in 0..3 {
            self.link(id, edge, triangles);
        }
    }

    /// Sets what lies across an edge of a block.
    fn link(&self, block: TriangleId, edge: usize, triangles: &mut [Triangle]) {
        let here = self.template(block.index()).borders[edge].iter();
        let mut set = |side: &Side, across: Neighbour| {
            triangles[side.triangle as usize].raw_neighbours[usize::from(side.edge)] = across;
        };
        let skeleton = &self.blocks.mesh;
        let Some(across) = skeleton.triangle(block).raw_neighbours[edge].triangle() else {
            return here.for_each(|side| set(side, Neighbour::BOUNDARY));
        };
        let there = &self.template(across.index()).borders[edge_shared_with(skeleton, across, block)];
        for (side, other) in here.zip(there.iter().rev()) {
            set(side, self.triangle(across, other.triangle).into());
        }
    }
}

/// Appends what `write` writes for each chunk, on all threads.
fn append_chunks<T: Copy + Send, R: Send>(
    array: &mut Vec<T>,
    chunks: &[Chunk],
    length: fn(&Chunk) -> usize,
    write: impl Fn(&Chunk, &mut Piece<T>) -> R + Sync,
) -> Vec<R> {
    let mut written = Vec::new();
    append_pieces(array, chunks.iter().map(length), |pieces| {
        let pieces = pieces.par_iter_mut().zip(chunks).with_max_len(1);
        pieces.map(|(piece, chunk)| write(chunk, piece)).collect_into_vec(&mut written);
    });
    written
}

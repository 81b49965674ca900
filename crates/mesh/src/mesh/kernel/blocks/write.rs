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
use std::slice;

use rayon::prelude::*;

use super::shape::Shape;
use super::template::{Template, TemplateEdge, nodes_within};
use crate::geometry::LatticePoint;
use crate::mesh::kernel::memory::{SpareRoom, append_pieces};
use crate::mesh::kernel::{
    LevelAndSideCounts, LimitError, Limits, Mesh, Neighbour, NodeId, Progress, Triangle, TriangleId,
};

/// About the number of triangles in a range of blocks, which one thread writes.
const CHUNK_TRIANGLES: usize = 1 << 14;
/// The fewest chunks of a slice for each thread.
const CHUNKS_PER_THREAD: usize = 2;
/// Nodes of the skeleton that are looked at in the time of a visit.
const NODES_PER_VISIT: usize = 8;

/// Writes blocks to the arrays of their skeleton, in slices.
#[derive(Clone, Debug)]
pub(super) struct Writer {
    depths: Vec<u8>,
    /// The first blocks, as their neighbours see them, as far as numbers are assigned.
    shapes: Vec<Shape>,
    /// The numbers of the first blocks, as far as they are assigned.
    numbers: Vec<Numbers>,
    /// The next numbers that are free.
    free: Free,
    counts: LevelAndSideCounts,
    /// The number of nodes of the skeleton, and how many of them have a triangle of a block.
    corners: usize,
    settled_corners: usize,
    chunks: Vec<BlockRange>,
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
struct BlockRange {
    blocks: Range<usize>,
    /// Number of triangles without the first ones of the blocks.
    triangles: usize,
    nodes: usize,
}

impl Writer {
    /// Creates the work of refining each triangle of `skeleton` by the number of levels in `depths`, with
    /// nothing written yet.
    pub fn new(skeleton: &Mesh, depths: Vec<u8>) -> Self {
        let corners = skeleton.nodes.len();
        let free = Free { triangle: skeleton.triangles.len() as u32, node: corners as u32 };
        Self {
            shapes: Vec::with_capacity(depths.len()),
            numbers: Vec::with_capacity(depths.len()),
            free,
            counts: LevelAndSideCounts::default(),
            corners,
            settled_corners: 0,
            chunks: Vec::new(),
            next: 0,
            depths,
        }
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
        if self.numbers.len() < self.depths.len() {
            self.number(mesh, visits);
            return Ok(Progress::More);
        }
        if self.settled_corners < self.corners {
            if self.settled_corners == 0 {
                let more = self.free.triangle as usize - mesh.triangles.len();
                mesh.make_room(more, limits.most_triangles())?;
                mesh.counts = self.counts;
            }
            self.settle_corners(mesh, visits);
            return Ok(Progress::More);
        }
        let count = (visits / CHUNK_TRIANGLES).max(CHUNKS_PER_THREAD * rayon::current_num_threads());
        let chunks = &self.chunks[self.next..];
        let chunks = &chunks[..count.min(chunks.len())];
        self.write(mesh, chunks);
        self.next += chunks.len();
        Ok(if self.next == self.chunks.len() { Progress::Done } else { Progress::More })
    }

    /// Gives the next nodes of the skeleton a triangle of a block.
    fn settle_corners(&mut self, mesh: &mut Mesh, visits: usize) {
        let first = self.settled_corners;
        let end = visits.max(1).saturating_mul(NODES_PER_VISIT).saturating_add(first).min(self.corners);
        let triangles = &mesh.triangles;
        let places = mesh.triangle_at[first..end].par_iter_mut().enumerate();
        places.for_each(|(behind, place)| {
            *place = self.triangle_at_corner(triangles, *place, NodeId::from_index(first + behind));
        });
        self.settled_corners = end;
    }

    fn write(&self, mesh: &mut Mesh, chunks: &[BlockRange]) {
        let nodes = |chunk: &BlockRange| chunk.nodes;
        let triangles = &mesh.triangles;
        append_pieces(&mut mesh.nodes, chunks.iter().map(nodes), |corners, pieces| {
            let work = pieces.par_iter_mut().zip(chunks).with_max_len(1);
            work.for_each(|(piece, chunk)| self.write_nodes(chunk, triangles, corners, piece));
        });
        append_pieces(&mut mesh.triangle_at, chunks.iter().map(nodes), |_, pieces| {
            let work = pieces.par_iter_mut().zip(chunks).with_max_len(1);
            work.for_each(|(piece, chunk)| self.write_triangles_at(chunk, piece));
        });
        append_pieces(&mut mesh.triangles, chunks.iter().map(|chunk| chunk.triangles), |present, pieces| {
            let blocks = parts(present, chunks);
            let work = pieces.par_iter_mut().zip(blocks).zip(chunks).with_max_len(1);
            work.for_each(|((piece, blocks), chunk)| self.write_triangles(chunk, blocks, piece));
        });
    }

    /// Gives the triangles and nodes of the next blocks their numbers, and divides the blocks into chunks.
    fn number(&mut self, skeleton: &Mesh, visits: usize) {
        let first = self.numbers.len();
        let end = first.saturating_add(visits).min(self.depths.len());
        for block in first..end {
            let before = self.free;
            self.number_block(skeleton, block);
            let triangles = (self.free.triangle - before.triangle) as usize;
            let nodes = (self.free.node - before.node) as usize;
            let has_room = |chunk: &&mut BlockRange| chunk.blocks.len() + chunk.triangles < CHUNK_TRIANGLES;
            match self.chunks.last_mut().filter(has_room) {
                Some(chunk) => {
                    chunk.blocks.end = block + 1;
                    chunk.triangles += triangles;
                    chunk.nodes += nodes;
                }
                None => self.chunks.push(BlockRange { blocks: block..block + 1, triangles, nodes }),
            }
        }
        if end == self.depths.len() {
            // The shapes have them.
            self.depths = Vec::new();
        }
    }

    fn number_block(&mut self, skeleton: &Mesh, block: usize) {
        let depth = u32::from(self.depths[block]);
        let kind = skeleton.triangles[block].level_and_side();
        self.counts.add_many(kind.finer_by(depth), 1 << depth);
        let shape = Shape::new(skeleton, TriangleId::from_index(block), depth);
        self.shapes.push(shape);
        self.numbers.push(Numbers { triangles: self.free.triangle - 1, nodes: self.free.node });
        self.free.triangle += (1 << depth) - 1;
        let own: usize = own_slots(shape).map(|slots| slots.len()).sum();
        self.free.node += own as u32;
    }

    /// Returns where the nodes within the first edges of a block, up to this one, begin that belong to it.
    fn own_nodes_within(&self, block: usize, edge: usize) -> u32 {
        let shape = self.shapes[block];
        let before = (0..edge).filter(|&edge| shape.owns(edge));
        self.numbers[block].nodes + before.map(|edge| nodes_within(shape.depth(), edge)).sum::<u32>()
    }

    /// Returns the number of a triangle of a block in the mesh.
    #[inline]
    fn triangle(&self, block: TriangleId, triangle: u32) -> TriangleId {
        if triangle == 0 { block } else { TriangleId(self.numbers[block.index()].triangles + triangle) }
    }

    /// Returns a triangle around a node of the skeleton, which has this block.
    fn triangle_at_corner(&self, skeleton: &[Triangle], block: TriangleId, node: NodeId) -> TriangleId {
        let shape = self.shapes[block.index()];
        if shape.is_one() {
            return block;
        }
        let vertices = skeleton[block.index()].vertices;
        let corner = vertices.iter().position(|&vertex| vertex == node).expect("the triangle has the node");
        self.triangle(block, shape.template().triangle_at[corner])
    }

    /// Returns the blocks of a chunk that have more than one triangle: the others have no nodes of their own.
    fn divided_blocks(&self, chunk: &BlockRange) -> impl Iterator<Item = (usize, Shape)> {
        chunk.blocks.clone().map(|block| (block, self.shapes[block])).filter(|(_, shape)| !shape.is_one())
    }

    fn write_nodes(
        &self,
        chunk: &BlockRange,
        skeleton: &[Triangle],
        corners: &[LatticePoint],
        nodes: &mut SpareRoom<LatticePoint>,
    ) {
        for (block, shape) in self.divided_blocks(chunk) {
            let corners = skeleton[block].vertices.map(|vertex| corners[vertex.index()]);
            for slots in own_slots(shape) {
                nodes.extend(slots.map(|slot| shape.template().point(slot, corners)));
            }
        }
    }

    fn write_triangles_at(&self, chunk: &BlockRange, triangle_at: &mut SpareRoom<TriangleId>) {
        for (block, shape) in self.divided_blocks(chunk) {
            let id = TriangleId::from_index(block);
            for slots in own_slots(shape) {
                triangle_at.extend(slots.map(|slot| self.triangle(id, shape.template().triangle_at[slot])));
            }
        }
    }

    /// Writes the triangles of blocks: the first one of each in the place of the block.
    fn write_triangles(&self, chunk: &BlockRange, blocks: &mut [Triangle], piece: &mut SpareRoom<Triangle>) {
        let (mut nodes, mut triangles) = (Vec::new(), Vec::new());
        for (block, number) in blocks.iter_mut().zip(chunk.blocks.clone()) {
            let shape = self.shapes[number];
            if shape.is_one() {
                self.link_one(shape, block);
                continue;
            }
            self.node_ids(number, block, &mut nodes);
            self.triangles(number, block, &nodes, &mut triangles);
            *block = triangles[0];
            piece.extend(triangles[1..].iter().copied());
        }
    }

    /// The nodes of all slots of a block.
    fn node_ids(&self, number: usize, block: &Triangle, ids: &mut Vec<NodeId>) {
        let shape = self.shapes[number];
        let template = shape.template();
        let mut own = self.numbers[number].nodes;
        ids.clear();
        ids.extend(block.vertices);
        for edge in 0..3 {
            let count = template.nodes_within(edge);
            match block.raw_neighbours[edge].triangle() {
                Some(owner) if count > 0 && !shape.owns(edge) => {
                    // The other block passes along the edge in the other direction.
                    let first = self.own_nodes_within(owner.index(), shape.edge_across(edge));
                    ids.extend((first..first + count).rev().map(NodeId));
                }
                _ if shape.owns(edge) => {
                    ids.extend((own..own + count).map(NodeId));
                    own += count;
                }
                _ => {}
            }
        }
        ids.extend((own..).take(template.inner_slots().len()).map(NodeId));
    }

    /// The triangles of a block with these nodes.
    fn triangles(&self, number: usize, block: &Triangle, nodes: &[NodeId], triangles: &mut Vec<Triangle>) {
        let (shape, places) = (self.shapes[number], self.numbers[number].triangles);
        let (template, kind) = (shape.template(), block.level_and_side().finer_by(shape.depth()));
        triangles.clear();
        triangles.extend(template.triangles.iter().map(|triangle| {
            let vertices = triangle.vertices.map(|slot| nodes[slot.index()]);
            triangle.renumbered(vertices, triangle.raw_neighbours.map(|n| n.behind(places)), kind)
        }));
        let id = TriangleId::from_index(number);
        for side in &template.around_first {
            triangles[side.triangle as usize].raw_neighbours[usize::from(side.edge)] = id.into();
        }
        for edge in 0..3 {
            self.link(shape, edge, block.raw_neighbours[edge], triangles);
        }
    }

    /// Sets what lies across the edges of a block of one triangle. That is another triangle only where the
    /// block there is divided.
    fn link_one(&self, shape: Shape, block: &mut Triangle) {
        for (edge, across) in block.raw_neighbours.into_iter().enumerate() {
            if across.triangle().is_some_and(|across| !self.shapes[across.index()].is_one()) {
                self.link(shape, edge, across, slice::from_mut(block));
            }
        }
    }

    /// Sets what lies across an edge of a block.
    fn link(&self, shape: Shape, edge: usize, across: Neighbour, triangles: &mut [Triangle]) {
        let here = shape.template().borders[edge].iter();
        let mut set = |side: &TemplateEdge, across: Neighbour| {
            triangles[side.triangle as usize].raw_neighbours[usize::from(side.edge)] = across;
        };
        let Some(across) = across.triangle() else {
            return here.for_each(|side| set(side, Neighbour::BOUNDARY));
        };
        let there = &self.shapes[across.index()].template().borders[shape.edge_across(edge)];
        for (side, other) in here.zip(there.iter().rev()) {
            set(side, self.triangle(across, other.triangle).into());
        }
    }
}

/// Returns the slots of the nodes that belong to a block, without its corners.
fn own_slots(shape: Shape) -> impl Iterator<Item = Range<usize>> {
    let template: &Template = shape.template();
    let mut first = 3;
    let on_edges = (0..3).filter_map(move |edge| {
        let slots = first..first + template.nodes_within(edge) as usize;
        first = slots.end;
        shape.owns(edge).then_some(slots)
    });
    on_edges.chain([template.inner_slots()])
}

/// Returns the entries of the blocks of each chunk; the chunks are consecutive.
fn parts<'a>(entries: &'a mut [Triangle], chunks: &[BlockRange]) -> Vec<&'a mut [Triangle]> {
    let first = chunks.first().map_or(0, |chunk| chunk.blocks.start);
    let mut rest = &mut entries[first..];
    let mut parts = Vec::with_capacity(chunks.len());
    for chunk in chunks {
        let (part, behind) = rest.split_at_mut(chunk.blocks.len());
        parts.push(part);
        rest = behind;
    }
    parts
}

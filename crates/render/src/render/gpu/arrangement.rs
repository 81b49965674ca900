//! The triangles of a large mesh in the order in which their details are needed.
//!
//! Consecutive entries of the array are a *block*. An arranged block has a rectangle around its triangles, so
//! that it is skipped where it is out of sight, and a list of its entries: first those that represent the
//! coarsest ancestors ([`Detail`](crate::scene::Detail)). At any detail level the triangles to draw are then
//! the beginning of the list:
//!
//! ```text
//!   block    ░░░░░░░░░░░░░░░░░░░░░░░░        entries in the order of the array
//!   list     3 17 8 │ 4 22 │ 0 1 2 5 6 …     by the coarsest level that they represent
//!            level 9  10     11
//!            └──── drawn ──┘                 at detail level 10
//! ```
//!
//! The picture does not depend on which blocks are arranged. In the others, the shader looks at all triangles
//! and decides which of them represent an ancestor. So a block that an edit has changed simply stops being
//! arranged, until there is time to arrange it again.

use std::ops::Range;

use rayon::prelude::*;

use super::chunks::ChunkedArray;
use super::device::Gpu;
use super::error::GpuError;
use crate::colormap::LEVELS;
use crate::render::software::on_drawing_threads;
use crate::scene::{InnerPoint, coarsest_represented};
use meshbrush_mesh::geometry::{LatticePoint, LatticeRect};
use meshbrush_mesh::mesh::{Mesh, Progress};

/// Entries of a block: few enough that blocks are small on the plane, so that most of those that are drawn
/// are in sight, and enough that a frame has few calls. Mesh.wgsl has the same number.
const BLOCK: usize = 1 << 14;
/// Places of the list in a word that the shader reads.
const PLACES_PER_WORD: usize = 2;
/// More words than any list has. All are in one buffer.
const MOST_WORDS: usize = 1 << 30;

/// The blocks of a mesh, and the lists of those that are arranged.
pub(super) struct Arrangement {
    /// Triangles in a buffer of triangles. No block is in two of them.
    chunk: usize,
    triangles: usize,
    blocks: Vec<Option<Arranged>>,
    words: ChunkedArray,
}

/// An arranged block.
struct Arranged {
    rect: LatticeRect,
    /// For each detail level the length of the beginning of the list that is drawn.
    drawn: [u32; LEVELS],
}

/// Consecutive triangles of a buffer that are drawn by one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    /// The first one, as an entry of the buffer or as a place in the lists of the buffer.
    pub(super) first: u32,
    pub(super) count: u32,
    pub(super) is_listed: bool,
}

impl Arrangement {
    pub(super) fn new(chunk: usize) -> Self {
        let words = ChunkedArray::new::<u32>("order of triangles", MOST_WORDS);
        Self { chunk, triangles: 0, blocks: Vec::new(), words }
    }

    /// Forgets all blocks.
    pub(super) fn clear(&mut self) {
        (self.triangles, self.blocks) = (0, Vec::new());
    }

    /// Follows the length of the array. Blocks that become longer or shorter are not arranged any more.
    pub(super) fn resize(&mut self, triangles: usize) {
        if triangles == self.triangles {
            return;
        }
        let (shorter, former) = (triangles.min(self.triangles), self.triangles);
        self.triangles = triangles;
        let count = triangles.div_ceil(self.chunk) * self.blocks_in_chunk();
        self.blocks.resize_with(count, || None);
        self.forget(shorter..former.max(triangles));
    }

    /// Notes that entries have changed.
    pub(super) fn forget(&mut self, entries: Range<usize>) {
        if entries.is_empty() {
            return;
        }
        let (first, last) = (self.block_of(entries.start), self.block_of(entries.end - 1));
        let end = (last + 1).min(self.blocks.len());
        if let Some(blocks) = self.blocks.get_mut(first..end) {
            blocks.fill_with(|| None);
        }
    }

    /// Returns the buffer of the lists, if there are any.
    pub(super) fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.words.chunks().first()
    }

    /// Returns the first place in the lists of a buffer of triangles.
    pub(super) fn first_place(&self, chunk: usize) -> usize {
        chunk * self.blocks_in_chunk() * self.places_of_block()
    }

    /// Returns whether all blocks are arranged.
    pub(super) fn is_complete(&self) -> bool {
        self.blocks.iter().enumerate().all(|(block, arranged)| arranged.is_some() || self.is_empty(block))
    }

    /// Makes room for the lists. Returns whether the buffer was replaced, or `None` where the device cannot
    /// bind one that is large enough.
    pub(super) fn fit(&mut self, gpu: &Gpu) -> Result<Option<bool>, GpuError> {
        let words = self.blocks.len() * self.places_of_block() / PLACES_PER_WORD;
        if (words * size_of::<u32>()) as u64 > gpu.largest_binding() {
            return Ok(None);
        }
        let replaced = self.words.reserve(gpu.device(), gpu.queue(), words, 0)?;
        if replaced {
            self.blocks.fill_with(|| None);
        }
        Ok(Some(replaced))
    }

    /// Arranges up to `count` more blocks of the mesh, on all threads that draw.
    pub(super) fn advance(&mut self, queue: &wgpu::Queue, mesh: &Mesh, count: usize) -> Progress {
        let open =
            (0..self.blocks.len()).filter(|&block| self.blocks[block].is_none() && !self.is_empty(block));
        let open: Vec<usize> = open.take(count).collect();
        let arrange = |&block: &usize| arranged(mesh, self.entries(block));
        let arranged: Vec<_> = on_drawing_threads(|| open.par_iter().with_max_len(1).map(arrange).collect());
        for (block, (arranged, places)) in open.into_iter().zip(arranged) {
            let first_word = block * self.places_of_block() / PLACES_PER_WORD;
            self.words.write(queue, first_word, bytemuck::cast_slice(&places));
            self.blocks[block] = Some(arranged);
        }
        if self.is_complete() { Progress::Done } else { Progress::More }
    }

    /// Returns the triangles of a buffer that must be drawn where `view` is visible, at a detail level.
    pub(super) fn spans(&self, chunk: usize, view: &LatticeRect, level: Option<u32>) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        let blocks = chunk * self.blocks_in_chunk()..(chunk + 1) * self.blocks_in_chunk();
        for block in blocks.filter(|&block| !self.is_empty(block)) {
            let entries = self.entries(block);
            let (first, all) = ((entries.start - chunk * self.chunk) as u32, entries.len() as u32);
            let span = match &self.blocks[block] {
                Some(arranged) if !meet(&arranged.rect, view) => continue,
                Some(arranged) => {
                    let count = level.map_or(all, |level| arranged.drawn[level as usize]);
                    Span { first, count, is_listed: count < all }
                }
                None => Span { first, count: all, is_listed: false },
            };
            match spans.last_mut() {
                Some(last) if !last.is_listed && !span.is_listed && last.first + last.count == first => {
                    last.count += span.count;
                }
                _ => spans.push(span),
            }
        }
        spans
    }

    fn blocks_in_chunk(&self) -> usize {
        self.chunk.div_ceil(BLOCK)
    }

    /// Returns how many places a list has. Small buffers are those of tests.
    fn places_of_block(&self) -> usize {
        self.chunk.next_multiple_of(PLACES_PER_WORD).min(BLOCK)
    }

    fn block_of(&self, entry: usize) -> usize {
        entry / self.chunk * self.blocks_in_chunk() + entry % self.chunk / BLOCK
    }

    /// Returns the entries of a block.
    fn entries(&self, block: usize) -> Range<usize> {
        let (chunk, in_chunk) = (block / self.blocks_in_chunk(), block % self.blocks_in_chunk());
        let end_of_chunk = ((chunk + 1) * self.chunk).min(self.triangles);
        let first = (chunk * self.chunk + in_chunk * BLOCK).min(end_of_chunk);
        first..(first + BLOCK).min(end_of_chunk)
    }

    fn is_empty(&self, block: usize) -> bool {
        self.entries(block).is_empty()
    }
}

/// Returns whether two rectangles have a point in common.
fn meet(a: &LatticeRect, b: &LatticeRect) -> bool {
    a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y
}

/// Returns an arranged block and its list.
fn arranged(mesh: &Mesh, entries: Range<usize>) -> (Arranged, Vec<u16>) {
    let (nodes, triangles) = (mesh.raw_nodes(), &mesh.raw_triangles()[entries]);
    let mut rect = LatticeRect { min: LatticePoint::new(u32::MAX, u32::MAX), max: LatticePoint::new(0, 0) };
    let mut coarsest = Vec::with_capacity(triangles.len());
    let mut drawn = [0; LEVELS];
    for triangle in triangles {
        for p in triangle.vertices.map(|vertex| nodes[vertex.index()]) {
            rect.min = LatticePoint::new(rect.min.x.min(p.x), rect.min.y.min(p.y));
            rect.max = LatticePoint::new(rect.max.x.max(p.x), rect.max.y.max(p.y));
        }
        let inner = InnerPoint::of(triangle, nodes);
        let level = coarsest_represented(mesh.lattice(), triangle.level(), inner);
        drawn[level as usize] += 1;
        coarsest.push(level as u8);
    }
    let (mut next, mut sum) = ([0; LEVELS], 0);
    for (next, drawn) in next.iter_mut().zip(&mut drawn) {
        *next = sum;
        sum += *drawn;
        *drawn = sum;
    }
    let mut places = vec![0; triangles.len().next_multiple_of(PLACES_PER_WORD)];
    for (place, level) in (0..=u16::MAX).zip(coarsest) {
        let next = &mut next[usize::from(level)];
        places[*next as usize] = place;
        *next += 1;
    }
    (Arranged { rect, drawn }, places)
}

//! One copy of a mesh and of the pieces in place of some of its triangles.

use std::ops::Range;

use super::arrangement::{Arrangement, Span};
use super::chunks::{ChunkLimits, ChunkedArray, NODE_BUFFERS};
use super::device::Gpu;
use super::error::GpuError;
use super::pipelines::uniform_buffer;
use super::sending::{joined, send, send_joined, send_ranges};
use crate::render::draw_flags::DrawFlags;
use crate::scene::Style;
use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect};
use meshbrush_mesh::mesh::{Changes, Mesh, PatchPieces, Progress, Triangle, TriangleId};

/// Changed ranges of words of flags with at most this many words between them are written as one. Writing
/// many words takes no longer than writing a few.
const SMALL_GAP_OF_WORDS: usize = 4096;

/// Upper bound of the words of flags of any mesh. All are in one buffer.
const MOST_WORDS: usize = 1 << 28;

/// Size of the uniform `Part` of mesh.wgsl in bytes: three u32, and padding that some drivers require.
const PART_BYTES: usize = 16;

/// The numbers of entries in the two arrays of a mesh.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub(super) nodes: usize,
    pub(super) triangles: usize,
}

impl Counts {
    pub(super) const NONE: Self = Self { nodes: 0, triangles: 0 };
    pub(super) const ALL: Self = Self { nodes: usize::MAX, triangles: usize::MAX };

    pub(super) fn at_most(self, mesh: &Mesh) -> Self {
        Self {
            nodes: self.nodes.min(mesh.raw_nodes().len()),
            triangles: self.triangles.min(mesh.raw_triangle_count()),
        }
    }
}

/// A mesh, the flags of its triangles, and the pieces that replace some of them.
pub(super) struct MeshCopy {
    mesh: Arrays,
    flags: FlagArray,
    arrangement: Arrangement,
    pieces: Arrays,
    /// The triangles that the pieces replace, retired ones included.
    replaced: Vec<TriangleId>,
    /// Whether pieces are shown, or would be if any triangle were replaced.
    has_pieces: bool,
    pub(super) lattice: Option<Lattice>,
}

impl MeshCopy {
    pub(super) fn new(limits: ChunkLimits) -> Self {
        Self {
            mesh: Arrays::new(limits),
            flags: FlagArray {
                flags: DrawFlags::default(),
                words: ChunkedArray::new::<u32>("flags", MOST_WORDS),
            },
            arrangement: Arrangement::new(limits.triangles),
            pieces: Arrays::new(limits),
            replaced: Vec::new(),
            has_pieces: false,
            lattice: None,
        }
    }

    /// Returns whether its buffers hold a large mesh.
    pub(super) fn is_large(&self) -> bool {
        Style::merges(self.mesh.triangle_count)
    }

    /// Prepares for a mesh whose upload begins.
    pub(super) fn begin(&mut self, gpu: &Gpu, mesh: &Mesh) -> Result<(), GpuError> {
        self.pieces.triangle_count = 0;
        self.replaced.clear();
        self.has_pieces = false;
        self.flags.flags.clear();
        self.arrangement.clear();
        self.mesh.bind_groups.clear();
        self.fit(gpu, mesh, Counts::NONE)
    }

    /// Makes the buffers large enough for a mesh. The first `kept` entries keep their contents.
    pub(super) fn fit(&mut self, gpu: &Gpu, mesh: &Mesh, kept: Counts) -> Result<(), GpuError> {
        let count = mesh.raw_triangle_count();
        let flags = self.flags.fit(gpu, count)?;
        let arrays = self.mesh.fit(gpu, mesh.raw_nodes().len(), count, kept)?;
        // The bind groups are missing when an earlier, failed call replaced buffers without binding them.
        self.arrangement.resize(count);
        if flags || arrays || self.mesh.bind_groups.is_empty() {
            self.bind(gpu);
        }
        self.lattice = Some(*mesh.lattice());
        Ok(())
    }

    fn bind(&mut self, gpu: &Gpu) {
        let flags = self.flags.words.chunks().first();
        self.mesh.bind(gpu, flags, Some(&self.arrangement));
    }

    /// Arranges up to `blocks` more blocks of the mesh, which must be complete.
    pub(super) fn arrange(&mut self, gpu: &Gpu, mesh: &Mesh, blocks: usize) -> Result<Progress, GpuError> {
        if self.arrangement.is_complete() {
            return Ok(Progress::Done);
        }
        match self.arrangement.fit(gpu)? {
            // Without lists the picture is the same.
            None => return Ok(Progress::Done),
            Some(true) => self.bind(gpu),
            Some(false) => {}
        }
        Ok(self.arrangement.advance(gpu.queue(), mesh, blocks))
    }

    /// Returns the triangles of a buffer that must be drawn where `view` is visible, at a detail level.
    pub(super) fn spans(&self, chunk: usize, view: &LatticeRect, level: Option<u32>) -> Vec<Span> {
        self.arrangement.spans(chunk, view, level)
    }

    /// Sends about `byte_budget` bytes, beginning with the entries after `sent`, and adds them to `sent`.
    pub(super) fn send(&mut self, gpu: &Gpu, mesh: &Mesh, sent: &mut Counts, byte_budget: usize) {
        debug_assert_eq!(
            self.mesh.triangle_count,
            mesh.raw_triangle_count(),
            "the mesh changed during its upload without apply_changes"
        );
        let queue = gpu.queue();
        let bytes = send(queue, &self.mesh.nodes, mesh.raw_nodes(), &mut sent.nodes, byte_budget);
        let left = byte_budget.saturating_sub(bytes);
        let first = sent.triangles;
        send(queue, &self.mesh.triangles, mesh.raw_triangles(), &mut sent.triangles, left);
        self.flags.classify(queue, mesh, std::slice::from_ref(&(first..sent.triangles)));
    }

    /// Writes the changed entries among the first `present` ones, and all flags.
    pub(super) fn write(&mut self, gpu: &Gpu, mesh: &Mesh, present: Counts, changes: &Changes) {
        let (queue, arrays) = (gpu.queue(), &self.mesh);
        send_ranges(queue, &arrays.nodes, &mesh.raw_nodes()[..present.nodes], &changes.nodes);
        let triangles = &mesh.raw_triangles()[..present.triangles];
        send_ranges(queue, &arrays.triangles, triangles, &changes.triangles);
        self.flags.classify(queue, mesh, &changes.triangles);
        changes.triangles.iter().for_each(|range| self.arrangement.forget(range.clone()));
    }

    /// Replaces the pieces, or removes them with `None`.
    pub(super) fn set_pieces(&mut self, gpu: &Gpu, pieces: Option<&PatchPieces>) -> Result<(), GpuError> {
        self.pieces.triangle_count = 0;
        let former = std::mem::take(&mut self.replaced);
        former.iter().for_each(|id| self.flags.flags.restore(*id));
        // The buffers come first: if they fail, the triangles of the mesh stay.
        let fitted = pieces.map_or(Ok(()), |pieces| self.send_pieces(gpu, pieces));
        if let (Ok(()), Some(pieces)) = (&fitted, pieces) {
            for (id, range) in pieces.replacements() {
                self.flags.flags.replace(id, !range.is_empty());
                self.replaced.push(id);
            }
        }
        self.flags.send_ids(gpu.queue(), former.into_iter());
        self.has_pieces = fitted.is_ok() && pieces.is_some();
        self.flags.send_ids(gpu.queue(), self.replaced.iter().copied());
        fitted
    }

    fn send_pieces(&mut self, gpu: &Gpu, pieces: &PatchPieces) -> Result<(), GpuError> {
        let (nodes, triangles) = (pieces.nodes(), pieces.triangles());
        gpu.check_nodes(nodes.len())?;
        self.pieces.fit(gpu, nodes.len(), triangles.len(), Counts::NONE)?;
        self.pieces.bind(gpu, None, None);
        self.pieces.nodes.write(gpu.queue(), 0, bytemuck::cast_slice(nodes));
        self.pieces.triangles.write(gpu.queue(), 0, bytemuck::cast_slice(triangles));
        Ok(())
    }

    /// Draws triangles of the mesh again in place of their pieces, or draws pieces that were appended.
    /// Returns false when other pieces are shown.
    pub(super) fn change_pieces(
        &mut self,
        gpu: &Gpu,
        pieces: &PatchPieces,
        touched: &[(TriangleId, Range<usize>)],
    ) -> Result<bool, GpuError> {
        if !self.has_pieces || self.pieces.triangle_count > pieces.triangles().len() {
            return Ok(false);
        }
        self.append_pieces(gpu, pieces)?;
        let mut ids: Vec<TriangleId> = touched.iter().map(|(id, _)| *id).collect();
        ids.sort_unstable();
        ids.dedup();
        for &id in &ids {
            match pieces.replacement(id) {
                Some(range) => {
                    self.flags.flags.replace(id, !range.is_empty());
                    self.replaced.push(id);
                }
                None => self.flags.flags.restore(id),
            }
        }
        let mut ranges: Vec<_> = touched.iter().map(|(_, range)| range.clone()).collect();
        ranges.sort_unstable_by_key(|range| range.start);
        send_ranges(gpu.queue(), &self.pieces.triangles, pieces.triangles(), &ranges);
        self.flags.send_ids(gpu.queue(), ids.into_iter());
        Ok(true)
    }

    /// Makes room for pieces that were appended, and sends their nodes.
    fn append_pieces(&mut self, gpu: &Gpu, pieces: &PatchPieces) -> Result<(), GpuError> {
        let (nodes, triangles) = (pieces.nodes(), pieces.triangles());
        let kept = Counts { nodes: self.pieces.node_count, triangles: self.pieces.triangle_count };
        gpu.check_nodes(nodes.len())?;
        if self.pieces.fit(gpu, nodes.len(), triangles.len(), kept)? {
            self.pieces.bind(gpu, None, None);
        }
        let added = bytemuck::cast_slice(&nodes[kept.nodes..]);
        self.pieces.nodes.write(gpu.queue(), kept.nodes, added);
        Ok(())
    }

    /// Returns the buffers of the mesh, each with its number of triangles.
    pub(super) fn mesh_draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        self.mesh.draws()
    }

    /// Returns the buffers of the pieces.
    pub(super) fn piece_draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        self.pieces.draws()
    }
}

/// Triangles and their nodes, in buffers.
struct Arrays {
    triangles: ChunkedArray,
    nodes: ChunkedArray,
    node_count: usize,
    triangle_count: usize,
    bind_groups: Vec<wgpu::BindGroup>,
}

impl Arrays {
    fn new(limits: ChunkLimits) -> Self {
        Self {
            triangles: ChunkedArray::new::<Triangle>("triangles", limits.triangles),
            nodes: ChunkedArray::new::<LatticePoint>("nodes", limits.nodes()),
            node_count: 0,
            triangle_count: 0,
            bind_groups: Vec::new(),
        }
    }

    /// Makes the buffers large enough. Returns whether any was replaced.
    fn fit(
        &mut self,
        gpu: &Gpu,
        node_count: usize,
        triangle_count: usize,
        kept: Counts,
    ) -> Result<bool, GpuError> {
        let (device, queue) = (gpu.device(), gpu.queue());
        let nodes = self.nodes.reserve(device, queue, node_count, kept.nodes)?;
        let triangles = self.triangles.reserve(device, queue, triangle_count, kept.triangles)?;
        (self.node_count, self.triangle_count) = (node_count, triangle_count);
        Ok(nodes || triangles)
    }

    /// Makes one bind group for each chunk of triangles, with all nodes, all flags and all lists.
    fn bind(&mut self, gpu: &Gpu, flags: Option<&wgpu::Buffer>, arrangement: Option<&Arrangement>) {
        let nodes: [&wgpu::Buffer; NODE_BUFFERS] =
            std::array::from_fn(|i| self.nodes.chunks().get(i).unwrap_or(gpu.nothing()));
        let bind = |(chunk, triangles): (usize, &wgpu::Buffer)| {
            let part = uniform_buffer(gpu.device(), "part of a mesh", PART_BYTES);
            let first = (chunk * gpu.limits().triangles) as u32;
            let first_place = arrangement.map_or(0, |arrangement| arrangement.first_place(chunk)) as u32;
            gpu.queue().write_buffer(
                &part,
                0,
                bytemuck::bytes_of(&[first, first_place, gpu.limits().node_bits]),
            );
            let lists = arrangement.and_then(Arrangement::buffer);
            let buffers = [triangles].into_iter().chain(nodes);
            let buffers =
                buffers.chain([flags.unwrap_or(gpu.nothing()), lists.unwrap_or(gpu.nothing()), &part]);
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("mesh"),
                layout: gpu.layout(),
                entries: &entries,
            })
        };
        self.bind_groups = self.triangles.chunks().iter().enumerate().map(bind).collect();
    }

    fn draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        self.bind_groups.iter().zip(self.triangles.items_in_chunks(self.triangle_count))
    }
}

/// The flags of a mesh, and their words on the GPU.
struct FlagArray {
    flags: DrawFlags,
    words: ChunkedArray,
}

impl FlagArray {
    /// Makes the buffer large enough. Returns whether it was replaced.
    fn fit(&mut self, gpu: &Gpu, triangles: usize) -> Result<bool, GpuError> {
        self.flags.resize(triangles);
        let words = self.flags.words();
        let replaced = self.words.reserve(gpu.device(), gpu.queue(), words.len(), 0)?;
        if replaced {
            self.words.write(gpu.queue(), 0, bytemuck::cast_slice(words));
        }
        Ok(replaced)
    }

    /// Marks which of the triangles in ascending ranges are outside the domain.
    fn classify(&mut self, queue: &wgpu::Queue, mesh: &Mesh, ranges: &[Range<usize>]) {
        let triangles = mesh.raw_triangles();
        for range in ranges {
            let end = range.end.min(triangles.len());
            self.flags.classify(range.start.min(end)..end, triangles);
        }
        self.send(queue, ranges.iter().cloned());
    }

    /// Sends the flags of triangles in ascending order.
    fn send_ids(&self, queue: &wgpu::Queue, ids: impl Iterator<Item = TriangleId>) {
        self.send(queue, ids.map(|id| id.index()..id.index() + 1));
    }

    fn send(&self, queue: &wgpu::Queue, triangles: impl Iterator<Item = Range<usize>>) {
        let words = joined(triangles.map(DrawFlags::words_of), SMALL_GAP_OF_WORDS);
        send_joined(queue, &self.words, self.flags.words(), words);
    }
}

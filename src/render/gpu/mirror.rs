//! The copy of a mesh on the GPU.

use std::ops::Range;

use super::GpuError;
use super::chunks::{ChunkLimits, ChunkedArray, NODE_BUFFERS, new_buffer};
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::{Changes, Mesh, Progress, Triangle};

/// Changed ranges with at most this many entries between them are written as one.
const SMALL_GAP: usize = 32;

/// A mesh on the GPU: the arrays of [`Mesh`] as they are, each in one or more buffers.
///
/// There are two copies. The front is drawn. The back receives another mesh in slices while the front stays
/// on the screen; when it is complete, the two change places.
///
/// ```text
///  mesh 2 ── begin_upload, advance_upload … ──► back    mesh 2, in part
///                                                │
///                                                │ with the last byte they change places:
///                                                │ the back is now drawn, and the buffers of
///                                                │ mesh 1 receive the next upload
///                                                ▼
///                                               front   mesh 1, drawn
/// ```
///
/// [`Self::apply_changes`] writes edits into the back during an upload, since they are edits of the mesh that
/// is being uploaded. At other times it writes into the front.
pub struct MeshMirror {
    gpu: Gpu,
    limits: ChunkLimits,
    front: MeshCopy,
    back: MeshCopy,
    upload: Option<Upload>,
    shown: Option<u64>,
    generation: u64,
}

/// What is needed to make buffers, fill them and bind them.
struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    /// Bound in place of node buffers that a mesh does not need.
    no_nodes: wgpu::Buffer,
}

/// Numbers of entries in the two arrays of a mesh.
#[derive(Clone, Copy)]
struct Counts {
    nodes: usize,
    triangles: usize,
}

struct MeshCopy {
    triangles: ChunkedArray,
    nodes: ChunkedArray,
    triangle_count: usize,
    lattice: Option<Lattice>,
    bind_groups: Vec<wgpu::BindGroup>,
}

/// An upload into the back: the revision of the mesh, and how many of its first entries are there.
struct Upload {
    revision: u64,
    sent: Counts,
}

impl MeshMirror {
    pub(super) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        limits: ChunkLimits,
    ) -> Result<Self, GpuError> {
        let available = device.limits().max_storage_buffers_per_shader_stage;
        let needed = 1 + NODE_BUFFERS as u32;
        if available < needed {
            return Err(GpuError::TooFewStorageBuffers { available, needed });
        }
        let gpu = Gpu {
            device: device.clone(),
            queue: queue.clone(),
            layout: bind_group_layout(device),
            no_nodes: new_buffer(device, "no nodes", size_of::<LatticePoint>() as u64)?,
        };
        Ok(Self {
            gpu,
            limits,
            front: MeshCopy::new(limits),
            back: MeshCopy::new(limits),
            upload: None,
            shown: None,
            generation: 0,
        })
    }

    /// Begins to upload a mesh; an unfinished upload is dropped. `revision` is the caller's name for the
    /// mesh.
    ///
    /// # Errors
    /// When the device cannot hold the mesh. The mesh on the screen stays.
    pub fn begin_upload(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.upload = None;
        self.check(mesh)?;
        let sent = Counts { nodes: 0, triangles: 0 };
        self.back.bind_groups.clear();
        self.back.fit(&self.gpu, mesh, sent)?;
        self.upload = Some(Upload { revision, sent });
        Ok(())
    }

    /// Uploads about `byte_budget` more bytes of the mesh that [`Self::begin_upload`] was called with. If the
    /// mesh has changed since, the changes must have gone to [`Self::apply_changes`]. With the last byte the
    /// mesh is shown.
    pub fn advance_upload(&mut self, mesh: &Mesh, byte_budget: usize) -> Progress {
        let Some(Upload { revision, sent }) = &mut self.upload else { return Progress::Done };
        debug_assert_eq!(
            self.back.triangle_count,
            mesh.raw_triangle_count(),
            "the mesh changed during its upload without apply_changes"
        );
        let queue = &self.gpu.queue;
        let bytes = send(queue, &self.back.nodes, mesh.raw_nodes(), &mut sent.nodes, byte_budget);
        let left = byte_budget.saturating_sub(bytes);
        send(queue, &self.back.triangles, mesh.raw_triangles(), &mut sent.triangles, left);
        if sent.nodes < mesh.raw_nodes().len() || sent.triangles < mesh.raw_triangle_count() {
            return Progress::More;
        }
        self.shown = Some(*revision);
        self.upload = None;
        std::mem::swap(&mut self.front, &mut self.back);
        self.generation += 1;
        Progress::Done
    }

    /// Uploads a whole mesh in one call.
    ///
    /// # Errors
    /// As [`Self::begin_upload`].
    pub fn upload(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.begin_upload(mesh, revision)?;
        self.advance_upload(mesh, usize::MAX);
        Ok(())
    }

    /// Writes the changed entries of a mesh: of the one being uploaded, otherwise of the one on the screen.
    /// Without either, the whole mesh is uploaded.
    ///
    /// During an upload, changed entries that were already sent are written again; the others follow in their
    /// turn.
    ///
    /// # Errors
    /// When the device cannot hold the mesh. An unfinished upload is dropped. The picture stays, but if the
    /// mesh on the screen was the one that changed, [`Self::shown`] becomes `None` and the next mesh is
    /// uploaded whole.
    pub fn apply_changes(&mut self, mesh: &Mesh, revision: u64, changes: &Changes) -> Result<(), GpuError> {
        if let Some(upload) = self.upload.take() {
            self.check(mesh)?;
            // Entries behind the end of a mesh that became shorter must be sent again if it grows.
            let sent = upload.sent.at_most(mesh);
            self.back.fit(&self.gpu, mesh, sent)?;
            self.back.write(&self.gpu.queue, mesh, sent, changes);
            self.upload = Some(Upload { revision, sent });
            return Ok(());
        }
        if self.shown.take().is_none() {
            return self.upload(mesh, revision);
        }
        self.check(mesh)?;
        let all = Counts { nodes: usize::MAX, triangles: usize::MAX };
        self.front.fit(&self.gpu, mesh, all)?;
        self.front.write(&self.gpu.queue, mesh, all.at_most(mesh), changes);
        self.shown = Some(revision);
        self.generation += 1;
        Ok(())
    }

    /// Revision of the mesh that is drawn, or `None` before the first and after a failure.
    pub fn shown(&self) -> Option<u64> {
        self.shown
    }

    /// Revision of the mesh that is being uploaded.
    pub fn uploading(&self) -> Option<u64> {
        self.upload.as_ref().map(|upload| upload.revision)
    }

    /// Sizes of the buffers.
    pub fn limits(&self) -> ChunkLimits {
        self.limits
    }

    /// Changes whenever the picture must be redrawn.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    /// Lattice of the mesh that is drawn.
    pub(super) fn lattice(&self) -> Option<&Lattice> {
        self.front.lattice.as_ref()
    }

    pub(super) fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.gpu.layout
    }

    /// The buffers to draw, each with its number of triangles.
    pub(super) fn draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        let copy = &self.front;
        copy.bind_groups.iter().zip(copy.triangles.items_in_chunks(copy.triangle_count))
    }

    fn check(&self, mesh: &Mesh) -> Result<(), GpuError> {
        let (nodes, limit) = (mesh.raw_nodes().len(), self.limits.max_nodes());
        if nodes > limit { Err(GpuError::TooManyNodes { nodes, limit }) } else { Ok(()) }
    }
}

impl Counts {
    fn at_most(self, mesh: &Mesh) -> Self {
        Self {
            nodes: self.nodes.min(mesh.raw_nodes().len()),
            triangles: self.triangles.min(mesh.raw_triangle_count()),
        }
    }
}

impl MeshCopy {
    fn new(limits: ChunkLimits) -> Self {
        Self {
            triangles: ChunkedArray::new::<Triangle>("triangles", limits.triangles),
            nodes: ChunkedArray::new::<LatticePoint>("nodes", limits.nodes()),
            triangle_count: 0,
            lattice: None,
            bind_groups: Vec::new(),
        }
    }

    /// Makes the buffers large enough for a mesh. The first `kept` entries keep their contents.
    fn fit(&mut self, gpu: &Gpu, mesh: &Mesh, kept: Counts) -> Result<(), GpuError> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let nodes = self.nodes.reserve(device, queue, mesh.raw_nodes().len(), kept.nodes)?;
        let triangles = self.triangles.reserve(device, queue, mesh.raw_triangle_count(), kept.triangles)?;
        // No bind groups: a failed call may have replaced buffers without binding them.
        if nodes || triangles || self.bind_groups.is_empty() {
            self.bind(gpu);
        }
        self.triangle_count = mesh.raw_triangle_count();
        self.lattice = Some(*mesh.lattice());
        Ok(())
    }

    /// Writes the changed entries among the first `present` ones.
    fn write(&self, queue: &wgpu::Queue, mesh: &Mesh, present: Counts, changes: &Changes) {
        send_ranges(queue, &self.nodes, &mesh.raw_nodes()[..present.nodes], &changes.nodes);
        send_ranges(queue, &self.triangles, &mesh.raw_triangles()[..present.triangles], &changes.triangles);
    }

    /// One group for each chunk of triangles, with all nodes.
    fn bind(&mut self, gpu: &Gpu) {
        let nodes: [&wgpu::Buffer; NODE_BUFFERS] =
            std::array::from_fn(|i| self.nodes.chunks().get(i).unwrap_or(&gpu.no_nodes));
        let bind = |triangles: &wgpu::Buffer| {
            let buffers = std::iter::once(triangles).chain(nodes);
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("mesh"),
                layout: &gpu.layout,
                entries: &entries,
            })
        };
        self.bind_groups = self.triangles.chunks().iter().map(bind).collect();
    }
}

fn bind_group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entries: [_; 1 + NODE_BUFFERS] = std::array::from_fn(|binding| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: wgpu::ShaderStages::VERTEX,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    });
    device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("mesh"), entries: &entries })
}

/// Sends items from `*next` on: as many as the budget allows, at least one. Returns the bytes sent.
fn send<T: bytemuck::Pod>(
    queue: &wgpu::Queue,
    array: &ChunkedArray,
    items: &[T],
    next: &mut usize,
    byte_budget: usize,
) -> usize {
    if byte_budget == 0 {
        return 0;
    }
    let end = next.saturating_add((byte_budget / size_of::<T>()).max(1)).min(items.len());
    let bytes: &[u8] = bytemuck::cast_slice(&items[*next..end]);
    array.write(queue, *next, bytes);
    *next = end;
    bytes.len()
}

fn send_ranges<T: bytemuck::Pod>(
    queue: &wgpu::Queue,
    array: &ChunkedArray,
    items: &[T],
    ranges: &[Range<usize>],
) {
    for range in joined(ranges) {
        let range = range.start.min(items.len())..range.end.min(items.len());
        array.write(queue, range.start, bytemuck::cast_slice(&items[range]));
    }
}

/// Joins ascending ranges across small gaps, for fewer and longer writes.
fn joined(ranges: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut joined: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match joined.last_mut() {
            Some(last) if range.start <= last.end + SMALL_GAP => last.end = last.end.max(range.end),
            _ => joined.push(range.clone()),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_ranges_are_joined() {
        assert_eq!(joined(&[0..3, 4..6, 6..9, 500..501]), [0..9, 500..501]);
        assert_eq!(joined(&[0..30, 5..7, 100..101]), [0..30, 100..101]);
        assert_eq!(joined(&[]), []);
    }
}

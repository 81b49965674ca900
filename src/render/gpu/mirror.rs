//! The copy of a mesh on the GPU.

use std::ops::Range;

use super::GpuError;
use super::chunks::{ChunkLimits, ChunkedArray, new_buffer};
use crate::geometry::{Lattice, LatticePoint};
use crate::mesh::{Changes, Mesh, Progress, Triangle};

/// Node buffers that a shader reads at once.
pub const NODE_BUFFERS: usize = 4;
/// Changed ranges with at most this many entries between them travel as one.
const SMALL_GAP: usize = 32;

/// A mesh on the GPU: the arrays of [`Mesh`] as they are, in one buffer or several.
///
/// There are two copies. The *front* is drawn; the *back* takes in another mesh piece by piece, while the front stays on
/// the screen, and changes places with it when it is whole. Small edits go to the front at once; while the back takes in a mesh
/// they are edits of that mesh, and go there.
pub struct MeshMirror {
    device: wgpu::Device,
    queue: wgpu::Queue,
    limits: ChunkLimits,
    layout: wgpu::BindGroupLayout,
    unused_nodes: wgpu::Buffer,
    front: MeshCopy,
    back: MeshCopy,
    upload: Option<Upload>,
    shown: Option<u64>,
    generation: u64,
}

struct MeshCopy {
    triangles: ChunkedArray,
    nodes: ChunkedArray,
    triangle_count: usize,
    lattice: Option<Lattice>,
    bind_groups: Vec<wgpu::BindGroup>,
}

/// How far the back has come: the revision of the mesh, and how many of its first nodes and triangles are there.
struct Upload {
    revision: u64,
    nodes: usize,
    triangles: usize,
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
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            limits,
            layout: bind_group_layout(device),
            unused_nodes: new_buffer(device, "no nodes", size_of::<LatticePoint>() as u64)?,
            front: MeshCopy::new(limits),
            back: MeshCopy::new(limits),
            upload: None,
            shown: None,
            generation: 0,
        })
    }

    /// Begins to take in a mesh; a mesh that was half taken in is dropped. `revision` is the caller's name for it.
    ///
    /// # Errors
    /// When the device cannot hold the mesh. The mesh on the screen stays.
    pub fn begin(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.upload = None;
        self.check(mesh)?;
        self.back.reserve(&self.device, &self.queue, mesh, [0, 0])?;
        self.back.bind(&self.device, &self.layout, &self.unused_nodes);
        self.back.describe(mesh);
        self.upload = Some(Upload { revision, nodes: 0, triangles: 0 });
        Ok(())
    }

    /// Takes in about `byte_budget` more bytes of the mesh that [`Self::begin`] was called with; where it has changed since,
    /// [`Self::write_ranges`] was told. When the last byte is in, the mesh is shown from the next frame on.
    pub fn upload_some(&mut self, mesh: &Mesh, byte_budget: usize) -> Progress {
        let Some(upload) = &mut self.upload else { return Progress::Done };
        debug_assert_eq!(
            self.back.triangle_count,
            mesh.triangles().len(),
            "the mesh changed during its upload, and its mirror was not told"
        );
        let sent = send(&self.queue, &self.back.nodes, mesh.nodes(), &mut upload.nodes, byte_budget);
        let left = byte_budget.saturating_sub(sent);
        send(&self.queue, &self.back.triangles, mesh.triangles(), &mut upload.triangles, left);
        if upload.nodes < mesh.nodes().len() || upload.triangles < mesh.triangles().len() {
            return Progress::More;
        }
        self.shown = Some(upload.revision);
        self.upload = None;
        std::mem::swap(&mut self.front, &mut self.back);
        self.generation += 1;
        Progress::Done
    }

    /// Takes in a whole mesh at once.
    ///
    /// # Errors
    /// As [`Self::begin`].
    pub fn upload(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.begin(mesh, revision)?;
        self.upload_some(mesh, usize::MAX);
        Ok(())
    }

    /// Takes over that only these entries of a mesh have changed: of the one that is being taken in, or else of the one on the
    /// screen. Where there is neither, all of it travels.
    ///
    /// While a mesh is taken in, what is there of it is written again, and what is not comes in its turn.
    ///
    /// # Errors
    /// When the device cannot hold the mesh. A mesh that was half taken in is dropped. The one on the screen stays, but if it
    /// was the one that changed, [`Self::shown`] forgets it: the next mesh travels as a whole.
    pub fn write_ranges(&mut self, mesh: &Mesh, revision: u64, changes: &Changes) -> Result<(), GpuError> {
        if let Some(upload) = self.upload.take() {
            self.upload = Some(self.patch_back(upload, mesh, revision, changes)?);
            return Ok(());
        }
        if self.shown.take().is_none() {
            return self.upload(mesh, revision);
        }
        self.check(mesh)?;
        if self.front.reserve(&self.device, &self.queue, mesh, [usize::MAX; 2])? {
            self.front.bind(&self.device, &self.layout, &self.unused_nodes);
        }
        send_ranges(&self.queue, &self.front.nodes, mesh.nodes(), &changes.nodes);
        send_ranges(&self.queue, &self.front.triangles, mesh.triangles(), &changes.triangles);
        self.front.describe(mesh);
        self.shown = Some(revision);
        self.generation += 1;
        Ok(())
    }

    /// The upload as it goes on with the mesh as it is now.
    fn patch_back(
        &mut self,
        upload: Upload,
        mesh: &Mesh,
        revision: u64,
        changes: &Changes,
    ) -> Result<Upload, GpuError> {
        self.check(mesh)?;
        // What lies behind the end of a mesh that became shorter is there no longer, though it may grow again.
        let nodes = upload.nodes.min(mesh.nodes().len());
        let triangles = upload.triangles.min(mesh.triangles().len());
        if self.back.reserve(&self.device, &self.queue, mesh, [nodes, triangles])? {
            self.back.bind(&self.device, &self.layout, &self.unused_nodes);
        }
        send_ranges(&self.queue, &self.back.nodes, &mesh.nodes()[..nodes], &changes.nodes);
        send_ranges(&self.queue, &self.back.triangles, &mesh.triangles()[..triangles], &changes.triangles);
        self.back.describe(mesh);
        Ok(Upload { revision, nodes, triangles })
    }

    /// Revision of the mesh that is drawn, or `None` before the first and after a failure.
    pub fn shown(&self) -> Option<u64> {
        self.shown
    }

    /// Revision of the mesh that is being taken in.
    pub fn uploading(&self) -> Option<u64> {
        self.upload.as_ref().map(|upload| upload.revision)
    }

    /// How the arrays are divided.
    pub fn limits(&self) -> ChunkLimits {
        self.limits
    }

    /// Changes whenever something else is to be drawn.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }

    /// Lattice of the mesh that is drawn.
    pub(super) fn lattice(&self) -> Option<&Lattice> {
        self.front.lattice.as_ref()
    }

    pub(super) fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The buffers to draw, each with how many triangles it holds.
    pub(super) fn draws(&self) -> impl Iterator<Item = (&wgpu::BindGroup, usize)> {
        let copy = &self.front;
        copy.bind_groups.iter().zip(copy.triangles.fill_of_chunks(copy.triangle_count))
    }

    fn check(&self, mesh: &Mesh) -> Result<(), GpuError> {
        let (nodes, limit) = (mesh.nodes().len(), self.limits.max_nodes());
        if nodes > limit { Err(GpuError::TooManyNodes { nodes, limit }) } else { Ok(()) }
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

    /// Makes room for a mesh. So many of the first nodes and triangles survive when buffers are exchanged for larger ones: true
    /// when some were.
    fn reserve(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mesh: &Mesh,
        [kept_nodes, kept_triangles]: [usize; 2],
    ) -> Result<bool, GpuError> {
        let nodes = self.nodes.reserve(device, queue, mesh.nodes().len(), kept_nodes)?;
        let triangles = self.triangles.reserve(device, queue, mesh.triangles().len(), kept_triangles)?;
        Ok(nodes || triangles)
    }

    fn describe(&mut self, mesh: &Mesh) {
        self.triangle_count = mesh.triangles().len();
        self.lattice = Some(*mesh.lattice());
    }

    /// One group for each chunk of triangles, with all nodes.
    fn bind(&mut self, device: &wgpu::Device, layout: &wgpu::BindGroupLayout, unused_nodes: &wgpu::Buffer) {
        let nodes: [&wgpu::Buffer; NODE_BUFFERS] =
            std::array::from_fn(|i| self.nodes.chunks().get(i).unwrap_or(unused_nodes));
        let bind = |triangles: &wgpu::Buffer| {
            let buffers = std::iter::once(triangles).chain(nodes);
            let entries: Vec<_> = (0..)
                .zip(buffers)
                .map(|(binding, buffer)| wgpu::BindGroupEntry {
                    binding,
                    resource: buffer.as_entire_binding(),
                })
                .collect();
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("mesh"),
                layout,
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

/// Sends items from `*next` on, within the budget but at least one, and returns the bytes sent.
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

/// Ascending ranges with the small gaps between them filled: fewer, longer writes.
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
    fn near_ranges_travel_together() {
        assert_eq!(joined(&[0..3, 4..6, 6..9, 500..501]), [0..9, 500..501]);
        assert_eq!(joined(&[0..30, 5..7, 100..101]), [0..30, 100..101]);
        assert_eq!(joined(&[]), []);
    }
}

//! Growing arrays in as many buffers as the limits of the device require.

use super::error::GpuError;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::Triangle;

/// Number of node buffers that a shader reads at once.
pub const NODE_BUFFERS: usize = 4;
/// Upper limit of a buffer in bytes: with larger ones, each growth of a mesh would allocate much memory at
/// once.
const LARGEST_CHUNK_BYTES: u64 = 256 << 20;
/// Size of the smallest buffer in bytes, so that the first strokes need no larger one.
const SMALLEST_CHUNK_BYTES: u64 = 64 << 10;

/// The number of array entries of a mesh that fit one buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChunkLimits {
    /// Triangles in a buffer. The triangles of a buffer are drawn together.
    pub triangles: usize,
    /// Binary logarithm of the nodes in a buffer; a shader reads [`NODE_BUFFERS`] buffers.
    pub node_bits: u32,
}

impl ChunkLimits {
    /// Returns the largest buffers that a device with these limits can bind, up to 256 MiB.
    pub fn from_device(limits: &wgpu::Limits) -> Self {
        let bytes =
            limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(LARGEST_CHUNK_BYTES)
                as usize;
        Self {
            triangles: (bytes / size_of::<Triangle>()).max(1),
            node_bits: (bytes / size_of::<LatticePoint>()).max(1).ilog2(),
        }
    }

    /// Returns the number of nodes in a buffer.
    pub fn nodes(&self) -> usize {
        1 << self.node_bits
    }

    /// Returns the largest number of nodes that can be shown.
    pub fn max_nodes(&self) -> usize {
        NODE_BUFFERS * self.nodes()
    }
}

/// An array on the GPU in chunks of equal length; the last chunk may be shorter.
pub(super) struct ChunkedArray {
    label: &'static str,
    item_bytes: u64,
    chunk_items: usize,
    chunks: Vec<wgpu::Buffer>,
}

impl ChunkedArray {
    pub(super) fn new<T>(label: &'static str, chunk_items: usize) -> Self {
        Self { label, item_bytes: size_of::<T>() as u64, chunk_items, chunks: Vec::new() }
    }

    pub(super) fn chunks(&self) -> &[wgpu::Buffer] {
        &self.chunks
    }

    /// Makes room for `items` and keeps the first `kept` items of the present contents. Returns whether any
    /// buffer was replaced.
    ///
    /// Unneeded chunks are kept for later. When no contents are kept, at most as many as needed now stay.
    pub(super) fn reserve(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        items: usize,
        kept: usize,
    ) -> Result<bool, GpuError> {
        let mut changed = false;
        let needed_chunks = items.div_ceil(self.chunk_items);
        if kept == 0 {
            self.chunks.truncate(2 * needed_chunks);
        }
        for chunk in 0..needed_chunks {
            let first = chunk * self.chunk_items;
            let needed = self.bytes((items - first).min(self.chunk_items));
            let present = self.chunks.get(chunk);
            if present.is_some_and(|buffer| buffer.size() >= needed) {
                continue;
            }
            let size = self.grown_size(needed, present);
            let buffer = new_buffer(device, self.label, size)?;
            if let Some(old) = present {
                let bytes = self.bytes(kept.saturating_sub(first).min(self.chunk_items)).min(old.size());
                copy(device, queue, old, &buffer, bytes);
            }
            self.chunks.truncate(chunk);
            self.chunks.push(buffer);
            changed = true;
        }
        Ok(changed)
    }

    /// Returns twice the present size or a quarter more than needed, in bytes, whichever is larger; at most a
    /// whole chunk.
    fn grown_size(&self, needed: u64, present: Option<&wgpu::Buffer>) -> u64 {
        let doubled = present.map_or(0, |buffer| 2 * buffer.size());
        let roomy = (needed + needed / 4).max(doubled).max(SMALLEST_CHUNK_BYTES);
        roomy.next_multiple_of(self.item_bytes).min(self.bytes(self.chunk_items))
    }

    /// Writes the bytes of whole items from index `first` on, across the boundaries of chunks.
    pub(super) fn write(&self, queue: &wgpu::Queue, first: usize, mut bytes: &[u8]) {
        let mut index = first;
        while !bytes.is_empty() {
            let (chunk, place) = (index / self.chunk_items, index % self.chunk_items);
            let room = self.bytes(self.chunk_items - place) as usize;
            let (now, later) = bytes.split_at(room.min(bytes.len()));
            queue.write_buffer(&self.chunks[chunk], self.bytes(place), now);
            index += now.len() / self.item_bytes as usize;
            bytes = later;
        }
    }

    /// Returns, for each chunk, how many of the first `items` items it contains.
    pub(super) fn items_in_chunks(&self, items: usize) -> impl Iterator<Item = usize> {
        let size = self.chunk_items;
        (0..items.div_ceil(size)).map(move |chunk| (items - chunk * size).min(size))
    }

    fn bytes(&self, items: usize) -> u64 {
        items as u64 * self.item_bytes
    }
}

pub(super) fn new_buffer(
    device: &wgpu::Device,
    label: &'static str,
    size: u64,
) -> Result<wgpu::Buffer, GpuError> {
    let descriptor = wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    };
    if cfg!(target_family = "wasm") {
        // A browser tells later whether there was memory: whoever handles the errors of the device is told.
        return Ok(device.create_buffer(&descriptor));
    }
    let scope = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let buffer = device.create_buffer(&descriptor);
    match pollster::block_on(scope.pop()) {
        None => Ok(buffer),
        Some(_) => Err(GpuError::OutOfMemory { bytes: size }),
    }
}

fn copy(device: &wgpu::Device, queue: &wgpu::Queue, from: &wgpu::Buffer, to: &wgpu::Buffer, bytes: u64) {
    if bytes > 0 {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(from, 0, to, 0, bytes);
        queue.submit([encoder.finish()]);
    }
}

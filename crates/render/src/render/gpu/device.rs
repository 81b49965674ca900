//! The device, and the handles with which buffers are made, filled and bound.

use std::sync::OnceLock;

use super::chunks::{ChunkLimits, NODE_BUFFERS};
use super::error::GpuError;
use super::pipelines::{storage_entry, uniform_entry};
use meshbrush_mesh::geometry::LatticePoint;

/// Storage buffers that the shader reads: triangles, nodes, flags and the order of triangles.
pub(super) const STORAGE_BUFFERS: u32 = 3 + NODE_BUFFERS as u32;

/// Requests the adapter's own limits: the default ones allow no large meshes and, on OpenGL, no storage
/// buffers.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("meshbrush"),
        required_limits: adapter.limits(),
        ..wgpu::DeviceDescriptor::default()
    }
}

/// Returns whether the driver emulates a GPU.
/// [`GpuRenderer::prepare_in_software`](super::GpuRenderer::prepare_in_software) is then faster.
pub fn emulates_gpu(adapter: &wgpu::Adapter) -> bool {
    adapter.get_info().device_type == wgpu::DeviceType::Cpu
}

/// The handles with which buffers are made, filled and bound.
pub(super) struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    limits: ChunkLimits,
    /// Made for the first mesh: a device for the software renderer may have no storage buffers.
    layout: OnceLock<wgpu::BindGroupLayout>,
    /// A buffer that is bound in place of buffers that are not needed.
    nothing: OnceLock<wgpu::Buffer>,
}

impl Gpu {
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue, limits: ChunkLimits) -> Self {
        let (layout, nothing) = (OnceLock::new(), OnceLock::new());
        Self { device: device.clone(), queue: queue.clone(), limits, layout, nothing }
    }

    pub(super) fn layout(&self) -> &wgpu::BindGroupLayout {
        self.layout.get_or_init(|| bind_group_layout(&self.device))
    }

    pub(super) fn nothing(&self) -> &wgpu::Buffer {
        self.nothing.get_or_init(|| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("nothing"),
                size: size_of::<LatticePoint>() as u64,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            })
        })
    }

    /// Fails where shaders cannot read as many buffers as a mesh needs.
    pub(super) fn check_device(&self) -> Result<(), GpuError> {
        let available = self.device.limits().max_storage_buffers_per_shader_stage;
        let needed = STORAGE_BUFFERS;
        if available < needed { Err(GpuError::TooFewStorageBuffers { available, needed }) } else { Ok(()) }
    }

    pub(super) fn limits(&self) -> ChunkLimits {
        self.limits
    }

    pub(super) fn device(&self) -> &wgpu::Device {
        &self.device
    }

    pub(super) fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Returns the most bytes of a buffer that a shader can read.
    pub(super) fn largest_binding(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    pub(super) fn check_nodes(&self, nodes: usize) -> Result<(), GpuError> {
        let limit = self.limits.max_nodes();
        if nodes > limit { Err(GpuError::TooManyNodes { nodes, limit }) } else { Ok(()) }
    }
}

fn bind_group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entries: Vec<_> =
        (0..STORAGE_BUFFERS).map(storage_entry).chain([uniform_entry(STORAGE_BUFFERS)]).collect();
    device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("mesh"), entries: &entries })
}

//! The pipelines that draw the arrays of a mirror in space.
//!
//! They read the buffers of the plan, and one more with the heights of the nodes. The plan keeps pipelines of
//! its own for speed: it needs neither heights nor a depth buffer.

use super::chunks::new_buffer;
use super::device::STORAGE_BUFFERS;
use super::error::GpuError;
use super::layout::SpaceUniform;
use super::mirror::MeshMirror;
use super::pipelines::{
    new_texture, pipeline_from, shader_module, storage_entry, uniform_buffer, uniform_entry,
};
use super::shaders::SPACE;
use crate::scene::{NO_HEIGHT, NodeHeights, SpaceView, Style};

/// The format of the buffer of depths.
const DEPTHS: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

pub(super) struct SpacePass {
    triangles: wgpu::RenderPipeline,
    pieces: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    view: wgpu::Buffer,
    mesh_heights: HeightBuffer,
    piece_heights: HeightBuffer,
    depths: Option<([u32; 2], wgpu::TextureView)>,
    revision: Option<u64>,
    /// Whether heights were sent since the last picture.
    has_news: bool,
}

/// The heights of some nodes, with the uniform data beside them.
struct HeightBuffer {
    buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl SpacePass {
    pub(super) fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        mirror: &MeshMirror,
    ) -> Result<Self, GpuError> {
        let available = device.limits().max_storage_buffers_per_shader_stage;
        let needed = STORAGE_BUFFERS + 1;
        if available < needed {
            return Err(GpuError::TooFewStorageBuffers { available, needed });
        }
        let view = uniform_buffer(device, "space view", size_of::<SpaceUniform>());
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("space view"),
            entries: &[uniform_entry(0), storage_entry(1)],
        });
        let shader = shader_module(device, "space", SPACE);
        let groups = [&layout, mirror.layout()];
        let depths = wgpu::DepthStencilState {
            format: DEPTHS,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        };
        let pipeline = |vertex_shader| {
            pipeline_from(device, &shader, vertex_shader, &groups, format, (None, Some(depths.clone())))
        };
        Ok(Self {
            triangles: pipeline("vs_main"),
            pieces: pipeline("vs_piece"),
            mesh_heights: HeightBuffer::new(device, &layout, &view, 0)?,
            piece_heights: HeightBuffer::new(device, &layout, &view, 0)?,
            layout,
            view,
            depths: None,
            revision: None,
            has_news: false,
        })
    }

    /// Sends heights, unless those of this revision were sent before.
    pub(super) fn set_heights(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        heights: &NodeHeights,
        revision: u64,
    ) -> Result<(), GpuError> {
        if self.revision == Some(revision) {
            return Ok(());
        }
        self.revision = None;
        for (buffer, heights) in
            [(&mut self.mesh_heights, &heights.mesh), (&mut self.piece_heights, &heights.pieces)]
        {
            if buffer.buffer.size() < (heights.len() * size_of::<u32>()) as u64 {
                *buffer = HeightBuffer::new(device, &self.layout, &self.view, heights.len())?;
            }
            queue.write_buffer(&buffer.buffer, 0, bytemuck::cast_slice(heights));
        }
        (self.revision, self.has_news) = (Some(revision), true);
        Ok(())
    }

    /// Returns whether heights were sent since the last picture.
    pub(super) fn has_news(&self) -> bool {
        self.has_news
    }

    /// Draws the mesh of the mirror and its pieces on a target of the size of the canvas.
    pub(super) fn draw(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        mirror: &MeshMirror,
        view: &SpaceView,
        style: &Style,
    ) {
        self.has_news = false;
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&SpaceUniform::new(view, style)));
        self.fit_depths(device, view.camera.size_px());
        let Some((_, depths)) = &self.depths else { return };
        let mut pass = begin_pass(encoder, target, depths, style.clear_color());
        for (pipeline, heights, is_of_mesh) in
            [(&self.triangles, &self.mesh_heights, true), (&self.pieces, &self.piece_heights, false)]
        {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &heights.group, &[]);
            let draws: Vec<_> =
                if is_of_mesh { mirror.mesh_draws().collect() } else { mirror.piece_draws().collect() };
            for (arrays, triangles) in draws {
                pass.set_bind_group(1, arrays, &[]);
                pass.draw(0..3 * triangles as u32, 0..1);
            }
        }
    }

    fn fit_depths(&mut self, device: &wgpu::Device, size: [u32; 2]) {
        if self.depths.as_ref().is_none_or(|(former, _)| *former != size) {
            let texture = new_texture(device, "depths", size, DEPTHS, wgpu::TextureUsages::RENDER_ATTACHMENT);
            self.depths = Some((size, texture.create_view(&wgpu::TextureViewDescriptor::default())));
        }
    }
}

impl HeightBuffer {
    fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        view: &wgpu::Buffer,
        nodes: usize,
    ) -> Result<Self, GpuError> {
        let limits = device.limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) as usize;
        let limit = limit / size_of_val(&NO_HEIGHT);
        if nodes > limit {
            return Err(GpuError::TooManyNodes { nodes, limit });
        }
        // A quarter more, so that a mesh that grows needs no new buffer for each stroke.
        let room = (nodes + nodes / 4).clamp(16, limit);
        let buffer = new_buffer(device, "heights", (room * size_of_val(&NO_HEIGHT)) as u64)?;
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("space view"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: buffer.as_entire_binding() },
            ],
        });
        Ok(Self { buffer, group })
    }
}

/// Begins a render pass onto one texture and a buffer of depths, which are first cleared.
fn begin_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
    depths: &wgpu::TextureView,
    color: [f32; 4],
) -> wgpu::RenderPass<'e> {
    let [r, g, b, a] = color.map(f64::from);
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depths,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    })
}

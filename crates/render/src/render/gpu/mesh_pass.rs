//! The render pipelines for the triangles and pieces of a mirror.

use super::arrangement::Span;
use super::layout::MeshView;
use super::mirror::MeshMirror;
use super::pipelines::{pipeline_from, shader_module, uniform_buffer, uniform_entry};
use super::shaders::MESH;
use crate::scene::{Camera, Detail, Style};
use meshbrush_mesh::geometry::LatticeRect;

pub(super) struct MeshPass {
    triangles: wgpu::RenderPipeline,
    /// Draws triangles, or the ancestors that they represent.
    merging: wgpu::RenderPipeline,
    /// Draws the beginnings of the lists of arranged blocks.
    listed: wgpu::RenderPipeline,
    pieces: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    view_group: wgpu::BindGroup,
}

impl MeshPass {
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat, mirror: &MeshMirror) -> Self {
        let view = uniform_buffer(device, "mesh view", size_of::<MeshView>());
        let view_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("mesh view"),
            entries: &[uniform_entry(0)],
        });
        let view_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("mesh view"),
            layout: &view_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() }],
        });
        let shader = shader_module(device, "mesh", MESH);
        let groups = [&view_layout, mirror.layout()];
        let pipeline =
            |vertex_shader| pipeline_from(device, &shader, vertex_shader, &groups, format, (None, None));
        Self {
            triangles: pipeline("vs_main"),
            merging: pipeline("vs_merging"),
            listed: pipeline("vs_listed"),
            pieces: pipeline("vs_piece"),
            view,
            view_group,
        }
    }

    pub(super) fn draw(
        &self,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        mirror: &MeshMirror,
        camera: &Camera,
        style: &Style,
    ) {
        let sight = MeshSight::new(mirror, camera, style);
        let view = MeshView::new(&sight.camera, style, sight.detail);
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        pass.set_bind_group(0, &self.view_group, &[]);
        let plain_pipeline = if sight.detail.is_some() { &self.merging } else { &self.triangles };
        for (chunk, (arrays, _)) in mirror.mesh_draws().enumerate() {
            pass.set_bind_group(1, arrays, &[]);
            let (listed, plain): (Vec<_>, _) =
                sight.spans(mirror, chunk).into_iter().partition(|span| span.is_listed);
            for (pipeline, spans) in [(plain_pipeline, plain), (&self.listed, listed)] {
                pass.set_pipeline(pipeline);
                for Span { first, count, .. } in spans {
                    pass.draw(3 * first..3 * (first + count), 0..1);
                }
            }
        }
        pass.set_pipeline(&self.pieces);
        for (arrays, pieces) in mirror.piece_draws() {
            pass.set_bind_group(1, arrays, &[]);
            pass.draw(0..3 * pieces as u32, 0..1);
        }
    }
}

/// How far beyond the canvas triangles are drawn, in pixels: more than a merged triangle reaches beyond those
/// that it is merged from.
const MARGIN_PX: f64 = 8.0;

/// What a camera sees of the mesh of a mirror, and in which detail.
pub(super) struct MeshSight {
    camera: Camera,
    detail: Option<Detail>,
    visible: LatticeRect,
}

impl MeshSight {
    pub(super) fn new(mirror: &MeshMirror, camera: &Camera, style: &Style) -> Self {
        // During the upload of a mesh with another lattice, the previous mesh keeps its place in the world.
        let camera = mirror.lattice().map_or(*camera, |lattice| camera.on_lattice(lattice));
        Self { camera, detail: Detail::of(&camera, style), visible: camera.visible_lattice(MARGIN_PX) }
    }

    /// Returns the triangles of a buffer that must be drawn.
    pub(super) fn spans(&self, mirror: &MeshMirror, chunk: usize) -> Vec<Span> {
        mirror.spans(chunk, &self.visible, self.detail.map(|detail| detail.level()))
    }
}

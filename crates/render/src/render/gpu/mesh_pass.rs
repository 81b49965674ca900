//! The render pipelines for the triangles and pieces of a mirror.

use super::arrangement::Span;
use super::layout::MeshView;
use super::mirror::MeshMirror;
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

/// Returns a shader from one of [`super::shaders`].
pub(super) fn shader_module(device: &wgpu::Device, label: &str, source: &str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

/// Returns a render pipeline without vertex buffers, from `vs_main` and `fs_main`, without depth buffer and
/// multisampling.
pub(super) fn render_pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    groups: &[&wgpu::BindGroupLayout],
    format: wgpu::TextureFormat,
    blend: Option<wgpu::BlendState>,
) -> wgpu::RenderPipeline {
    pipeline_from(device, shader, "vs_main", groups, format, (blend, None))
}

/// Makes a pipeline like [`render_pipeline`], with another function as vertex shader, and where it is given
/// with a buffer of depths.
pub(super) fn pipeline_from(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    vertex_shader: &str,
    groups: &[&wgpu::BindGroupLayout],
    format: wgpu::TextureFormat,
    (blend, depth_stencil): (Option<wgpu::BlendState>, Option<wgpu::DepthStencilState>),
) -> wgpu::RenderPipeline {
    let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some(vertex_shader),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some("fs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

pub(super) fn uniform_buffer(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

pub(super) fn uniform_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

/// Returns layout entry of a texture that a fragment shader reads without filtering.
pub(super) fn texel_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

/// Returns a two-dimensional texture without mip levels.
pub(super) fn new_texture(
    device: &wgpu::Device,
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

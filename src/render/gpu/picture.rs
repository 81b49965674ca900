//! The picture of the mesh, kept as a texture.

use super::GpuError;
use super::mesh_pass::{MeshPass, new_texture, render_pipeline, texel_entry};
use super::mirror::MeshMirror;
use crate::render::{Image, software};
use crate::scene::{Camera, ShownMesh, ShownRevision, Style};

/// Independent of the canvas, so that a picture drawn in software needs no conversion.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Draws the mesh into a texture when something changed, and otherwise only copies the texture to the canvas.
///
/// A window repaints whenever the pointer moves in a panel; that must not redraw a large mesh.
pub(super) struct MeshPicture {
    mesh_pass: MeshPass,
    blit: wgpu::RenderPipeline,
    blit_layout: wgpu::BindGroupLayout,
    target: Option<Target>,
    drawn: Option<Drawn>,
    redraws: u64,
}

struct Target {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

/// What the picture shows. When any of it changes, the picture is redrawn.
#[derive(PartialEq)]
struct Drawn {
    source: Source,
    camera: Camera,
    style: Style,
}

#[derive(PartialEq)]
enum Source {
    /// The mirror at this generation.
    Mirror(u64),
    /// The mesh and the pieces of this revision, drawn in software.
    Software(ShownRevision),
}

impl MeshPicture {
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat, mirror: &MeshMirror) -> Self {
        let blit_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("picture"),
            entries: &[texel_entry(0)],
        });
        let shader = device.create_shader_module(wgpu::include_wgsl!("blit.wgsl"));
        let blend = wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING;
        Self {
            mesh_pass: MeshPass::new(device, FORMAT, mirror),
            blit: render_pipeline(device, &shader, &[&blit_layout], format, Some(blend)),
            blit_layout,
            target: None,
            drawn: None,
            redraws: 0,
        }
    }

    /// [`GpuRenderer::prepare`](super::GpuRenderer::prepare), without the overlay.
    pub(super) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        mirror: &MeshMirror,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        let source = Source::Mirror(mirror.generation());
        let Some(wanted) = self.if_not_drawn(source, camera, style) else { return Ok(()) };
        let target = self.target_with_size(device, camera.size_px())?;
        let mut pass = begin_pass(encoder, &target.view, style.clear_color());
        self.mesh_pass.draw(queue, &mut pass, mirror, camera, style);
        drop(pass);
        self.keep(target, wanted);
        Ok(())
    }

    /// [`GpuRenderer::prepare_in_software`](super::GpuRenderer::prepare_in_software), without the overlay.
    pub(super) fn prepare_in_software(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        let source = Source::Software(revision);
        let Some(wanted) = self.if_not_drawn(source, camera, style) else { return Ok(()) };
        let target = self.target_with_size(device, camera.size_px())?;
        write_image(queue, &target.texture, &software::draw(shown, camera, style, None, &[]));
        self.keep(target, wanted);
        Ok(())
    }

    /// What to draw, unless the picture already shows it.
    fn if_not_drawn(&self, source: Source, camera: &Camera, style: &Style) -> Option<Drawn> {
        let wanted = Drawn { source, camera: *camera, style: style.clone() };
        (self.drawn.as_ref() != Some(&wanted)).then_some(wanted)
    }

    fn keep(&mut self, target: Target, drawn: Drawn) {
        self.target = Some(target);
        self.drawn = Some(drawn);
        self.redraws += 1;
    }

    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(target) = &self.target else { return };
        pass.set_pipeline(&self.blit);
        pass.set_bind_group(0, &target.group, &[]);
        pass.draw(0..3, 0..1);
    }

    pub(super) fn redraws(&self) -> u64 {
        self.redraws
    }

    /// The current texture if it has the right size, otherwise a new one.
    fn target_with_size(&mut self, device: &wgpu::Device, size: [u32; 2]) -> Result<Target, GpuError> {
        if let Some(target) =
            self.target.take_if(|target| [target.texture.width(), target.texture.height()] == size)
        {
            return Ok(target);
        }
        let limit = device.limits().max_texture_dimension_2d;
        if size[0] > limit || size[1] > limit {
            return Err(GpuError::TooLarge { what: "A canvas", size, limit });
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_DST;
        let texture = new_texture(device, "mesh picture", size, FORMAT, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.blit_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        });
        Ok(Target { texture, view, group })
    }
}

fn write_image(queue: &wgpu::Queue, texture: &wgpu::Texture, image: &Image) {
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * image.size[0]),
        rows_per_image: None,
    };
    queue.write_texture(texture.as_image_copy(), &image.rgba, layout, texture.size());
}

/// Begins a render pass onto one texture, which is first cleared to `color`, premultiplied.
pub(super) fn begin_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    color: [f32; 4],
) -> wgpu::RenderPass<'e> {
    let [r, g, b, a] = color.map(f64::from);
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..wgpu::RenderPassDescriptor::default()
    })
}

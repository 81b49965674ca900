//! A picture in a texture, shown on a canvas of the same size.

use super::GpuError;
use super::mesh_pass::{new_texture, render_pipeline, texel_entry};
use crate::render::Image;
use crate::render::software::PxRect;

/// Independent of the canvas, so that a picture drawn in software needs no conversion.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A picture that is drawn on or written to, and copied to the canvas.
pub struct ShownImage {
    /// Copies the picture.
    copy: wgpu::RenderPipeline,
    /// Draws a picture that is transparent in part over what is on the canvas.
    blend: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    target: Option<Target>,
}

struct Target {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

impl ShownImage {
    /// Nothing yet, to be shown on canvases of `format`.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("picture"),
            entries: &[texel_entry(0)],
        });
        let shader = device.create_shader_module(wgpu::include_wgsl!("blit.wgsl"));
        let pipeline = |blend| render_pipeline(device, &shader, &[&layout], format, blend);
        let (copy, blend) = (pipeline(None), pipeline(Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)));
        Self { copy, blend, layout, target: None }
    }

    /// Makes the texture as large as a picture. Returns whether it is another one, which shows nothing yet.
    ///
    /// # Errors
    /// When the picture is larger than the largest texture.
    pub fn fit(&mut self, device: &wgpu::Device, size: [u32; 2]) -> Result<bool, GpuError> {
        let has_size =
            |target: &Target| target.texture.width() == size[0] && target.texture.height() == size[1];
        if self.target.as_ref().is_some_and(has_size) {
            return Ok(false);
        }
        let limit = device.limits().max_texture_dimension_2d;
        if size[0] > limit || size[1] > limit {
            return Err(GpuError::TooLarge { what: "A canvas", size, limit });
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_DST;
        let texture = new_texture(device, "picture", size, FORMAT, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        });
        self.target = Some(Target { texture, view, group });
        Ok(true)
    }

    /// The texture, to be drawn on, once it was [fitted](Self::fit).
    pub(super) fn view(&self) -> Option<&wgpu::TextureView> {
        self.target.as_ref().map(|target| &target.view)
    }

    /// Writes a part of a picture to the same place of the texture, which must have its size.
    pub fn write(&self, queue: &wgpu::Queue, image: &Image, part: &PxRect) {
        let Some(Target { texture, .. }) = &self.target else { return };
        let (x, y) = (part.columns.start, part.rows.start);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 4 * (u64::from(y) * u64::from(image.size[0]) + u64::from(x)),
            bytes_per_row: Some(4 * image.size[0]),
            rows_per_image: None,
        };
        let size = wgpu::Extent3d {
            width: part.columns.len() as u32,
            height: part.rows.len() as u32,
            depth_or_array_layers: 1,
        };
        let to =
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x, y, z: 0 }, ..texture.as_image_copy() };
        queue.write_texture(to, &image.rgba, layout, size);
    }

    /// Copies the picture to the canvas, or draws it over the canvas unless it is opaque. The viewport of
    /// `pass` must be the canvas.
    pub fn paint(&self, pass: &mut wgpu::RenderPass<'_>, is_opaque: bool) {
        let Some(target) = &self.target else { return };
        // Blending takes a driver that emulates a GPU as long as all the rest.
        pass.set_pipeline(if is_opaque { &self.copy } else { &self.blend });
        pass.set_bind_group(0, &target.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

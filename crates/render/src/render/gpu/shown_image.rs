//! A picture in a texture, shown on a canvas of the same size.

use super::error::GpuError;
use super::pipelines::{new_texture, render_pipeline, shader_module, texel_entry};
use super::shaders::BLIT;
use crate::render::Image;
use crate::render::software::PxRect;

/// A picture that is drawn on or written to, and copied to the canvas.
pub struct ShownImage {
    /// Copies the picture to the canvas.
    copy: wgpu::RenderPipeline,
    /// Blends a partly transparent picture over the canvas.
    blend: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// The pixel format of the canvas.
    format: wgpu::TextureFormat,
    target: Option<Target>,
}

struct Target {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

impl ShownImage {
    /// Creates an empty picture for canvases of `format`, which must have four bytes per pixel.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("picture"),
            entries: &[texel_entry(0), sampler_entry(1)],
        });
        let shader = shader_module(device, "blit", BLIT);
        let pipeline = |blend| render_pipeline(device, &shader, &[&layout], format, blend);
        let (copy, blend) = (pipeline(None), pipeline(Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING)));
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor::default());
        Self { copy, blend, layout, sampler, format, target: None }
    }

    /// Gives the texture the size of a picture. Returns whether the texture was replaced by an empty one.
    ///
    /// # Errors
    /// Fails when the picture is larger than the largest texture.
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
        let texture = new_texture(device, "picture", size, self.format, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        self.target = Some(Target { texture, view, group });
        Ok(true)
    }

    /// Returns the texture for drawing on it, or `None` before the first call of [`Self::fit`].
    pub(super) fn view(&self) -> Option<&wgpu::TextureView> {
        self.target.as_ref().map(|target| &target.view)
    }

    /// Writes a part of a picture to the same part of the texture, which must have the picture's size.
    pub fn write(&self, queue: &wgpu::Queue, image: &Image, part: &PxRect) {
        let Some(Target { texture, .. }) = &self.target else { return };
        let origin = wgpu::Origin3d { x: part.columns.start, y: part.rows.start, z: 0 };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * part.columns.len() as u32),
            rows_per_image: None,
        };
        let size = wgpu::Extent3d {
            width: part.columns.len() as u32,
            height: part.rows.len() as u32,
            depth_or_array_layers: 1,
        };
        let to = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
        let pixels = pixels_of(image, part, self.format);
        queue.write_texture(to, bytemuck::cast_slice(&pixels), layout, size);
    }

    /// Copies the picture to the canvas, or blends it over the canvas unless it is opaque. The viewport of
    /// `pass` must be the canvas.
    pub fn paint(&self, pass: &mut wgpu::RenderPass<'_>, is_opaque: bool) {
        let Some(target) = &self.target else { return };
        // Where a driver emulates a GPU, blending takes as long as everything else together.
        pass.set_pipeline(if is_opaque { &self.copy } else { &self.blend });
        pass.set_bind_group(0, &target.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Returns the pixels of a part of a picture, with their bytes in the order of a format.
fn pixels_of(image: &Image, part: &PxRect, format: wgpu::TextureFormat) -> Vec<[u8; 4]> {
    let columns = part.columns.start as usize..part.columns.end as usize;
    let rows = part.rows.start as usize..part.rows.end as usize;
    let mut pixels = Vec::with_capacity(columns.len() * rows.len());
    for row in image.pixels().chunks_exact(image.size[0] as usize).take(rows.end).skip(rows.start) {
        let row = &row[columns.clone()];
        match format {
            wgpu::TextureFormat::Bgra8Unorm => pixels.extend(row.iter().map(|&[r, g, b, a]| [b, g, r, a])),
            _ => pixels.extend_from_slice(row),
        }
    }
    pixels
}

/// Returns layout entry of a sampler that takes the nearest pixel.
fn sampler_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
        count: None,
    }
}

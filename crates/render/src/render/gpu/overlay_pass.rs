//! The render pipeline for the overlay above the mesh.

use super::error::GpuError;
use super::layout::OverlayView;
use super::pipelines::{
    new_texture, render_pipeline, shader_module, texel_entry, uniform_buffer, uniform_entry,
};
use super::shaders::OVERLAY;
use crate::scene::{Camera, Overlay};
use meshbrush_mesh::geometry::Rect;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

pub(super) struct OverlayPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    view: wgpu::Buffer,
    shown: Option<OverlayTexture>,
}

/// An overlay whose colours are on the GPU.
struct OverlayTexture {
    texture: wgpu::Texture,
    group: wgpu::BindGroup,
    bounds: Rect,
    beyond: [u8; 4],
    revision: u64,
}

impl OverlayTexture {
    fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }
}

impl OverlayPass {
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("overlay"),
            entries: &[uniform_entry(0), texel_entry(1)],
        });
        let shader = shader_module(device, "overlay", OVERLAY);
        let blend = wgpu::BlendState {
            color: wgpu::BlendComponent {
                src_factor: wgpu::BlendFactor::Dst,
                dst_factor: wgpu::BlendFactor::Zero,
                operation: wgpu::BlendOperation::Add,
            },
            alpha: wgpu::BlendComponent {
                src_factor: wgpu::BlendFactor::Zero,
                dst_factor: wgpu::BlendFactor::One,
                operation: wgpu::BlendOperation::Add,
            },
        };
        Self {
            pipeline: render_pipeline(device, &shader, &[&layout], format, Some(blend)),
            layout,
            view: uniform_buffer(device, "overlay view", size_of::<OverlayView>()),
            shown: None,
        }
    }

    pub(super) fn set(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        overlay: Option<&Overlay>,
    ) -> Result<(), GpuError> {
        let previous = self.shown.take();
        let Some(overlay) = overlay.filter(|overlay| overlay.columns > 0 && overlay.rows > 0) else {
            return Ok(());
        };
        let size = [overlay.columns, overlay.rows];
        let (mut shown, stale) = match previous.filter(|previous| previous.size() == size) {
            Some(previous) => {
                let stale = previous.revision != overlay.revision;
                (previous, stale)
            }
            None => (self.new_texture(device, overlay)?, true),
        };
        if stale {
            write(queue, &shown.texture, overlay);
        }
        (shown.bounds, shown.beyond, shown.revision) = (overlay.bounds, overlay.beyond, overlay.revision);
        self.shown = Some(shown);
        Ok(())
    }

    pub(super) fn prepare(&self, queue: &wgpu::Queue, camera: &Camera) {
        let Some(shown) = &self.shown else { return };
        let [columns, rows] = shown.size();
        let placement = Overlay {
            bounds: shown.bounds,
            columns,
            rows,
            rgba: &[],
            beyond: shown.beyond,
            revision: shown.revision,
        };
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&OverlayView::new(camera, &placement)));
    }

    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(shown) = &self.shown else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &shown.group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn new_texture(&self, device: &wgpu::Device, overlay: &Overlay) -> Result<OverlayTexture, GpuError> {
        let size = [overlay.columns, overlay.rows];
        let limit = device.limits().max_texture_dimension_2d;
        if size[0] > limit || size[1] > limit {
            return Err(GpuError::TooLarge { what: "A field raster", size, limit });
        }
        let usage = wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING;
        let texture = new_texture(device, "overlay", size, FORMAT, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("overlay"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.view.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
            ],
        });
        let Overlay { bounds, beyond, revision, .. } = *overlay;
        Ok(OverlayTexture { texture, group, bounds, beyond, revision })
    }
}

fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, overlay: &Overlay) {
    let count = overlay.columns as usize * overlay.rows as usize;
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        },
        bytemuck::cast_slice(&overlay.rgba[..count]),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * overlay.columns),
            rows_per_image: None,
        },
        wgpu::Extent3d { width: overlay.columns, height: overlay.rows, depth_or_array_layers: 1 },
    );
}

//! The GPU renderer without a window.

use super::picture::begin_pass;
use super::pipelines::new_texture;
use super::{ChunkLimits, GpuError, GpuRenderer, device_descriptor};
use crate::render::Image;
use crate::scene::{Camera, Overlay, ShownMesh, ShownRevision, ShownSurface, SpaceView, Style};
use meshbrush_mesh::mesh::Mesh;

/// A renderer with a device of its own, which draws pictures without a window.
pub struct Offscreen {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: String,
    format: wgpu::TextureFormat,
    renderer: GpuRenderer,
}

/// Draws one picture on the GPU, as [`software::draw`](crate::render::software::draw) does without outlines.
///
/// # Errors
/// Fails when there is no usable driver, or it cannot hold the mesh or the picture.
pub fn offscreen(
    mesh: &Mesh,
    camera: &Camera,
    style: &Style,
    overlay: Option<&Overlay>,
) -> Result<Image, GpuError> {
    let mut offscreen = Offscreen::new()?;
    offscreen.show(mesh, 0)?;
    offscreen.show_overlay(overlay)?;
    offscreen.picture(camera, style)
}

impl Offscreen {
    /// Opens the first usable driver.
    ///
    /// # Errors
    /// Fails when there is no usable driver.
    pub fn new() -> Result<Self, GpuError> {
        let (device, queue, adapter) = pollster::block_on(open())?;
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let renderer = GpuRenderer::new(&device, &queue, format)?;
        Ok(Self { device, queue, adapter, format, renderer })
    }

    /// Replaces the renderer by one with buffers of the given size.
    ///
    /// # Errors
    /// Fails when the device cannot draw a mesh at all.
    pub fn with_chunks(self, chunks: ChunkLimits) -> Result<Self, GpuError> {
        let renderer = GpuRenderer::with_chunks(&self.device, &self.queue, self.format, chunks)?;
        Ok(Self { renderer, ..self })
    }

    /// Replaces the renderer by one for canvases of another format, such as the `Bgra8Unorm` of windows.
    ///
    /// # Errors
    /// Fails when the device cannot draw a mesh at all.
    pub fn with_format(self, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let renderer = GpuRenderer::new(&self.device, &self.queue, format)?;
        Ok(Self { renderer, format, ..self })
    }

    /// Returns name of the driver.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Returns the device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Returns the queue of the device.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Returns the renderer.
    pub fn renderer(&mut self) -> &mut GpuRenderer {
        &mut self.renderer
    }

    /// Uploads a whole mesh; `revision` is the caller's name for it.
    ///
    /// # Errors
    /// Fails when the device cannot hold the mesh.
    pub fn show(&mut self, mesh: &Mesh, revision: u64) -> Result<(), GpuError> {
        self.renderer.mirror_mut().upload(mesh, revision)
    }

    /// Shows or hides the overlay.
    ///
    /// # Errors
    /// Fails when the raster is larger than the largest texture.
    pub fn show_overlay(&mut self, overlay: Option<&Overlay>) -> Result<(), GpuError> {
        self.renderer.set_overlay(&self.device, &self.queue, overlay)
    }

    /// Draws a frame as a window does, and waits for the device to finish.
    ///
    /// # Errors
    /// Fails when the canvas is larger than the largest texture, or the device is lost.
    pub fn frame(&mut self, camera: &Camera, style: &Style) -> Result<(), GpuError> {
        let canvas = self.canvas(camera.size_px())?;
        let mut encoder = self.encoder();
        self.renderer.prepare(&self.device, &self.queue, &mut encoder, camera, style)?;
        self.paint(&mut encoder, &canvas, style);
        self.queue.submit([encoder.finish()]);
        self.wait()
    }

    /// Draws a frame and reads it back.
    ///
    /// # Errors
    /// Fails as [`Self::frame`] does.
    pub fn picture(&mut self, camera: &Camera, style: &Style) -> Result<Image, GpuError> {
        let canvas = self.canvas(camera.size_px())?;
        let mut encoder = self.encoder();
        self.renderer.prepare(&self.device, &self.queue, &mut encoder, camera, style)?;
        self.paint(&mut encoder, &canvas, style);
        read_back(&self.device, &self.queue, encoder, &canvas)
    }

    /// Draws a frame with [`GpuRenderer::prepare_in_software`] and reads it back.
    ///
    /// # Errors
    /// Fails as [`Self::frame`] does.
    pub fn picture_in_software(
        &mut self,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Result<Image, GpuError> {
        let canvas = self.canvas(camera.size_px())?;
        let mut encoder = self.encoder();
        self.renderer.prepare_in_software(&self.device, &self.queue, shown, revision, camera, style)?;
        self.paint(&mut encoder, &canvas, style);
        read_back(&self.device, &self.queue, encoder, &canvas)
    }

    /// Draws a frame in space and reads it back. `shown` is the mesh that was uploaded with its pieces, and
    /// `revision` the caller's name for its heights.
    ///
    /// # Errors
    /// Fails as [`Self::frame`] does.
    pub fn picture_in_space(
        &mut self,
        shown: ShownSurface,
        revision: u64,
        view: &SpaceView,
        style: &Style,
    ) -> Result<Image, GpuError> {
        let canvas = self.canvas(view.camera.size_px())?;
        let mut encoder = self.encoder();
        self.renderer.set_heights(&self.device, &self.queue, shown.heights, revision)?;
        self.renderer.prepare_in_space(&self.device, &self.queue, &mut encoder, view, style)?;
        self.paint(&mut encoder, &canvas, style);
        read_back(&self.device, &self.queue, encoder, &canvas)
    }

    fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    fn paint(&self, encoder: &mut wgpu::CommandEncoder, canvas: &wgpu::Texture, style: &Style) {
        let view = canvas.create_view(&wgpu::TextureViewDescriptor::default());
        let [r, g, b] = style.ground_color();
        self.renderer.paint(&mut begin_pass(encoder, &view, [r, g, b, 1.0]));
    }

    fn canvas(&self, size: [u32; 2]) -> Result<wgpu::Texture, GpuError> {
        let limit = self.device.limits().max_texture_dimension_2d;
        if size[0] > limit || size[1] > limit {
            return Err(GpuError::TooLarge { what: "A picture", size, limit });
        }
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        Ok(new_texture(&self.device, "canvas", size, self.format, usage))
    }

    fn wait(&self) -> Result<(), GpuError> {
        wait(&self.device)
    }
}

fn wait(device: &wgpu::Device) -> Result<(), GpuError> {
    let done = device.poll(wgpu::PollType::wait_indefinitely());
    done.map(|_| ()).map_err(|e| GpuError::ReadBack { reason: e.to_string() })
}

/// Submits `encoder`, waits for the device and reads `canvas` back. `canvas` must have the usage `COPY_SRC`.
///
/// # Errors
/// Fails when the device is lost.
pub fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    canvas: &wgpu::Texture,
) -> Result<Image, GpuError> {
    let size = [canvas.width(), canvas.height()];
    let row_bytes = (4 * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(row_bytes) * u64::from(size[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes), rows_per_image: None };
    let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(canvas.as_image_copy(), destination, canvas.size());
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    wait(device)?;
    let bytes = buffer.get_mapped_range(..).map_err(|e| GpuError::ReadBack { reason: e.to_string() })?;
    let rows = bytes.chunks(row_bytes as usize);
    let mut rgba: Vec<u8> = rows.flat_map(|row| &row[..4 * size[0] as usize]).copied().collect();
    if canvas.format() == wgpu::TextureFormat::Bgra8Unorm {
        rgba.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
    }
    Ok(Image { size, rgba })
}

async fn open() -> Result<(wgpu::Device, wgpu::Queue, String), GpuError> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = instance
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await
        .map_err(|e| GpuError::NoAdapter { reason: e.to_string() })?;
    let name = adapter.get_info().name;
    let (device, queue) = adapter
        .request_device(&device_descriptor(&adapter))
        .await
        .map_err(|e| GpuError::NoDevice { adapter: name.clone(), reason: e.to_string() })?;
    Ok((device, queue, name))
}

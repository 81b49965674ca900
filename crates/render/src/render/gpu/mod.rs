//! Draws a scene on the GPU. The arrays of the mesh are the vertex data.
//!
//! A window keeps a [`GpuRenderer`]. It contains a [`MeshMirror`], the copy of the mesh and of the pieces in
//! place of some of its triangles. It keeps the picture of the mesh as a texture, so that the mesh is redrawn
//! only when the mesh, the camera or the style changed.

mod arrangement;
mod chunks;
mod device;
mod error;
mod layout;
mod mesh_copy;
mod mesh_pass;
mod mirror;
mod offscreen;
mod overlay_pass;
mod picture;
mod pipelines;
mod sending;
pub mod shaders;
mod shown_image;
mod space_pass;

pub use chunks::{ChunkLimits, NODE_BUFFERS};
pub use device::{device_descriptor, emulates_gpu};
pub use error::GpuError;
pub use mirror::MeshMirror;
pub use offscreen::{Offscreen, offscreen, read_back};
pub use shown_image::ShownImage;

use self::overlay_pass::OverlayPass;
use self::picture::MeshPicture;
use crate::render::Image;
use crate::render::software::{KeptPicture, PxRect};
use crate::scene::{Camera, NodeHeights, Overlay, ShownMesh, ShownRevision, ShownSurface, SpaceView, Style};

/// Renderer of a canvas on the GPU.
///
/// For each frame, bring [`Self::mirror_mut`] and the overlay up to date, then call [`Self::prepare`] and
/// [`Self::paint`].
pub struct GpuRenderer {
    mirror: MeshMirror,
    picture: MeshPicture,
    overlay: OverlayPass,
}

impl GpuRenderer {
    /// Creates a renderer for canvases of `target_format`, which must be in gamma space: `Rgba8Unorm` or
    /// `Bgra8Unorm`.
    ///
    /// # Errors
    /// Fails when the device cannot draw a mesh at all.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        Self::with_chunks(device, queue, target_format, ChunkLimits::from_device(&device.limits()))
    }

    /// Creates a renderer with buffers of the given size, for canvases of `target_format` (see
    /// [`Self::new`]).
    ///
    /// # Errors
    /// Fails when the device cannot draw a mesh at all.
    pub fn with_chunks(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
        chunks: ChunkLimits,
    ) -> Result<Self, GpuError> {
        let renderer = Self::of_any(device, queue, target_format, chunks);
        renderer.mirror.check_device()?;
        Ok(renderer)
    }

    /// Creates a renderer that only shows pictures of the software renderer, for canvases of `target_format`
    /// (see [`Self::new`]). That needs nothing but a texture: WebGL and old drivers let no shader read the
    /// arrays of a mesh.
    pub fn in_software(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Self {
        Self::of_any(device, queue, target_format, ChunkLimits::from_device(&device.limits()))
    }

    fn of_any(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
        chunks: ChunkLimits,
    ) -> Self {
        debug_assert!(!target_format.is_srgb(), "colours are sRGB bytes, written as they are");
        let mirror = MeshMirror::new(device, queue, chunks);
        let picture = MeshPicture::new(device, target_format);
        let overlay = OverlayPass::new(device, target_format);
        Self { mirror, picture, overlay }
    }

    /// Returns the copy of the mesh.
    pub fn mirror(&self) -> &MeshMirror {
        &self.mirror
    }

    /// Returns the copy of the mesh, for updates.
    pub fn mirror_mut(&mut self) -> &mut MeshMirror {
        &mut self.mirror
    }

    /// Shows or hides the overlay. Its colours are uploaded only when its size or revision changed.
    ///
    /// # Errors
    /// Fails when the raster is larger than the largest texture.
    pub fn set_overlay(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        overlay: Option<&Overlay>,
    ) -> Result<(), GpuError> {
        self.overlay.set(device, queue, overlay)
    }

    /// Redraws the picture of the mesh with `encoder` if the mesh, the camera or the style changed, and
    /// prepares [`Self::paint`].
    ///
    /// # Errors
    /// Fails when the canvas is larger than the largest texture.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        self.picture.prepare(device, queue, encoder, &self.mirror, camera, style)?;
        self.overlay.prepare(queue, camera);
        Ok(())
    }

    /// Redraws the picture with the [software renderer](crate::render::software) if the mesh, the camera or
    /// the style changed, and prepares [`Self::paint`]. This is several times as fast as [`Self::prepare`]
    /// where the driver emulates a GPU. It does not use the mirror. After an edit that
    /// [`Self::picture_in_software_mut`] was told of, only the changed part is drawn.
    ///
    /// # Errors
    /// Fails when the canvas is larger than the largest texture.
    pub fn prepare_in_software(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        shown: ShownMesh,
        revision: ShownRevision,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        self.picture.prepare_in_software(device, queue, shown, revision, camera, style)?;
        self.overlay.prepare(queue, camera);
        Ok(())
    }

    /// Draws the picture in software, for a caller that draws the whole window with [`Self::take_image`].
    pub fn draw_image(&mut self, shown: ShownMesh, revision: ShownRevision, camera: &Camera, style: &Style) {
        self.picture.draw_image(shown, revision, camera, style);
    }

    /// Sends the heights of the nodes of the mesh in the mirror and of its pieces, unless those of this
    /// revision were sent before. The revision is the caller's name for them.
    ///
    /// # Errors
    /// Fails when the device cannot draw in space or hold the heights.
    pub fn set_heights(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        heights: &NodeHeights,
        revision: u64,
    ) -> Result<(), GpuError> {
        self.picture.set_heights((device, queue), &self.mirror, heights, revision)
    }

    /// Redraws the picture in space with `encoder` if the mesh, its heights, the view or the style changed,
    /// and prepares [`Self::paint`]. [`Self::set_heights`] must have sent the heights of the mesh that is
    /// shown. There is no overlay in space.
    ///
    /// # Errors
    /// Fails when the canvas is larger than the largest texture.
    pub fn prepare_in_space(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        view: &SpaceView,
        style: &Style,
    ) -> Result<(), GpuError> {
        self.picture.prepare_in_space((device, queue), encoder, &self.mirror, view, style)
    }

    /// Redraws the picture in space with the [software renderer](crate::render::software) if the mesh, the
    /// view or the style changed, and prepares [`Self::paint`]; without a device, for a caller that draws the
    /// whole window with [`Self::take_image`].
    ///
    /// # Errors
    /// Fails when the canvas is larger than the largest texture.
    pub fn prepare_in_space_in_software(
        &mut self,
        gpu: Option<(&wgpu::Device, &wgpu::Queue)>,
        shown: ShownSurface,
        revision: ShownRevision,
        view: &SpaceView,
        style: &Style,
    ) -> Result<(), GpuError> {
        self.picture.prepare_in_space_in_software(gpu, shown, revision, view, style)
    }

    /// Returns the picture of [`Self::draw_image`], the part that is new since the last call, and whether the
    /// picture is opaque. Returns `None` if another function drew last.
    pub fn take_image(&mut self) -> Option<(&Image, Option<PxRect>, bool)> {
        self.picture.take_image()
    }

    /// Returns the picture that the software renderer draws. It must be told of every edit of the mesh.
    pub fn picture_in_software_mut(&mut self) -> &mut KeptPicture {
        self.picture.kept_mut()
    }

    /// Draws the picture and the overlay on the canvas. The viewport of `pass` must be the canvas.
    ///
    /// The pass must have a target of the renderer's format, no depth buffer and no multisampling.
    pub fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.picture.paint(pass);
        self.overlay.paint(pass);
    }

    /// Returns how often the picture was redrawn.
    pub fn redraws(&self) -> u64 {
        self.picture.redraws()
    }
}

//! Draws a scene on the GPU: the mesh's own arrays are the vertex data.
//!
//! [`GpuRenderer`] is what a window keeps. In it a [`MeshMirror`] holds the copy of the mesh, and a picture of it is kept
//! as a texture, so that only a change of the mesh, the camera or the style costs drawing.

mod chunks;
mod layout;
mod mesh_pass;
mod mirror;
mod offscreen;
mod overlay_pass;
mod picture;

pub use chunks::ChunkLimits;
pub use mirror::{MeshMirror, NODE_BUFFERS};
pub use offscreen::{Offscreen, offscreen, read_back};

use self::overlay_pass::OverlayPass;
use self::picture::MeshPicture;
use crate::geometry::Grouped;
use crate::mesh::{Bytes, Mesh};
use crate::scene::{Camera, Overlay, Style};

/// What cannot be drawn with the graphics driver at hand.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// No graphics driver at all.
    #[error(
        "No usable graphics driver ({reason}). Install a Vulkan or OpenGL driver, such as mesa-vulkan-drivers."
    )]
    NoAdapter {
        /// What the search for one said.
        reason: String,
    },
    /// The driver refused to be opened.
    #[error("The graphics driver {adapter} cannot be used: {reason}.")]
    NoDevice {
        /// Name of the driver.
        adapter: String,
        /// What it said.
        reason: String,
    },
    /// Vertex shaders cannot read the mesh.
    #[error(
        "The graphics driver lets a shader read {available} storage buffers, and drawing a mesh takes {needed}. Update \
         the driver, or choose another with WGPU_BACKEND=vulkan."
    )]
    TooFewStorageBuffers {
        /// Buffers that a shader may read.
        available: u32,
        /// Buffers that the mesh takes.
        needed: u32,
    },
    /// The nodes do not fit the buffers that a shader can read at once.
    #[error(
        "The mesh has {} nodes, and this graphics driver can show {}. Raise the smallest diameter or paint \
         less; the command line can draw and export the mesh as it is.",
        Grouped(*nodes), Grouped(*limit)
    )]
    TooManyNodes {
        /// Nodes of the mesh.
        nodes: usize,
        /// Most nodes that can be shown.
        limit: usize,
    },
    /// The graphics memory is used up.
    #[error(
        "The graphics memory is used up: {} more for the mesh were refused. Raise the smallest diameter or \
         paint less, or close other programs that draw.",
        Bytes(*bytes as usize)
    )]
    OutOfMemory {
        /// Bytes that were asked for.
        bytes: u64,
    },
    /// A picture or a raster is larger than a texture can be.
    #[error(
        "{what} of {} × {} pixels is larger than this graphics driver can hold: at most {limit} along each side. \
         Choose a lower resolution.", size[0], size[1]
    )]
    TooLarge {
        /// What is too large, as the beginning of a sentence.
        what: &'static str,
        /// Its width and height in pixels.
        size: [u32; 2],
        /// Most pixels along a side.
        limit: u32,
    },
    /// The device was lost while a picture was read back.
    #[error("The picture could not be read back from the graphics driver: {reason}.")]
    ReadBack {
        /// What the driver said.
        reason: String,
    },
}

/// What to ask an adapter for: all that it can hold, for the default limits allow neither large meshes nor, on OpenGL,
/// any storage buffer.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("meshbrush"),
        required_limits: adapter.limits(),
        ..wgpu::DeviceDescriptor::default()
    }
}

/// Whether [`GpuRenderer::prepare_in_software`] is the better choice: the driver has no GPU behind it.
pub fn emulates_gpu(adapter: &wgpu::Adapter) -> bool {
    adapter.get_info().device_type == wgpu::DeviceType::Cpu
}

/// Everything on the GPU that a canvas needs.
///
/// For each frame: bring [`Self::mirror_mut`] and the overlay up to date, [`Self::prepare`], then [`Self::paint`].
pub struct GpuRenderer {
    mirror: MeshMirror,
    picture: MeshPicture,
    overlay: OverlayPass,
}

impl GpuRenderer {
    /// A renderer for canvases of `target_format`, which must be in gamma space: `Rgba8Unorm` or `Bgra8Unorm`.
    ///
    /// # Errors
    /// When the device cannot draw a mesh at all.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        Self::with_chunks(device, queue, target_format, ChunkLimits::of_device(&device.limits()))
    }

    /// As [`Self::new`], with buffers of another size than the device allows.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_chunks(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
        chunks: ChunkLimits,
    ) -> Result<Self, GpuError> {
        debug_assert!(!target_format.is_srgb(), "colours are sRGB bytes, written as they are");
        let mirror = MeshMirror::new(device, queue, chunks)?;
        let picture = MeshPicture::new(device, target_format, &mirror);
        let overlay = OverlayPass::new(device, target_format);
        Ok(Self { mirror, picture, overlay })
    }

    /// The copy of the mesh.
    pub fn mirror(&self) -> &MeshMirror {
        &self.mirror
    }

    /// The copy of the mesh, to bring it up to date.
    pub fn mirror_mut(&mut self) -> &mut MeshMirror {
        &mut self.mirror
    }

    /// Shows an overlay, or none. Its colours travel only when its size or revision changed.
    ///
    /// # Errors
    /// When the raster is larger than a texture can be.
    pub fn set_overlay(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        overlay: Option<&Overlay>,
    ) -> Result<(), GpuError> {
        self.overlay.set(device, queue, overlay)
    }

    /// Draws the picture of the mesh with `encoder` if the mesh, the camera or the style changed, and readies
    /// [`Self::paint`].
    ///
    /// # Errors
    /// When the canvas is larger than a texture can be.
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

    /// As [`Self::prepare`] with a picture drawn by [`software`](crate::render::software), for drivers without a GPU
    /// behind them: several times as fast there. Needs no mirror; `revision` is the caller's name for the mesh.
    ///
    /// # Errors
    /// As [`Self::prepare`].
    pub fn prepare_in_software(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mesh: &Mesh,
        revision: u64,
        camera: &Camera,
        style: &Style,
    ) -> Result<(), GpuError> {
        self.picture.prepare_in_software(device, queue, mesh, revision, camera, style)?;
        self.overlay.prepare(queue, camera);
        Ok(())
    }

    /// Puts the picture and the overlay on the canvas, which the viewport of `pass` must be.
    ///
    /// The pass has a target of the renderer's format, no depth and no multisampling.
    pub fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        self.picture.paint(pass);
        self.overlay.paint(pass);
    }

    /// How often the picture was drawn anew.
    pub fn redraws(&self) -> u64 {
        self.picture.redraws()
    }
}

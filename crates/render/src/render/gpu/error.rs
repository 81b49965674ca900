use meshbrush_mesh::text::{Bytes, Grouped};

/// The reason why the graphics driver cannot draw.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// The machine has no usable graphics driver.
    #[error(
        "No usable graphics driver ({reason}). Install a Vulkan or OpenGL driver, such as mesa-vulkan-drivers."
    )]
    NoAdapter {
        /// The driver loader's message.
        reason: String,
    },
    /// The driver refused to be opened.
    #[error("The graphics driver {adapter} cannot be used: {reason}.")]
    NoDevice {
        /// Name of the driver.
        adapter: String,
        /// The driver's message.
        reason: String,
    },
    /// Vertex shaders cannot read as many buffers as a mesh needs.
    #[error(
        "The graphics driver lets a shader read {available} storage buffers, but drawing a mesh needs {needed}. Update \
         the driver, or choose another one with WGPU_BACKEND=vulkan."
    )]
    TooFewStorageBuffers {
        /// Buffers that a shader may read.
        available: u32,
        /// Buffers that the mesh needs.
        needed: u32,
    },
    /// The nodes do not fit into the buffers that a shader can read.
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
    /// A picture or a raster is larger than the largest texture.
    #[error(
        "{what} of {} × {} pixels is larger than this graphics driver can hold: at most {limit} along each side. \
         Choose a lower resolution.", size[0], size[1]
    )]
    TooLarge {
        /// The thing that is too large, as the subject of a sentence.
        what: &'static str,
        /// Its width and height in pixels.
        size: [u32; 2],
        /// Largest number of pixels along a side.
        limit: u32,
    },
    /// The device was lost while a picture was read back.
    #[error("The picture could not be read back from the graphics driver: {reason}.")]
    ReadBack {
        /// The driver's message.
        reason: String,
    },
}

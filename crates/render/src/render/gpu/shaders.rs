//! The sources of the shaders.

/// Draws the plan.
pub const MESH: &str = concat!(include_str!("mesh_arrays.wgsl"), include_str!("mesh.wgsl"));
/// Draws in space.
pub const SPACE: &str = concat!(include_str!("mesh_arrays.wgsl"), include_str!("space.wgsl"));
/// Draws the overlay.
pub const OVERLAY: &str = include_str!("overlay.wgsl");
/// Copies a picture to the canvas.
pub const BLIT: &str = include_str!("blit.wgsl");

/// All of them, with the names of their last files.
pub const ALL: [(&str, &str); 4] =
    [("mesh.wgsl", MESH), ("space.wgsl", SPACE), ("overlay.wgsl", OVERLAY), ("blit.wgsl", BLIT)];

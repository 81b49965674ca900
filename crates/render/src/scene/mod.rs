//! The contents of a picture as plain data: the mesh with its pieces, the camera, the appearance of levels,
//! the highlights and the overlay.
//!
//! This module knows neither GPU nor window. Both renderers take their numbers from it, so they cannot
//! diverge. Pixels are physical pixels, counted from the upper left corner of the canvas, y downwards.
//! Colours are sRGB bytes and are mixed as such, as in egui.

mod camera;
mod detail;
mod heights;
mod highlight;
mod overlay;
mod shown;
mod space_camera;
mod space_style;
mod style;
mod surface_index;

pub use camera::Camera;
pub use detail::{Detail, InnerPoint, coarsest_represented};
pub use heights::{HeightScale, NO_HEIGHT, NodeHeights};
pub use highlight::{Highlights, Outline, highlight_outlines};
pub use overlay::{Overlay, TexelMap};
pub use shown::{ShownMesh, ShownRevision};
pub use space_camera::{Light, SpaceCamera, ViewDirection, ViewRay};
pub use space_style::{ShownSurface, SpacePaint, SpaceView};
pub use style::{LevelPaint, Style};
pub use surface_index::{SurfaceArrays, SurfaceIndex};

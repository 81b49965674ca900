//! The contents of a picture as plain data: the mesh with its pieces, the camera, the appearance of levels,
//! the highlights and the overlay.
//!
//! This module knows neither GPU nor window. Both renderers take their numbers from it, so they cannot
//! diverge. Pixels are physical pixels, counted from the upper left corner of the canvas, y downwards.
//! Colours are sRGB bytes and are mixed as such, as in egui.

mod camera;
mod detail;
mod highlight;
mod overlay;
mod shown;
mod style;

pub use camera::Camera;
pub use detail::{Detail, InnerPoint, coarsest_represented};
pub use highlight::{Highlights, Outline, highlight_outlines};
pub use overlay::{Overlay, TexelMap};
pub use shown::{ShownMesh, ShownRevision};
pub use style::{LevelPaint, Style};

//! What a picture shows, as plain data: where the camera stands, how levels look, what is highlighted, what lies above.
//!
//! Everything here is in the user's terms, with neither GPU nor window. Both renderers take their numbers from here, so
//! they cannot drift apart. Pixels are physical ones, counted from the upper left corner of the canvas, y downwards.
//! Colours are sRGB bytes and are mixed as such, as in egui.

mod camera;
mod highlight;
mod overlay;
mod style;

pub use camera::Camera;
pub use highlight::{Highlights, Outline, highlight_outlines};
pub use overlay::{Overlay, TexelMap};
pub use style::{ColorTable, LEVELS, LevelPaint, Style};

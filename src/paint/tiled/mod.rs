//! Strokes on sparse rasters of any depth, one raster for each paint layer.

mod layers;
mod patch;
mod preview;
mod resolution;
mod stroke;

pub use layers::PaintLayers;
pub use patch::Patch;
pub use preview::{Preview, preview};
pub use stroke::Stroke;

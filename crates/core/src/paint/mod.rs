//! Paint: the brush as data, the stroke that stamps it into the raster of a layer, its preview, and old tiles
//! for undo.

mod brush;
mod patch;
mod preview;
mod resolution;
mod stroke;

pub use brush::{Brush, DiameterChange, Medium, Mirror, PathPoint};
pub use patch::{Patch, Repaint};
pub use preview::{Preview, StrokePlan};
pub use stroke::Stroke;

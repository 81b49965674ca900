//! Strokes and the brush.

mod brush;
mod command;
mod entries;
mod eraser;
mod execute;
mod gestures;
mod panel;
mod pen;
#[cfg(test)]
mod tests;

pub use brush::{BRUSH, BrushMode, picks};
pub use command::BrushCommand;
pub use eraser::ERASER;
use gestures::GESTURES;
use panel::BRUSH_PANEL;
pub use pen::{Pen, PenEffect};

/// The stroke is in the document, and the settings of the brush are in [`Tools`](crate::app::tools::Tools).
#[derive(Default)]
pub struct Painting;

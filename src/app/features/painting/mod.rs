//! Strokes and the brush.

mod command;

pub use command::BrushCommand;

//! The layers of the size field.

mod command;
mod files;

pub use command::LayerCommand;
pub use files::{OPEN_BAND, OPEN_DIAMETERS, OPEN_MASK, OPEN_RISK, OPEN_SHAPES, OPEN_VALUES, REPLACE_SHAPES};

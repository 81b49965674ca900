//! The layers of the size field.

mod command;

pub use command::LayerCommand;

//! The threats of the selected layer.

mod command;

pub use command::ThreatsCommand;

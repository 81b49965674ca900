//! The threats of the selected layer.

mod command;
mod files;

pub use command::ThreatsCommand;
pub use files::{OPEN_THREATS, SAVE_THREATS};

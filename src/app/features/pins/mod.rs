//! Pins: points of the document whose triangles and values are followed.

mod command;
mod files;

pub use command::PinsCommand;
pub use files::EXPORT_PINS;

//! Pins: points of the document whose triangles and values are followed.

mod command;

pub use command::PinsCommand;

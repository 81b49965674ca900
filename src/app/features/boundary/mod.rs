//! The pieces of the boundary.

mod command;

pub use command::BoundaryCommand;

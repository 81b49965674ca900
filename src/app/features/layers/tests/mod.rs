//! The stack of layers, and layers of data from files.

mod data;
mod depth;
mod ground;
pub mod stack;
mod surface;

//! The stack of layers, and layers of data from files.

mod data;
mod depth;
pub mod stack;
mod surface;

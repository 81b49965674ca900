//! The stack of layers, and layers of data from files.

mod data;
pub mod stack;

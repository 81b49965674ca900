//! The stack of layers, and layers of data from files.

mod data;
mod depth;
mod ground;
mod row_menu;
pub mod stack;
mod surface;

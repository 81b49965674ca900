//! The stack on a lattice: one question about all layers, answered by descent through rectangles of cells.

pub mod analytic;
pub mod asked;
pub mod cells;
mod compiled;
pub mod gradation;
pub mod least;
pub mod reading;
pub mod search;

pub use compiled::CompiledLayer;
pub use reading::LEVELS;

//! The stack on a lattice: one question about all layers, answered by descent through rectangles of cells.

pub mod analytic;
pub mod asked;
pub mod cells;
mod compiled;
pub mod cone;
pub mod convex;
pub mod counting;
mod cover;
mod depth_formula;
pub mod gradation;
#[cfg(test)]
mod gradation_tests;
pub mod least;
pub mod parts;
pub mod patch;
mod pixels;
mod place;
pub mod reading;
#[cfg(test)]
mod round_tests;
pub mod search;
mod steepness;
mod validity;
mod values;

pub use analytic::{Analytic, Function, Profile};
pub use compiled::{CompiledLayer, CompiledPlane};
pub use parts::KnownParts;
pub use reading::{NO_RISK, Reading};
pub use values::Values;

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
mod diameters;
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
mod stack;
mod steepness;
mod validity;
mod values;

pub use analytic::{Analytic, Function, Profile};
pub use compiled::{CompiledLayer, CompiledPlane};
pub use cover::Cover;
pub use diameters::{DiameterLimit, Ungraded, is_asked};
pub use parts::KnownParts;
pub use reading::{NO_RISK, Reading};
pub use stack::{Nearby, Stack, StackLimits};
pub use values::Values;

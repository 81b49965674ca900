//! How good a mesh is for a solver: a number for each triangle or node, its histogram, and its extremes with
//! their places.
//!
//! What is measured is an extract: the mesh that files get, with its nodes on the outline where there is one.

mod bins;
mod links;
mod measures;
mod tally;
#[cfg(test)]
mod tests;

pub use bins::QualityBin;
pub use measures::{QualityMeasure, TriangleMeasures};
pub use tally::{MeasureSummary, MeasuredPlace, MeshQuality, QualityCount};

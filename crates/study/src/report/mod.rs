//! The figures of the report and its experiment, made again, with its numbers beside ours.

mod experiment;
mod figures;

pub use experiment::{Experiment, ExperimentMesh};
pub use figures::{Comparison, ReportFigure};

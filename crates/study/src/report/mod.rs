//! The figures and the experiment of the report, reproduced, with its numbers beside ours.

mod power_law;
mod times;
mod experiment;
mod running_times;
mod figures;

pub use experiment::{Experiment, ExperimentMesh, ExperimentRun};
pub use figures::{Comparison, ReportFigure};
pub use power_law::PowerLaw;
pub use running_times::{ABOUT_EXPONENT, DISTURBED};
pub use times::RunTime;

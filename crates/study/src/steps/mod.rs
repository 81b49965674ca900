//! Algorithms 10 to 12 one step at a time, forwards and backwards, on a small mesh; and then how the mesh is
//! fitted to the outline of its domain.
//!
//! ```text
//! coarse grid, rule ──▶ StepRecorder ──▶ Recording ──▶ StepPlayer
//!                       runs once,        the rows that    the arrays at any step
//!                       in slices         each step changes
//! ```
//!
//! Everything is numbered as in the report: triangles and nodes from 1, and −1 stands for the boundary.

mod drawn;
mod labels;
mod names;
mod parts;
mod player;
mod pseudo_code;
mod recorder;
mod recording;
mod stages;

pub use drawn::{StepColors, drawing, numbered};
pub use labels::{LabelRoom, LabelSize, MOST_AVOIDED, placed};
pub use names::{NamedPlace, Names};
pub use parts::{Marked, StepPart};
pub use player::StepPlayer;
pub use pseudo_code::{Algorithm, NeighbourCase};
pub use recorder::StepRecorder;
pub use recording::{BOUNDARY, RecordedStep, Recording, ReportRow, RowChange, StepAction};
pub use stages::{StageChange, StepStage, StepTriangle};

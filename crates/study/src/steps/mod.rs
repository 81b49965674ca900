//! Algorithms 10 to 12 one step at a time, forwards and backwards, on a small mesh.
//!
//! ```text
//! coarse grid, rule ──▶ StepRecorder ──▶ Recording ──▶ StepPlayer
//!                       runs once,        the rows that    the arrays at any step
//!                       in slices         each step changes
//! ```
//!
//! Everything is numbered as in the report: triangles and nodes from 1, and −1 stands for the boundary.

mod parts;
mod player;
mod pseudo_code;
mod recorder;
mod recording;
pub mod svg;

pub use parts::StepPart;
pub use player::StepPlayer;
pub use pseudo_code::{Algorithm, NeighbourCase};
pub use recorder::StepRecorder;
pub use recording::{BOUNDARY, Recording, ReportRow, RowChange, Step, StepAction};

//! What can be done while steps are shown.

use std::path::PathBuf;

use meshbrush_kit::kit::command::CommandSet;
use meshbrush_render::colormap::Ground;
use meshbrush_study::report::ReportFigure;

/// One thing to do in this mode.
#[derive(Clone, Debug, PartialEq)]
pub enum StepCommand {
    /// Begins to step through the refinement: before the first step, at the one that a figure of the report
    /// shows, or at the one that made the queried triangle.
    Begin(Option<ReportFigure>),
    /// Begins where so many steps are done.
    BeginAt(usize),
    /// Shows the mesh of the document again.
    Leave,
    /// Goes to where so many steps are done.
    GoTo(usize),
    /// Goes so many steps forwards, or backwards.
    Move(isize),
    /// Begins or ends to go forwards by itself.
    TogglePlay,
    /// Sets whether the next and the previous step are bisections.
    OnlyBisections(bool),
    /// Sets how many steps it goes in a second.
    Speed(f64),
    /// Sets the first and the last step to be exported.
    ExportRange(usize, usize),
    /// Sets the ground of exported drawings.
    ExportGround(Ground),
    /// Writes the chosen steps, and asks before other files are replaced.
    ExportAs(PathBuf),
    /// Writes the chosen steps, each to a file with its number.
    Export(PathBuf),
}

impl CommandSet for StepCommand {}

//! Commands about plots.

use std::path::PathBuf;

use meshbrush_core::surface::CurvePoint;
use meshbrush_kit::kit::command::CommandSet;

/// One thing to do with plots.
#[derive(Clone, Debug, PartialEq)]
pub enum PlotsCommand {
    /// Chooses a plot, and opens the panel.
    Show(PlotKind),
    /// Chooses a plot.
    Choose(PlotKind),
    /// Computes what the plot shows.
    Compute,
    /// Makes the mesh of a point of the curve of errors that of the document.
    TakeError(CurvePoint),
    /// Sets how the experiment is measured.
    SetUp {
        /// The deepest level.
        last_level: u32,
        /// How often each mesh is made.
        runs: u32,
    },
    /// Measures the experiment.
    Measure,
    /// Measures the experiment, unless that was done before.
    MeasureOnce,
    /// Ends the measuring.
    CancelMeasuring,
    /// Copies the numbers of the plot.
    Copy,
    /// Writes the plot, and asks before another file is replaced.
    ExportAs(PathBuf),
    /// Writes the plot.
    Export(PathBuf),
}

impl CommandSet for PlotsCommand {}

/// The plots that can be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotKind {
    /// Triangles per level.
    Triangles,
    /// Closure cost: required and forced bisections per level.
    Bisections,
    /// The smallest and the largest h per level.
    Diameters,
    /// The error from a surface over the number of triangles.
    Errors,
    /// The time for one triangle over the number of triangles.
    Time,
    /// The time over the number of triangles, as in Figure 5 of the report.
    Figure5,
}

impl PlotKind {
    /// All of them with their names.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Triangles, "Triangles per level"),
        (Self::Bisections, "Closure cost"),
        (Self::Diameters, "h per level"),
        (Self::Errors, "Error against triangles"),
        (Self::Time, "Time per triangle"),
        (Self::Figure5, "Figure 5 of the report"),
    ];

    /// Returns the name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(kind, _)| *kind == self).map_or("", |(_, name)| name)
    }

    /// Returns whether it shows the experiment of the report and not the mesh of the document.
    pub fn is_of_experiment(self) -> bool {
        matches!(self, Self::Time | Self::Figure5)
    }
}

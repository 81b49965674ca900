//! Commands about plots.

use std::path::PathBuf;

use super::PlotKind;
use crate::app::command::CommandSet;
use meshbrush_core::surface::CurvePoint;

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

//! Commands about the figures of the report.

use meshbrush_kit::kit::command::CommandSet;
use meshbrush_study::report::ReportFigure;

/// One thing to do with the figures of the report.
#[derive(Clone, Debug, PartialEq)]
pub enum FigureCommand {
    /// Opens the document of a figure, and shows of it what the figure shows.
    Open(ReportFigure),
    /// Shows a figure, whose document was just opened.
    Show(ReportFigure),
    /// Closes the figure. Its document stays.
    Close,
    /// Copies the figure with its numbers.
    Copy(String),
}

impl CommandSet for FigureCommand {
    fn closes_document(&self) -> bool {
        matches!(self, Self::Open(_))
    }
}

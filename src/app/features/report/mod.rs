//! The figures of the report: each opens as a document, with its numbers beside ours.

mod command;
mod comparison;
mod entries;
mod execute;
mod panel;
#[cfg(test)]
mod tests;

pub use command::FigureCommand;
use comparison::{as_text, comparisons};
use panel::FIGURE;
pub use panel::section;

use meshbrush_study::report::ReportFigure;

/// The figure that is shown.
#[derive(Default)]
pub struct Report {
    shown: Option<ReportFigure>,
}

impl Report {
    /// Returns the figure that is shown.
    pub fn figure(&self) -> Option<ReportFigure> {
        self.shown
    }

    /// Returns whether a figure is shown.
    pub fn is_shown(&self) -> bool {
        self.shown.is_some()
    }
}

//! The plot as a file.

use super::PlotsCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FileAct, FileKind};
use meshbrush_study::plot;

/// The plot.
pub static EXPORT_PLOT: FileKind = FileKind {
    title: "Export plot",
    act: FileAct::Export,
    endings: || plot::ENDINGS.to_vec(),
    formats: || vec![("svg", "A vector drawing"), ("csv", "A table of the points")],
    contents: "Drawings and tables",
    folder: "exports",
    suffix: " plot",
    command_after_browsing: |path| Command::from(PlotsCommand::Export(path)),
    ..FileKind::new(|path| Command::from(PlotsCommand::ExportAs(path)))
};

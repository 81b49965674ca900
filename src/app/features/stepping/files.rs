//! Steps of the refinement as files.

use super::StepCommand;
use crate::app::command::Command;
use crate::app::kit::{FileAct, FileKind};

/// Steps of the refinement, each to a file.
pub static EXPORT_STEPS: FileKind = FileKind {
    title: "Export steps as SVG",
    act: FileAct::Export,
    endings: || vec!["svg"],
    contents: "Drawings",
    folder: "exports",
    suffix: " step",
    ..FileKind::new(|path| Command::from(StepCommand::ExportAs(path)))
};

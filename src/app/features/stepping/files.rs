//! Steps of the refinement as files.

use super::StepCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FileAct, FileKind};

/// Steps of the refinement, each to a file.
pub static EXPORT_STEPS: FileKind = FileKind {
    title: "Export steps",
    act: FileAct::Export,
    endings: || vec!["svg", "png"],
    formats: || vec![("svg", "A vector drawing of each step"), ("png", "A picture of each step")],
    contents: "Drawings",
    folder: "exports",
    suffix: " step",
    ..FileKind::new(|path| Command::from(StepCommand::ExportAs(path)))
};

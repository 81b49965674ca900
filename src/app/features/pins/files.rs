//! The table of the pins as a file.

use crate::app::command::{Command, PinsCommand};
use crate::app::kit::{FileAct, FileKind};

/// The table of the pins.
pub static EXPORT_PINS: FileKind = FileKind {
    title: "Export table of pins",
    act: FileAct::Export,
    endings: || vec!["csv"],
    contents: "Tables",
    folder: "exports",
    suffix: " pins",
    command_after_browsing: |path| Command::Pins(PinsCommand::Export(path)),
    ..FileKind::new(|path| Command::Pins(PinsCommand::ExportAs(path)))
};

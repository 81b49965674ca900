//! The table of the pins as a file.

use crate::app::features::pins::PinsCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{DataContents, DataRole, FileAct, FileKind};

/// The table of the pins.
pub static EXPORT_PINS: FileKind = FileKind {
    title: "Export table of pins",
    act: FileAct::Export,
    endings: || vec!["csv"],
    contents: "Tables",
    folder: "exports",
    suffix: " pins",
    command_after_browsing: |path| Command::from(PinsCommand::Export(path)),
    ..FileKind::new(|path| Command::from(PinsCommand::ExportAs(path)))
};

/// Points as pins.
pub static OPEN_PINS: FileKind = FileKind {
    title: "Open table of points as pins",
    act: FileAct::Add,
    endings: || vec!["csv"],
    contents: "Tables of points",
    folder: "points",
    ..FileKind::new(|path| Command::from(PinsCommand::Open(path)))
};

/// The use of a file that pins have.
pub static ROLES: [DataRole; 1] = [DataRole {
    place: 15,
    title: "Pins",
    sentence: "Pins are added at the points; the mesh does not change.",
    kind: &OPEN_PINS,
    is_for: |contents| matches!(contents, DataContents::Points(_)),
    refusal: |_, _| None,
}];

//! The kinds of files that the picture behind the mesh is read from.

use crate::app::command::{Command, PictureCommand};
use crate::app::dialogs::{FileAct, FileKind};

/// A picture to trace.
pub static OPEN_PICTURE: FileKind = FileKind {
    title: "Open background picture",
    act: FileAct::Open,
    endings: || vec!["png"],
    contents: "Pictures",
    folder: "backgrounds",
    suffix: "",
    command: |path| Command::Picture(PictureCommand::Open(path)),
    command_after_browsing: |path| Command::Picture(PictureCommand::Open(path)),
};

//! The kinds of files that the picture behind the mesh is read from.

use crate::app::command::{Command, PictureCommand};
use crate::app::kit::FileKind;

/// A picture to trace.
pub static OPEN_PICTURE: FileKind = FileKind {
    title: "Open background picture",
    endings: || vec!["png"],
    contents: "Pictures",
    folder: "backgrounds",
    ..FileKind::new(|path| Command::Picture(PictureCommand::Open(path)))
};

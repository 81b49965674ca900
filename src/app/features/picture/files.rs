//! The kinds of files that the picture behind the mesh is read from.

use crate::app::features::picture::PictureCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{DataContents, DataRole, FileKind};

/// A picture to trace.
pub static OPEN_PICTURE: FileKind = FileKind {
    title: "Open background picture",
    endings: || vec!["png"],
    contents: "Pictures",
    folder: "backgrounds",
    ..FileKind::new(|path| Command::from(PictureCommand::Open(path)))
};

/// The use of a file that the picture has.
pub static ROLES: [DataRole; 1] = [DataRole {
    place: 24,
    title: "Background picture",
    sentence: "A picture behind the mesh, to trace; it does not change the mesh.",
    kind: &OPEN_PICTURE,
    is_for: |contents| matches!(contents, DataContents::Picture(_)),
    refusal: |_, _| None,
}];

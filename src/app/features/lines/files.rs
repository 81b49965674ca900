//! The files that lines are read from.

use super::LinesCommand;
use meshbrush_io::io::shape_format;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{DataContents, DataRole, FileAct, FileKind};

/// Lines and polygons along which the mesh has edges.
pub static ADD_LINES: FileKind = FileKind {
    title: "Add lines to this document",
    act: FileAct::Add,
    endings: shape_format::endings,
    contents: "Lines and polygons",
    folder: "lines",
    ..FileKind::new(|path| Command::from(LinesCommand::Open(path)))
};

/// The use of a file as lines.
pub static ROLES: [DataRole; 1] = [DataRole {
    place: 13,
    title: "Lines inside the mesh",
    sentence: "The mesh that files get has edges along the lines; sizes do not change.",
    kind: &ADD_LINES,
    is_for: |contents| matches!(contents, DataContents::Shapes { lines, polygons, .. } if lines + polygons > 0),
    refusal: |_, _| None,
}];

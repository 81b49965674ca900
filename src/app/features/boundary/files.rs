//! The kinds of files that say where the boundary is open.

use super::BoundaryCommand;
use crate::app::command::Command;
use crate::app::kit::FileKind;
use meshbrush_io::io::settings::SavedOpen;
use meshbrush_io::io::shape_format;

/// Polygons in which the boundary is open.
pub static OPEN_IN_POLYGONS: FileKind = FileKind {
    title: "Open the boundary in polygons",
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(BoundaryCommand::Open(SavedOpen::Polygons(path))))
};

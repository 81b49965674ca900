//! The kinds of files that say where the boundary is open.

use super::BoundaryCommand;
use meshbrush_io::io::settings::SavedOpen;
use meshbrush_io::io::shape_format;
use meshbrush_kit::kit::FileKind;
use meshbrush_kit::kit::command::Command;

/// Polygons in which the boundary is open.
pub static OPEN_IN_POLYGONS: FileKind = FileKind {
    title: "Open the boundary in polygons",
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(BoundaryCommand::Open(SavedOpen::Polygons(path))))
};

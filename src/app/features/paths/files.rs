//! Paths and the regions that they stay out of, as files.

use super::{KeepOutCommand, PathCommand};
use meshbrush_io::io::shape_format;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{DataContents, DataRole, FileAct, FileKind};
use meshbrush_render::render::path_export::PathFormat;

/// Polygons as a region that paths stay out of.
pub static OPEN_KEEP_OUT: FileKind = FileKind {
    title: "Open polygons as keep-out region",
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(PathCommand::KeepOut(KeepOutCommand::Open(path))))
};

/// A path.
pub static EXPORT_PATH: FileKind = FileKind {
    title: "Export path",
    act: FileAct::Export,
    endings: || PathFormat::ENDINGS.to_vec(),
    formats: || PathFormat::PURPOSES.to_vec(),
    contents: "Lines, tables, routes and pictures",
    folder: "exports",
    suffix: " path",
    command_after_browsing: |path| {
        let is_complete = path.extension().is_some();
        Command::from(if is_complete { PathCommand::Export(path) } else { PathCommand::ExportAs(path) })
    },
    ..FileKind::new(|path| Command::from(PathCommand::ExportAs(path)))
};

/// The use of a file that paths have.
pub static ROLES: [DataRole; 1] = [DataRole {
    place: 14,
    title: "Keep-out region of paths",
    sentence: "Paths stay out of the polygons; the mesh does not change.",
    kind: &OPEN_KEEP_OUT,
    is_for: |contents| matches!(contents, DataContents::Shapes { .. }),
    refusal: |file, _| file.lacks_polygons(),
}];

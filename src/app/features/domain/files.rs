//! The kinds of files that domains are read from.

use crate::app::command::{Command, DomainCommand};
use crate::app::kit::{FileAct, FileKind};

/// Polygons as the domain of a new document.
pub static OPEN_DOMAIN: FileKind = FileKind {
    title: "Open domain",
    act: FileAct::OpenDocument,
    endings: || vec!["geojson", "json"],
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::Domain(DomainCommand::Open(path)))
};

/// Polygons that are added to the domain of the document.
pub static ADD_OUTLINE: FileKind = FileKind {
    title: "Add outline to this document",
    act: FileAct::Add,
    endings: || vec!["geojson", "json"],
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::Domain(DomainCommand::AddOutline(path)))
};

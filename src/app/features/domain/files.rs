//! The kinds of files that domains are read from.

use crate::app::features::domain::DomainCommand;
use meshbrush_io::io::shape_format;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{DataContents, DataRole, FileAct, FileKind};

/// Polygons as the domain of a new document. Longitudes and latitudes are asked about.
pub static OPEN_DOMAIN: FileKind = FileKind {
    title: "Open domain",
    act: FileAct::OpenDocument,
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    command_at_start: |path| Command::from(DomainCommand::OpenFirst(path)),
    ..FileKind::new(|path| Command::from(DomainCommand::Choose(path)))
};

/// Polygons as the domain of a new document, in the coordinates of their file.
pub static OPEN_DOMAIN_AS_IT_IS: FileKind = FileKind {
    title: "Open domain in its own coordinates",
    act: FileAct::OpenDocument,
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(DomainCommand::Open(path)))
};

/// Polygons on the Earth as the domain of a new document, in the plane of a projection.
pub static OPEN_DOMAIN_IN_METRES: FileKind = FileKind {
    title: "Open domain in metres",
    act: FileAct::OpenDocument,
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(DomainCommand::OpenInMetres(path)))
};

/// Land or coasts, whose sea is the domain of a new document.
pub static OPEN_SEA: FileKind = FileKind {
    title: "Open the sea around land",
    act: FileAct::OpenDocument,
    endings: shape_format::endings,
    contents: "Land or coasts",
    folder: "domains",
    is_of_sea: true,
    ..FileKind::new(|path| Command::from(DomainCommand::OpenSea(path)))
};

/// Polygons that are added to the domain of the document.
pub static ADD_OUTLINE: FileKind = FileKind {
    title: "Add outline to this document",
    act: FileAct::Add,
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(DomainCommand::AddOutline(path)))
};

/// The uses of a file that the domain has.
pub static ROLES: [DataRole; 4] = [
    DataRole {
        place: 9,
        title: "Domain in metres",
        sentence: "A new document opens. Its domain lies in the plane of a projection: lengths are metres on the Earth.",
        kind: &OPEN_DOMAIN_IN_METRES,
        is_for: |contents| matches!(contents, DataContents::Shapes { .. }),
        refusal: |file, _| {
            let problem = || "It does not say where on the Earth its coordinates are.".into();
            file.lacks_polygons().or_else(|| (!file.is_on_earth).then(problem))
        },
    },
    DataRole {
        place: 10,
        title: "Domain of a new document",
        sentence: "A new document opens. The polygons are its domain in the coordinates of the file: degrees stay degrees.",
        kind: &OPEN_DOMAIN_AS_IT_IS,
        is_for: |contents| matches!(contents, DataContents::Shapes { .. }),
        refusal: |file, _| file.lacks_polygons(),
    },
    DataRole {
        place: 11,
        title: "Sea around this land",
        sentence: "A new document opens. Its domain is the water around the land, or beside lines of coast.",
        kind: &OPEN_SEA,
        is_for: |contents| matches!(contents, DataContents::Shapes { .. }),
        refusal: |file, _| file.sea.as_ref().err().cloned(),
    },
    DataRole {
        place: 12,
        title: "Outline of this document",
        sentence: "The polygons are added to the domain of this document, or become it.",
        kind: &ADD_OUTLINE,
        is_for: |contents| matches!(contents, DataContents::Shapes { .. }),
        refusal: |file, _| file.lacks_polygons(),
    },
];

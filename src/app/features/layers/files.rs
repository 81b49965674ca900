//! The kinds of files that layers are read from.

use crate::app::command::{Command, LayerCommand};
use crate::app::kit::FileKind;

/// A picture or a grid as risk.
pub static OPEN_RISK: FileKind = FileKind {
    title: "Open picture as risk",
    endings: || vec!["png", "asc"],
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::Layer(LayerCommand::OpenImage(path)))
};

/// A grid as target diameters.
pub static OPEN_DIAMETERS: FileKind = FileKind {
    title: "Open grid as target diameter",
    endings: || vec!["asc"],
    contents: "Grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::Layer(LayerCommand::OpenDiameters(path)))
};

/// A picture or a grid, for a band of its values.
pub static OPEN_BAND: FileKind = FileKind {
    title: "Open picture or grid as band",
    endings: || vec!["png", "asc"],
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::Layer(LayerCommand::OpenBand(path)))
};

/// A picture or a grid through a curve of its values.
pub static OPEN_VALUES: FileKind = FileKind {
    title: "Open picture or grid through a curve",
    endings: || vec!["png", "asc"],
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::Layer(LayerCommand::OpenValues(path)))
};

/// Points, lines and polygons as a layer of distances.
pub static OPEN_SHAPES: FileKind = FileKind {
    title: "Open shapes to measure the distance to",
    endings: || vec!["geojson", "json"],
    contents: "Points, lines and polygons",
    folder: "shapes",
    ..FileKind::new(|path| Command::Layer(LayerCommand::OpenShapes(path)))
};

/// Points, lines and polygons in place of those of a layer.
pub static REPLACE_SHAPES: FileKind = FileKind {
    title: "Open other shapes for this layer",
    endings: || vec!["geojson", "json"],
    contents: "Points, lines and polygons",
    folder: "shapes",
    ..FileKind::new(|path| Command::Layer(LayerCommand::ReplaceShapes(path)))
};

/// Polygons as the mask of a layer.
pub static OPEN_MASK: FileKind = FileKind {
    title: "Open polygons as mask",
    endings: || vec!["geojson", "json"],
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::Layer(LayerCommand::OpenMask(path)))
};

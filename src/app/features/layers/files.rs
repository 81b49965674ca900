//! The kinds of files that layers are read from.

use meshbrush_io::io::{RasterFormat, shape_format};
use meshbrush_kit::kit::command::{Command, LayerCommand};
use meshbrush_kit::kit::{DataContents, DataFile, DataRole, FileAct, FileKind, FrameState};

fn raster_endings() -> Vec<&'static str> {
    RasterFormat::all().flat_map(RasterFormat::endings).copied().collect()
}

fn grid_endings() -> Vec<&'static str> {
    let grids = RasterFormat::all().filter(|format| format.is_grid());
    grids.flat_map(RasterFormat::endings).copied().collect()
}

fn shape_and_table_endings() -> Vec<&'static str> {
    shape_format::endings().into_iter().chain(["csv"]).collect()
}

/// What a layer asks for, as a grid.
pub static EXPORT_GRID: FileKind = FileKind {
    title: "Export the layer as a grid",
    act: FileAct::Export,
    endings: || vec!["asc"],
    contents: "Grids",
    folder: "exports",
    suffix: " layer",
    command_after_browsing: |path| Command::from(LayerCommand::ExportGrid(path)),
    ..FileKind::new(|path| Command::from(LayerCommand::ExportGridAs(path)))
};

/// A picture or a grid as risk.
pub static OPEN_RISK: FileKind = FileKind {
    title: "Open picture as risk",
    endings: raster_endings,
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenImage(path)))
};

/// A grid as target diameters.
pub static OPEN_DIAMETERS: FileKind = FileKind {
    title: "Open grid as target diameter",
    endings: grid_endings,
    contents: "Grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenDiameters(path)))
};

/// A grid of heights or depths of water.
pub static OPEN_DEPTH: FileKind = FileKind {
    title: "Open grid of depths",
    endings: grid_endings,
    contents: "Grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenDepth(path)))
};

/// A picture or a grid, for a band of its values.
pub static OPEN_BAND: FileKind = FileKind {
    title: "Open picture or grid as band",
    endings: raster_endings,
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenBand(path)))
};

/// A picture or a grid as a surface that the mesh is to be close to.
pub static OPEN_SURFACE: FileKind = FileKind {
    title: "Open picture or grid as surface",
    endings: raster_endings,
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenSurface(path)))
};

/// A picture or a grid through a curve of its values.
pub static OPEN_VALUES: FileKind = FileKind {
    title: "Open picture or grid through a curve",
    endings: raster_endings,
    contents: "Pictures and grids",
    folder: "pictures",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenValues(path)))
};

/// Points, lines and polygons as a layer of distances.
pub static OPEN_SHAPES: FileKind = FileKind {
    title: "Open shapes to measure the distance to",
    endings: shape_and_table_endings,
    contents: "Points, lines and polygons",
    folder: "shapes",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenShapes(path)))
};

/// Points, lines and polygons in place of those of a layer.
pub static REPLACE_SHAPES: FileKind = FileKind {
    title: "Open other shapes for this layer",
    endings: shape_and_table_endings,
    contents: "Points, lines and polygons",
    folder: "shapes",
    ..FileKind::new(|path| Command::from(LayerCommand::ReplaceShapes(path)))
};

/// Polygons as the mask of a layer.
pub static OPEN_MASK: FileKind = FileKind {
    title: "Open polygons as mask",
    endings: shape_format::endings,
    contents: "Polygons",
    folder: "domains",
    ..FileKind::new(|path| Command::from(LayerCommand::OpenMask(path)))
};

/// The uses of a file that layers have.
pub static ROLES: [DataRole; 8] = [
    DataRole {
        place: 12,
        title: "Shapes to measure the distance to",
        sentence: "A layer is fine at the shapes, and grows with the distance to them.",
        kind: &OPEN_SHAPES,
        is_for: |contents| matches!(contents, DataContents::Shapes { .. } | DataContents::Points(_)),
        refusal: |_, _| None,
    },
    DataRole {
        place: 13,
        title: "Mask of the selected layer",
        sentence: "The selected layer counts only inside the polygons.",
        kind: &OPEN_MASK,
        is_for: |contents| matches!(contents, DataContents::Shapes { .. }),
        refusal: |file, state| file.lacks_polygons().or_else(|| no_layer(state)),
    },
    DataRole {
        place: 20,
        title: "Risk",
        sentence: "A layer of risk from 0 to 1; the curve from risk to diameter says how fine that is.",
        kind: &OPEN_RISK,
        is_for: is_raster,
        refusal: |file, _| {
            refused_values(file, |least, greatest| least >= 0.0 && greatest <= 1.0, "from 0 to 1")
        },
    },
    DataRole {
        place: 21,
        title: "Values through a curve",
        sentence: "A layer whose curve gives the diameter for each value, such as finer where the water is shallow.",
        kind: &OPEN_VALUES,
        is_for: is_raster,
        refusal: |file, _| refused_values(file, |_, _| true, ""),
    },
    DataRole {
        place: 22,
        title: "Target diameter",
        sentence: "A layer of target diameters, in the unit of the document.",
        kind: &OPEN_DIAMETERS,
        is_for: is_raster,
        refusal: |file, _| match file.contents {
            DataContents::Grid(_) => refused_values(file, |least, _| least > 0.0, "above 0"),
            _ => Some("Diameters are read from grids, not from pictures.".into()),
        },
    },
    DataRole {
        place: 24,
        title: "Depth of water",
        sentence: "Files get the depth at each node; a layer asks for triangles by wavelength, slope or time step.",
        kind: &OPEN_DEPTH,
        is_for: |contents| matches!(contents, DataContents::Grid(_)),
        refusal: |file, _| refused_values(file, |_, _| true, ""),
    },
    DataRole {
        place: 25,
        title: "Surface",
        sentence: "The mesh is the smallest whose values, linear over triangles, are within an error of the grid's.",
        kind: &OPEN_SURFACE,
        is_for: is_raster,
        refusal: |file, _| refused_values(file, |_, _| true, ""),
    },
    DataRole {
        place: 23,
        title: "Band of values",
        sentence: "A layer with one diameter where the value lies between two numbers.",
        kind: &OPEN_BAND,
        is_for: is_raster,
        refusal: |file, _| refused_values(file, |_, _| true, ""),
    },
];

fn is_raster(contents: &DataContents) -> bool {
    matches!(contents, DataContents::Grid(_) | DataContents::Picture(_))
}

fn no_layer(state: &FrameState<'_>) -> Option<String> {
    let is_missing = state.session.document().active_layer().is_none();
    is_missing.then(|| "No layer is selected.".into())
}

/// Returns why the least and the greatest value of a raster are not allowed.
fn refused_values(file: &DataFile, is_allowed: fn(f64, f64) -> bool, rule: &str) -> Option<String> {
    match file.raster()?.values {
        Some([least, greatest]) if is_allowed(least, greatest) => None,
        Some(_) => Some(format!("The values of the file are not all {rule}.")),
        None => Some("No pixel of the file has a value.".into()),
    }
}

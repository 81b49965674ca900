//! Reads the files of layers: rasters, shapes and masks.

use std::path::Path;
use std::sync::Arc;

use super::ground::ground_under;
use meshbrush_core::document::{Settings, extent};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{
    DistanceTo, LayerKind, RasterLayer, RasterReading, RasterSource, ShapeList, Shapes,
};
use meshbrush_core::raster::{Raster, RasterPyramid, RasterValues};
use meshbrush_io::io::layers::{
    LoadedRaster, RasterError, RasterFile, RasterFrame, RasterLoader, in_direction,
};
use meshbrush_io::io::{self, DocumentPlane, FileCoordinates, Meter};
use meshbrush_kit::kit::background::{Aim, Background, Outcome, name_of};
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand, ShellCommand};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::{EmptyDocument, raster_frame, show_with_layer, with_mask, with_space_around};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// How a part of a grid becomes a document in metres.
const COAST_IN_METRES: &str = "Open a coast as “Domain in metres”, and add the grid to it.";

/// Says how a document in another unit becomes one in metres.
pub fn way_to_metres(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Degree => {
            "Open the coast as “Domain in metres” and add the grid to it, or start a new document with the grid as “Depth of \
             water”."
        }
        _ => "Open a domain whose coordinates are metres.",
    }
}

/// Reads a picture or a grid, and adds it as a layer of risk.
pub fn load_image(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Risk, |source, _| {
        Some(LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk }))
    });
}

/// Reads a picture or a grid, and adds it as a layer of target diameters.
pub fn load_diameters(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Diameter, |source, _| {
        Some(LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter }))
    });
}

/// Reads a picture or a grid, and adds a band of its values.
pub fn load_band(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Any, LayerKind::band_of);
}

/// Reads a grid of heights or depths, and adds a layer of depths. An empty document becomes one in metres
/// where that is possible.
pub fn load_depth(session: &Session, background: &mut Background, path: &Path) {
    let making = Making { values: RasterValues::Any, kind_of: LayerKind::depths_of, is_depth: true };
    load_layer(session, background, path, making);
}

/// Reads a picture or a grid, and adds it as a surface that the mesh is to be close to.
pub fn load_surface(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Any, LayerKind::surface_of);
}

/// Reads a picture or a grid, and adds it as a layer with a curve from its values to diameters.
pub fn load_values(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Any, LayerKind::curve_of);
}

/// How a layer is made of a raster.
#[derive(Clone, Copy)]
struct Making {
    values: RasterValues,
    kind_of: fn(RasterSource, &Transfer) -> Option<LayerKind>,
    /// Whether its sizes are from depths, and need metres.
    is_depth: bool,
}

/// Reads a picture or a grid, and adds what it becomes as a layer. An empty document takes its extent.
fn load_raster(
    session: &Session,
    background: &mut Background,
    path: &Path,
    values: RasterValues,
    kind_of: fn(RasterSource, &Transfer) -> Option<LayerKind>,
) {
    load_layer(session, background, path, Making { values, kind_of, is_depth: false });
}

/// The document that a raster is read for.
struct Target {
    frame: RasterFrame,
    empty: Option<EmptyDocument>,
    unit: LengthUnit,
}

fn load_layer(session: &Session, background: &mut Background, path: &Path, making: Making) {
    let file = path.to_owned();
    let unit = session.document().settings().unit;
    let target = Target { frame: raster_frame(session), empty: EmptyDocument::of(session), unit };
    background.start(Aim::Read, path, move |meter| match layer_of(&file, making, &target, meter) {
        // Only what the window opens by its ending is among the recent files.
        Ok(commands) if making.values == RasterValues::Risk => Outcome::Read { path: file, commands },
        Ok(commands) => Outcome::PartRead(commands),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Returns the commands that add a raster as a layer, or show it in place of an empty document.
fn layer_of(file: &Path, making: Making, target: &Target, meter: &Meter) -> Result<Vec<Command>, String> {
    let LoadedRaster { raster, facts, coordinates } = raster_of(file, making.values, &target.frame, meter)?;
    let bounds = raster.raster().bounds();
    let ground = target
        .empty
        .as_ref()
        .and_then(|empty| ground_under(empty, file, &raster, coordinates, making.is_depth));
    let note = |note: &String| format!("{}: {note}", name_of(file));
    let mut notes: Vec<String> = facts.notes.iter().map(note).collect();
    let (settings, raster) = match ground {
        Some(ground) => {
            notes.extend(ground.note);
            (Some(ground.settings), ground.raster.unwrap_or(raster))
        }
        None => (None, raster),
    };
    let lack = match making.is_depth {
        true => lack_of_metres(file, settings.as_ref(), target, coordinates),
        false => None,
    };
    let kind_of = if lack.is_some() { LayerKind::depths_without_sizes } else { making.kind_of };
    notes.extend(lack);
    let transfer = settings.as_ref().map_or(target.frame.transfer, |settings| settings.transfer);
    let source = RasterSource { name: name_of(file), raster };
    let kind = kind_of(source, &transfer).ok_or_else(|| no_values(file))?;
    let kind = in_direction(kind, facts.positive);
    if let Some(settings) = settings {
        return show_with_layer(settings.with_nodes_on_samples(&kind), kind, file, &notes);
    }
    check_place(&bounds, &target.frame.domain, file)?;
    let mut commands = commands_to_add(kind);
    if !notes.is_empty() {
        commands.push(Command::from(ShellCommand::Tell(notes.join(" "))));
    }
    Ok(commands)
}

/// Returns a sentence where sizes from depths have no metres in the document that the raster is for.
fn lack_of_metres(
    file: &Path,
    over: Option<&Settings>,
    target: &Target,
    coordinates: Option<FileCoordinates>,
) -> Option<String> {
    let unit = over.map_or(target.unit, |settings| settings.unit);
    let is_stated = matches!(coordinates, Some(FileCoordinates::Known(_)));
    let in_degrees =
        is_stated && coordinates.is_some_and(|coordinates| coordinates.unit() == LengthUnit::Degree);
    let lies_in_degrees = unit == LengthUnit::None && target.frame.plane.is_none() && in_degrees;
    if unit.may_be_metres() && !lies_in_degrees {
        return None;
    }
    let unit = if lies_in_degrees { LengthUnit::Degree } else { unit };
    // A grid that begins a document in degrees cannot begin one in metres.
    let is_whole = over.is_some() && unit == LengthUnit::Degree;
    let way = if is_whole { COAST_IN_METRES } else { way_to_metres(unit) };
    Some(format!(
        "The layer {} asks for no sizes: they need a document in metres, and this one is in {}. {way}",
        name_of(file),
        unit.name()
    ))
}

fn commands_to_add(kind: LayerKind) -> Vec<Command> {
    vec![Command::from(LayerCommand::Add(Box::new(kind))), Command::from(EditCommand::EndGesture)]
}

/// Reads points, lines and polygons, and adds a layer of the distance to them. An empty document takes their
/// extent.
pub fn load_shapes(session: &Session, background: &mut Background, path: &Path) {
    let Settings { transfer, domain, .. } = session.document().settings();
    let (transfer, plane) = (*transfer, domain.projection.map(DocumentPlane::from));
    let (file, empty) = (path.to_owned(), EmptyDocument::of(session));
    background.start(Aim::Read, path, move |meter| {
        let read = || {
            let (to, extent, unit) = shapes_of(&file, plane.as_ref(), meter)?;
            let over = empty.and_then(|empty| empty.over(&file, with_space_around(extent), unit));
            let transfer = over.as_ref().map_or(transfer, |settings| settings.transfer);
            let kind = LayerKind::distance_to(to, &transfer, Settings::DEFAULT_GRADATION);
            over.map_or_else(
                || Ok(commands_to_add(kind.clone())),
                |settings| show_with_layer(settings, kind.clone(), &file, &[]),
            )
        };
        match read() {
            Ok(commands) => Outcome::PartRead(commands),
            Err(problem) => Outcome::NotRead(problem),
        }
    });
}

/// Reads points, lines and polygons, to which the selected layer measures the distance from then on.
pub fn replace_shapes(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    let (file, plane) = (path.to_owned(), session.document().settings().domain.projection);
    let plane = plane.map(DocumentPlane::from);
    background.start(Aim::Read, path, move |meter| match shapes_of(&file, plane.as_ref(), meter) {
        Ok((to, ..)) => Outcome::PartRead(vec![Command::from(LayerCommand::MeasureTo(layer, to))]),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads polygons as the mask of the selected layer.
pub fn load_mask(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    with_mask(session, background, path, move |mask| Command::from(LayerCommand::Mask(layer, Some(mask))));
}

/// Returns the shapes of a file, or the points of a table, with their extent and the unit of coordinates;
/// longitudes and latitudes in the plane of the document, if it has one. The distance within a polygon is 0.
fn shapes_of(
    path: &Path,
    plane: Option<&DocumentPlane>,
    meter: &Meter,
) -> Result<(DistanceTo, Rect, LengthUnit), String> {
    let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let (list, unit) = if is_table {
        let table = io::points::read_table(path).map_err(|error| error.to_string())?;
        let points = table.points(plane.map(|plane| plane.projection));
        (ShapeList { points, ..ShapeList::default() }, LengthUnit::None)
    } else {
        let file = io::shape_format::read_shapes(path, plane, meter).map_err(|error| error.to_string())?;
        (file.shapes, file.coordinates.unit())
    };
    let shapes = Shapes::new(list, true).map_err(|error| format!("{}: {error}", path.display()))?;
    let extent = shapes.extent();
    Ok((DistanceTo::Shapes { name: name_of(path), shapes }, extent, unit))
}

/// Returns the raster of a file at its place; one of a format without a place where its world file says, or
/// else over the domain.
fn raster_of(
    path: &Path,
    values: RasterValues,
    frame: &RasterFrame,
    meter: &Meter,
) -> Result<LoadedRaster, String> {
    let file = RasterFile::named(path).map_err(|rule| format!("{}: {rule}", path.display()))?;
    let loaded = RasterLoader::new(meter).load(&file, values, frame);
    let loaded = loaded.map_err(|error| match (&error, values) {
        (RasterError::Value(_), RasterValues::Risk) => {
            format!(
                "{error} If they are target diameters, add the file with “Add data…” in the menu File as target diameter."
            )
        }
        _ => error.to_string(),
    })?;
    let beside = match file.format.has_place() {
        false => io::world_file::bounds_beside(path, loaded.raster.raster().size()),
        true => Ok(None),
    };
    Ok(match beside.map_err(|error| error.to_string())? {
        Some(bounds) => LoadedRaster { raster: placed(loaded.raster.raster(), bounds), ..loaded },
        None => loaded,
    })
}

fn placed(raster: &Raster, bounds: Rect) -> Arc<RasterPyramid> {
    Arc::new(RasterPyramid::new(Raster::from_values(bounds, raster.size(), raster.values().to_vec())))
}

/// Checks that a raster covers some of the document.
fn check_place(grid: &Rect, document: &Rect, path: &Path) -> Result<(), String> {
    if grid.intersection(document).is_some_and(|common| common.is_proper()) {
        return Ok(());
    }
    let (file, grid, document) = (path.display(), extent(grid), extent(document));
    Err(format!(
        "{file}: the grid lies outside this document: it covers {grid}, and the document {document}. Set the bounds in \
         the Domain panel first, or open the file in an empty document, which takes its extent."
    ))
}

fn no_values(path: &Path) -> String {
    format!("{}: no pixel of the grid has a value, so there is nothing to make a layer of.", path.display())
}

//! Reads the files of layers: rasters, shapes and masks.

use std::path::Path;
use std::sync::Arc;

use crate::app::background::{Aim, Background, Outcome, name_of};
use crate::app::command::{Command, EditCommand, LayerCommand, ShellCommand};
use crate::app::kit::{EmptyDocument, raster_frame, show_with_layer, with_mask, with_space_around};
use crate::app::session::Session;
use meshbrush_core::document::{Settings, extent};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{DistanceTo, LayerKind, RasterReading, RasterSource, ShapeList, Shapes};
use meshbrush_core::raster::{Raster, RasterPyramid, RasterValues};
use meshbrush_io::io::layers::{
    LoadedRaster, RasterError, RasterFile, RasterFrame, RasterLoader, in_direction,
};
use meshbrush_io::io::{self, DocumentPlane, Meter, ValueFacts};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Reads a picture or a grid, and adds it as a layer of risk.
pub fn load_image(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Risk, |source, _| {
        Some(LayerKind::Raster { source, reading: RasterReading::Risk })
    });
}

/// Reads a picture or a grid, and adds it as a layer of target diameters.
pub fn load_diameters(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Diameter, |source, _| {
        Some(LayerKind::Raster { source, reading: RasterReading::Diameter })
    });
}

/// Reads a picture or a grid, and adds a band of its values.
pub fn load_band(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Any, LayerKind::band_of);
}

/// Reads a grid of heights or depths, and adds a layer of depths.
pub fn load_depth(session: &Session, background: &mut Background, path: &Path) {
    let kind_of = match session.document().settings().unit.may_be_metres() {
        true => LayerKind::depths_of,
        false => LayerKind::depths_without_sizes,
    };
    load_raster(session, background, path, RasterValues::Any, kind_of);
}

/// Reads a picture or a grid, and adds it as a surface that the mesh is to be close to.
pub fn load_surface(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Any, LayerKind::surface_of);
}

/// Reads a picture or a grid, and adds it as a layer with a curve from its values to diameters.
pub fn load_values(session: &Session, background: &mut Background, path: &Path) {
    load_raster(session, background, path, RasterValues::Any, LayerKind::curve_of);
}

/// Reads a picture or a grid, and adds what it becomes as a layer. An empty document takes its extent.
fn load_raster(
    session: &Session,
    background: &mut Background,
    path: &Path,
    values: RasterValues,
    kind_of: fn(RasterSource, &Transfer) -> Option<LayerKind>,
) {
    let (file, empty) = (path.to_owned(), EmptyDocument::of(session));
    let frame = raster_frame(session);
    background.start(Aim::Read, path, move |meter| {
        let read = || {
            let (source, facts) = raster_of(&file, values, &frame, meter)?;
            let bounds = source.raster.raster().bounds();
            let over = empty.and_then(|empty| empty.over(&file, bounds, LengthUnit::None));
            let transfer = over.as_ref().map_or(frame.transfer, |settings| settings.transfer);
            let kind = kind_of(source, &transfer).ok_or_else(|| no_values(&file))?;
            let kind = in_direction(kind, facts.positive);
            let mut commands = match over {
                Some(settings) => show_with_layer(settings.with_nodes_on_samples(&kind), kind, &file),
                None => check_place(&bounds, &frame.domain, &file).map(|()| commands_to_add(kind)),
            }?;
            let notes = facts.notes.iter().map(|note| format!("{}: {note}", name_of(&file)));
            let notes: Vec<String> = notes.collect();
            if !notes.is_empty() {
                commands.push(Command::Shell(ShellCommand::Tell(notes.join(" "))));
            }
            Ok(commands)
        };
        match read() {
            // Only what the window opens by its ending is among the recent files.
            Ok(commands) if values == RasterValues::Risk => Outcome::Read { path: file, commands },
            Ok(commands) => Outcome::PartRead(commands),
            Err(problem) => Outcome::NotRead(problem),
        }
    });
}

fn commands_to_add(kind: LayerKind) -> Vec<Command> {
    vec![Command::Layer(LayerCommand::Add(Box::new(kind))), Command::Edit(EditCommand::EndGesture)]
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
            let kind = LayerKind::distance_to(to, &transfer, Settings::USUAL_GRADATION);
            over.map_or_else(
                || Ok(commands_to_add(kind.clone())),
                |settings| show_with_layer(settings, kind.clone(), &file),
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
        Ok((to, ..)) => Outcome::PartRead(vec![Command::Layer(LayerCommand::MeasureTo(layer, to))]),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads polygons as the mask of the selected layer.
pub fn load_mask(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    with_mask(session, background, path, move |mask| Command::Layer(LayerCommand::Mask(layer, Some(mask))));
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
) -> Result<(RasterSource, ValueFacts), String> {
    let file = RasterFile::named(path).map_err(|rule| format!("{}: {rule}", path.display()))?;
    let loaded = RasterLoader::new(meter).load(&file, values, frame);
    let LoadedRaster { raster, facts } = loaded.map_err(|error| match (&error, values) {
        (RasterError::Value(_), RasterValues::Risk) => {
            format!(
                "{error} If they are target diameters, add the file with *Add data…* in the menu File as target diameter."
            )
        }
        _ => error.to_string(),
    })?;
    let beside = match file.format.has_place() {
        false => io::world_file::bounds_beside(path, raster.raster().size()),
        true => Ok(None),
    };
    let raster = match beside.map_err(|error| error.to_string())? {
        Some(bounds) => placed(raster.raster(), bounds),
        None => raster,
    };
    Ok((RasterSource { name: name_of(path), raster }, facts))
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

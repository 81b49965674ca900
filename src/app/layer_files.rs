//! Opening and writing the files of layers: rasters, shapes, masks and threats.

use std::path::Path;
use std::sync::Arc;

use super::background::{Aim, Background, Outcome, exported, name_of};
use super::command::{Command, EditCommand, LayerCommand};
use super::session::Session;
use super::tools::ThreatsTool;
use super::widgets::format;
use meshbrush_core::document::{Settings, extent};
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::{DistanceTo, LayerKind, Mask, RasterReading, RasterSource, Shapes, Threats};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::png::Behind;
use meshbrush_io::io::{self, Meter};
use meshbrush_mesh::geometry::Rect;

/// Reads a picture and adds it as a layer of risk.
pub fn load_image(session: &Session, background: &mut Background, path: &Path) {
    let bounds = session.document().settings().domain.bounds;
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match risk_of(&file, bounds, meter) {
        Ok(raster) => {
            let kind = raster_layer(&file, raster, RasterReading::Risk);
            let commands = vec![
                Command::Layer(LayerCommand::Add(Box::new(kind))),
                Command::Edit(EditCommand::EndGesture),
            ];
            Outcome::Read { path: file, commands }
        }
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads a grid and adds it as a layer of target diameters.
pub fn load_diameters(session: &Session, background: &mut Background, path: &Path) {
    let bounds = session.document().settings().domain.bounds;
    load_layer(background, path, move |file, meter| {
        Ok(raster_layer(file, diameters_of(file, bounds, meter)?, RasterReading::Diameter))
    });
}

/// Reads a picture or a grid, and adds a band of its values.
pub fn load_band(session: &Session, background: &mut Background, path: &Path) {
    let Settings { domain, transfer, .. } = session.document().settings();
    let (bounds, transfer) = (domain.bounds, *transfer);
    load_layer(background, path, move |file, meter| {
        LayerKind::band_of(values_of(file, bounds, meter)?, &transfer).ok_or_else(|| no_values(file))
    });
}

/// Reads a picture or a grid, and adds it as a layer with a curve from its values to diameters.
pub fn load_values(session: &Session, background: &mut Background, path: &Path) {
    let Settings { domain, transfer, .. } = session.document().settings();
    let (bounds, transfer) = (domain.bounds, *transfer);
    load_layer(background, path, move |file, meter| {
        LayerKind::curve_of(values_of(file, bounds, meter)?, &transfer).ok_or_else(|| no_values(file))
    });
}

/// Reads points, lines and polygons, and adds a layer of the distance to them.
pub fn load_shapes(session: &Session, background: &mut Background, path: &Path) {
    let transfer = session.document().settings().transfer;
    load_layer(background, path, move |file, meter| {
        Ok(LayerKind::distance_to(shapes_of(file, meter)?, &transfer, Settings::USUAL_GRADATION))
    });
}

/// Reads points, lines and polygons, to which the selected layer measures the distance from then on.
pub fn replace_shapes(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match shapes_of(&file, meter) {
        Ok(to) => Outcome::PartRead(vec![Command::Layer(LayerCommand::MeasureTo(layer, to))]),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads a file, and adds what it becomes as a layer.
fn load_layer(
    background: &mut Background,
    path: &Path,
    kind_of: impl FnOnce(&Path, &Meter) -> Result<LayerKind, String> + Send + 'static,
) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| match kind_of(&file, meter) {
        Ok(kind) => Outcome::PartRead(vec![
            Command::Layer(LayerCommand::Add(Box::new(kind))),
            Command::Edit(EditCommand::EndGesture),
        ]),
        Err(problem) => Outcome::NotRead(problem),
    });
}

/// Reads polygons as the mask of the selected layer.
pub fn load_mask(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    with_mask(background, path, move |mask| Command::Layer(LayerCommand::Mask(layer, Some(mask))));
}

/// Reads polygons as one mask, and sends a command with it.
pub fn with_mask(
    background: &mut Background,
    path: &Path,
    command: impl FnOnce(Mask) -> Command + Send + 'static,
) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let named = match io::geojson::read_named_metered(&file, meter) {
            Ok(named) => named,
            Err(error) => return Outcome::not_read(error),
        };
        let polygons: Vec<Polygon> = named.into_iter().map(|named| named.polygon).collect();
        match Mask::new(&polygons) {
            Ok(mask) => Outcome::PartRead(vec![command(mask)]),
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Reads a table of threats in place of those of the selected layer.
pub fn load_threats(session: &Session, background: &mut Background, path: &Path) {
    let Some(layer) = session.document().active_layer().map(|layer| layer.id) else { return };
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let list = match io::threats::read(&file, meter) {
            Ok(list) => list,
            Err(error) => return Outcome::not_read(error),
        };
        match Threats::new(list) {
            Ok(threats) => {
                let change = LayerCommand::SetKind(layer, Box::new(LayerKind::Threats(threats)));
                Outcome::PartRead(vec![
                    Command::Edit(EditCommand::EndGesture),
                    Command::Layer(change),
                    Command::Edit(EditCommand::EndGesture),
                ])
            }
            Err((_, error)) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

/// Writes the threats of the selected layer as a table.
pub fn save_threats(session: &Session, background: &mut Background, path: &Path) {
    let Some((_, threats)) = ThreatsTool::layer(session.document()) else { return };
    let (threats, file) = (threats.clone(), path.to_owned());
    background.start(Aim::Export, path, move |meter| {
        let written = io::write_file_metered(&file, meter, |out| io::threats::write(out, threats.list()));
        let count = format::count(threats.list().len() as u64);
        exported(written, meter, &file, || format!("{count} threats written to {}.", file.display()))
    });
}

fn source_of(file: &Path, raster: Raster) -> RasterSource {
    RasterSource { name: name_of(file), raster: Arc::new(RasterPyramid::new(raster)) }
}

fn raster_layer(file: &Path, raster: Raster, reading: RasterReading) -> LayerKind {
    LayerKind::Raster { source: source_of(file, raster), reading }
}

/// The shapes of a file. The distance within a polygon is 0.
fn shapes_of(path: &Path, meter: &Meter) -> Result<DistanceTo, String> {
    let list = io::shapes::read(path, meter).map_err(|error| error.to_string())?.shapes;
    let shapes = Shapes::new(list, true).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(DistanceTo::Shapes { name: name_of(path), shapes })
}

/// The values of a picture over `bounds`, black 0 and white 1, or of a grid, as they are.
fn values_of(path: &Path, bounds: Rect, meter: &Meter) -> Result<RasterSource, String> {
    let raster = if is_grid(path) {
        grid_within(path, bounds, meter)?
    } else {
        let picture = io::png::read_metered(path, bounds, Behind::White, meter);
        picture.map_err(|error| error.to_string())?
    };
    Ok(source_of(path, raster))
}

fn no_values(path: &Path) -> String {
    format!("{}: no pixel of the grid has a value, so there is nothing to make a layer of.", path.display())
}

fn is_grid(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("asc"))
}

/// Target diameters by pixel; infinite where the grid has no value.
fn diameters_of(path: &Path, bounds: Rect, meter: &Meter) -> Result<Raster, String> {
    let grid = grid_within(path, bounds, meter)?;
    if let Some((x, y)) = grid.all().pixels().find(|&(x, y)| grid.get(x, y) <= 0.0) {
        let (value, at) = (grid.get(x, y), grid.pixel_center(x, y));
        return Err(format!(
            "{}: the target diameter is {value} at x = {}, y = {}; it must be positive.",
            path.display(),
            at.x,
            at.y
        ));
    }
    let values =
        grid.values().iter().map(|&value| if value.is_nan() { f32::INFINITY } else { value }).collect();
    Ok(Raster::from_values(grid.bounds(), grid.size(), values))
}

/// A grid that covers some of `bounds`.
fn grid_within(path: &Path, bounds: Rect, meter: &Meter) -> Result<Raster, String> {
    let grid = io::asc::read_metered(path, meter).map_err(|error| error.to_string())?;
    if grid.bounds().intersection(&bounds).is_none_or(|common| !common.is_proper()) {
        let (file, grid, document) = (path.display(), extent(&grid.bounds()), extent(&bounds));
        return Err(format!(
            "{file}: the grid lies outside this document: it covers {grid}, and the document {document}. Set the bounds in \
             the Domain panel first."
        ));
    }
    Ok(grid)
}

/// Risks by pixel: a picture over `bounds`, or a grid, which has a placement of its own.
fn risk_of(path: &Path, bounds: Rect, meter: &Meter) -> Result<Raster, String> {
    if !is_grid(path) {
        let picture = io::png::read_metered(path, bounds, Behind::Black, meter);
        return picture.map_err(|error| error.to_string());
    }
    let grid = grid_within(path, bounds, meter)?;
    let file = path.display();
    if let Some((x, y)) = grid.all().pixels().find(|&(x, y)| !is_risk(grid.get(x, y))) {
        let (value, at) = (grid.get(x, y), grid.pixel_center(x, y));
        return Err(format!(
            "{file}: the risk is {value} at x = {}, y = {}; it must lie from 0 to 1. If the values are target \
             diameters, use *Open grid as target diameter…* in the menu File; else scale them first.",
            at.x, at.y
        ));
    }
    let values = grid.values().iter().map(|&risk| if risk.is_nan() { 0.0 } else { risk }).collect();
    Ok(Raster::from_values(grid.bounds(), grid.size(), values))
}

/// Whether a pixel of a grid is a risk, or has no value.
fn is_risk(value: f32) -> bool {
    value.is_nan() || (0.0..=1.0).contains(&value)
}

//! Opening and writing the files of layers: rasters, shapes, masks and threats.

use std::path::Path;

use crate::app::background::{Aim, Background, Outcome, name_of};
use crate::app::command::{Command, EditCommand, LayerCommand};
use crate::app::kit::with_mask;
use crate::app::session::Session;
use meshbrush_core::document::{Settings, extent};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{DistanceTo, LayerKind, RasterReading, RasterSource, Shapes};
use meshbrush_io::io::layers::{RasterError, RasterFile, RasterFrame, RasterLoader, RasterValues};
use meshbrush_io::io::{self, Meter};
use meshbrush_mesh::geometry::Rect;

/// Reads a picture or a grid, and adds it as a layer of risk.
pub fn load_image(session: &Session, background: &mut Background, path: &Path) {
    let (bounds, transfer) = frame_of(session);
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        match raster_of(&file, RasterValues::Risk, bounds, transfer, meter) {
            Ok(source) => {
                let kind = LayerKind::Raster { source, reading: RasterReading::Risk };
                let commands = vec![
                    Command::Layer(LayerCommand::Add(Box::new(kind))),
                    Command::Edit(EditCommand::EndGesture),
                ];
                Outcome::Read { path: file, commands }
            }
            Err(problem) => Outcome::NotRead(problem),
        }
    });
}

/// Reads a picture or a grid, and adds it as a layer of target diameters.
pub fn load_diameters(session: &Session, background: &mut Background, path: &Path) {
    let (bounds, transfer) = frame_of(session);
    load_layer(background, path, move |file, meter| {
        let source = raster_of(file, RasterValues::Diameter, bounds, transfer, meter)?;
        Ok(LayerKind::Raster { source, reading: RasterReading::Diameter })
    });
}

/// Reads a picture or a grid, and adds a band of its values.
pub fn load_band(session: &Session, background: &mut Background, path: &Path) {
    let (bounds, transfer) = frame_of(session);
    load_layer(background, path, move |file, meter| {
        let source = raster_of(file, RasterValues::Any, bounds, transfer, meter)?;
        LayerKind::band_of(source, &transfer).ok_or_else(|| no_values(file))
    });
}

/// Reads a picture or a grid, and adds it as a layer with a curve from its values to diameters.
pub fn load_values(session: &Session, background: &mut Background, path: &Path) {
    let (bounds, transfer) = frame_of(session);
    load_layer(background, path, move |file, meter| {
        let source = raster_of(file, RasterValues::Any, bounds, transfer, meter)?;
        LayerKind::curve_of(source, &transfer).ok_or_else(|| no_values(file))
    });
}

/// Returns the rectangle that pictures cover, in world units, and the scale of those of diameters.
fn frame_of(session: &Session) -> (Rect, Transfer) {
    let Settings { domain, transfer, .. } = session.document().settings();
    (domain.bounds, *transfer)
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

/// The shapes of a file. The distance within a polygon is 0.
fn shapes_of(path: &Path, meter: &Meter) -> Result<DistanceTo, String> {
    let list = io::shapes::read(path, meter).map_err(|error| error.to_string())?.shapes;
    let shapes = Shapes::new(list, true).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(DistanceTo::Shapes { name: name_of(path), shapes })
}

/// Returns the raster of a picture over `bounds`, or of a grid, which has to cover some of `bounds`.
fn raster_of(
    path: &Path,
    values: RasterValues,
    bounds: Rect,
    transfer: Transfer,
    meter: &Meter,
) -> Result<RasterSource, String> {
    let file = RasterFile::named(path).map_err(|rule| format!("{}: {rule}", path.display()))?;
    let frame = RasterFrame { domain: bounds, transfer };
    let raster = RasterLoader::new(meter).load(&file, values, &frame).map_err(|error| match (&error, values) {
        (RasterError::Value(_), RasterValues::Risk) => {
            format!(
                "{error} If they are target diameters, use *Open grid as target diameter…* in the menu File."
            )
        }
        _ => error.to_string(),
    })?;
    let grid = raster.raster().bounds();
    if grid.intersection(&bounds).is_none_or(|common| !common.is_proper()) {
        let (file, grid, document) = (path.display(), extent(&grid), extent(&bounds));
        return Err(format!(
            "{file}: the grid lies outside this document: it covers {grid}, and the document {document}. Set the bounds in \
             the Domain panel first."
        ));
    }
    Ok(RasterSource { name: name_of(path), raster })
}

fn no_values(path: &Path) -> String {
    format!("{}: no pixel of the grid has a value, so there is nothing to make a layer of.", path.display())
}

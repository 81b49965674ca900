//! A region that is a contour of a grid of heights or depths, or where a grid has values.

use std::path::Path;

use super::super::geojson::Outline;
use super::super::settings::RegionCoordinates;
use super::super::{GridPlace, GridWindow, Meter, RasterFormat, ReadRaster};
use super::LoadError;
use super::file_frame::{is_beyond_180, is_on_earth};
use meshbrush_core::domain::{NamedPolygon, PixelLengths, Polygon};
use meshbrush_core::layers::{DepthRule, DepthSizes, PositiveDepth};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Returns the polygons of the water of a grid, or of its values, in its own coordinates, and sentences for a
/// person about it. Where `bounds` are certain to be one rectangle of the grid, only that part is read.
///
/// # Errors
/// Fails when the file cannot be read, does not say where it lies, or has no water.
pub fn contour_of_grid(
    file: &Path,
    format: RasterFormat,
    bounds: Option<Rect>,
    region: &RegionCoordinates,
    meter: &Meter,
) -> Result<(Outline, Vec<String>), LoadError> {
    let unsuited = |problem: &str| LoadError::Unsuited(format!("{}: {problem}", file.display()));
    let ReadRaster::Grid(read) = format.read() else {
        return Err(unsuited(
            "a region from a contour needs a grid that says where it lies, such as .asc, .tif or .nc.",
        ));
    };
    let window = bounds.filter(|area| is_of_file(area, region)).map(|area| GridWindow { area, plane: None });
    let grid = read(file, &GridPlace { over: None, window }, meter)?;
    let positive = region.positive.or(grid.facts.positive).unwrap_or(PositiveDepth::Up);
    let coordinates = grid.coordinates().assuming(region.assumed);
    let lengths = match coordinates.unit() {
        LengthUnit::Degree => PixelLengths::Degrees,
        _ => PixelLengths::Plane,
    };
    let polygons = match region.outside_nodata {
        true => region.contour.polygons_of_values(&grid.raster, lengths),
        false => region.contour.polygons(&grid.raster, lengths, depth_of(positive)),
    };
    let polygons = polygons.map_err(|error| unsuited(&error.to_string()))?;
    let unnamed = |polygon: Polygon| NamedPolygon { polygon, name: String::new() };
    let notes = grid.facts.notes.iter().map(|note| format!("{}: {note}", file.display())).collect();
    Ok((Outline { polygons: polygons.into_iter().map(unnamed).collect(), coordinates }, notes))
}

/// Returns whether bounds are certain to be one rectangle in the coordinates of a file. They can also be
/// metres in the plane of a projection, or cover both ends of a grid that is cut at the antimeridian.
fn is_of_file(bounds: &Rect, region: &RegionCoordinates) -> bool {
    match is_on_earth(bounds) {
        true => !is_beyond_180(bounds),
        false => region.projection.is_none(),
    }
}

/// Returns the depth for a value.
fn depth_of(positive: PositiveDepth) -> impl Fn(f64) -> f64 {
    let sizes =
        DepthSizes { positive, offset: 0.0, between: DepthSizes::ALL_WATER, rule: DepthRule::Nothing };
    move |value| sizes.depth_of(value)
}

//! Files of shapes in any format: polygons as domains and masks; points, lines and polygons to measure the
//! distance to.
//!
//! The ending of the name decides. A file with an unknown ending is read as GeoJSON.

use std::path::Path;

use super::geojson::Outline;
use super::shapes::ShapeFile;
use super::{Meter, ReadError, SHAPE_FORMATS};
use meshbrush_core::domain::NamedPolygon;
use meshbrush_core::earth::Projection;
use meshbrush_mesh::text::LengthUnit;

/// A file format of shapes, as its module describes it.
pub struct ShapeFormatSpec {
    /// The file name extensions, in lower case and without the dot; the usual one first.
    pub endings: &'static [&'static str],
    /// Reads the polygons of a file, and counts its bytes.
    pub read_outline: fn(&Path, &Meter) -> Result<Outline, ReadError>,
    /// Reads the points, lines and polygons of a file, and counts its bytes.
    pub read_shapes: fn(&Path, &Meter) -> Result<ShapeFile, ReadError>,
}

/// Returns the endings of all formats, in lower case and without the dot.
pub fn endings() -> Vec<&'static str> {
    SHAPE_FORMATS.iter().flat_map(|format| format.endings).copied().collect()
}

/// Reads polygons with their names and their unit. The meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, breaks a rule of its format, or has no polygon, and when the work was
/// cancelled.
pub fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    (format_of(path).read_outline)(path, meter)
}

/// Reads polygons with their names for a document, as [`read_outline`] does. `plane` is that of the document,
/// if it has one: longitudes and latitudes are projected to it.
///
/// # Errors
/// Fails as [`read_outline`] does.
pub fn read_polygons(
    path: &Path,
    plane: Option<&Projection>,
    meter: &Meter,
) -> Result<Vec<NamedPolygon>, ReadError> {
    let outline = read_outline(path, meter)?;
    Ok(match plane {
        Some(plane) if outline.unit == LengthUnit::Degree => outline.in_plane(plane).polygons,
        _ => outline.polygons,
    })
}

/// Reads points, lines and polygons for a document, with their unit. `plane` is as in [`read_polygons`]. The
/// meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, breaks a rule of its format, or has no shape, and when the work was
/// cancelled.
pub fn read_shapes(path: &Path, plane: Option<&Projection>, meter: &Meter) -> Result<ShapeFile, ReadError> {
    let file = (format_of(path).read_shapes)(path, meter)?;
    Ok(match plane {
        Some(plane) if file.unit == LengthUnit::Degree => {
            ShapeFile { shapes: file.shapes.projected(plane), unit: LengthUnit::Metre }
        }
        _ => file,
    })
}

fn format_of(path: &Path) -> &'static ShapeFormatSpec {
    let ending = path.extension().unwrap_or_default();
    let has = |format: &&&ShapeFormatSpec| format.endings.iter().any(|own| ending.eq_ignore_ascii_case(own));
    SHAPE_FORMATS.iter().find(has).unwrap_or(&SHAPE_FORMATS[0])
}

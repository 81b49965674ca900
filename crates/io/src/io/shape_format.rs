//! Files of shapes in any format: polygons as domains and masks; points, lines and polygons to measure the
//! distance to.
//!
//! The ending of the name decides. A file with an unknown ending is read as GeoJSON if it is some.

use std::path::Path;

use super::error::{Flaw, PlacedFlaw};
use super::geojson::Outline;
use super::shapes::ShapeFile;
use super::{DocumentPlane, FileCoordinates, Meter, ReadError, SHAPE_FORMATS};
use meshbrush_core::domain::NamedPolygon;
use meshbrush_core::earth::Coordinates;
use meshbrush_mesh::geometry::Rect;

/// Reads the shapes of a file that can meet a rectangle, and counts its bytes.
pub type ReadShapesNear = fn(&Path, Rect, &Meter) -> Result<ShapeFile, ReadError>;

/// A file format of shapes, as its module describes it.
pub struct ShapeFormatSpec {
    /// The file name extensions, in lower case and without the dot; the default one first.
    pub endings: &'static [&'static str],
    /// Reads the polygons of a file, and counts its bytes.
    pub read_outline: fn(&Path, &Meter) -> Result<Outline, ReadError>,
    /// Reads the points, lines and polygons of a file, and counts its bytes.
    pub read_shapes: fn(&Path, &Meter) -> Result<ShapeFile, ReadError>,
    /// Reads the shapes that can meet a rectangle in the coordinates of the file, after whole turns of
    /// longitudes; `None` where the format does not tell the extent of a shape before its points.
    pub read_shapes_near: Option<ReadShapesNear>,
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
    let read = (format_of(path).read_outline)(path, meter).map(Outline::in_degrees);
    read.map_err(|error| with_endings(error, path))
}

/// Reads polygons with their names for a document, as [`read_outline`] does. `plane` is that of the document,
/// if it has one: the polygons are projected to it.
///
/// # Errors
/// Fails as [`read_outline`] does, and where the file names a coordinate system that is not known.
pub fn read_polygons(
    path: &Path,
    plane: Option<&DocumentPlane>,
    meter: &Meter,
) -> Result<Vec<NamedPolygon>, ReadError> {
    placed_polygons(read_outline(path, meter)?, plane, path)
}

/// Returns the polygons of an outline for a document with this plane, if it has one. Errors call it `name`.
///
/// # Errors
/// Fails where the outline names a coordinate system that is not known.
pub fn placed_polygons(
    outline: Outline,
    plane: Option<&DocumentPlane>,
    name: &Path,
) -> Result<Vec<NamedPolygon>, ReadError> {
    let Some(plane) = plane else { return Ok(outline.polygons) };
    let placed = outline.in_plane(plane).map_err(|flaw| PlacedFlaw::from(flaw).in_file(name))?;
    Ok(placed.polygons)
}

/// Reads points, lines and polygons for a document, with what their coordinates are. `plane` is as in
/// [`read_polygons`]. The meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, breaks a rule of its format, has no shape, or names a coordinate
/// system that is not known for a document with a plane, and when the work was cancelled.
pub fn read_shapes(
    path: &Path,
    plane: Option<&DocumentPlane>,
    meter: &Meter,
) -> Result<ShapeFile, ReadError> {
    placed_shapes(read_own_shapes(path, None, meter)?, plane, path)
}

/// Reads points, lines and polygons in the coordinates of their file; other longitudes and latitudes are in
/// degrees from Greenwich. Where a rectangle is `wanted`, shapes far from it can be left out.
///
/// # Errors
/// Fails when the file cannot be read, breaks a rule of its format, or has no shape, and when the work was
/// cancelled.
pub fn read_own_shapes(path: &Path, wanted: Option<Rect>, meter: &Meter) -> Result<ShapeFile, ReadError> {
    let format = format_of(path);
    let read = match (format.read_shapes_near, wanted) {
        (Some(read_near), Some(wanted)) => read_near(path, wanted, meter),
        _ => (format.read_shapes)(path, meter),
    };
    read.map(ShapeFile::in_degrees).map_err(|error| with_endings(error, path))
}

/// Returns shapes for a document with this plane, if it has one. Errors call their file `name`.
///
/// # Errors
/// Fails where the file names a coordinate system that is not known.
pub(super) fn placed_shapes(
    file: ShapeFile,
    plane: Option<&DocumentPlane>,
    name: &Path,
) -> Result<ShapeFile, ReadError> {
    let Some(plane) = plane else { return Ok(file) };
    let way = plane.way_of_shapes(&file.coordinates);
    Ok(match way.map_err(|flaw| PlacedFlaw::from(flaw).in_file(name))? {
        Some(reprojection) => ShapeFile {
            shapes: file.shapes.projected(&reprojection),
            coordinates: FileCoordinates::Known(Coordinates::Plane(plane.projection)),
        },
        None => file,
    })
}

fn format_of(path: &Path) -> &'static ShapeFormatSpec {
    known_format(path).unwrap_or(SHAPE_FORMATS[0])
}

fn known_format(path: &Path) -> Option<&'static ShapeFormatSpec> {
    let ending = path.extension().unwrap_or_default();
    let has = |format: &&&ShapeFormatSpec| format.endings.iter().any(|own| ending.eq_ignore_ascii_case(own));
    SHAPE_FORMATS.iter().find(has).copied()
}

/// Returns the error of a file, with the endings that are known where its own is not and its content is no
/// GeoJSON.
fn with_endings(error: ReadError, path: &Path) -> ReadError {
    match error.flaw {
        Flaw::Syntax(sentence) if known_format(path).is_none() => {
            let endings: Vec<String> = endings().into_iter().map(|ending| format!(".{ending}")).collect();
            let known = endings.join(", ");
            let sentence = format!(
                "the endings of files of shapes are {known}; with another one it is read as GeoJSON, and {sentence}"
            );
            ReadError { flaw: Flaw::Syntax(sentence), ..error }
        }
        _ => error,
    }
}

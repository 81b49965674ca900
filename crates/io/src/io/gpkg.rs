//! `.gpkg`: GeoPackages, the databases of points, lines and polygons that QGIS and others write
//! (OGC 12-128r18). They are read with the feature `gpkg` of the package.
//!
//! A file can have several layers, each a table. The shapes of all of them are read where they have the same
//! coordinate system.

use std::path::Path;

use super::Meter;
use super::error::ReadError;
use super::format_spec::ShapeFormatSpec;
use super::geojson::Outline;
use super::shapes::ShapeFile;

/// The format, for the list of all formats of shapes.
pub static FORMAT: ShapeFormatSpec =
    ShapeFormatSpec { endings: &["gpkg"], read_outline, read_shapes: read, read_shapes_near: None };

/// Reads the polygons of a file with their names, from a column *name* if there is one.
///
/// # Errors
/// Fails when the file cannot be read, is not a GeoPackage, or has no polygon or too many points, when
/// several of its layers have polygons, and when the work was cancelled.
pub fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    database::outline(path, meter).map_err(|flaw| flaw.in_file(path))
}

/// Reads the shapes of all layers of a file.
///
/// # Errors
/// Fails when the file cannot be read, is not a GeoPackage, has no shape or too many points, when its layers
/// have several coordinate systems, and when the work was cancelled.
pub fn read(path: &Path, meter: &Meter) -> Result<ShapeFile, ReadError> {
    database::shapes(path, meter).map_err(|flaw| flaw.in_file(path))
}

/// Without a reader of databases.
#[cfg(not(feature = "gpkg"))]
mod database {
    use std::path::Path;

    use crate::io::Meter;
    use crate::io::disk;
    use crate::io::error::{Flaw, PlacedFlaw};
    use crate::io::geojson::Outline;
    use crate::io::shapes::ShapeFile;

    fn absent<T>(path: &Path) -> Result<T, PlacedFlaw> {
        disk::find(path)?;
        let problem = "this program was built without the reader of GeoPackages, the feature `gpkg`. Export the layer \
                       as GeoJSON.";
        Err(Flaw::Syntax(problem.into()).into())
    }

    pub(super) fn outline(path: &Path, _: &Meter) -> Result<Outline, PlacedFlaw> {
        absent(path)
    }

    pub(super) fn shapes(path: &Path, _: &Meter) -> Result<ShapeFile, PlacedFlaw> {
        absent(path)
    }
}

#[cfg(feature = "gpkg")]
mod connection;
#[cfg(feature = "gpkg")]
mod database;

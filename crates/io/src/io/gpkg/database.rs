//! Reads the tables of a GeoPackage, with SQLite.

use std::path::Path;

use rusqlite::{Connection, Row};

use crate::io::coordinates::{self, FileCoordinates};
use crate::io::error::{Flaw, PlacedFlaw};
use crate::io::geojson::{self, Outline};
use crate::io::gpkg::connection::Database;
use crate::io::shapes::{self, ShapeFile};
use crate::io::wkb::WkbBytes;
use crate::io::{CoordinateSystem, Meter};
use meshbrush_core::domain::NamedPolygon;
use meshbrush_core::layers::ShapeList;

/// Bytes of the envelope in front of a geometry, by its number in the header.
const ENVELOPES: [usize; 5] = [0, 32, 48, 48, 64];

/// Most tables of shapes.
const MOST_LAYERS: usize = 1000;
/// Most characters of a name of a row that are read.
const LONGEST_NAME: usize = 250;

/// A table of shapes, or a view.
struct Layer {
    table: String,
    column: String,
    /// The number of its coordinate system in the file.
    system: i64,
    /// The shapes of each row, with the name of the row.
    rows: Vec<(ShapeList, String)>,
}

impl Layer {
    fn has_polygons(&self) -> bool {
        self.rows.iter().any(|(shapes, _)| !shapes.polygons.is_empty())
    }
}

pub(super) fn outline(path: &Path, meter: &Meter) -> Result<Outline, PlacedFlaw> {
    let (database, layers) = layers_of(path, meter)?;
    let names: Vec<String> =
        layers.iter().filter(|layer| layer.has_polygons()).map(|layer| layer.table.clone()).collect();
    if names.len() > 1 {
        let problem = format!(
            "it has several layers with polygons: {}. Export the one that is the domain, as GeoJSON or into a \
             GeoPackage of its own.",
            names.join(", ")
        );
        return Err(Flaw::Syntax(problem).into());
    }
    let Some(layer) = layers.into_iter().find(Layer::has_polygons) else {
        return Err(Flaw::Syntax(geojson::no_polygon(&[])).into());
    };
    let system = layer.system;
    let of_row = |(shapes, name): (ShapeList, String)| {
        shapes.polygons.into_iter().map(move |polygon| NamedPolygon { polygon, name: name.clone() })
    };
    let polygons: Vec<NamedPolygon> = layer.rows.into_iter().flat_map(of_row).collect();
    let corners = polygons.iter().flat_map(|named| &named.polygon).flatten().copied();
    let coordinates = system_of(&database, system)?.unwrap_or_else(|| FileCoordinates::unstated(corners));
    Ok(Outline { polygons, coordinates })
}

pub(super) fn shapes(path: &Path, meter: &Meter) -> Result<ShapeFile, PlacedFlaw> {
    let (database, layers) = layers_of(path, meter)?;
    let system = layers.first().map(|layer| layer.system);
    if layers.iter().any(|layer| Some(layer.system) != system) {
        let problem = "its layers have several coordinate systems. Export the layer that is wanted, as GeoJSON or \
                       into a GeoPackage of its own.";
        return Err(Flaw::Syntax(problem.into()).into());
    }
    let mut all = ShapeList::default();
    for (shapes, _) in layers.into_iter().flat_map(|layer| layer.rows) {
        all.points.extend(shapes.points);
        all.lines.extend(shapes.lines);
        all.polygons.extend(shapes.polygons);
    }
    shapes::check(&all)?;
    let stated = system.map(|system| system_of(&database, system)).transpose()?.flatten();
    let coordinates = stated.unwrap_or_else(|| FileCoordinates::unstated(shapes::places(&all)));
    Ok(ShapeFile { shapes: all, coordinates })
}

/// Opens a file, and reads the layers that have shapes.
fn layers_of(path: &Path, meter: &Meter) -> Result<(Database, Vec<Layer>), PlacedFlaw> {
    let database = Database::open(path, meter)?;
    let bytes = database.bytes;
    meter.expect(bytes);
    let mut layers = tables(&database.connection).map_err(|error| database.flaw(error))?;
    if layers.len() > MOST_LAYERS {
        let problem = format!(
            "it has more than {MOST_LAYERS} layers, which is the limit. Export those that are wanted."
        );
        return Err(Flaw::Syntax(problem).into());
    }
    let (mut corners, mut counted) = (0, 0);
    for layer in &mut layers {
        read_rows(&database, layer, meter, &mut (&mut corners, &mut counted))?;
    }
    meter.add(bytes.saturating_sub(counted)).map_err(Flaw::from)?;
    layers.retain(|layer| !layer.rows.is_empty());
    Ok((database, layers))
}

/// Returns the tables of shapes in the order of their names, without their rows; one too many where they are
/// too many.
fn tables(connection: &Connection) -> rusqlite::Result<Vec<Layer>> {
    let sql =
        "SELECT table_name, column_name, srs_id FROM gpkg_geometry_columns ORDER BY table_name LIMIT ?1";
    let layer = |row: &Row| {
        Ok(Layer { table: row.get(0)?, column: row.get(1)?, system: row.get(2)?, rows: Vec::new() })
    };
    connection.prepare(sql)?.query_map([MOST_LAYERS as i64 + 1], layer)?.collect()
}

/// Returns what the coordinates of a system of the file are; `None` where it says that they are undefined.
fn system_of(database: &Database, system: i64) -> Result<Option<FileCoordinates>, PlacedFlaw> {
    if system <= 0 {
        return Ok(None);
    }
    let sql = "SELECT organization, organization_coordsys_id, definition FROM gpkg_spatial_ref_sys WHERE srs_id = ?1";
    let read = |row: &Row| Ok((row.get::<_, String>(0)?, row.get::<_, i64>(1)?, row.get::<_, String>(2)?));
    let (organization, code, definition) =
        database.connection.query_row(sql, [system], read).map_err(|error| database.flaw(error))?;
    if organization.eq_ignore_ascii_case("epsg") {
        return Ok(u32::try_from(code).ok().map(coordinates::of_epsg));
    }
    let described = CoordinateSystem::from_wkt(&definition);
    Ok(Some(described.map_or(FileCoordinates::Foreign(Default::default()), |system| system.stated())))
}

/// Returns a name as SQL writes it.
fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

/// Reads the rows of a layer that have shapes. `counts` are the corners and the bytes so far.
fn read_rows(
    database: &Database,
    layer: &mut Layer,
    meter: &Meter,
    counts: &mut (&mut usize, &mut u64),
) -> Result<(), PlacedFlaw> {
    let refused = |error| database.flaw(error);
    let connection = &database.connection;
    let (table, column) = (quoted(&layer.table), quoted(&layer.column));
    let named = format!("SELECT count(*) FROM pragma_table_info({table}) WHERE lower(name) = 'name'");
    let has_name = connection.query_row(&named, [], |row| row.get::<_, i64>(0)).map_err(refused)? > 0;
    let name = format!("substr(CAST(name AS TEXT), 1, {LONGEST_NAME})");
    let name = if has_name { &*name } else { "NULL" };
    let sql = format!("SELECT {column}, {name} FROM {table} WHERE {column} IS NOT NULL");
    // The rows of a view have no numbers: they come in the order of its query.
    let in_order = connection.prepare(&format!("{sql} ORDER BY rowid"));
    let mut statement = in_order.or_else(|_| connection.prepare(&sql)).map_err(refused)?;
    let mut rows = statement.query([]).map_err(refused)?;
    let mut number = 0;
    while let Some(row) = rows.next().map_err(refused)? {
        number += 1;
        let bytes = row.get_ref(0).map_err(refused)?.as_blob().map_err(|error| refused(error.into()))?;
        meter.add(bytes.len() as u64).map_err(Flaw::from)?;
        *counts.1 += bytes.len() as u64;
        let mut shapes = ShapeList::default();
        read_blob(bytes, &mut shapes).map_err(|rule| {
            Flaw::Syntax(format!("row {number} of the layer {} {rule}. Export it again.", layer.table))
        })?;
        *counts.0 += shapes::places(&shapes).count();
        shapes::check_count(*counts.0)?;
        let name = row.get::<_, Option<String>>(1).map_err(refused)?.unwrap_or_default();
        if shapes::places(&shapes).next().is_some() {
            layer.rows.push((shapes, name));
        }
    }
    Ok(())
}

/// Reads a geometry: two letters, a version, flags, the number of its system, its envelope, and well-known
/// binary.
fn read_blob(bytes: &[u8], shapes: &mut ShapeList) -> Result<(), String> {
    let mut bytes = WkbBytes::new(bytes, true);
    let header = bytes.take(8)?;
    if &header[..2] != b"GP" {
        return Err("is no geometry: it begins with other bytes".into());
    }
    let flags = header[3];
    let envelope = ENVELOPES.get(usize::from(flags >> 1 & 7)).ok_or("has an unknown envelope")?;
    bytes.take(*envelope)?;
    let is_extended = flags & 1 << 5 != 0;
    if is_extended {
        return Err("is of a type of its own (ExtendedGeoPackageBinary)".into());
    }
    bytes.geometry(shapes)
}

#[cfg(test)]
mod tests;

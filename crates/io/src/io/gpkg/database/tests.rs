//! Files that GDAL wrote, with QGIS's defaults but for the index; and broken ones.

use std::path::PathBuf;

use glam::dvec2;

use super::*;
use crate::io::gpkg;
use meshbrush_core::earth::Coordinates;

const LAND: &[u8] = include_bytes!("../land.gpkg");
const TWO: &[u8] = include_bytes!("../two.gpkg");

/// A file in the folder of the system that is removed in the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("meshbrush-{}-{name}.gpkg", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn polygons_have_their_names_and_their_system() {
    let file = Scratch::new("land", LAND);
    let meter = Meter::default();
    let outline = gpkg::read_outline(&file.0, &meter).unwrap();
    assert_eq!(outline.coordinates, FileCoordinates::Known(Coordinates::Geographic));
    let names: Vec<&str> = outline.polygons.iter().map(|named| &*named.name).collect();
    assert_eq!(names, ["Big", "Big", "Small é"]);
    assert_eq!(outline.polygons[0].polygon.len(), 2, "with its hole");
    let corners = [dvec2(7.0, 0.0), dvec2(8.0, 0.0), dvec2(8.0, 1.0)];
    assert!(corners.iter().all(|corner| outline.polygons[2].polygon[0].contains(corner)), "without heights");
    assert_eq!(outline.polygons[2].polygon[0].len(), 3);
    assert_eq!((meter.done(), meter.total()), (LAND.len() as u64, Some(LAND.len() as u64)));
}

#[test]
fn shapes_of_all_layers_are_read() {
    let file = Scratch::new("two", TWO);
    let found = gpkg::read(&file.0, &Meter::default()).unwrap();
    assert_eq!(found.shapes.points, [dvec2(1.0, 2.0)]);
    assert_eq!(found.shapes.lines, [[dvec2(0.0, 0.0), dvec2(1.0, 1.0)]]);
    assert_eq!(found.coordinates, coordinates::of_epsg(32633));
    let refused = gpkg::read_outline(&file.0, &Meter::default()).unwrap_err().to_string();
    assert!(refused.contains("a domain needs a Polygon"), "{refused}");
}

#[test]
fn what_cannot_be_read_is_a_sentence() {
    let text = Scratch::new(
        "text",
        b"no database at all, but long enough to be looked at by SQLite: 0123456789 0123456789 0123456789",
    );
    let sentence = gpkg::read(&text.0, &Meter::default()).unwrap_err().to_string();
    assert!(sentence.contains("is not a GeoPackage that can be read"), "{sentence}");
    let missing = gpkg::read(&text.0.with_extension("missing.gpkg"), &Meter::default()).unwrap_err();
    assert!(missing.to_string().contains("cannot be read"), "{missing}");
    let cancelled = Meter::default();
    cancelled.cancel();
    let file = Scratch::new("cancelled", LAND);
    assert!(gpkg::read(&file.0, &cancelled).is_err());
    let mut random = fastrand::Rng::with_seed(1);
    for n in 0..60 {
        let mut bytes = LAND.to_vec();
        for _ in 0..4 {
            let place = random.usize(..bytes.len());
            bytes[place] = random.u8(..);
        }
        let end = if n % 2 == 0 { bytes.len() } else { random.usize(..bytes.len()) };
        let file = Scratch::new("broken", &bytes[..end]);
        let _ = gpkg::read_outline(&file.0, &Meter::default());
    }
}

#[test]
fn several_layers_of_polygons_or_systems_are_refused() {
    let file = Scratch::new("several", LAND);
    let connection = Connection::open(&file.0).unwrap();
    connection
        .execute_batch(
            "CREATE TABLE \"old \"\"land\" AS SELECT * FROM land;
             INSERT INTO gpkg_contents (table_name, data_type, identifier) VALUES ('old \"land', 'features', 'b');
             INSERT INTO gpkg_geometry_columns VALUES ('old \"land', 'geom', 'POLYGON', 4326, 0, 0);",
        )
        .unwrap();
    drop(connection);
    let sentence = gpkg::read_outline(&file.0, &Meter::default()).unwrap_err().to_string();
    assert!(sentence.contains("several layers with polygons: land, old \"land"), "{sentence}");
    assert_eq!(gpkg::read(&file.0, &Meter::default()).unwrap().shapes.polygons.len(), 6);
    let connection = Connection::open(&file.0).unwrap();
    connection
        .execute_batch("UPDATE gpkg_geometry_columns SET srs_id = -1 WHERE table_name = 'land'")
        .unwrap();
    drop(connection);
    let sentence = gpkg::read(&file.0, &Meter::default()).unwrap_err().to_string();
    assert!(sentence.contains("several coordinate systems"), "{sentence}");
}

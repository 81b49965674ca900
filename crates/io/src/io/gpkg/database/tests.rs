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

/// Returns a good file in which the only layer is the view of this query.
fn with_view(name: &str, query: &str) -> Scratch {
    let file = Scratch::new(name, LAND);
    let connection = Connection::open(&file.0).unwrap();
    let sql = format!(
        "CREATE VIEW shown AS {query};
         UPDATE gpkg_geometry_columns SET table_name = 'shown';"
    );
    connection.execute_batch(&format!("PRAGMA foreign_keys = OFF; {sql}")).unwrap();
    file
}

#[test]
fn views_are_read_as_tables_are() {
    let file = with_view("view", "SELECT name, geom FROM land WHERE name <> 'Big'");
    let outline = gpkg::read_outline(&file.0, &Meter::default()).unwrap();
    let names: Vec<&str> = outline.polygons.iter().map(|named| &*named.name).collect();
    assert_eq!(names, ["Small é"]);
}

#[test]
fn queries_of_views_are_limited_in_time_and_memory() {
    let count = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)";
    for (name, query, said) in [
        ("endless", format!("{count} SELECT CASE WHEN i < 0 THEN x'' END AS geom FROM n"), "take too long"),
        ("endless-rows", format!("{count} SELECT x'' AS geom FROM n"), "row 1 of the layer"),
        ("late", format!("{count} SELECT geom FROM land, n WHERE n.i < 0"), "take too long"),
        ("long", "SELECT zeroblob(1000000000) AS geom".into(), "more than 64 MiB"),
        ("sorted", format!("{count} SELECT randomblob(1000000) AS geom FROM n ORDER BY 1"), "of memory"),
        ("absent", "SELECT geom FROM missing".into(), "that can be read (no such table: main.missing)"),
        (
            "function",
            "SELECT load_extension('a') AS geom".into(),
            "that can be read (unsafe use of load_extension())",
        ),
    ] {
        let file = with_view(name, &query);
        let refused = gpkg::read(&file.0, &Meter::default()).unwrap_err().to_string();
        assert!(refused.contains(said) && refused.len() < 600, "{name}: {refused}");
        assert!(!refused.contains("SELECT"), "{name}: {refused}");
    }
    let file = with_view("cancelled-view", &format!("{count} SELECT geom FROM land, n WHERE n.i < 0"));
    let meter = Meter::default();
    let cancel = {
        let meter = meter.clone();
        std::thread::spawn(move || {
            std::thread::sleep(std::time::Duration::from_millis(20));
            meter.cancel();
        })
    };
    let refused = gpkg::read(&file.0, &meter).unwrap_err().to_string();
    assert!(refused.contains("it was cancelled"), "{refused}");
    cancel.join().unwrap();
}

#[cfg(unix)]
#[test]
fn changes_beside_a_file_count_and_nothing_stays_behind() {
    use std::os::unix::fs::PermissionsExt as _;

    let folder = std::env::temp_dir().join(format!("meshbrush-{}-wal", std::process::id()));
    std::fs::create_dir(&folder).unwrap();
    let path = folder.join("land.gpkg");
    std::fs::write(&path, LAND).unwrap();
    let names = || {
        let names = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    };
    let polygons = || gpkg::read_outline(&path, &Meter::default()).map(|outline| outline.polygons.len());
    let writer = Connection::open(&path).unwrap();
    writer.pragma_update(None, "journal_mode", "wal").unwrap();
    writer.execute_batch("DELETE FROM land WHERE name <> 'Big'").unwrap();
    assert_eq!(polygons().unwrap(), 2, "as the other program sees them");
    // A copy without the file that SQLite needs beside it, in a folder where nobody makes one.
    let copy = folder.join("copy");
    std::fs::create_dir(&copy).unwrap();
    for ending in ["", "-wal"] {
        std::fs::copy(format!("{}{ending}", path.display()), copy.join(format!("land.gpkg{ending}")))
            .unwrap();
    }
    drop(writer);
    assert_eq!((polygons().unwrap(), names()), (2, vec!["copy".to_owned(), "land.gpkg".to_owned()]));
    std::fs::set_permissions(&copy, std::fs::Permissions::from_mode(0o555)).unwrap();
    let copied = gpkg::read_outline(&copy.join("land.gpkg"), &Meter::default());
    std::fs::set_permissions(&copy, std::fs::Permissions::from_mode(0o755)).unwrap();
    // The superuser makes files in any folder.
    let said = copied.map(|outline| outline.polygons.len()).map_err(|error| error.to_string());
    assert!(
        said == Ok(2) || said.as_ref().is_err_and(|said| said.contains("left changes beside")),
        "{said:?}"
    );
    // With a name that an address must escape.
    let odd = folder.join("a b%20?é#.gpkg");
    std::fs::copy(&path, &odd).unwrap();
    assert_eq!(gpkg::read_outline(&odd, &Meter::default()).unwrap().polygons.len(), 2);
    std::fs::remove_dir_all(folder).unwrap();
}

//! GeoPackages: raw bytes, bytes of a good file changed at some places, and any bytes as a geometry.
//!
//! The first byte of the input says which; 0 is a raw file, 1 changes bytes, and 2 is a geometry.

#![no_main]

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use meshbrush_io::io::{Meter, gpkg};
use rusqlite::Connection;

const LAND: &[u8] = include_bytes!("../../crates/io/src/io/gpkg/land.gpkg");

/// Where files are written.
static FILE: LazyLock<PathBuf> =
    LazyLock::new(|| std::env::temp_dir().join(format!("meshbrush-fuzz-{}.gpkg", std::process::id())));

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((&way, bytes)) = bytes.split_first() else { return };
    match way % 3 {
        0 => std::fs::write(&*FILE, bytes).unwrap(),
        1 => std::fs::write(&*FILE, changed(bytes)).unwrap(),
        _ => write_geometry(bytes),
    }
    check(&FILE);
});

/// A good file, in which each four bytes of `edits` say where another byte is, and which.
fn changed(edits: &[u8]) -> Vec<u8> {
    let mut file = LAND.to_vec();
    for &[a, b, c, byte] in edits.as_chunks::<4>().0 {
        let place = u32::from_le_bytes([a, b, c, 0]) as usize % file.len();
        file[place] = byte;
    }
    file
}

/// A good file with these bytes as its first geometry, after the header of a geometry if they have none.
fn write_geometry(bytes: &[u8]) {
    std::fs::write(&*FILE, LAND).unwrap();
    let header = [b"GP\0\x01".as_slice(), &4326_u32.to_le_bytes()].concat();
    let geometry = if bytes.starts_with(b"GP") { bytes.to_vec() } else { [&header, bytes].concat() };
    let connection = Connection::open(&*FILE).unwrap();
    connection.execute_batch("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;").unwrap();
    connection.execute("UPDATE land SET geom = ?1 WHERE rowid = 1", [&geometry]).unwrap();
}

fn check(path: &Path) {
    let is_sentence =
        |sentence: String| assert!(sentence.len() < 1000 && sentence.ends_with('.'), "{sentence}");
    match gpkg::read(path, &Meter::default()) {
        Ok(file) => {
            assert!(!file.shapes.is_empty());
            let rings = file.shapes.lines.iter().chain(file.shapes.polygons.iter().flatten());
            assert!(rings.flatten().chain(&file.shapes.points).all(|point| point.is_finite()));
        }
        Err(error) => is_sentence(error.to_string()),
    }
    match gpkg::read_outline(path, &Meter::default()) {
        Ok(outline) => assert!(!outline.polygons.is_empty()),
        Err(error) => is_sentence(error.to_string()),
    }
}

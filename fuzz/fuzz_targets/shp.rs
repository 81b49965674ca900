//! Shapefiles.

#![no_main]

use std::path::Path;

use meshbrush_io::io::shp;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| match shp::read_from(bytes, Path::new("fuzz.shp")) {
    Ok(file) => {
        assert!(!file.shapes.is_empty());
        let rings = file.shapes.lines.iter().chain(file.shapes.polygons.iter().flatten());
        assert!(rings.flatten().chain(&file.shapes.points).all(|point| point.is_finite()));
    }
    Err(error) => {
        let sentence = error.to_string();
        assert!(sentence.starts_with("fuzz.shp") && sentence.len() < 1000, "{sentence}");
    }
});

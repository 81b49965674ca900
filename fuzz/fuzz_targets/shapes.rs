//! Files of points, lines and polygons.

#![no_main]

use std::path::Path;

use meshbrush_io::io::shapes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| match shapes::read_from(bytes, Path::new("fuzz.geojson")) {
    Ok(file) => {
        assert!(!file.shapes.is_empty());
        let mut text = Vec::new();
        shapes::write(&mut text, &file.shapes).expect("memory takes every byte");
        let again =
            shapes::read_from(&text[..], Path::new("again.geojson")).expect("what is written is read");
        assert_eq!(again.shapes, file.shapes);
    }
    Err(error) => {
        let sentence = error.to_string();
        assert!(sentence.starts_with("fuzz.geojson") && sentence.len() < 1000, "{sentence}");
    }
});

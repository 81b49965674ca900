//! Tables of points.

#![no_main]

use std::path::Path;

use meshbrush_io::io::points;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = points::read_from(bytes, Path::new("fuzz.csv")) {
        let sentence = error.to_string();
        assert!(sentence.starts_with("fuzz.csv") && sentence.len() < 1000, "{sentence}");
    }
});

//! Recipes. No file that they name is read.

#![no_main]

use std::path::{Path, PathBuf};

use meshbrush_io::io::recipe;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let found = |name: &str| Ok(PathBuf::from(name));
    if let Err(error) = recipe::parse(Path::new("fuzz.toml"), text.to_owned(), &found) {
        let sentence = error.to_string();
        assert!(sentence.starts_with("fuzz.toml"), "{sentence}");
        let first = sentence.lines().next().unwrap_or_default();
        assert!(first.len() < 1000, "{first}");
    }
});

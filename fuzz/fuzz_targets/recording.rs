//! Recordings of edits. The edits are not done again: they may make large meshes.

#![no_main]

use std::path::Path;

use meshbrush_io::io::recording;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = recording::from_bytes(bytes, Path::new("fuzz.jsonl")) {
        let sentence = error.to_string();
        assert!(sentence.starts_with("fuzz.jsonl") && sentence.len() < 1000, "{sentence}");
    }
});

//! Tables of threats.

#![no_main]

use std::path::Path;

use meshbrush_io::io::threats;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| match threats::read_from(bytes, Path::new("fuzz.csv")) {
    Ok(list) => {
        let mut text = Vec::new();
        threats::write(&mut text, &list).expect("memory takes every byte");
        let again = threats::read_from(&text[..], Path::new("again.csv")).expect("what is written is read");
        assert_eq!(again, list);
    }
    Err(error) => {
        let sentence = error.to_string();
        assert!(sentence.starts_with("fuzz.csv") && sentence.len() < 1000, "{sentence}");
    }
});

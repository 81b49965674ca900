//! World files beside a picture.

#![no_main]

use std::fs;

use meshbrush_io::io::world_file;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let folder = std::env::temp_dir().join(format!("meshbrush-fuzz-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("fuzz.pgw"), bytes).unwrap();
    match world_file::bounds_beside(&folder.join("fuzz.png"), [300, 200]) {
        Ok(bounds) => assert!(bounds.expect("there is a world file").is_proper()),
        Err(error) => {
            let sentence = error.to_string();
            assert!(sentence.len() < 1000 && sentence.ends_with('.'), "{sentence}");
        }
    }
});

//! Arrays of NumPy.

#![no_main]

use std::io::Cursor;

use meshbrush_io::io::npy;
use meshbrush_mesh::geometry::Rect;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let raster = match npy::decode(Cursor::new(bytes), Rect::UNIT) {
        Ok(raster) => raster,
        Err(flaw) => {
            let sentence = flaw.to_string();
            assert!(sentence.ends_with('.') && sentence.len() < 1000, "{sentence}");
            return;
        }
    };
    assert!(raster.bounds().is_proper());
    let [columns, rows] = raster.size();
    assert_eq!(raster.values().len(), columns as usize * rows as usize);
    assert!(raster.values().iter().all(|value| !value.is_infinite()));
});

//! GeoTIFF.

#![no_main]

use std::io::Cursor;

use meshbrush_io::io::geotiff;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let raster = match geotiff::decode(Cursor::new(bytes)).map(|read| read.raster) {
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

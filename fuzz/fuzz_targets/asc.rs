//! ESRI ASCII grids.

#![no_main]

use std::path::Path;

use meshbrush_io::io::asc;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(raster) = asc::from_bytes(bytes, Path::new("fuzz.asc")) else { return };
    assert!(raster.bounds().is_proper());
    let [columns, rows] = raster.size();
    assert_eq!(raster.values().len(), columns as usize * rows as usize);
    assert!(raster.values().iter().all(|value| !value.is_infinite()));
});

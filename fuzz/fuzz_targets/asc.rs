//! ESRI ASCII grids.

#![no_main]

mod rasters;

use std::path::Path;

use meshbrush_io::io::asc;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(raster) = asc::from_bytes(bytes, Path::new("fuzz.asc")) {
        rasters::check(&raster);
    }
});

//! GeoTIFF.

#![no_main]

mod rasters;

use std::io::Cursor;

use meshbrush_io::io::geotiff;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    rasters::check_decoded(geotiff::decode(Cursor::new(bytes)).map(|read| read.raster));
});

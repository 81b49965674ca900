//! PNG images.

#![no_main]

mod rasters;

use std::io::Cursor;

use meshbrush_io::io::png::{Behind, decode};
use meshbrush_mesh::geometry::Rect;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for behind in [Behind::Black, Behind::White] {
        let Ok(raster) = decode(Cursor::new(bytes), Rect::UNIT, behind) else { return };
        rasters::check(&raster);
        assert!(raster.values().iter().all(|value| (0.0..=1.0).contains(value)));
    }
});

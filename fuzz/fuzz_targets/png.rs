//! PNG images.

#![no_main]

use std::io::Cursor;

use meshbrush_io::io::png::{Behind, decode};
use meshbrush_mesh::geometry::Rect;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for behind in [Behind::Black, Behind::White] {
        let Ok(raster) = decode(Cursor::new(bytes), Rect::UNIT, behind) else { return };
        let [columns, rows] = raster.size();
        assert_eq!(raster.values().len(), columns as usize * rows as usize);
        assert!(raster.values().iter().all(|value| (0.0..=1.0).contains(value)));
    }
});

//! Arrays of NumPy.

#![no_main]

mod rasters;

use std::io::Cursor;

use meshbrush_io::io::npy;
use meshbrush_mesh::geometry::Rect;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    rasters::check_decoded(npy::decode(Cursor::new(bytes), Rect::UNIT));
});

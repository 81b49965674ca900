//! NetCDF, in the classic forms and in NetCDF-4.

#![no_main]

mod rasters;

use std::io::Cursor;

use glam::dvec2;
use meshbrush_io::io::{GridPlace, GridWindow, Meter, netcdf};
use meshbrush_mesh::geometry::Rect;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let window = GridWindow { area: Rect::new(dvec2(-200.0, -100.0), dvec2(200.0, 100.0)), plane: None };
    for window in [None, Some(window)] {
        let place = GridPlace { over: None, window };
        let read = netcdf::decode(Cursor::new(bytes.to_vec()), None, &place, &Meter::default());
        rasters::check_decoded(read.map(|grid| grid.raster));
    }
});

//! What holds for every raster that is read, and for every sentence about one that is not.

use meshbrush_core::raster::Raster;
use meshbrush_io::io::Flaw;

/// Checks a raster: its place, and that it has a finite value or none for each pixel.
pub fn check(raster: &Raster) {
    assert!(raster.bounds().is_proper());
    let [columns, rows] = raster.size();
    assert_eq!(raster.values().len(), columns as usize * rows as usize);
    assert!(raster.values().iter().all(|value| !value.is_infinite()));
}

/// Checks what was decoded, or the sentence that says why nothing was.
#[allow(dead_code)] // Not every target decodes.
pub fn check_decoded(raster: Result<Raster, Flaw>) {
    match raster {
        Ok(raster) => check(&raster),
        Err(flaw) => {
            let sentence = flaw.to_string();
            assert!(sentence.ends_with('.') && sentence.len() < 1000, "{sentence}");
        }
    }
}

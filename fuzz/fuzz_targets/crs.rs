//! Texts about coordinates: what lies beside a shapefile (`.prj`), and words for projections.

#![no_main]

use meshbrush_core::earth::{Coordinates, Projection, ProjectionChoice};
use meshbrush_io::io::CoordinateSystem;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Some(system) = CoordinateSystem::from_wkt(text) {
        assert!(system.name.is_none_or(|name| !name.is_empty() && name.len() < 1000));
        if let Some(projection) = system.on_earth.and_then(|coordinates| coordinates.projection()) {
            check(&projection.to_string());
        }
    }
    check(text);
    if let Err(error) = text.parse::<Coordinates>() {
        check_sentence(&error.to_string());
    }
    if let Err(error) = text.parse::<ProjectionChoice>() {
        check_sentence(&error.to_string());
    }
});

/// The text of a projection is the projection.
fn check(text: &str) {
    match text.parse::<Projection>() {
        Ok(projection) => {
            let again = projection.to_string();
            assert_eq!(again.parse::<Projection>().ok(), Some(projection), "{again}");
        }
        Err(error) => check_sentence(&error.to_string()),
    }
}

fn check_sentence(sentence: &str) {
    assert!(sentence.len() < 1000 && !sentence.contains('\n'), "{sentence}");
}

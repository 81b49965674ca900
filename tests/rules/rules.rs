//! The rules of the source code. This package uses nothing of the program, so it compiles in a moment.

mod architecture;
mod circles;
mod documents;
mod names;
mod packaging;
mod public_api;
mod python;
mod source;
mod web;

/// The root of the repository.
const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

//! Reads a mask from a file, for a layer or for paths.

use std::path::Path;

use crate::app::background::{Aim, Background, Outcome};
use crate::app::command::Command;
use meshbrush_core::domain::Polygon;
use meshbrush_core::layers::Mask;
use meshbrush_io::io;

/// Reads polygons as one mask, and sends a command with it.
pub fn with_mask(
    background: &mut Background,
    path: &Path,
    command: impl FnOnce(Mask) -> Command + Send + 'static,
) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |meter| {
        let named = match io::shape_format::read_polygons(&file, meter) {
            Ok(named) => named,
            Err(error) => return Outcome::not_read(error),
        };
        let polygons: Vec<Polygon> = named.into_iter().map(|named| named.polygon).collect();
        match Mask::new(&polygons) {
            Ok(mask) => Outcome::PartRead(vec![command(mask)]),
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

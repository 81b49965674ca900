//! Reads a mask from a file, for a layer or for paths.

use std::path::Path;

use crate::kit::background::{Aim, Background, Outcome};
use crate::kit::command::Command;
use crate::kit::session::Session;
use meshbrush_core::layers::Mask;
use meshbrush_io::io;

/// Reads polygons as one mask, and sends a command with it.
pub fn with_mask(
    session: &Session,
    background: &mut Background,
    path: &Path,
    command: impl FnOnce(Mask) -> Command + Send + 'static,
) {
    let (file, plane) = (path.to_owned(), session.document().settings().domain.projection);
    let plane = plane.map(io::DocumentPlane::from);
    background.start(Aim::Read, path, move |meter| {
        let named = match io::shape_format::read_polygons(&file, plane.as_ref(), meter) {
            Ok(named) => named,
            Err(error) => return Outcome::not_read(error),
        };
        match Mask::new(&io::geojson::without_names(named)) {
            Ok(mask) => Outcome::PartRead(vec![command(mask)]),
            Err(error) => Outcome::NotRead(format!("{}: {error}", file.display())),
        }
    });
}

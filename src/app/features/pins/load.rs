//! Reads pins from a table of points.

use std::path::Path;

use super::PinsCommand;
use crate::app::background::{Aim, Background, Outcome};
use crate::app::command::Command;
use meshbrush_io::io;

/// Reads a table of points, and adds a pin at each.
pub fn load_pins(background: &mut Background, path: &Path) {
    let file = path.to_owned();
    background.start(Aim::Read, path, move |_| match io::points::read(&file) {
        Ok(points) => Outcome::PartRead(vec![Command::Pins(PinsCommand::AddAll(points))]),
        Err(error) => Outcome::not_read(error),
    });
}

//! Reads pins from a table of points.

use std::path::Path;
use std::sync::Arc;

use super::PinsCommand;
use super::execute::with_points;
use meshbrush_io::io;
use meshbrush_kit::kit::background::{Aim, Background, Outcome};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::{EmptyDocument, show_over_extent, with_space_around};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Reads a table of points, and adds a pin at each. An empty document takes their extent.
pub fn load_pins(session: &Session, background: &mut Background, path: &Path) {
    let (file, empty) = (path.to_owned(), EmptyDocument::of(session));
    let projection = session.document().settings().domain.projection;
    background.start(Aim::Read, path, move |_| {
        let points = match io::points::read_table(&file) {
            Ok(table) => table.points(projection),
            Err(error) => return Outcome::not_read(error),
        };
        let extent = points.iter().map(|&point| Rect::new(point, point)).reduce(|a, b| a.union(&b));
        let over = empty
            .zip(extent)
            .and_then(|(empty, extent)| empty.over(&file, with_space_around(extent), LengthUnit::None));
        let Some(mut settings) = over else {
            return Outcome::PartRead(vec![Command::from(PinsCommand::AddAll(points))]);
        };
        settings.pins = Arc::new(with_points(Vec::new(), points));
        match show_over_extent(settings, &file, &[]) {
            Ok(commands) => Outcome::PartRead(commands),
            Err(problem) => Outcome::NotRead(problem),
        }
    });
}

//! Reads lines from a file.

use std::path::Path;

use super::LinesCommand;
use meshbrush_io::io::recipe::Loading;
use meshbrush_io::io::settings::{SavedLine, SavedSettings};
use meshbrush_kit::kit::background::{Aim, Background, Outcome};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::session::Session;

/// Reads the lines and polygons of a file for the document, and adds them.
pub fn load_lines(session: &Session, background: &mut Background, path: &Path) {
    let (file, settings) = (path.to_owned(), session.document().settings().clone());
    background.start(Aim::Read, path, move |meter| {
        let line = vec![SavedLine::of_file(&file)];
        let saved: SavedSettings = SavedSettings { line, ..SavedSettings::default() };
        match saved.lines_for(&settings, &Loading::for_document(meter)) {
            Ok((lines, notes)) => Outcome::PartRead(vec![Command::from(LinesCommand::Add(lines, notes))]),
            Err(error) => Outcome::NotRead(error.to_string()),
        }
    });
}

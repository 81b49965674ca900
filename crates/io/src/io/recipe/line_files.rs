//! Lines along which meshes have edges, from files.

use std::path::Path;

use super::LoadError;
use super::files::{Files, Loading};
use crate::io::settings::SavedSettings;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::Line;
use meshbrush_core::layers::ShapeList;
use meshbrush_mesh::text::Grouped;

impl SavedSettings {
    /// Reads the lines for a document. Returns them with notes for a person.
    ///
    /// # Errors
    /// Fails when a file cannot be read or has no lines.
    pub fn lines_for(
        &self,
        settings: &Settings,
        loading: &Loading,
    ) -> Result<(Vec<Line>, Vec<String>), LoadError> {
        let mut files = Files::for_document(settings, None, loading);
        let lines = self.read_lines(&mut files)?;
        Ok((lines, files.notes))
    }
}

/// Refuses a file without lines and polygons. Returns a note on what else is in it.
pub(super) fn check_lines(file: &Path, shapes: &ShapeList) -> Result<Option<String>, LoadError> {
    let ShapeList { points, lines, polygons } = shapes;
    if lines.is_empty() && polygons.is_empty() {
        let problem =
            "has no lines and no polygons. Name a file with lines along which the mesh shall have edges.";
        return Err(LoadError::Unsuited(format!("{} {problem}", file.display())));
    }
    let count = Grouped(points.len());
    let note = || format!("{}: its {count} points are no lines and are left out.", file.display());
    Ok((!points.is_empty()).then(note))
}

//! Lines along which meshes have edges, and the crests of weirs, from files.

use std::path::Path;

use super::LoadError;
use super::files::{Files, Loading};
use crate::io::ValueUnit;
use crate::io::layers::{LayerData, LoadedRaster, RasterError, RasterFile, RasterFrame};
use crate::io::settings::SavedSettings;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{Crest, CrestOnGrid, Line, NoCrest};
use meshbrush_core::layers::{PositiveDepth, ShapeList};
use meshbrush_core::raster::RasterValues;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::{Grouped, Number, short_name};

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
        let lines = self.read_lines(&mut files, settings.domain.bounds)?;
        Ok((lines, files.notes))
    }
}

impl Files<'_> {
    /// Returns the crest of a line from a file with a grid of heights, in a domain with these bounds.
    ///
    /// # Errors
    /// Fails when the file is no grid, and when the line is far from its values.
    pub(super) fn crest_of(&mut self, file: &Path, line: &Line, bounds: Rect) -> Result<Crest, LoadError> {
        let name = file.display();
        let unsuited = |problem: String| LoadError::Unsuited(format!("{name}: {problem}"));
        let grid = RasterFile::named(file).map_err(unsuited)?;
        if !grid.format.is_grid() {
            let problem =
                "a crest needs a grid of heights, as .asc, .tif or .nc have it, and this is a picture.";
            return Err(unsuited(problem.into()));
        }
        let frame = RasterFrame { domain: bounds, wanted: Some(bounds), plane: self.plane, ..self.frame };
        let loaded = self.rasters.load(&grid, RasterValues::Any, &frame);
        let LoadedRaster { raster, facts, .. } = loaded.map_err(|error| match error {
            RasterError::Read(error) => LoadError::Read(error),
            RasterError::Value(problem) => LoadError::Unsuited(problem),
        })?;
        if let ValueUnit::Other(unit) = &facts.unit {
            let sentence = "its values are taken as heights in metres, and it says that their unit is";
            LayerData::note(self, format!("{name}: {sentence} “{unit}”."));
        }
        let CrestOnGrid { mut crest, farthest } =
            CrestOnGrid::of(line, raster.raster(), &bounds).map_err(|NoCrest { place }| {
                unsuited(format!(
                    "it has no height within 64 pixels of the line “{}” at x = {}, y = {}. Choose a grid that covers the line, \
                     or write the height as a number.",
                    short_name(&line.name),
                    Number(place.x),
                    Number(place.y)
                ))
            })?;
        if facts.positive == Some(PositiveDepth::Down) {
            crest = crest.negated();
            let sentence = "it says that its values are depths, positive downwards; crests are minus these.";
            LayerData::note(self, format!("{name}: {sentence}"));
        }
        if let Some(farthest) = farthest {
            LayerData::note(
                self,
                format!(
                    "{name}: where it has no value along the line “{}”, the crest has the height of the nearest pixel, at most \
                     {farthest:.1} away.",
                    short_name(&line.name)
                ),
            );
        }
        Ok(crest)
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

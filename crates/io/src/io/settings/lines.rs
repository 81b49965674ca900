//! Lines along which the derived mesh has edges.

use std::path::Path;

use glam::DVec2;

use super::SavedLine;
use crate::io::KeyFault;
use crate::io::layers::points;
use meshbrush_core::domain::{Line, LineKind};
use meshbrush_core::layers::ShapeList;

/// The name of a line that has neither a name nor a file.
const DEFAULT_NAME: &str = "Line";

impl SavedLine {
    /// Returns a line with its points in place.
    pub fn of(Line { name, points, closed, kind }: &Line) -> Self {
        let points = points.iter().map(DVec2::to_array).collect();
        Self { name: Some(name.clone()), points: Some(points), closed: *closed, ..Self::of_kind(kind) }
    }

    /// Returns the lines of a file, with its name.
    pub fn of_file(file: &Path) -> Self {
        Self { name: name_of(file), file: Some(file.to_owned()), ..Self::default() }
    }

    /// Gives lines of a file its name, unless they have one.
    pub(super) fn name_after_file(&mut self) {
        self.name = self.name.take().or_else(|| name_of(self.file.as_deref()?));
    }

    /// Returns the points, if they are in place.
    pub(super) fn check(&self) -> Result<Option<Vec<DVec2>>, KeyFault> {
        self.checked_kind()?;
        match (&self.points, &self.file) {
            (Some(_), Some(_)) => Err(KeyFault::key("file", "a line has `points` or `file`, not both.")),
            (None, None) => Err(KeyFault::entry("points", "a line needs `points` or `file`.")),
            (None, Some(_)) if self.closed => {
                let sentence =
                    "this is for a line with `points`; in a file, polygons are closed lines. Leave it out.";
                Err(KeyFault::key("closed", sentence))
            }
            (None, Some(_)) => Ok(None),
            (Some(at), None) => points(at, 2, "a line").map(Some).map_err(|fault| fault.within("points")),
        }
    }

    /// Returns the line, or all lines of its file, before they have their kind; `read` reads the file. Lines
    /// of a file are numbered where it has several.
    pub(super) fn load<E: From<KeyFault>>(
        &self,
        read: impl FnOnce(&Path) -> Result<ShapeList, E>,
    ) -> Result<Vec<Line>, E> {
        let in_place = self.check()?;
        let name = self.name.clone().unwrap_or_else(|| DEFAULT_NAME.into());
        let Some(file) = self.file.as_deref().filter(|_| in_place.is_none()) else {
            let points = in_place.unwrap_or_default();
            return Ok(vec![Line { name, points, closed: self.closed, kind: LineKind::Edges }]);
        };
        let ShapeList { points: _, lines, polygons } = read(file)?;
        let open = lines.into_iter().map(|points| (points, false));
        let closed = polygons.into_iter().flatten().map(|points| (points, true));
        let all: Vec<(Vec<DVec2>, bool)> = open.chain(closed).collect();
        let is_one = all.len() == 1;
        let numbered = (1..).zip(all).map(|(number, (points, closed))| {
            let name = if is_one { name.clone() } else { format!("{name} {number}") };
            Line { name, points, closed, kind: LineKind::Edges }
        });
        Ok(numbered.collect())
    }
}

/// Returns the name of a file without its ending.
fn name_of(file: &Path) -> Option<String> {
    file.file_stem().map(|stem| stem.to_string_lossy().into_owned())
}

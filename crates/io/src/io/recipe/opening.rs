//! Opens the boundary where `open` of a recipe says, and says what had no effect.

use std::sync::Arc;

use glam::DVec2;

use super::super::settings::SavedOpen;
use super::LoadError;
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{BoundaryPieces, OutlineOnEarth, Polygon};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::{DepthSurface, Mask};
use meshbrush_mesh::geometry::Rect;

/// What entries of `open` need beside the settings.
pub struct OpenData {
    /// What the coordinates of the domain's file are, if that is known.
    pub file: Option<Coordinates>,
    /// The polygons of each entry that names a file, in world units.
    pub polygons: Vec<Vec<Polygon>>,
}

/// Opens the boundary of settings. Returns a sentence for each entry that opens nothing.
///
/// # Errors
/// Fails when the domain is given by a formula, or an entry needs depths and there are none.
pub fn open(
    settings: &mut Settings,
    entries: &[SavedOpen],
    data: OpenData,
) -> Result<Vec<String>, LoadError> {
    if settings.domain.formula().is_some() && !entries.is_empty() {
        let problem =
            "`open` needs a domain of polygons or a rectangle; the boundary of a formula is that of its mesh";
        return Err(LoadError::Unsuited(format!("{problem}. Set types of pieces instead (`types`).")));
    }
    let mut polygons = data.polygons.into_iter();
    let mut notes = Vec::new();
    for entry in entries {
        let is_met = match entry {
            SavedOpen::Frame => open_frame(settings, data.file),
            SavedOpen::Box(area) => {
                let way =
                    Way { projection: settings.domain.projection.map(Coordinates::Plane), file: data.file };
                open_where(settings, |at| way.is_in(area, at))
            }
            SavedOpen::Deeper(level) => open_deeper(settings, *level)?,
            SavedOpen::Polygons(_) => match Mask::new(&polygons.next().unwrap_or_default()) {
                Ok(mask) => open_where(settings, |at| mask.contains(at)),
                Err(error) => return Err(LoadError::Unsuited(format!("{}: {error}", entry.text()))),
            },
        };
        if !is_met {
            notes.push(format!(
                "No part of the boundary but islands is in “{}”: it opens nothing.",
                entry.text()
            ));
        }
    }
    Ok(notes)
}

fn open_frame(settings: &mut Settings, file: Option<Coordinates>) -> bool {
    let on_earth = OutlineOnEarth { file, projection: settings.domain.projection, frame: None };
    settings.domain = settings.domain.cut_by_own_frame(&on_earth);
    !settings.domain.cuts().is_empty() || settings.domain.region().is_none()
}

fn open_deeper(settings: &mut Settings, level: f64) -> Result<bool, LoadError> {
    let layers = settings.layers.clone();
    let Some(depths) = DepthSurface::of(&layers) else {
        let problem = format!(
            "`open = \"depth>{level}\"` needs depths. Name a grid of them (--depth, or a layer of depths)"
        );
        return Err(LoadError::Unsuited(format!("{problem}.")));
    };
    Ok(open_where(settings, |at| depths.depth_near(at).is_some_and(|depth| depth > level)))
}

/// Opens the boundary where `is_open` holds. Returns whether it holds somewhere.
fn open_where(settings: &mut Settings, is_open: impl Fn(DVec2) -> bool) -> bool {
    let pieces = BoundaryPieces::of_domain(&settings.domain, &settings.boundary_marks);
    let opened = pieces.and_then(|pieces| pieces.opened(&settings.boundary_marks, is_open));
    let is_met = opened.is_some();
    if let Some(marks) = opened {
        settings.boundary_marks = Arc::new(marks);
    }
    is_met
}

/// The way from world coordinates to those of the domain's file.
struct Way {
    projection: Option<Coordinates>,
    file: Option<Coordinates>,
}

impl Way {
    /// Returns whether a box in the coordinates of the file holds a point in world coordinates.
    fn is_in(&self, area: &Rect, world: DVec2) -> bool {
        let is_geographic = self.file == Some(Coordinates::Geographic);
        let at = match (self.projection, self.file) {
            (Some(plane), Some(file)) if plane != file => file.from_geographic(plane.to_geographic(world)),
            _ => world,
        };
        let turns = if is_geographic { &[0.0, 360.0, -360.0][..] } else { &[0.0] };
        turns.iter().any(|turn| area.contains(at + DVec2::new(*turn, 0.0)))
    }
}

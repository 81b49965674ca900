//! The part of a file of shapes in a rectangle: of polygons of water, or the water beside land.

use std::path::Path;

use glam::DVec2;

use super::super::Number;
use super::super::geojson::Outline;
use super::super::settings::RegionCoordinates;
use super::super::shapes::ShapeFile;
use super::LoadError;
use meshbrush_core::domain::{FileFrame, Land, NamedPolygon, Sea, WaterSide};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::ShapeList;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::LengthUnit;

/// Polygons of water in the coordinates of their file.
pub struct OutlineSource {
    /// The polygons.
    pub outline: Outline,
    /// The rectangle that they were cut from, if they were.
    pub frame: Option<FileFrame>,
}

/// Returns the part of polygons in `bounds`, where these are in the coordinates of the file and that is not
/// the plane of the mesh: there, the bounds of the domain clip the polygons without moving a corner.
///
/// # Errors
/// Fails when nothing is in the bounds.
pub fn part_in_bounds(
    file: &Path,
    outline: Outline,
    bounds: Option<Rect>,
    region: &RegionCoordinates,
) -> Result<OutlineSource, LoadError> {
    let moves = region.projection.filter(|&choice| outline.own_plane(choice, region.assumed).is_none());
    let (Some(rect), Some(_)) = (bounds, moves) else { return Ok(OutlineSource { outline, frame: None }) };
    let in_degrees = outline.coordinates.assuming(region.assumed).unit() == LengthUnit::Degree;
    if in_degrees && !is_on_earth(&rect) {
        // They are in the plane of the mesh.
        return Ok(OutlineSource { outline, frame: None });
    }
    let frame = FileFrame { rect, in_degrees };
    let polygons = frame.clipped(&outline.polygons).map_err(|error| in_file(file, &error.to_string()))?;
    if polygons.is_empty() {
        let problem = format!("none of its polygons lies in the bounds {}", places(&rect));
        return Err(in_file(file, &format!("{problem}. They are in the coordinates of the file.")));
    }
    Ok(OutlineSource { outline: Outline { polygons, ..outline }, frame: Some(frame) })
}

/// The water beside the land of a file.
pub struct SeaSource {
    /// Its polygons, and the rectangle that they were cut from.
    pub source: OutlineSource,
    /// How the sides of lines were told apart; `None` without lines that need it.
    pub decided: Option<WaterSide>,
}

/// Returns the water in `bounds` beside the land of a file, or in a rectangle around the land. `sea_at` is a
/// place in the water, in the coordinates of the file, which are `assumed` where it does not name a known
/// system.
///
/// # Errors
/// Fails when the file has neither polygons nor lines, and when they do not part water from land.
pub fn sea_of_land(
    file: &Path,
    read: &ShapeFile,
    bounds: Option<Rect>,
    sea_at: Option<DVec2>,
    assumed: Option<Coordinates>,
) -> Result<SeaSource, LoadError> {
    let ShapeList { points: _, lines, polygons } = &read.shapes;
    let land = Land { polygons, lines, sea_at };
    let unit = read.coordinates.assuming(assumed).unit();
    let frame = match bounds {
        Some(rect) => Some(frame_of(file, rect, unit)?),
        None => land.frame_around(unit == LengthUnit::Degree),
    };
    let none = || in_file(file, "the file has neither polygons of land nor lines of coast.");
    let frame = frame.ok_or_else(none)?;
    let Sea { polygons, decided } = frame.sea(&land).map_err(|error| in_file(file, &error.to_string()))?;
    let unnamed = |polygon| NamedPolygon { polygon, name: String::new() };
    let polygons = polygons.into_iter().map(unnamed).collect();
    let outline = Outline { polygons, coordinates: read.coordinates };
    Ok(SeaSource { source: OutlineSource { outline, frame: Some(frame) }, decided })
}

/// Returns sentences for a person about a sea: how its side was found, and its frame unless bounds were
/// given.
pub(super) fn sea_notes(file: &Path, sea: &SeaSource, has_bounds: bool) -> Vec<String> {
    let frame = sea.source.frame.filter(|_| !has_bounds);
    let frame = frame.map(|frame| {
        format!(
            "the domain is the water in a frame around the land, {}. Other bounds are given with --bounds, or the key \
             `bounds`.",
            places(&frame.rect)
        )
    });
    let notes = side_note(sea.decided).into_iter().chain(frame);
    notes.map(|note| format!("{}: {note}", file.display())).collect()
}

/// Returns the note on how the sides of lines were told apart.
fn side_note(decided: Option<WaterSide>) -> Option<String> {
    let side = decided.filter(|&side| side != WaterSide::OfPlace)?;
    Some(format!(
        "{}. If that is the wrong side, name a place in the sea with --sea, or the key `sea`.",
        side.text()
    ))
}

/// Returns the frame of bounds in the coordinates of a file.
fn frame_of(file: &Path, rect: Rect, unit: LengthUnit) -> Result<FileFrame, LoadError> {
    let in_degrees = unit == LengthUnit::Degree;
    if in_degrees && !is_on_earth(&rect) {
        let problem = "are no longitudes and latitudes, and bounds are in the coordinates of the file";
        let rule = "They are west, south, east and north, in degrees";
        return Err(in_file(file, &format!("the bounds {} {problem}. {rule}.", places(&rect))));
    }
    Ok(FileFrame { rect, in_degrees })
}

/// Returns whether a rectangle is one of longitudes and latitudes.
fn is_on_earth(Rect { min, max }: &Rect) -> bool {
    let is_near = min.x.abs().max(max.x.abs()) <= 720.0 && max.x - min.x <= 360.0;
    is_near && min.y >= -90.0 && max.y <= 90.0
}

fn places(Rect { min, max }: &Rect) -> String {
    let place = |at: DVec2| format!("{}, {}", Number(at.x), Number(at.y));
    format!("{} to {}", place(*min), place(*max))
}

fn in_file(file: &Path, problem: &str) -> LoadError {
    LoadError::Unsuited(format!("{}: {problem}", file.display()))
}

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

/// Returns the part of polygons in `bounds`, where these are in the coordinates of the file and the domain
/// cannot clip to them: where the mesh is in another plane, and beyond 180°, where polygons count after whole
/// turns. Otherwise the domain clips the polygons, and moves no corner.
///
/// # Errors
/// Fails when nothing is in the bounds.
pub fn part_in_bounds(
    file: &Path,
    outline: Outline,
    bounds: Option<Rect>,
    region: &RegionCoordinates,
) -> Result<OutlineSource, LoadError> {
    let moves = region.projection.is_some_and(|choice| outline.own_plane(choice, region.assumed).is_none());
    let unit = outline.coordinates.assuming(region.assumed).unit();
    // Bounds that are no longitudes and latitudes are in the plane of the mesh.
    let frame = bounds.and_then(|rect| frame_of(rect, unit));
    let frame = frame.filter(|frame| moves || (frame.in_degrees && is_beyond_180(&frame.rect)));
    let Some(frame) = frame else { return Ok(OutlineSource { outline, frame: None }) };
    let polygons = frame.clipped(&outline.polygons).map_err(|error| in_file(file, &error.to_string()))?;
    if polygons.is_empty() {
        let problem = format!("none of its polygons lies in the bounds {}", places(&frame.rect));
        return Err(in_file(file, &format!("{problem}. They are in the coordinates of the file.")));
    }
    Ok(OutlineSource { outline: Outline { polygons, ..outline }, frame: Some(frame) })
}

/// Checks that only bounds of longitudes have an east that is less than their west.
///
/// # Errors
/// Fails for bounds in other coordinates.
pub fn check_east(
    file: &Path,
    outline: &Outline,
    bounds: Option<Rect>,
    region: &RegionCoordinates,
) -> Result<(), LoadError> {
    let is_degree = outline.coordinates.assuming(region.assumed).unit() == LengthUnit::Degree;
    match bounds {
        Some(Rect { min, max }) if region.east_is_less && !is_degree => {
            let (west, east) = (Number(min.x), Number(max.x - 360.0));
            let rule = "and only longitudes go round. Write west, south, east and north";
            Err(in_file(
                file,
                &format!("the east of the bounds, {east}, is less than their west, {west}, {rule}."),
            ))
        }
        _ => Ok(()),
    }
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
        Some(rect) => Some(frame_of(rect, unit).ok_or_else(|| in_file(file, &no_longitudes(&rect)))?),
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

/// Returns the frame of bounds in the coordinates of a file; `None` where these are degrees, and the bounds
/// are no longitudes and latitudes.
fn frame_of(rect: Rect, unit: LengthUnit) -> Option<FileFrame> {
    let in_degrees = unit == LengthUnit::Degree;
    (!in_degrees || is_on_earth(&rect)).then_some(FileFrame { rect, in_degrees })
}

fn no_longitudes(rect: &Rect) -> String {
    let problem = "are no longitudes and latitudes, and bounds are in the coordinates of the file";
    format!("the bounds {} {problem}. They are west, south, east and north, in degrees.", places(rect))
}

/// Returns whether a rectangle is one of longitudes and latitudes.
pub fn is_on_earth(Rect { min, max }: &Rect) -> bool {
    let is_near = min.x.abs().max(max.x.abs()) <= 720.0 && max.x - min.x <= 360.0;
    is_near && min.y >= -90.0 && max.y <= 90.0
}

/// Returns whether a rectangle of longitudes is on both sides of the antimeridian, or beyond it.
pub fn is_beyond_180(Rect { min, max }: &Rect) -> bool {
    min.x < -180.0 || max.x > 180.0
}

fn places(Rect { min, max }: &Rect) -> String {
    let place = |at: DVec2| format!("{}, {}", Number(at.x), Number(at.y));
    format!("{} to {}", place(*min), place(*max))
}

fn in_file(file: &Path, problem: &str) -> LoadError {
    LoadError::Unsuited(format!("{}: {problem}", file.display()))
}

//! `.geojson` with points, lines and polygons (RFC 7946), to measure the distance to them.

use std::io::{self, Read, Write};
use std::path::Path;

use glam::DVec2;

use super::error::{Flaw, PlacedFlaw, ReadError};
use super::features::{Object, Wanted};
use super::positions::NestedPositions;
use super::{FileCoordinates, Meter, coordinates, geojson};
use meshbrush_core::domain::MOST_CORNERS;
use meshbrush_core::layers::ShapeList;
use meshbrush_mesh::text::Grouped;

/// The shapes in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeFile {
    /// The shapes, each kind in the order of the file.
    pub shapes: ShapeList,
    /// What their coordinates are.
    pub coordinates: FileCoordinates,
}

impl ShapeFile {
    /// Returns shapes in other longitudes and latitudes in degrees from Greenwich, and others as they are.
    pub(super) fn in_degrees(mut self) -> Self {
        let Some((coordinates, factor, summand)) = self.coordinates.in_degrees() else { return self };
        let ShapeList { points, lines, polygons } = &mut self.shapes;
        let lines = lines.iter_mut().flatten();
        let all = points.iter_mut().chain(lines).chain(polygons.iter_mut().flatten().flatten());
        all.for_each(|at| *at = factor * *at + summand);
        Self { coordinates, ..self }
    }
}

/// Reads every shape of a file: of a geometry, a feature, or a collection of either. The meter counts the
/// bytes of the file.
///
/// Coordinates are not projected: the first is x and the second y. Rings come without the repeated last
/// position.
///
/// # Errors
/// Fails when the file cannot be read, is not GeoJSON, has no shape, or more than [`MOST_CORNERS`] points;
/// and when the work was cancelled.
pub fn read(path: &Path, meter: &Meter) -> Result<ShapeFile, ReadError> {
    geojson::read_metered(path, meter, parse)
}

/// Reads shapes as [`read`] does, from any input, such as bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_from(input: impl Read, name: &Path) -> Result<ShapeFile, ReadError> {
    geojson::read_limited(input, name, |input| parse(input))
}

/// A reader of all shapes.
struct AllShapes;

impl Wanted for AllShapes {
    fn is_wanted(kind: &str) -> bool {
        depth_of(kind).is_some()
    }
}

fn parse(input: impl Read) -> Result<ShapeFile, PlacedFlaw> {
    let object = Object::parse(input)?;
    let crs = object.crs_name();
    let mut shapes = ShapeList::default();
    collect(object, &mut shapes).map_err(Flaw::Syntax)?;
    check(&shapes)?;
    let coordinates = coordinates::named(crs.as_deref(), places(&shapes));
    Ok(ShapeFile { shapes, coordinates })
}

/// Checks that there are shapes, and not too many points.
pub(super) fn check(shapes: &ShapeList) -> Result<(), Flaw> {
    if shapes.is_empty() {
        let problem = "there is no point, line or polygon in it. Export the features, not an empty layer.";
        return Err(Flaw::Syntax(problem.into()));
    }
    let count = places(shapes).count();
    if count > MOST_CORNERS {
        let (count, limit) = (Grouped(count), Grouped(MOST_CORNERS));
        let problem =
            format!("the shapes have {count} points, and the limit is {limit}. Simplify them first.");
        return Err(Flaw::Syntax(problem));
    }
    Ok(())
}

/// Checks that there are not too many points so far, while there may be more.
pub(super) fn check_count(so_far: usize) -> Result<(), Flaw> {
    if so_far <= MOST_CORNERS {
        return Ok(());
    }
    let limit = Grouped(MOST_CORNERS);
    Err(Flaw::Syntax(format!("the shapes have more than {limit} points, the limit. Simplify them first.")))
}

/// Returns all positions of the shapes.
pub(super) fn places(shapes: &ShapeList) -> impl Iterator<Item = DVec2> {
    let rings = shapes.polygons.iter().flatten().flatten();
    shapes.points.iter().chain(shapes.lines.iter().flatten()).chain(rings).copied()
}

/// Collects the shapes of an object. The recursion is bounded, as the parser bounds the nesting.
fn collect(mut object: Object<AllShapes>, shapes: &mut ShapeList) -> Result<(), String> {
    let kind = &object.kind;
    if let Some(depth) = depth_of(kind) {
        let coordinates = object.coordinates.take();
        let coordinates = coordinates.ok_or_else(|| format!("a {kind} has no \"coordinates\"."))?;
        take(kind, coordinates, depth, shapes)?;
    }
    object.into_inner().try_for_each(|object| collect(object, shapes))
}

/// Returns how deep the positions of a geometry are nested.
fn depth_of(kind: &str) -> Option<usize> {
    match kind {
        "Point" => Some(1),
        "MultiPoint" | "LineString" => Some(2),
        "MultiLineString" | "Polygon" => Some(3),
        "MultiPolygon" => Some(4),
        _ => None,
    }
}

fn take(
    kind: &str,
    coordinates: NestedPositions,
    depth: usize,
    shapes: &mut ShapeList,
) -> Result<(), String> {
    if kind.ends_with("Polygon") {
        shapes.polygons.extend(coordinates.polygons(kind, depth)?);
        return Ok(());
    }
    if coordinates.positions.is_empty() {
        return Ok(());
    }
    if coordinates.depth != depth {
        let found = coordinates.depth;
        return Err(format!("the positions of a {kind} must be nested {depth} deep; here it is {found}."));
    }
    if kind.ends_with("Point") {
        shapes.points.extend(coordinates.positions);
        return Ok(());
    }
    let lines = coordinates.lists();
    if lines.iter().any(|line| line.len() == 1) {
        return Err(format!("a line of a {kind} has one position, and it needs two."));
    }
    shapes.lines.extend(lines.into_iter().filter(|line| !line.is_empty()));
    Ok(())
}

/// Writes shapes as one collection of geometries. [`read`] returns the same shapes bit for bit.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut dyn Write, shapes: &ShapeList) -> io::Result<()> {
    let array = |list: &[DVec2]| list.iter().map(|p| p.to_array()).collect::<Vec<_>>();
    let lines: Vec<_> = shapes.lines.iter().map(|line| array(line)).collect();
    write!(
        out,
        "{{\"type\":\"GeometryCollection\",\"geometries\":[\n{{\"type\":\"MultiPoint\",\"coordinates\":"
    )?;
    serde_json::to_writer(&mut *out, &array(&shapes.points))?;
    write!(out, "}},\n{{\"type\":\"MultiLineString\",\"coordinates\":")?;
    serde_json::to_writer(&mut *out, &lines)?;
    writeln!(out, "}},")?;
    geojson::write(out, &shapes.polygons)?;
    writeln!(out, "]}}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    fn parsed(text: &str) -> Result<ShapeFile, String> {
        parse(text.as_bytes()).map_err(|e| format!("{}: {}", e.place, e.flaw))
    }

    #[test]
    fn every_geometry_is_read_wherever_it_is() {
        let text = r#"{"type":"FeatureCollection","features":[
            {"type":"Feature","properties":{"name":"a"},"geometry":{"type":"Point","coordinates":[1,2,9]}},
            {"type":"Feature","properties":null,"geometry":null},
            {"type":"Feature","geometry":{"type":"GeometryCollection","geometries":[
                {"type":"MultiPoint","coordinates":[[3,4],[5,6]]},
                {"type":"LineString","coordinates":[[0,0],[1,0],[0,0]]},
                {"type":"MultiLineString","coordinates":[[[7,7],[8,8]],[[1,1],[2,1]]]},
                {"type":"LineString","coordinates":[]}]}},
            {"type":"Feature","geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,0]]]}},
            {"type":"Feature","geometry":{"type":"MultiPolygon","coordinates":[[[[0,0],[1,0],[1,1],[0,0]]]]}}]}"#;
        let file = parsed(text).unwrap();
        assert_eq!(file.shapes.points, [dvec2(1.0, 2.0), dvec2(3.0, 4.0), dvec2(5.0, 6.0)]);
        let lines: Vec<usize> = file.shapes.lines.iter().map(Vec::len).collect();
        assert_eq!((lines, file.shapes.lines[0][2]), (vec![3, 2, 2], DVec2::ZERO));
        let corners: Vec<usize> = file.shapes.polygons.iter().map(|rings| rings[0].len()).collect();
        assert_eq!(
            (corners, file.coordinates),
            (vec![3, 3], FileCoordinates::Unstated { can_be_degrees: true })
        );
    }

    #[test]
    fn errors_are_sentences() {
        for (text, expected) in [
            ("", ", line 1: the file ends too early"),
            (r#"{"type":"FeatureCollection","features":[]}"#, ": there is no point, line or polygon in it"),
            (
                r#"{"type":"Point","coordinates":[[1,2]]}"#,
                ": the positions of a Point must be nested 1 deep; here it is 2.",
            ),
            (r#"{"type":"LineString","coordinates":[[1,2]]}"#, ": a line of a LineString has one position"),
            (r#"{"type":"LineString"}"#, ": a LineString has no \"coordinates\"."),
            (
                r#"{"type":"Point","coordinates":[1]}"#,
                ", line 1: this is not valid GeoJSON: a position needs two numbers",
            ),
        ] {
            let message = parsed(text).unwrap_err();
            assert!(message.starts_with(expected), "{text} gave {message}");
        }
    }

    #[test]
    fn what_is_written_is_read_bit_for_bit() {
        let mut random = fastrand::Rng::with_seed(101);
        let mut places = |count: usize| -> Vec<DVec2> {
            (0..count).map(|_| 1e4 * dvec2(random.f64() - 0.5, random.f64())).collect()
        };
        for count in [0, 1, 5] {
            let lines = (0..count).map(|n| places(n + 2)).collect();
            let polygons = (0..count).map(|n| vec![places(n + 3), places(4)]).collect();
            let shapes = ShapeList { points: places(count + 1), lines, polygons };
            let mut file = Vec::new();
            write(&mut file, &shapes).unwrap();
            assert_eq!(parse(&*file).unwrap().shapes, shapes);
        }
    }
}

//! `.shp`: shapefiles with points, lines and polygons, as geographic programs write them.
//!
//! Heights and measures of the types Z and M are left out, and so are the attributes beside the file
//! (`.dbf`). The text beside it (`.prj`) tells the unit of coordinates, which are not projected.

use std::io::{ErrorKind, Read};
use std::path::Path;

use glam::{DVec2, dvec2};

use super::Meter;
use super::coordinate_system::CoordinateSystem;
use super::error::{Flaw, PlacedFlaw, ReadError};
use super::format_spec::ShapeFormatSpec;
use super::geojson::{self, Outline};
use super::positions::open_ring;
use super::shapes::{self, ShapeFile};
use meshbrush_core::domain::{NamedPolygon, Polygon, Ring, signed_area};
use meshbrush_core::layers::ShapeList;
use meshbrush_mesh::geometry::{Rect, is_around};
use meshbrush_mesh::text::Grouped;

/// The format, for the list of all formats of shapes.
pub static FORMAT: ShapeFormatSpec =
    ShapeFormatSpec { endings: &["shp"], read_outline, read_shapes: read, read_shapes_near: Some(read_near) };

/// The number that begins every file.
const FILE_CODE: i32 = 9994;
/// Bytes of the header.
const HEADER: u64 = 100;

/// Reads the polygons of a file. A record with several outer rings becomes several polygons, each with the
/// holes inside it, whichever way rings run. The meter counts the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, is not a shapefile, is cut off, or has no polygon or too many points,
/// and when the work was cancelled.
pub fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    let shapes = geojson::read_metered(path, meter, |input| parse(input, None))?;
    if shapes.polygons.is_empty() {
        let others = [(!shapes.lines.is_empty(), "PolyLine"), (!shapes.points.is_empty(), "Point")];
        let others: Vec<String> = others.iter().filter(|kind| kind.0).map(|kind| kind.1.to_owned()).collect();
        return Err(PlacedFlaw::from(Flaw::Syntax(geojson::no_polygon(&others))).in_file(path));
    }
    let corners = shapes.polygons.iter().flatten().flatten().copied();
    let coordinates = CoordinateSystem::from_corners(CoordinateSystem::beside(path).as_ref(), corners);
    let named = |polygon| NamedPolygon { polygon, name: String::new() };
    Ok(Outline { polygons: shapes.polygons.into_iter().map(named).collect(), coordinates })
}

/// Reads the shapes of a file. The meter counts the bytes of the file.
///
/// # Errors
/// Fails as [`read_outline`] does, but where there is no shape at all.
pub fn read(path: &Path, meter: &Meter) -> Result<ShapeFile, ReadError> {
    read_records(path, None, meter)
}

/// Reads the shapes of a file that can meet a rectangle in its coordinates, after whole turns of longitudes:
/// a file of the whole Earth has more points than are read.
///
/// # Errors
/// Fails as [`read`] does; it is no error if no shape is near.
pub fn read_near(path: &Path, wanted: Rect, meter: &Meter) -> Result<ShapeFile, ReadError> {
    read_records(path, Some(wanted), meter)
}

fn read_records(path: &Path, wanted: Option<Rect>, meter: &Meter) -> Result<ShapeFile, ReadError> {
    let shapes = geojson::read_metered(path, meter, |input| parse(input, wanted))?;
    let system = CoordinateSystem::beside(path);
    if wanted.is_some() {
        let coordinates = CoordinateSystem::from_corners(system.as_ref(), shapes::places(&shapes));
        return Ok(ShapeFile { shapes, coordinates });
    }
    checked(shapes, system.as_ref()).map_err(|flaw| PlacedFlaw::from(flaw).in_file(path))
}

/// Reads the shapes of a file without the text beside it, from any input, such as bytes. Errors call the
/// file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_from(input: impl Read, name: &Path) -> Result<ShapeFile, ReadError> {
    geojson::read_limited(input, name, |input| Ok(checked(parse(input, None)?, None)?))
}

fn checked(shapes: ShapeList, system: Option<&CoordinateSystem>) -> Result<ShapeFile, Flaw> {
    shapes::check(&shapes)?;
    let coordinates = CoordinateSystem::from_corners(system, shapes::places(&shapes));
    Ok(ShapeFile { shapes, coordinates })
}

/// Reads the records, where a rectangle is `wanted` only those that can meet it. Memory grows with the bytes
/// of these records.
fn parse(mut input: impl Read, wanted: Option<Rect>) -> Result<ShapeList, PlacedFlaw> {
    let header: [u8; HEADER as usize] = bytes(&mut input)?;
    let numbers = Numbers(&header);
    if numbers.big(0) != FILE_CODE {
        let problem =
            "this is not a shapefile: it begins with other bytes. Choose the file that ends in .shp.";
        return Err(Flaw::Syntax(problem.into()).into());
    }
    let length = 2 * u64::from(numbers.big(24).unsigned_abs());
    let (mut shapes, mut at, mut number) = (ShapeList::default(), HEADER, 0);
    let mut count = 0;
    while at < length {
        let start: [u8; 8] = bytes(&mut input)?;
        let size = 2 * u64::from(Numbers(&start).big(4).unsigned_abs());
        number += 1;
        at += 8 + size;
        let Some(record) = near_record(&mut input, size, wanted)? else { continue };
        let problem = |rule: String| Flaw::Syntax(format!("record {number} {rule}. Export the layer again."));
        count += take(Numbers(&record), &mut shapes).map_err(problem)?;
        // What is cut to a rectangle can have more: a continent is one polygon.
        if wanted.is_none() {
            shapes::check_count(count)?;
        }
    }
    Ok(shapes)
}

/// Bytes of the type of a record and of its extent.
const EXTENT_BYTES: u64 = 36;

/// Reads a record; `None` for a line or polygon whose extent, which precedes its points, cannot meet a
/// rectangle.
fn near_record(input: &mut impl Read, size: u64, wanted: Option<Rect>) -> Result<Option<Vec<u8>>, Flaw> {
    let mut record = Vec::new();
    let mut rest = input.take(size);
    let read = |part: &mut dyn Read, record: &mut Vec<u8>| part.read_to_end(record).map_err(Flaw::Io);
    read(&mut rest.by_ref().take(EXTENT_BYTES), &mut record)?;
    let is_near = wanted.is_none_or(|wanted| {
        let extent = Numbers(&record).extent();
        extent.is_none_or(|extent| can_meet(extent, wanted))
    });
    let skipped = match is_near {
        true => read(&mut rest, &mut record).map(|_| 0)?,
        false => std::io::copy(&mut rest, &mut std::io::sink()).map_err(Flaw::Io)?,
    };
    if record.len() as u64 + skipped < size {
        return Err(Flaw::CutOff);
    }
    Ok(is_near.then_some(record))
}

/// Returns whether extents can meet after whole turns of longitudes.
fn can_meet(extent: Rect, wanted: Rect) -> bool {
    [-720.0, -360.0, 0.0, 360.0, 720.0].iter().any(|&turn| {
        let offset = dvec2(turn, 0.0);
        Rect::new(extent.min + offset, extent.max + offset).intersection(&wanted).is_some()
    })
}

fn bytes<const N: usize>(input: &mut impl Read) -> Result<[u8; N], Flaw> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => Flaw::CutOff,
        _ => Flaw::Io(error),
    })?;
    Ok(bytes)
}

/// Adds the shape of a record, and returns the number of its points.
///
/// # Errors
/// Fails with the rule that the record breaks, as the end of a sentence.
fn take(record: Numbers, shapes: &mut ShapeList) -> Result<usize, String> {
    let kind = record.little(0).ok_or("is too short")?;
    // The types Z and M have heights and measures after the points.
    match kind {
        0 => Ok(0),
        1 | 11 | 21 => {
            shapes.points.push(record.point(4)?);
            Ok(1)
        }
        8 | 18 | 28 => {
            let points = record.points(40, record.count(36)?)?;
            shapes.points.extend(&points);
            Ok(points.len())
        }
        3 | 13 | 23 => {
            let lines = record.parts()?;
            if lines.iter().any(|line| line.len() < 2) {
                return Err("has a line with one point, and it needs two".into());
            }
            let count = lines.iter().map(Vec::len).sum();
            shapes.lines.extend(lines);
            Ok(count)
        }
        5 | 15 | 25 => {
            let rings = record.parts()?;
            let count = rings.iter().map(Vec::len).sum();
            shapes.polygons.extend(polygons(rings));
            Ok(count)
        }
        31 => Err("is a surface in space (MultiPatch), and only points, lines and polygons are read".into()),
        other => Err(format!("is of the unknown type {other}")),
    }
}

/// The bytes of a header or of a record.
#[derive(Clone, Copy)]
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    fn array<const N: usize>(self, at: usize) -> Option<[u8; N]> {
        self.0.get(at..at.checked_add(N)?)?.try_into().ok()
    }

    /// Returns a big-endian number; 0 beyond the end.
    fn big(self, at: usize) -> i32 {
        i32::from_be_bytes(self.array(at).unwrap_or_default())
    }

    fn little(self, at: usize) -> Option<i32> {
        self.array(at).map(i32::from_le_bytes)
    }

    fn count(self, at: usize) -> Result<usize, String> {
        let count = self.little(at).ok_or("is too short")?;
        usize::try_from(count).map_err(|_| format!("has {count} points"))
    }

    fn point(self, at: usize) -> Result<DVec2, String> {
        let number = |at: usize| self.array(at).map(f64::from_le_bytes).ok_or("is too short");
        let point = dvec2(number(at)?, number(at + 8)?);
        if point.is_finite() { Ok(point) } else { Err("has a coordinate that is not finite".into()) }
    }

    /// Returns the extent of a line or polygon; `None` for other shapes, and where it is not one.
    fn extent(self) -> Option<Rect> {
        matches!(self.little(0)?, 3 | 13 | 23 | 5 | 15 | 25).then_some(())?;
        let number = |at: usize| self.array(at).map(f64::from_le_bytes);
        let (min, max) = (dvec2(number(4)?, number(12)?), dvec2(number(20)?, number(28)?));
        (min.cmple(max).all()).then(|| Rect::new(min, max))
    }

    fn points(self, at: usize, count: usize) -> Result<Vec<DVec2>, String> {
        if count.saturating_mul(16).saturating_add(at) > self.0.len() {
            return Err(format!("announces {} points and is too short for them", Grouped(count)));
        }
        (0..count).map(|i| self.point(at + 16 * i)).collect()
    }

    /// Returns the lines or rings of a record.
    fn parts(self) -> Result<Vec<Vec<DVec2>>, String> {
        let (parts, count) = (self.count(36)?, self.count(40)?);
        if parts > count {
            return Err(format!("has {} parts with {} points in all", Grouped(parts), Grouped(count)));
        }
        let points = self.points(44 + 4 * parts, count)?;
        let mut lists = Vec::new();
        for part in 0..parts {
            let start = self.count(44 + 4 * part)?;
            let end = if part + 1 < parts { self.count(48 + 4 * part)? } else { count };
            let list = points.get(start..end).ok_or("has parts that do not follow each other")?;
            lists.push(list.to_vec());
        }
        Ok(lists)
    }
}

/// Returns the polygons of a record: a ring within an even number of others is an outer one, and one within
/// an odd number a hole of the smallest ring around it. The format has outer rings clockwise, and many files
/// do not.
fn polygons(mut rings: Vec<Ring>) -> Vec<Polygon> {
    rings.iter_mut().for_each(open_ring);
    rings.retain(|ring| !ring.is_empty());
    let around = rings_around(&rings);
    let mut depths = vec![0; rings.len()];
    for &(ring, around) in &around {
        depths[ring] = around.map_or(0, |outer| depths[outer] + 1);
    }
    let mut places = vec![None; rings.len()];
    let mut polygons: Vec<Polygon> = Vec::new();
    for ring in (0..rings.len()).filter(|&ring| depths[ring] % 2 == 0) {
        places[ring] = Some(polygons.len());
        polygons.push(vec![std::mem::take(&mut rings[ring])]);
    }
    let mut holes: Vec<(usize, usize)> = around
        .into_iter()
        .filter(|(ring, _)| depths[*ring] % 2 == 1)
        .filter_map(|(ring, outer)| Some((ring, places[outer?]?)))
        .collect();
    holes.sort_unstable();
    holes.into_iter().for_each(|(ring, place)| polygons[place].push(std::mem::take(&mut rings[ring])));
    polygons
}

/// Returns each ring with the smallest ring around it, after those around it.
fn rings_around(rings: &[Ring]) -> Vec<(usize, Option<usize>)> {
    let bounds: Vec<Rect> = rings.iter().map(|ring| bounds(ring)).collect();
    let areas: Vec<f64> = rings.iter().map(|ring| signed_area(ring).abs()).collect();
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by(|&a, &b| bounds[a].min.x.total_cmp(&bounds[b].min.x).then(areas[b].total_cmp(&areas[a])));
    // Those that reach as far to the right as the next one begins.
    let mut near: Vec<usize> = Vec::new();
    let mut around = Vec::with_capacity(rings.len());
    for ring in order {
        near.retain(|&other| bounds[other].max.x >= bounds[ring].min.x);
        let inside = point_inside(&rings[ring]);
        let holds = |&&other: &&usize| bounds[other].contains(inside) && is_around(&rings[other], inside);
        let outer = near.iter().filter(holds).min_by(|&&a, &&b| areas[a].total_cmp(&areas[b])).copied();
        around.push((ring, outer));
        near.push(ring);
    }
    around
}

fn bounds(ring: &[DVec2]) -> Rect {
    let min = ring.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    Rect::new(min, ring.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max))
}

/// Returns a point within a ring and not on it, but for a ring without an area.
fn point_inside(ring: &[DVec2]) -> DVec2 {
    let mut heights: Vec<f64> = ring.iter().map(|point| point.y).collect();
    heights.sort_by(f64::total_cmp);
    let gap = |pair: &[f64]| pair[1] - pair[0];
    let widest = heights.windows(2).max_by(|a, b| gap(a).total_cmp(&gap(b)));
    let y = widest.map_or(ring[0].y, |pair| 0.5 * (pair[0] + pair[1]));
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| (a.y > y) != (b.y > y));
    let mut crossings: Vec<f64> = crossed.map(|(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)).collect();
    crossings.sort_by(f64::total_cmp);
    let within = crossings.chunks_exact(2).max_by(|a, b| gap(a).total_cmp(&gap(b)));
    within.map_or(ring[0], |pair| dvec2(0.5 * (pair[0] + pair[1]), y))
}

#[cfg(test)]
mod tests;

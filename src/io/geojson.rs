//! `.geojson`: polygons with holes, as geographic programs write them (RFC 7946).

use std::fmt;
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use glam::DVec2;
use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, SeqAccess, Visitor};
use serde_json::Value;

use super::Meter;
use super::coordinates;
use super::error::{Flaw, PlacedFlaw, ReadError};
use crate::domain::{MOST_CORNERS, NamedPolygon, Polygon};
use crate::text::{Grouped, LengthUnit};

/// Largest file read.
const MOST_BYTES: u64 = 256 << 20;

/// What a file says of a domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The polygons with their names.
    pub polygons: Vec<NamedPolygon>,
    /// The unit of their coordinates.
    pub unit: LengthUnit,
}

/// Reads every polygon of a file: of a geometry, a feature, or a collection of either. Other geometries are
/// ignored.
///
/// Coordinates are not projected: the first is x and the second y. Rings come without the repeated last
/// position.
///
/// # Errors
/// When the file cannot be read, is not GeoJSON, has no polygon, or more than [`MOST_CORNERS`] corners.
pub fn read(path: &Path) -> Result<Vec<Polygon>, ReadError> {
    read_named(path).map(without_names)
}

/// Reads as [`read`] does, with the name of each polygon: the first of the properties `name`, `NAME`, `Name`,
/// `title` and `id` of its feature that is text or a number.
///
/// # Errors
/// As [`read`].
pub fn read_named(path: &Path) -> Result<Vec<NamedPolygon>, ReadError> {
    read_named_metered(path, &Meter::default())
}

/// Reads as [`read_named`] does, and counts the bytes of the file.
///
/// # Errors
/// As [`read_outline`].
pub fn read_named_metered(path: &Path, meter: &Meter) -> Result<Vec<NamedPolygon>, ReadError> {
    read_outline(path, meter).map(|outline| outline.polygons)
}

/// Reads polygons with their names and their unit, and counts the bytes of the file.
///
/// # Errors
/// As [`read`], and when the work was cancelled.
pub fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    let open = || -> Result<File, PlacedFlaw> {
        let file = File::open(path)?;
        let bytes = file.metadata()?.len();
        if bytes > MOST_BYTES {
            return Err(too_long(bytes));
        }
        meter.expect(bytes);
        Ok(file)
    };
    let read = open().and_then(|file| {
        let outline = parse(BufReader::new(meter.count(file.take(MOST_BYTES))))?;
        meter.check()?;
        Ok(outline)
    });
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads as [`read`] does, from any input, such as bytes. Errors call the file `name`.
///
/// # Errors
/// As [`read`].
pub fn read_from(input: impl Read, name: &Path) -> Result<Vec<Polygon>, ReadError> {
    read_named_from(input, name).map(without_names)
}

/// Reads as [`read_named`] does, from any input, such as standard input. Errors call the file `name`.
///
/// # Errors
/// As [`read`].
pub fn read_named_from(input: impl Read, name: &Path) -> Result<Vec<NamedPolygon>, ReadError> {
    read_outline_from(input, name).map(|outline| outline.polygons)
}

/// Reads as [`read_outline`] does, from any input. Errors call the file `name`.
///
/// # Errors
/// As [`read`].
pub fn read_outline_from(input: impl Read, name: &Path) -> Result<Outline, ReadError> {
    // One byte more shows that there is more.
    let mut input = BufReader::new(input.take(MOST_BYTES + 1));
    let read = parse(&mut input);
    let flaw = if input.get_ref().limit() == 0 { Some(too_long(MOST_BYTES + 1)) } else { None };
    flaw.map_or(read, Err).map_err(|flaw| flaw.in_file(name))
}

/// The polygons alone.
pub(super) fn without_names(polygons: Vec<NamedPolygon>) -> Vec<Polygon> {
    polygons.into_iter().map(|named| named.polygon).collect()
}

fn too_long(bytes: u64) -> PlacedFlaw {
    let limit = MOST_BYTES >> 20;
    Flaw::Syntax(format!(
        "the file has {} MiB, and the limit for an outline is {limit} MiB. Keep only the polygons, and simplify them.",
        bytes.div_ceil(1 << 20)
    ))
    .into()
}

/// Reads as [`read_outline`] does, from any input.
pub(super) fn parse(input: impl Read) -> Result<Outline, PlacedFlaw> {
    let mut json = serde_json::Deserializer::from_reader(input);
    let object = Object::deserialize(&mut json).map_err(placed)?;
    json.end().map_err(placed)?;
    let crs = object.crs.as_ref().and_then(|crs| crs["properties"]["name"].as_str()).map(str::to_owned);
    let mut polygons = Vec::new();
    let mut others = Vec::new();
    collect(object, "", &mut polygons, &mut others).map_err(Flaw::Syntax)?;
    if polygons.is_empty() {
        return Err(Flaw::Syntax(no_polygon(&others)).into());
    }
    let corners = polygons.iter().flat_map(|named: &NamedPolygon| named.polygon.iter().flatten());
    let unit = coordinates::unit(crs.as_deref(), corners.copied());
    Ok(Outline { polygons, unit })
}

/// Writes polygons as one geometry with one line for each ring. [`read`] returns the same polygons bit for
/// bit.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut dyn Write, polygons: &[Polygon]) -> io::Result<()> {
    writeln!(out, "{{\"type\":\"MultiPolygon\",\"coordinates\":[")?;
    for (i, polygon) in polygons.iter().enumerate() {
        writeln!(out, "{}[", if i == 0 { "" } else { "," })?;
        for (j, ring) in polygon.iter().enumerate() {
            // The format repeats the first position at the end.
            let closed: Vec<[f64; 2]> = ring.iter().chain(ring.first()).map(|p| p.to_array()).collect();
            write!(out, "{}", if j == 0 { "" } else { "," })?;
            serde_json::to_writer(&mut *out, &closed)?;
            writeln!(out)?;
        }
        writeln!(out, "]")?;
    }
    writeln!(out, "]}}")
}

fn no_polygon(others: &[String]) -> String {
    let found = match others.first() {
        Some(kind) => format!("it has {kind}"),
        None => "it has no geometry".into(),
    };
    format!(
        "a domain needs a Polygon or a MultiPolygon, and {found}. Export the area, not its points or lines."
    )
}

/// The error of serde_json with its line.
fn placed(error: serde_json::Error) -> PlacedFlaw {
    let line = error.line();
    if error.is_eof() {
        return Flaw::CutOff.at(line.max(1));
    }
    if error.is_io() {
        return Flaw::Io(error.into()).into();
    }
    let text = error.to_string();
    let problem = text.split(" at line ").next().unwrap_or(&text);
    Flaw::Syntax(format!("this is not valid GeoJSON: {problem}.")).at(line.max(1))
}

/// Any object of the format. Other members are ignored.
#[derive(Deserialize)]
struct Object {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    coordinates: Option<Coordinates>,
    #[serde(default, rename = "properties", deserialize_with = "name_of")]
    name: String,
    /// The coordinate reference system, as of the format before RFC 7946.
    #[serde(default)]
    crs: Option<Value>,
    #[serde(default)]
    geometry: Option<Box<Self>>,
    #[serde(default, deserialize_with = "with_polygons")]
    geometries: Vec<Self>,
    #[serde(default, deserialize_with = "with_polygons")]
    features: Vec<Self>,
}

impl Object {
    fn has_polygons(&self) -> bool {
        let mut inner = self.geometry.as_deref().into_iter().chain(&self.geometries).chain(&self.features);
        self.kind.ends_with("Polygon") || inner.any(Self::has_polygons)
    }
}

/// The objects of a list that have polygons, and its first object, to be named in an error. The others are
/// dropped: a file may have millions of points.
fn with_polygons<'de, D: Deserializer<'de>>(json: D) -> Result<Vec<Object>, D::Error> {
    json.deserialize_seq(Objects)
}

struct Objects;

impl<'de> Visitor<'de> for Objects {
    type Value = Vec<Object>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of features or geometries")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<Object>, A::Error> {
        let mut objects: Vec<Object> = Vec::new();
        while let Some(object) = list.next_element::<Object>()? {
            if objects.is_empty() || object.has_polygons() {
                objects.push(object);
            }
        }
        Ok(objects)
    }
}

/// The properties that may be the name of a feature.
const NAMES: [&str; 5] = ["name", "NAME", "Name", "title", "id"];

/// The name that the properties of a feature give it; empty if they give none.
fn name_of<'de, D: Deserializer<'de>>(json: D) -> Result<String, D::Error> {
    let properties = Value::deserialize(json)?;
    let text = |value: &Value| match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    let found =
        NAMES.iter().find_map(|name| properties.get(name).and_then(text).filter(|name| !name.is_empty()));
    Ok(found.unwrap_or_default())
}

/// Collects polygons with their names, and the kind of the first other geometry. `name` is that of the
/// object around this one. The recursion is bounded, as the parser bounds the nesting.
fn collect(
    object: Object,
    name: &str,
    polygons: &mut Vec<NamedPolygon>,
    others: &mut Vec<String>,
) -> Result<(), String> {
    let Object { kind, coordinates, name: own_name, geometry, geometries, features, .. } = object;
    let name = if own_name.is_empty() { name } else { &own_name };
    let named = |polygon| NamedPolygon { polygon, name: name.to_owned() };
    match (kind.as_str(), coordinates) {
        ("Polygon", Some(coordinates)) => {
            polygons.extend(coordinates.polygons(&kind, 3)?.into_iter().map(named));
        }
        ("MultiPolygon", Some(coordinates)) => {
            polygons.extend(coordinates.polygons(&kind, 4)?.into_iter().map(named));
        }
        ("Polygon" | "MultiPolygon", None) => return Err(format!("a {kind} has no \"coordinates\".")),
        (_, Some(_)) if others.is_empty() => others.push(kind),
        (_, Some(_)) => {}
        (_, None) => {}
    }
    let inner = geometry.map(|geometry| *geometry).into_iter().chain(geometries).chain(features);
    inner.into_iter().try_for_each(|object| collect(object, name, polygons, others))
}

/// The positions of nested lists in one flat list: nested vectors would take several times the memory while
/// reading.
#[derive(Default)]
struct Coordinates {
    positions: Vec<DVec2>,
    /// The end of each ring in `positions`, and of each polygon in `ring_ends`.
    ring_ends: Vec<usize>,
    polygon_ends: Vec<usize>,
    /// How deep the positions are nested: 1 for a single position, 3 for a list of rings; 0 without
    /// positions.
    depth: usize,
}

impl Coordinates {
    /// The polygons, if the positions are nested `depth` deep.
    fn polygons(mut self, kind: &str, depth: usize) -> Result<Vec<Polygon>, String> {
        if self.positions.is_empty() {
            return Ok(Vec::new());
        }
        if self.depth != depth {
            let lists = "lists of positions in lists of rings";
            return Err(format!(
                "the coordinates of a {kind} must be {lists}, nested {depth} deep; here it is {}.",
                self.depth
            ));
        }
        if depth == 3 {
            self.polygon_ends.push(self.ring_ends.len());
        }
        let mut rings = self.rings().into_iter();
        let mut start = 0;
        let polygon = |end: usize| {
            let count = end - std::mem::replace(&mut start, end);
            rings.by_ref().take(count).collect::<Polygon>()
        };
        Ok(self.polygon_ends.iter().copied().map(polygon).filter(|polygon| !polygon.is_empty()).collect())
    }

    /// The rings, without the repeated last position.
    fn rings(&self) -> Vec<Vec<DVec2>> {
        let mut start = 0;
        let ring = |&end: &usize| {
            let mut ring = self.positions[std::mem::replace(&mut start, end)..end].to_vec();
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            ring
        };
        self.ring_ends.iter().map(ring).collect()
    }
}

impl<'de> Deserialize<'de> for Coordinates {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        let mut coordinates = Self::default();
        coordinates.depth = List(&mut coordinates).deserialize(json)?.depth();
        Ok(coordinates)
    }
}

/// The deepest nesting of the format: the positions of a MultiPolygon.
const DEEPEST: usize = 4;

/// Reads a list of numbers or of lists into the coordinates.
struct List<'a>(&'a mut Coordinates);

/// A value that was read.
#[derive(Clone, Copy, PartialEq)]
enum Met {
    Number(f64),
    /// A list with positions nested this deep; 0 if it has none.
    List(usize),
}

impl Met {
    fn depth(self) -> usize {
        match self {
            Self::Number(_) => 0,
            Self::List(depth) => depth,
        }
    }
}

impl<'de> DeserializeSeed<'de> for List<'_> {
    type Value = Met;

    fn deserialize<D: Deserializer<'de>>(self, json: D) -> Result<Met, D::Error> {
        json.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for List<'_> {
    type Value = Met;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a list")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Met, E> {
        if value.is_finite() { Ok(Met::Number(value)) } else { Err(E::custom("a coordinate is not finite")) }
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Met, E> {
        Ok(Met::Number(value as f64))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Met, E> {
        Ok(Met::Number(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Met, A::Error> {
        let mut position = DVec2::ZERO;
        let (mut numbers, mut lists, mut depth) = (0, 0, 0);
        while let Some(met) = list.next_element_seed(List(self.0))? {
            match met {
                Met::Number(value) => {
                    if numbers < 2 {
                        position[numbers] = value;
                    }
                    numbers += 1;
                }
                Met::List(inner) if depth > 0 && inner > 0 && inner != depth => {
                    return Err(A::Error::custom("a list has elements that are nested to different depths"));
                }
                Met::List(inner) => {
                    depth = depth.max(inner);
                    lists += 1;
                }
            }
        }
        if numbers > 0 && lists > 0 {
            return Err(A::Error::custom("a list has both numbers and lists"));
        }
        let depth = if depth > 0 { depth + 1 } else { usize::from(numbers > 0) };
        self.0.close(position, numbers, depth).map_err(A::Error::custom)?;
        Ok(Met::List(depth))
    }
}

impl Coordinates {
    /// Ends a list with positions nested `depth` deep.
    fn close(&mut self, position: DVec2, numbers: usize, depth: usize) -> Result<(), String> {
        match depth {
            0 => {}
            1 if numbers < 2 => return Err("a position needs two numbers".into()),
            1 => self.positions.push(position),
            2 => self.ring_ends.push(self.positions.len()),
            3 => self.polygon_ends.push(self.ring_ends.len()),
            DEEPEST => {}
            _ => return Err("lists are nested deeper than those of a MultiPolygon".into()),
        }
        if self.positions.len() > MOST_CORNERS {
            let help = "Simplify the outline first, to the detail that the mesh needs";
            return Err(format!(
                "a polygon has more than {} corners, which is the limit. {help}",
                Grouped(MOST_CORNERS)
            ));
        }
        Ok(())
    }
}

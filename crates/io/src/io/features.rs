//! The objects of a GeoJSON file (RFC 7946): geometries, features and collections.

use std::fmt;
use std::io::{self, Cursor, Read};
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde_json::Value;

use super::error::{Flaw, PlacedFlaw};
use super::json::problem;
use super::positions::NestedPositions;
use meshbrush_core::domain::MOST_CORNERS;
use meshbrush_mesh::text::Grouped;

/// Which geometries a reader wants.
pub(super) trait Wanted {
    /// Returns whether geometries of this kind, such as `Polygon`, are wanted.
    fn is_wanted(kind: &str) -> bool;
}

/// Any object of the format. Other members are ignored.
///
/// Of a list, only the objects with a wanted geometry are kept, and the first one, to be named in an error: a
/// file may have millions of others.
#[derive(Deserialize)]
#[serde(bound(deserialize = "W: Wanted"))]
pub(super) struct Object<W> {
    #[serde(rename = "type")]
    pub(super) kind: String,
    #[serde(default)]
    pub(super) coordinates: Option<NestedPositions>,
    /// The name that the properties of a feature give it; empty if they give none.
    #[serde(default, rename = "properties", deserialize_with = "name_of")]
    pub(super) name: String,
    /// The coordinate reference system, as of the format before RFC 7946.
    #[serde(default)]
    crs: Option<Value>,
    #[serde(default)]
    geometry: Option<Box<Self>>,
    #[serde(default, deserialize_with = "with_wanted")]
    geometries: Vec<Self>,
    #[serde(default, deserialize_with = "with_wanted")]
    features: Vec<Self>,
    #[serde(skip)]
    wanted: PhantomData<W>,
}

impl<W: Wanted> Object<W> {
    /// Reads the object of a file, which may begin with a byte order mark. The parser bounds how deep objects
    /// are nested.
    pub(super) fn parse(input: impl Read) -> Result<Self, PlacedFlaw> {
        let mut json = serde_json::Deserializer::from_reader(without_mark(input).map_err(Flaw::Io)?);
        let object = Self::deserialize(&mut json).map_err(placed)?;
        json.end().map_err(|error| match error.is_syntax() {
            true => Flaw::Syntax(SEVERAL.into()).at(error.line().max(1)),
            false => placed(error),
        })?;
        match object.kind.as_str() {
            "Topology" => Err(Flaw::Syntax(TOPOLOGY.into()).into()),
            _ => Ok(object),
        }
    }

    fn has_wanted(&self) -> bool {
        let mut inner = self.geometry.as_deref().into_iter().chain(&self.geometries).chain(&self.features);
        W::is_wanted(&self.kind) || inner.any(Self::has_wanted)
    }
}

impl<W> Object<W> {
    /// Returns the name of the coordinate reference system, if the object has one.
    pub(super) fn crs_name(&self) -> Option<String> {
        self.crs.as_ref().and_then(|crs| crs["properties"]["name"].as_str()).map(str::to_owned)
    }

    /// Returns the objects inside this one.
    pub(super) fn into_inner(self) -> impl Iterator<Item = Self> {
        self.geometry.map(|geometry| *geometry).into_iter().chain(self.geometries).chain(self.features)
    }
}

fn with_wanted<'de, D: Deserializer<'de>, W: Wanted>(json: D) -> Result<Vec<Object<W>>, D::Error> {
    json.deserialize_seq(Objects(PhantomData))
}

struct Objects<W>(PhantomData<W>);

impl<'de, W: Wanted> Visitor<'de> for Objects<W> {
    type Value = Vec<Object<W>>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of features or geometries")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<Object<W>>, A::Error> {
        let mut objects: Vec<Object<W>> = Vec::new();
        while let Some(object) = list.next_element::<Object<W>>()? {
            if objects.len() > MOST_CORNERS {
                let limit = Grouped(MOST_CORNERS);
                return Err(A::Error::custom(format!("a list has more than {limit} geometries, the limit")));
            }
            if objects.is_empty() || object.has_wanted() {
                objects.push(object);
            }
        }
        Ok(objects)
    }
}

/// The properties that may be the name of a feature.
const NAMES: [&str; 5] = ["name", "NAME", "Name", "title", "id"];

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

/// The sentence for objects one after the other.
const SEVERAL: &str = "it has more after its first object, as lines of features have (GeoJSON Lines), and one object is \
                       read. Join them to a FeatureCollection, for example with ogr2ogr out.geojson.";
/// The sentence for TopoJSON.
const TOPOLOGY: &str = "this is TopoJSON, which divides shapes into common arcs. Convert it to GeoJSON, for example with \
                        ogr2ogr or topo2geo.";
/// What is added to the sentence for an object without a type.
const NO_TYPE: &str = "Files of ArcGIS (Esri JSON) have none: export the layer as GeoJSON";

/// Returns the input without the byte order mark, or the separator of records, that it may begin with.
fn without_mark(mut input: impl Read) -> io::Result<impl Read> {
    const MARK: [u8; 3] = *b"\xef\xbb\xbf";
    const SEPARATOR: u8 = 0x1e;
    let mut start = Vec::new();
    input.by_ref().take(MARK.len() as u64).read_to_end(&mut start)?;
    if start == MARK {
        start.clear();
    } else if start.first() == Some(&SEPARATOR) {
        start.remove(0);
    }
    Ok(Cursor::new(start).chain(input))
}

/// Returns the error of serde_json with its line.
fn placed(error: serde_json::Error) -> PlacedFlaw {
    let line = error.line();
    if error.is_eof() {
        return Flaw::CutOff.at(line.max(1));
    }
    if error.is_io() {
        return Flaw::Io(error.into()).into();
    }
    let problem = problem(&error);
    let help = if problem.contains("`type`") { format!(". {NO_TYPE}") } else { String::new() };
    Flaw::Syntax(format!("this is not valid GeoJSON: {problem}{help}.")).at(line.max(1))
}

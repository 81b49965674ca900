//! `.geojson`: polygons with holes, as geographic programs write them (RFC 7946).

use std::io::{self, BufReader, Read, Take, Write};
use std::path::Path;

use super::coordinates::{self, DocumentPlane, FileCoordinates};
use super::disk::File;
use super::error::{Flaw, PlacedFlaw, ReadError};
use super::features::{Object, Wanted};
use super::format_spec::ShapeFormatSpec;
use super::{Counted, Meter, shapes};
use meshbrush_core::domain::{NamedPolygon, Polygon};
use meshbrush_core::earth::{
    Coordinates, GeographicExtent, Projection, ProjectionChoice, ProjectionError, Reprojection,
    projected_polygons,
};
use meshbrush_mesh::text::LengthUnit;

/// The format, for the list of all formats of shapes.
pub static FORMAT: ShapeFormatSpec = ShapeFormatSpec {
    endings: &["geojson", "json"],
    read_outline,
    read_shapes: shapes::read,
    read_shapes_near: None,
};

/// Largest file read.
const MOST_BYTES: u64 = 256 << 20;

/// The domain in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The polygons with their names.
    pub polygons: Vec<NamedPolygon>,
    /// What their coordinates are.
    pub coordinates: FileCoordinates,
}

impl Outline {
    /// Returns whether the polygons end at the antimeridian on both sides of it: coordinates are degrees, and
    /// edges along the longitudes 180° and −180° lie at the same latitudes. Files are cut there (RFC 7946,
    /// section 3.1.9), and a mesh does not join the halves.
    pub fn is_cut_at_antimeridian(&self) -> bool {
        let rings = || self.polygons.iter().flat_map(|named| &named.polygon);
        self.coordinates.unit() == LengthUnit::Degree && coordinates::meet_at_antimeridian(rings())
    }

    /// Returns polygons in other longitudes and latitudes in degrees from Greenwich, and others as they are.
    pub fn in_degrees(mut self) -> Self {
        let Some((coordinates, factor, summand)) = self.coordinates.in_degrees() else { return self };
        let rings = self.polygons.iter_mut().flat_map(|named| &mut named.polygon);
        rings.flatten().for_each(|at| *at = factor * *at + summand);
        Self { coordinates, ..self }
    }

    /// Returns the polygons in the plane of a projection that suits them. Their coordinates are `assumed`
    /// where the file does not name a known system.
    ///
    /// # Errors
    /// Fails where nobody says what the coordinates are on the Earth, and where no projection suits them.
    pub fn projected(
        self,
        choice: ProjectionChoice,
        assumed: Option<Coordinates>,
    ) -> Result<(Self, Projection), ProjectOutlineError> {
        let from = self.coordinates.on_earth(assumed).ok_or(ProjectOutlineError::NotOnEarth)?;
        if let Some(own) = self.own_plane(choice, assumed) {
            return Ok((Self { coordinates: FileCoordinates::Known(from), ..self }, own));
        }
        let rings = self.polygons.iter().flat_map(|named| named.polygon.iter().map(Vec::as_slice));
        let extent =
            GeographicExtent::from_coordinates(&from, rings).ok_or(ProjectOutlineError::NotOnEarth)?;
        let projection = choice.projection(&extent)?;
        Ok((self.reprojected(&Reprojection { from, to: projection }), projection))
    }

    /// Returns the projection whose plane the coordinates are in, if the polygons stay there.
    pub(super) fn own_plane(
        &self,
        choice: ProjectionChoice,
        assumed: Option<Coordinates>,
    ) -> Option<Projection> {
        let Some(Coordinates::Plane(own)) = self.coordinates.on_earth(assumed) else { return None };
        let stays = choice == ProjectionChoice::OwnOrAutomatic || choice == ProjectionChoice::Given(own);
        stays.then_some(own)
    }

    /// Returns the polygons in the plane of a document.
    ///
    /// # Errors
    /// Fails where the file names a system that is not known.
    pub(super) fn in_plane(self, plane: &DocumentPlane) -> Result<Self, Flaw> {
        Ok(match plane.way_of_shapes(&self.coordinates)? {
            Some(reprojection) => self.reprojected(&reprojection),
            None => self,
        })
    }

    fn reprojected(self, reprojection: &Reprojection) -> Self {
        let (polygons, names): (Vec<_>, Vec<_>) =
            self.polygons.into_iter().map(|named| (named.polygon, named.name)).unzip();
        let projected = projected_polygons(&polygons, reprojection).into_iter().zip(names);
        let polygons = projected.map(|(polygon, name)| NamedPolygon { polygon, name }).collect();
        Self { polygons, coordinates: FileCoordinates::Known(Coordinates::Plane(reprojection.to)) }
    }
}

/// Why polygons cannot be projected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProjectOutlineError {
    /// They do not lie on the Earth, as far as the file says.
    #[error(
        "its coordinates are not longitudes from −180° to 180° and latitudes, and it names no coordinate system that is \
         known here, so they cannot be projected. Say what they are: --crs lonlat for longitudes beyond 180°, or a code \
         such as --crs EPSG:32633 (or the key `crs`); or convert the file to EPSG:4326."
    )]
    NotOnEarth,
    /// No projection suits them.
    #[error(transparent)]
    Unsuited(#[from] ProjectionError),
}

/// Reads every polygon of a file: of a geometry, a feature, or a collection of either. Other geometries are
/// ignored.
///
/// Coordinates are not projected: the first is x and the second y. Rings come without the repeated last
/// position.
///
/// # Errors
/// Fails when the file cannot be read, is not GeoJSON, has no polygon, or more than
/// [`MOST_CORNERS`](meshbrush_core::domain::MOST_CORNERS) corners.
pub fn read(path: &Path) -> Result<Vec<Polygon>, ReadError> {
    read_named(path).map(without_names)
}

/// Reads as [`read`] does, with the name of each polygon: the first of the properties `name`, `NAME`, `Name`,
/// `title` and `id` of its feature that is text or a number.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_named(path: &Path) -> Result<Vec<NamedPolygon>, ReadError> {
    read_named_metered(path, &Meter::default())
}

/// Reads as [`read_named`] does, and counts the bytes of the file.
///
/// # Errors
/// Fails as [`read_outline`] does.
pub fn read_named_metered(path: &Path, meter: &Meter) -> Result<Vec<NamedPolygon>, ReadError> {
    read_outline(path, meter).map(|outline| outline.polygons)
}

/// Reads polygons with their names and their unit, and counts the bytes of the file.
///
/// # Errors
/// Fails as [`read`] does, and when the work was cancelled.
pub fn read_outline(path: &Path, meter: &Meter) -> Result<Outline, ReadError> {
    read_metered(path, meter, parse)
}

/// A file whose bytes are counted, up to the limit of its size.
pub(super) type Metered = BufReader<Counted<Take<File>>>;

/// Opens a file for a parser, within the limit of its size, and counts its bytes.
pub(super) fn read_metered<T>(
    path: &Path,
    meter: &Meter,
    parse: impl FnOnce(Metered) -> Result<T, PlacedFlaw>,
) -> Result<T, ReadError> {
    let read = || -> Result<T, PlacedFlaw> {
        let file = File::open(path)?;
        let bytes = file.length()?;
        if bytes > MOST_BYTES {
            return Err(too_long(bytes));
        }
        meter.expect(bytes);
        let parsed = parse(BufReader::new(meter.count(file.take(MOST_BYTES))))?;
        meter.check()?;
        Ok(parsed)
    };
    read().map_err(|flaw| flaw.in_file(path))
}

/// Reads as [`read`] does, from any input, such as bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_from(input: impl Read, name: &Path) -> Result<Vec<Polygon>, ReadError> {
    read_named_from(input, name).map(without_names)
}

/// Reads as [`read_named`] does, from any input, such as standard input. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_named_from(input: impl Read, name: &Path) -> Result<Vec<NamedPolygon>, ReadError> {
    read_outline_from(input, name).map(|outline| outline.polygons)
}

/// Reads as [`read_outline`] does, from any input. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn read_outline_from(input: impl Read, name: &Path) -> Result<Outline, ReadError> {
    read_limited(input, name, |input| parse(input))
}

/// Parses an input within the limit of its size.
pub(super) fn read_limited<T, R: Read>(
    input: R,
    name: &Path,
    parse: fn(&mut BufReader<Take<R>>) -> Result<T, PlacedFlaw>,
) -> Result<T, ReadError> {
    // One byte more shows that there is more.
    let mut input = BufReader::new(input.take(MOST_BYTES + 1));
    let read = parse(&mut input);
    let flaw = if input.get_ref().limit() == 0 { Some(too_long(MOST_BYTES + 1)) } else { None };
    flaw.map_or(read, Err).map_err(|flaw| flaw.in_file(name))
}

/// Returns the polygons alone.
pub fn without_names(polygons: Vec<NamedPolygon>) -> Vec<Polygon> {
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
    let object = Object::parse(input)?;
    let crs = object.crs_name();
    let mut polygons = Vec::new();
    let mut others = Vec::new();
    collect(object, "", &mut polygons, &mut others).map_err(Flaw::Syntax)?;
    if polygons.is_empty() {
        return Err(Flaw::Syntax(no_polygon(&others)).into());
    }
    let corners = polygons.iter().flat_map(|named: &NamedPolygon| named.polygon.iter().flatten());
    let coordinates = coordinates::named(crs.as_deref(), corners.copied());
    Ok(Outline { polygons, coordinates })
}

/// Writes polygons as one geometry with one line for each ring. [`read`] returns the same polygons bit for
/// bit.
///
/// # Errors
/// Fails with the errors of `out`.
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

pub(super) fn no_polygon(others: &[String]) -> String {
    let found = match others.first() {
        Some(kind) => format!("it has {kind}"),
        None => "it has no geometry".into(),
    };
    format!(
        "a domain needs a Polygon or a MultiPolygon, and {found}. Export the area, not its points or lines."
    )
}

/// A reader of polygons.
struct Polygons;

impl Wanted for Polygons {
    fn is_wanted(kind: &str) -> bool {
        kind.ends_with("Polygon")
    }
}

/// Collects polygons with their names, and the kind of the first other geometry. `name` is the name of the
/// object around this one. The recursion is bounded, as the parser bounds the nesting.
fn collect(
    mut object: Object<Polygons>,
    name: &str,
    polygons: &mut Vec<NamedPolygon>,
    others: &mut Vec<String>,
) -> Result<(), String> {
    let (kind, coordinates) = (std::mem::take(&mut object.kind), object.coordinates.take());
    let own_name = std::mem::take(&mut object.name);
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
    object.into_inner().try_for_each(|object| collect(object, name, polygons, others))
}

//! What the coordinates in a file are, from the file's own description.

use glam::DVec2;

use super::CoordinateSystem;
use super::error::Flaw;
use meshbrush_core::domain::Ring;
use meshbrush_core::earth::{Coordinates, Projection, Reprojection};
use meshbrush_mesh::text::LengthUnit;

/// Codes of coordinate systems whose unit is known, and no more: Europe's equal-area system.
const UNITS: [(u32, LengthUnit); 1] = [(3035, LengthUnit::Metre)];

/// What the coordinates in a file are, as far as it says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FileCoordinates {
    /// It names a system that is known here.
    Known(Coordinates),
    /// It names another one, with this unit.
    Foreign(LengthUnit),
    /// It says nothing.
    Unstated {
        /// Whether all coordinates can be longitudes and latitudes.
        can_be_degrees: bool,
    },
}

impl FileCoordinates {
    /// Returns what a file of these corners is that says nothing. Longitudes are from −180 to 180 here, as in
    /// RFC 7946.
    pub(super) fn unstated(corners: impl IntoIterator<Item = DVec2>) -> Self {
        let can_be = |corner: DVec2| corner.x.abs() <= 180.0 && corner.y.abs() <= 90.0;
        Self::Unstated { can_be_degrees: corners.into_iter().all(can_be) }
    }

    /// Returns the unit of coordinates. Without a name, they are degrees if they can be.
    pub fn unit(&self) -> LengthUnit {
        match *self {
            Self::Known(Coordinates::Geographic) | Self::Unstated { can_be_degrees: true } => {
                LengthUnit::Degree
            }
            Self::Known(Coordinates::OnDatum(system)) => system.length_unit(),
            Self::Known(Coordinates::Plane(_) | Coordinates::WebMercator) => LengthUnit::Metre,
            Self::Foreign(unit) => unit,
            Self::Unstated { can_be_degrees: false } => LengthUnit::None,
        }
    }

    /// Returns the unit of coordinates where the file names their system.
    pub fn stated_unit(&self) -> LengthUnit {
        match self {
            Self::Unstated { .. } => LengthUnit::None,
            Self::Known(_) | Self::Foreign(_) => self.unit(),
        }
    }

    /// Returns the same, where the coordinates of a file that does not name a known system are `assumed`.
    pub(super) fn assuming(self, assumed: Option<Coordinates>) -> Self {
        self.on_earth(assumed).map_or(self, Self::Known)
    }

    /// Returns the same in degrees from Greenwich, where they are other longitudes and latitudes, and the
    /// factor and the summand that lead there.
    pub(super) fn in_degrees(self) -> Option<(Self, f64, DVec2)> {
        let Self::Known(Coordinates::OnDatum(system)) = self else { return None };
        let (plain, factor, summand) = system.in_degrees();
        let is_other = factor != 1.0 || summand != DVec2::ZERO;
        is_other.then_some((Self::Known(plain.coordinates()), factor, summand))
    }

    /// Returns what a person should know about the places of coordinates that count as these.
    pub fn note(&self) -> Option<String> {
        match self {
            Self::Known(Coordinates::OnDatum(system)) if system.is_uncertain() => Some(format!(
                "the shift of its geographic system to WGS 84 is not known here: places may be up to about {} m off.",
                system.accuracy
            )),
            _ => None,
        }
    }

    /// Returns what the coordinates are on the Earth. Those of a file that does not name a known system are
    /// `assumed`, or else degrees if it says nothing and they can be.
    pub fn on_earth(&self, assumed: Option<Coordinates>) -> Option<Coordinates> {
        match *self {
            Self::Known(coordinates) => Some(coordinates),
            Self::Foreign(_) | Self::Unstated { can_be_degrees: false } => assumed,
            Self::Unstated { can_be_degrees: true } => assumed.or(Some(Coordinates::Geographic)),
        }
    }
}

/// The plane of a document, for files that are read for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DocumentPlane {
    /// The projection.
    pub projection: Projection,
    /// What the coordinates of files are that do not name a known system.
    pub assumed: Option<Coordinates>,
}

impl From<Projection> for DocumentPlane {
    fn from(projection: Projection) -> Self {
        Self { projection, assumed: None }
    }
}

impl DocumentPlane {
    /// Returns the way from the coordinates of a file to the plane; `None` where nobody says what they are.
    pub fn reprojection(&self, coordinates: &FileCoordinates) -> Option<Reprojection> {
        let from = coordinates.on_earth(self.assumed)?;
        Some(Reprojection { from, to: self.projection })
    }

    /// Returns the way of shapes to the plane. `None` where nobody says what their coordinates are, and they
    /// are no longitudes and latitudes: then they are in the plane already.
    ///
    /// # Errors
    /// Fails where the file names a system that is not known.
    pub(super) fn way_of_shapes(&self, coordinates: &FileCoordinates) -> Result<Option<Reprojection>, Flaw> {
        let way = self.reprojection(coordinates);
        if way.is_none() && matches!(coordinates, FileCoordinates::Foreign(_)) {
            let problem = "it names a coordinate system that is not known here, so its shapes cannot be placed in the \
                           plane of the document. Convert it to EPSG:4326 first.";
            return Err(Flaw::Syntax(problem.into()));
        }
        Ok(way)
    }
}

/// Returns what coordinates are in a system `crs`, which is named as in `urn:ogc:def:crs:EPSG::4326`,
/// `EPSG:4326` or `urn:ogc:def:crs:OGC:1.3:CRS84`, or by its text. A system that is not listed here may be in
/// feet: there is no unit then.
pub fn named(crs: Option<&str>, corners: impl IntoIterator<Item = DVec2>) -> FileCoordinates {
    let Some(crs) = crs else {
        return FileCoordinates::unstated(corners);
    };
    if let Some(described) = CoordinateSystem::from_wkt(crs) {
        return described.stated();
    }
    if let Ok(known) = crs.parse() {
        return FileCoordinates::Known(known);
    }
    let crs = crs.to_uppercase();
    let code = crs.rsplit(':').next().and_then(|code| code.parse().ok());
    match code.filter(|_| crs.contains("EPSG")) {
        _ if crs.ends_with("CRS84") => FileCoordinates::Known(Coordinates::Geographic),
        Some(code) => of_epsg(code),
        None => FileCoordinates::Foreign(LengthUnit::None),
    }
}

/// Returns what coordinates are in a system of the EPSG register.
pub fn of_epsg(code: u32) -> FileCoordinates {
    let unit = || UNITS.iter().find(|(known, _)| *known == code).map_or(LengthUnit::None, |&(_, unit)| unit);
    Coordinates::of_epsg(code).map_or_else(|| FileCoordinates::Foreign(unit()), FileCoordinates::Known)
}

/// Returns whether rings have edges along the longitudes 180° and −180° whose latitudes overlap.
pub(super) fn meet_at_antimeridian<'a>(rings: impl Iterator<Item = &'a Ring> + Clone) -> bool {
    let [east, west] = [180.0, -180.0].map(|longitude| {
        let edges = rings.clone().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let along = edges.filter(|(a, b)| a.x == longitude && b.x == longitude && a.y != b.y);
        let mut latitudes: Vec<[f64; 2]> = along.map(|(a, b)| [a.y.min(b.y), a.y.max(b.y)]).collect();
        latitudes.sort_by(|a, b| a[0].total_cmp(&b[0]));
        latitudes
    });
    let (mut e, mut w) = (0, 0);
    // Of two ranges apart, the lower one meets none of the other side that come later.
    while let (Some(a), Some(b)) = (east.get(e), west.get(w)) {
        if a[0] < b[1] && b[0] < a[1] {
            return true;
        }
        if a[1] <= b[0] { e += 1 } else { w += 1 }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn a_named_coordinate_system_decides_the_unit() {
        let far = dvec2(500_000.0, 4_000_000.0);
        for (crs, unit_of_crs) in [
            ("urn:ogc:def:crs:OGC:1.3:CRS84", LengthUnit::Degree),
            ("urn:ogc:def:crs:EPSG::4326", LengthUnit::Degree),
            ("EPSG:32635", LengthUnit::Metre),
            ("urn:ogc:def:crs:EPSG::25832", LengthUnit::Metre),
            ("EPSG:2263", LengthUnit::None),
            ("a local grid", LengthUnit::None),
        ] {
            assert_eq!(named(Some(crs), [far]).unit(), unit_of_crs, "{crs}");
        }
    }

    #[test]
    fn without_a_coordinate_system_longitudes_and_latitudes_are_degrees() {
        let unit = |corners: &[DVec2]| named(None, corners.iter().copied()).unit();
        assert_eq!(unit(&[dvec2(-180.0, -90.0), dvec2(180.0, 90.0)]), LengthUnit::Degree);
        assert_eq!(unit(&[dvec2(23.0, 38.0), dvec2(23.0, 91.0)]), LengthUnit::None);
        assert_eq!(unit(&[dvec2(181.0, 0.0)]), LengthUnit::None);
    }

    #[test]
    fn polygons_that_are_cut_at_the_antimeridian_are_recognised() {
        let rectangle = |west: f64, east: f64, south: f64, north: f64| -> Ring {
            vec![dvec2(west, south), dvec2(east, south), dvec2(east, north), dvec2(west, north)]
        };
        let meet = |rings: &[Ring]| meet_at_antimeridian(rings.iter());
        let east = rectangle(177.0, 180.0, -18.0, -16.0);
        assert!(meet(&[east.clone(), rectangle(-180.0, -178.0, -17.0, -10.0)]));
        assert!(meet(&[rectangle(-180.0, -178.0, 50.0, 60.0), rectangle(-180.0, 180.0, -5.0, 5.0)]));
        // One side only, other latitudes, or a corner.
        assert!(!meet(std::slice::from_ref(&east)) && !meet(&[]));
        assert!(!meet(&[east.clone(), rectangle(-180.0, -178.0, -16.0, -10.0)]));
        assert!(!meet(&[east, vec![dvec2(-180.0, -17.0), dvec2(-178.0, -18.0), dvec2(-178.0, -16.0)]]));
    }
}

//! What a file says about the coordinate reference system of its coordinates.
//!
//! What a file says is kept as it is, and tells the unit of coordinates.

use std::f64::consts::PI;
use std::io::Read;
use std::path::Path;

use glam::DVec2;

use super::coordinates::{self, FileCoordinates};
use super::disk::File;
use super::vertical::{ValueUnit, VerticalSystem};
use super::wkt_projection::projection;
use meshbrush_core::earth::{Coordinates, GeographicSystem};
use meshbrush_core::layers::PositiveDepth;
use meshbrush_mesh::text::LengthUnit;

/// A coordinate reference system, as a file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateSystem {
    /// Whether coordinates are angles or lengths.
    pub kind: CoordinateKind,
    /// The code of the EPSG register, if the file has one.
    pub epsg: Option<u32>,
    /// The name, if the file has one.
    pub name: Option<String>,
    /// What the coordinates are on the Earth, if that is known here.
    pub on_earth: Option<Coordinates>,
    /// The unit of coordinates; `None` also for units that the program does not know, such as feet.
    pub unit: LengthUnit,
    /// What it says about heights or depths, where it is compound.
    pub vertical: VerticalSystem,
}

/// The kind of a coordinate reference system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateKind {
    /// Longitude and latitude.
    Geographic,
    /// Lengths in a plane.
    Projected,
    /// Neither, or the file does not say.
    Other,
}

/// Keywords of well-known text (versions 1 and 2) that begin a coordinate reference system.
const KEYWORDS: [(&str, CoordinateKind); 7] = [
    ("PROJCS", CoordinateKind::Projected),
    ("PROJCRS", CoordinateKind::Projected),
    ("PROJECTEDCRS", CoordinateKind::Projected),
    ("GEOGCS", CoordinateKind::Geographic),
    ("GEOGCRS", CoordinateKind::Geographic),
    ("GEOGRAPHICCRS", CoordinateKind::Geographic),
    ("GEODCRS", CoordinateKind::Geographic),
];

/// Longest name that is kept, in characters.
const LONGEST_NAME: usize = 200;

/// Most bytes of a text beside a file.
const MOST_TEXT: u64 = 1 << 16;

impl CoordinateSystem {
    /// Returns what the text beside a file (`.prj`) says about its coordinates; `None` without one.
    pub fn beside(path: &Path) -> Option<Self> {
        let open = |ending| File::open(path.with_extension(ending)).ok();
        let text = ["prj", "PRJ"].into_iter().find_map(open)?;
        let mut bytes = Vec::new();
        text.take(MOST_TEXT).read_to_end(&mut bytes).ok()?;
        Self::from_wkt(&String::from_utf8_lossy(&bytes))
    }

    /// Returns the system of an EPSG code, as GeoTIFF keys state it.
    pub(super) fn from_keys(kind: CoordinateKind, epsg: Option<u32>, name: Option<String>) -> Self {
        let by_code = epsg.map(coordinates::of_epsg);
        let named = || name.as_deref().and_then(GeographicSystem::named).map(GeographicSystem::coordinates);
        let on_earth = by_code.and_then(|known| known.on_earth(None)).or_else(|| match kind {
            CoordinateKind::Geographic => Some(named().unwrap_or(Coordinates::Geographic)),
            CoordinateKind::Projected | CoordinateKind::Other => None,
        });
        let unit = match (on_earth, by_code) {
            (Some(known), _) => FileCoordinates::Known(known).unit(),
            (None, Some(foreign)) => foreign.unit(),
            (None, None) => LengthUnit::None,
        };
        let vertical = VerticalSystem::default();
        Self { kind, epsg, name: name.and_then(|name| kept_name(&name)), on_earth, unit, vertical }
    }

    /// Returns what coordinates of these corners are, beside a text that describes their system.
    pub(super) fn from_corners(
        system: Option<&Self>,
        corners: impl IntoIterator<Item = DVec2>,
    ) -> FileCoordinates {
        match system {
            Some(Self { kind: CoordinateKind::Other, .. }) | None => FileCoordinates::unstated(corners),
            Some(system) => system.stated(),
        }
    }

    /// Returns what the system says about coordinates.
    pub fn stated(&self) -> FileCoordinates {
        self.on_earth.map_or(FileCoordinates::Foreign(self.unit), FileCoordinates::Known)
    }

    /// Returns the system that well-known text describes, as in a `.prj` file. Of a system that is compound
    /// or bound to another, this is the first part in the plane. `None` where there is none.
    pub fn from_wkt(text: &str) -> Option<Self> {
        let elements = elements(text);
        let kind_of = |element: &Element| {
            let known = |(keyword, _): &&(&str, _)| element.keyword.eq_ignore_ascii_case(keyword);
            KEYWORDS.iter().find(known).map(|&(_, kind)| kind)
        };
        let (at, kind) = elements.iter().enumerate().find_map(|(i, e)| Some((i, kind_of(e)?)))?;
        let system = &elements[at];
        let inner = elements[at + 1..].iter().take_while(|part| part.depth > system.depth);
        let inner: Vec<&Element> = inner.collect();
        let direct: Vec<&Element> =
            inner.iter().filter(|part| part.depth == system.depth + 1).copied().collect();
        let is = |part: &Element, keywords: &[&str]| {
            keywords.iter().any(|keyword| part.keyword.eq_ignore_ascii_case(keyword))
        };
        let is_code =
            |part: &&&Element| is(part, &["AUTHORITY", "ID"]) && part.values.iter().any(|v| v == "EPSG");
        let code = direct.iter().rfind(is_code);
        let is_unit = |part: &&&Element| is(part, &["UNIT", "LENGTHUNIT", "ANGLEUNIT"]);
        // Version 2 may have it in the last axis.
        let unit = direct.iter().rfind(is_unit).or_else(|| inner.iter().rfind(is_unit));
        let epsg = code.and_then(|part| part.values.get(1)?.parse().ok());
        let factor = unit.and_then(|part| part.values.get(1)?.parse().ok());
        let name = system.values.first().and_then(|name| kept_name(name));
        let unit = unit_of(kind, factor);
        let on_earth = match (kind, unit) {
            (CoordinateKind::Geographic, _) => geographic(&inner, epsg, name.as_deref(), factor),
            (CoordinateKind::Projected, LengthUnit::Metre) => {
                epsg.and_then(Coordinates::of_epsg).or_else(|| projection(&inner).map(Coordinates::Plane))
            }
            _ => None,
        };
        Some(Self { kind, epsg, name, on_earth, unit, vertical: vertical(&elements) })
    }
}

/// Returns the geographic system that elements describe. `radians` is the size of its unit.
fn geographic(
    inner: &[&Element],
    epsg: Option<u32>,
    name: Option<&str>,
    radians: Option<f64>,
) -> Option<Coordinates> {
    let element = |keywords: &[&str]| {
        let is = |part: &&&Element| keywords.iter().any(|word| part.keyword.eq_ignore_ascii_case(word));
        inner.iter().find(is).copied()
    };
    let numbers = |element: &Element| -> Vec<f64> {
        element.values.iter().skip(1).map_while(|value| value.parse().ok()).collect()
    };
    if let Some(known) = epsg.and_then(Coordinates::of_epsg) {
        return Some(known);
    }
    if let Some(known) = name.and_then(GeographicSystem::named) {
        return Some(known.coordinates());
    }
    let ellipsoid = element(&["SPHEROID", "ELLIPSOID"]).map(numbers);
    let ellipsoid = match ellipsoid.as_deref() {
        Some(&[radius, reciprocal, ..]) => [radius, reciprocal],
        _ => return Some(Coordinates::Geographic),
    };
    let meridian = element(&["PRIMEM", "PRIMEMERIDIAN"]).and_then(|part| numbers(part).first().copied());
    let shift = element(&["TOWGS84", "ABRIDGEDTRANSFORMATION"]).and_then(|part| {
        let numbers: Option<Vec<f64>> = part.values.iter().map(|value| value.parse().ok()).collect();
        let mut numbers = numbers?;
        numbers.resize(7, 0.0);
        numbers.try_into().ok()
    });
    let system = GeographicSystem::on_ellipsoid(ellipsoid);
    let unit = radians.map_or(1.0, |radians| radians.to_degrees());
    let unit = if (unit - 1.0).abs() < 1e-6 { 1.0 } else { unit };
    let accuracy = if shift.is_some() { 10.0 } else { system.accuracy };
    let prime_meridian = meridian.unwrap_or(0.0);
    Some(GeographicSystem { prime_meridian, unit, shift, accuracy, ..system }.coordinates())
}

/// Returns what the vertical part of a compound system says.
fn vertical(elements: &[Element]) -> VerticalSystem {
    let is = |part: &Element, keywords: &[&str]| {
        keywords.iter().any(|keyword| part.keyword.eq_ignore_ascii_case(keyword))
    };
    let Some(at) =
        elements.iter().position(|part| is(part, &["VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"]))
    else {
        return VerticalSystem::default();
    };
    let depth = elements[at].depth;
    let inner: Vec<&Element> = elements[at + 1..].iter().take_while(|part| part.depth > depth).collect();
    let unit = inner.iter().rfind(|part| is(part, &["UNIT", "LENGTHUNIT"]));
    let metres = unit.and_then(|part| Some((part.values.get(1)?.parse().ok()?, part.values.first()?)));
    let axis = inner.iter().rfind(|part| is(part, &["AXIS"]));
    let is_down = axis.is_some_and(|part| part.values.iter().any(|value| value.eq_ignore_ascii_case("down")));
    VerticalSystem {
        unit: metres.map_or(ValueUnit::Unstated, |(metres, name)| ValueUnit::of_metres(metres, name)),
        positive: is_down.then_some(PositiveDepth::Down),
    }
}

/// Returns the unit whose size is `factor` metres or radians.
fn unit_of(kind: CoordinateKind, factor: Option<f64>) -> LengthUnit {
    let is = |size: f64| factor.is_some_and(|factor| (factor - size).abs() <= 1e-9 * size);
    match kind {
        CoordinateKind::Geographic if factor.is_none() || is(PI / 180.0) => LengthUnit::Degree,
        CoordinateKind::Projected if is(1.0) => LengthUnit::Metre,
        CoordinateKind::Projected if is(1000.0) => LengthUnit::Kilometre,
        _ => LengthUnit::None,
    }
}

fn kept_name(name: &str) -> Option<String> {
    let name: String = name.trim().chars().filter(|c| !c.is_control()).take(LONGEST_NAME).collect();
    (!name.is_empty()).then_some(name)
}

/// An element of well-known text, such as `UNIT["metre",1]`.
pub(super) struct Element {
    pub(super) keyword: String,
    depth: usize,
    /// Its texts and numbers, without those of the elements in it.
    pub(super) values: Vec<String>,
}

/// Returns the elements of well-known text in the order in which they begin.
fn elements(text: &str) -> Vec<Element> {
    let mut elements: Vec<Element> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let (mut word, mut is_quoted) = (String::new(), false);
    for c in text.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => word.push(c),
            '[' | '(' => {
                let keyword = std::mem::take(&mut word).trim().to_owned();
                open.push(elements.len());
                elements.push(Element { keyword, depth: open.len(), values: Vec::new() });
            }
            ',' | ']' | ')' => {
                let value = std::mem::take(&mut word).trim().to_owned();
                if let Some(&element) = open.last().filter(|_| !value.is_empty()) {
                    elements[element].values.push(value);
                }
                if c != ',' {
                    open.pop();
                }
            }
            _ => word.push(c),
        }
    }
    elements
}

#[cfg(test)]
mod tests {
    use super::*;

    const UTM: &str = r#"PROJCS["WGS 84 / UTM zone 33N",GEOGCS["WGS 84",DATUM["WGS_1984",
        SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]]],PRIMEM["Greenwich",0],
        UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]],PROJECTION["Transverse_Mercator"],
        PARAMETER["central_meridian",15],UNIT["metre",1],AUTHORITY["EPSG","32633"]]"#;

    #[test]
    fn well_known_text_says_kind_name_code_and_unit() {
        use CoordinateKind::{Geographic, Projected};
        let esri = r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257]],
            PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]"#;
        let feet = r#"projcs["NAD83 / New York",geogcs["NAD83"],unit["US survey foot",0.304800609601219]]"#;
        let kilometres = r#"PROJCS["grid",GEOGCS["any"],UNIT["kilometre",1000]]"#;
        let second = r#"PROJCRS["ETRS89-extended / LAEA Europe",BASEGEOGCRS["ETRS89"],CS[Cartesian,2],
            LENGTHUNIT["metre",1],ID["EPSG",3035]]"#;
        let compound = format!(r#"COMPD_CS["both",{UTM},VERT_CS["height",UNIT["metre",1]]]"#);
        let utm = Coordinates::of_epsg(32633);
        let degrees = Some(Coordinates::Geographic);
        for (text, kind, epsg, name, unit, on_earth) in [
            (UTM, Projected, Some(32633), "WGS 84 / UTM zone 33N", LengthUnit::Metre, utm),
            (esri, Geographic, None, "GCS_WGS_1984", LengthUnit::Degree, degrees),
            (feet, Projected, None, "NAD83 / New York", LengthUnit::None, None),
            (kilometres, Projected, None, "grid", LengthUnit::Kilometre, None),
            (second, Projected, Some(3035), "ETRS89-extended / LAEA Europe", LengthUnit::Metre, None),
            (&compound, Projected, Some(32633), "WGS 84 / UTM zone 33N", LengthUnit::Metre, utm),
        ] {
            let (name, found) = (Some(name.to_owned()), CoordinateSystem::from_wkt(text));
            let vertical = found.as_ref().unwrap().vertical.clone();
            let expected = CoordinateSystem { kind, epsg, name, on_earth, unit, vertical };
            assert_eq!(found, Some(expected));
        }
    }

    #[test]
    fn the_vertical_part_says_unit_and_direction() {
        let compound = |vertical: &str| {
            CoordinateSystem::from_wkt(&format!(r#"COMPD_CS["both",{UTM},{vertical}]"#)).unwrap().vertical
        };
        let feet = r#"VERT_CS["NAVD88 depth (ftUS)",VERT_DATUM["NAVD88",2005],
            UNIT["US survey foot",0.304800609601219],AXIS["Depth",DOWN]]"#;
        assert_eq!(compound(feet).unit.metres(), 1200.0 / 3937.0);
        assert_eq!(compound(feet).positive, Some(PositiveDepth::Down));
        let metres = r#"VERTCRS["EGM96 height",VDATUM["EGM96"],CS[vertical,1],AXIS["up (H)",up,LENGTHUNIT["metre",1]]]"#;
        assert_eq!((compound(metres).unit.metres(), compound(metres).positive), (1.0, None));
    }

    #[test]
    fn text_that_describes_no_system_is_none() {
        for text in ["", "]]]", "PROJCS", "LOCAL_CS[\"a\"]", "\"GEOGCS[", &"[".repeat(10_000)] {
            assert_eq!(CoordinateSystem::from_wkt(text), None, "{text}");
        }
        for end in 0..UTM.len() {
            let _ = CoordinateSystem::from_wkt(&UTM[..end]);
        }
    }

    #[test]
    fn a_code_tells_the_unit() {
        let projected = |code| CoordinateSystem::from_keys(CoordinateKind::Projected, code, None).unit;
        assert_eq!([projected(Some(32633)), projected(Some(2263))], [LengthUnit::Metre, LengthUnit::None]);
        assert_eq!(projected(None), LengthUnit::None);
    }
}

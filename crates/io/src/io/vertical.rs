//! What files say about their values as heights and depths: the unit, and the direction in which they grow.

use meshbrush_core::layers::PositiveDepth;
use meshbrush_core::raster::Raster;
use meshbrush_mesh::text::{Number, excerpt};

/// What a file says about the values of a grid, beyond the numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValueFacts {
    /// The direction in which the values grow, as heights or depths, if the file says it.
    pub positive: Option<PositiveDepth>,
    /// The unit of the values in the file. Values that were read are in metres where it is a length.
    pub unit: ValueUnit,
    /// What a person should know about the reading, a sentence each, without the name of the file.
    pub notes: Vec<String>,
}

impl ValueFacts {
    /// Returns what attributes of the CF conventions say.
    pub fn from_attributes(units: Option<&str>, positive: Option<&str>, standard_name: Option<&str>) -> Self {
        let unit = ValueUnit::named(units.unwrap_or_default());
        let notes = unit.note().into_iter().collect();
        Self { positive: direction(positive, standard_name), unit, notes }
    }

    /// Returns values in the unit of their source in metres, where it is a length.
    pub fn in_metres(&self, raster: Raster) -> Raster {
        let metres = self.unit.metres();
        if metres == 1.0 {
            return raster;
        }
        let values = raster.values().iter().map(|&value| (f64::from(value) * metres) as f32);
        Raster::from_values(raster.bounds(), raster.size(), values.collect())
    }
}

/// The unit of values in a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ValueUnit {
    /// The file names none, or one of numbers without a dimension.
    #[default]
    Unstated,
    /// A length.
    Length(UnitOfLength),
    /// Another unit, by its name in the file.
    Other(String),
}

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitOfLength {
    /// Its name, as several.
    pub name: &'static str,
    /// Its size in metres.
    pub metres: f64,
}

/// Units of length by their names in files, in lower case, with blanks for underscores, and their codes in
/// the EPSG register.
const LENGTHS: [(UnitOfLength, &[&str], &[u16]); 12] = [
    (length("metres", 1.0), &["m", "metre", "metres", "meter", "meters", "m."], &[9001]),
    (length("kilometres", 1000.0), &["km", "kilometre", "kilometres", "kilometer", "kilometers"], &[9036]),
    (length("decimetres", 0.1), &["dm", "decimetre", "decimetres", "decimeter", "decimeters"], &[]),
    (length("centimetres", 0.01), &["cm", "centimetre", "centimetres", "centimeter", "centimeters"], &[1033]),
    (
        length("millimetres", 0.001),
        &["mm", "millimetre", "millimetres", "millimeter", "millimeters"],
        &[1025],
    ),
    (
        length("feet", 0.3048),
        &["ft", "foot", "feet", "'", "international foot", "international feet", "foot (international)"],
        &[9002],
    ),
    (
        length("US survey feet", 1200.0 / 3937.0),
        &[
            "us survey foot",
            "us survey feet",
            "u.s. survey foot",
            "foot us",
            "foot us survey",
            "us survey ft",
            "us-ft",
            "us ft",
            "ftus",
            "ft us",
            "ft-us",
            "sft",
            "survey foot",
            "survey feet",
            "foot survey us",
            "us foot",
            "us feet",
        ],
        &[9003],
    ),
    (length("yards", 0.9144), &["yd", "yard", "yards"], &[9096]),
    (length("fathoms", 1.8288), &["fm", "fathom", "fathoms", "ftm"], &[9014]),
    (length("inches", 0.0254), &["in", "inch", "inches"], &[]),
    (length("nautical miles", 1852.0), &["nautical mile", "nautical miles", "nmi"], &[9030]),
    (length("Clarke's feet", 0.304_797_265_4), &["clarke's foot", "clarkes foot"], &[9005]),
];

const fn length(name: &'static str, metres: f64) -> UnitOfLength {
    UnitOfLength { name, metres }
}

/// Names of units of numbers without a dimension.
const DIMENSIONLESS: [&str; 6] = ["", "1", "-", "none", "unitless", "dimensionless"];

/// Beginnings of standard names of quantities that grow downwards (CF conventions).
const STANDARD_DEPTHS: [&str; 2] = ["sea_floor_depth_below", "depth_below"];
/// Codes of vertical systems of the EPSG register whose unit is not the metre, and the code of that unit.
const VERTICAL_UNITS: [(u16, &[u16]); 2] = [
    (9002, &[5614, 6130, 6131, 6132, 8050, 8051, 8228, 8897]),
    (9003, &[5702, 6358, 6359, 6360, 8052, 8053]),
];

/// Codes of vertical systems of the EPSG register that are depths.
const VERTICAL_DEPTHS: [u16; 52] = [
    5336, 5612, 5614, 5706, 5715, 5734, 5739, 5789, 5831, 5861, 5862, 5863, 5864, 5865, 5866, 5867, 5873,
    6357, 6358, 6359, 7976, 8051, 8053, 8358, 8378, 8897, 9287, 9288, 9672, 10150, 10151, 10349, 10364,
    10370, 10371, 10372, 10373, 10374, 10375, 10376, 10377, 10378, 10379, 10547, 10548, 10549, 10550, 10551,
    10552, 10649, 10650, 10678,
];

/// A vertical coordinate system, as far as values depend on it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VerticalSystem {
    /// The unit of heights or depths.
    pub unit: ValueUnit,
    /// The direction in which they grow, if the system says it.
    pub positive: Option<PositiveDepth>,
}

impl VerticalSystem {
    /// Returns what is known of a code of the EPSG register.
    pub(super) fn from_epsg(code: u16) -> Self {
        let unit = VERTICAL_UNITS.iter().find(|(_, codes)| codes.contains(&code)).map(|&(unit, _)| unit);
        let positive = VERTICAL_DEPTHS.contains(&code).then_some(PositiveDepth::Down);
        Self { unit: unit.map_or(ValueUnit::Unstated, ValueUnit::from_epsg), positive }
    }
}

impl ValueUnit {
    /// Returns the unit with a name as files have it.
    pub(super) fn named(text: &str) -> Self {
        let plain = text.trim().to_lowercase().replace('_', " ");
        if DIMENSIONLESS.contains(&plain.as_str()) {
            return Self::Unstated;
        }
        let known = |name: &str| LENGTHS.iter().find(|(_, names, _)| names.contains(&name));
        // As in `m above mean sea level`.
        let before_datum = || {
            let words = plain.split_once([' ', '(']).filter(|(_, rest)| {
                let rest = rest.trim_start_matches(['(', ' ']);
                [
                    "above", "below", "relative", "positive", "msl", "a.s.l", "asl", "amsl", "navd", "down",
                    "up",
                ]
                .iter()
                .any(|start| rest.starts_with(start))
            });
            words.and_then(|(unit, _)| known(unit))
        };
        let found = known(&plain).or_else(before_datum);
        found.map_or_else(|| Self::Other(excerpt(40, text.trim())), |&(unit, ..)| Self::Length(unit))
    }

    /// Returns the unit with a code of the EPSG register.
    pub(super) fn from_epsg(code: u16) -> Self {
        let known = LENGTHS.iter().find(|(.., codes)| codes.contains(&code));
        known.map_or_else(|| Self::Other(format!("EPSG:{code}")), |&(unit, ..)| Self::Length(unit))
    }

    /// Returns the unit of this many metres, which a file calls `name`.
    pub(super) fn of_metres(metres: f64, name: &str) -> Self {
        let is_near = |unit: &UnitOfLength| (unit.metres - metres).abs() <= 1e-9 * metres;
        let known = LENGTHS.iter().find(|(unit, ..)| is_near(unit));
        known.map_or_else(|| Self::Other(excerpt(40, name)), |&(unit, ..)| Self::Length(unit))
    }

    /// Returns this unit, or another one where the file names none.
    pub(super) fn or(self, other: Self) -> Self {
        if self == Self::Unstated { other } else { self }
    }

    /// Returns what values are multiplied by when they are read.
    pub(super) fn metres(&self) -> f64 {
        match self {
            Self::Length(unit) => unit.metres,
            Self::Unstated | Self::Other(_) => 1.0,
        }
    }

    /// Returns what a person should know about the unit of values.
    pub(super) fn note(&self) -> Option<String> {
        match self {
            Self::Length(UnitOfLength { name, metres }) if *metres != 1.0 => {
                let metres = Number(1e-10 * (1e10 * metres).round());
                Some(format!("its values are in {name}; they are read in metres (times {metres})."))
            }
            Self::Length(_) | Self::Unstated | Self::Other(_) => None,
        }
    }
}

/// Returns the direction that the attributes `positive` and `standard_name` of the CF conventions say.
pub(super) fn direction(positive: Option<&str>, standard_name: Option<&str>) -> Option<PositiveDepth> {
    match positive.map(str::to_ascii_lowercase).as_deref() {
        Some("down") => return Some(PositiveDepth::Down),
        Some("up") => return Some(PositiveDepth::Up),
        _ => {}
    }
    let name = standard_name?.to_ascii_lowercase();
    let is_depth = name == "depth" || STANDARD_DEPTHS.iter().any(|start| name.starts_with(start));
    is_depth.then_some(PositiveDepth::Down)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_by_the_names_of_many_programs() {
        for (text, metres) in [
            ("metre", 1.0),
            ("Meters", 1.0),
            ("m above mean sea level", 1.0),
            ("metres (below MLLW)", 1.0),
            ("ft", 0.3048),
            ("US survey foot", 1200.0 / 3937.0),
            ("US_survey_foot", 1200.0 / 3937.0),
            ("cm", 0.01),
            ("km", 1000.0),
            ("fathoms", 1.8288),
            ("dm", 0.1),
        ] {
            assert!(matches!(ValueUnit::named(text), ValueUnit::Length(_)), "{text}");
            assert_eq!(ValueUnit::named(text).metres(), metres, "{text}");
        }
        for text in ["m s-1", "m/s", "K", "degrees", "m2"] {
            assert_eq!(ValueUnit::named(text), ValueUnit::Other(text.into()));
        }
        assert_eq!(["", "1", "-"].map(ValueUnit::named), [const { ValueUnit::Unstated }; 3]);
        assert_eq!(ValueUnit::from_epsg(9003).metres(), ValueUnit::named("us-ft").metres());
        assert_eq!(VerticalSystem::from_epsg(6360).unit.metres(), 1200.0 / 3937.0);
        assert_eq!(VerticalSystem::from_epsg(5715).positive, Some(PositiveDepth::Down));
        assert_eq!(VerticalSystem::from_epsg(5703).positive, None);
    }

    #[test]
    fn a_direction_is_that_of_its_attribute_or_else_of_the_standard_name() {
        use PositiveDepth::{Down, Up};
        for (positive, name, expected) in [
            (Some("down"), None, Some(Down)),
            (Some("UP"), Some("depth"), Some(Up)),
            (None, Some("sea_floor_depth_below_geoid"), Some(Down)),
            (None, Some("sea_floor_depth_below_mean_sea_level"), Some(Down)),
            (None, Some("surface_altitude"), None),
            (Some("sideways"), None, None),
        ] {
            assert_eq!(direction(positive, name), expected, "{positive:?} {name:?}");
        }
    }
}

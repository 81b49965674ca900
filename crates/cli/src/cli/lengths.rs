//! Lengths as typed: plain numbers, or with a unit.

use std::fmt;
use std::str::FromStr;

use super::args::InputArguments;
use super::failure::Failure;
use meshbrush_mesh::text::{LengthUnit, typed};

/// A length as typed: `2000`, `2 km`, `0.5 nmi`, `0.1°`.
#[derive(Clone, Debug, PartialEq)]
pub struct Length {
    /// The number, in world units where it has no unit, or else in metres or degrees.
    pub value: f64,
    /// Metres or degrees, if it has a unit.
    unit: LengthUnit,
    text: String,
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let with = |value, unit| Self { value, unit, text: text.to_owned() };
        if let Ok(value) = text.parse().or_else(|_| typed::number(text, "")) {
            return Ok(with(value, LengthUnit::None));
        }
        if let Ok(degrees) = typed::number(text, LengthUnit::Degree.symbol()) {
            return Ok(with(degrees, LengthUnit::Degree));
        }
        typed::number(text, LengthUnit::Metre.symbol()).map(|metres| with(metres, LengthUnit::Metre))
    }
}

impl Length {
    /// Checks that the unit has a meaning in a document.
    ///
    /// # Errors
    /// Fails with the option where lengths of the document are in another unit.
    pub fn check(&self, option: &str, of_document: LengthUnit) -> Result<(), Failure> {
        if self.unit == LengthUnit::None {
            return Ok(());
        }
        LengthWithUnit { option: format!("{option} {self}"), unit: self.unit }.check(of_document)
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// An option with a length that has a unit.
#[derive(Debug)]
pub struct LengthWithUnit {
    /// The option as typed.
    option: String,
    unit: LengthUnit,
}

impl LengthWithUnit {
    /// Returns the lengths with a unit among the options on what to mesh.
    pub fn all(typed: &InputArguments) -> Vec<Self> {
        let lengths = [
            ("--boundary-diameter", &typed.boundary_diameter),
            ("--spacing", &typed.spacing),
            ("--distance-at-zero", &typed.distances.distance_at_zero),
            ("--distance-range", &typed.distances.distance_range),
            ("--smoothing", &typed.water.smoothing),
            ("--widest-strait", &typed.water.widest_strait),
            ("--h-min", &typed.h_min),
            ("--h-risk", &typed.h_risk),
            ("--h-max", &typed.h_max),
        ];
        let lengths = lengths.into_iter().filter_map(|(option, length)| Some((option, length.clone()?)));
        let targets = typed.target.iter().filter_map(|text| Some(("--target", length_with_unit(text)?)));
        let with_unit = lengths.chain(targets).filter(|(_, length)| length.unit != LengthUnit::None);
        with_unit
            .map(|(option, Length { unit, text, .. })| Self { option: format!("{option} {text}"), unit })
            .collect()
    }

    /// Returns whether it is in metres.
    pub fn is_metric(&self) -> bool {
        self.unit == LengthUnit::Metre
    }

    /// Checks that the length has a meaning in a document.
    ///
    /// # Errors
    /// Fails with the option where lengths of the document are in another unit.
    pub fn check(&self, of_document: LengthUnit) -> Result<(), Failure> {
        if self.unit == of_document {
            return Ok(());
        }
        let Self { option, .. } = self;
        let lengths = match of_document {
            LengthUnit::None => "plain numbers",
            LengthUnit::Metre => "in metres",
            LengthUnit::Kilometre => "in kilometres",
            LengthUnit::Degree => "in degrees, which are not lengths on the Earth",
        };
        let advice = match (of_document, self.unit) {
            (LengthUnit::Degree, _) => {
                "Mesh the region in metres with --projection auto, or type the number alone"
            }
            (LengthUnit::None, LengthUnit::Metre) => {
                "Name a region on the Earth with --region, say its coordinates with --crs, or type the number alone"
            }
            _ => "Type the number alone",
        };
        Err(Failure::Usage(format!("{option}: lengths of this domain are {lengths}. {advice}.")))
    }
}

/// Returns the length that a text is, if it has a unit: formulas are none.
pub fn length_with_unit(text: &str) -> Option<Length> {
    text.parse().ok().filter(|length: &Length| length.unit != LengthUnit::None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_typed_as_people_like() {
        use LengthUnit::{Degree, Metre, None};
        for (text, value, unit) in [
            ("2000", 2000.0, None),
            ("-1e3", -1000.0, None),
            ("2k", 2000.0, None),
            ("2 km", 2000.0, Metre),
            ("0.5nmi", 926.0, Metre),
            ("300 m", 300.0, Metre),
            ("0.1°", 0.1, Degree),
            ("0.1 deg", 0.1, Degree),
        ] {
            let length: Length = text.parse().unwrap();
            assert_eq!((length.value, length.unit, length.to_string()), (value, unit, text.to_owned()));
        }
        assert!("x".parse::<Length>().unwrap_err().contains("is not a number"));
        assert!("2 apples".parse::<Length>().unwrap_err().contains("cannot be converted to m"));
        // A formula is not a length.
        assert_eq!(
            ["3*x", "x", "2", "2m*x", "2 m"].map(|text| length_with_unit(text).is_some()),
            [false, false, false, false, true]
        );
    }
}

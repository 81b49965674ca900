use std::fmt;
use std::str::FromStr;

use super::{LengthUnit, typed};

/// A length as people write it: `2000`, `2 km`, `0.5 nmi`, `0.1°`.
#[derive(Clone, Debug, PartialEq)]
pub struct Length {
    /// The number, in world units where it has no unit, or else in [`Self::unit`].
    pub value: f64,
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
    /// Returns the length that a text says, if it has a unit; a formula has none.
    pub fn with_unit(text: &str) -> Option<Self> {
        text.parse().ok().filter(Self::has_unit)
    }

    /// Returns the number of a length that is never in degrees: with a unit in metres, or in kilometres where
    /// lengths of the document are.
    ///
    /// # Errors
    /// Fails with a sentence where the text is no such length.
    pub fn on_ground(text: &str, of_document: LengthUnit) -> Result<f64, String> {
        let length: Self = text.parse()?;
        match length.unit {
            LengthUnit::Degree => Err(format!(
                "“{text}” is an angle; this is a length on the ground, as in \"300 m\" or \"0.2 km\"."
            )),
            _ => Ok(length.in_document(of_document).value),
        }
    }

    /// Returns the unit of the number: metres or degrees, or none.
    pub fn unit(&self) -> LengthUnit {
        self.unit
    }

    /// Returns whether it was written with a unit.
    pub fn has_unit(&self) -> bool {
        self.unit != LengthUnit::None
    }

    /// Returns the length for a document whose lengths are in `of_document`: metres become kilometres there.
    pub fn in_document(self, of_document: LengthUnit) -> Self {
        match (self.unit, of_document) {
            (LengthUnit::Metre, LengthUnit::Kilometre) => {
                Self { value: self.value / 1000.0, unit: LengthUnit::Kilometre, ..self }
            }
            _ => self,
        }
    }

    /// Checks that the unit has a meaning in a document.
    ///
    /// # Errors
    /// Fails with a sentence where lengths of the document are in another unit.
    pub fn check(&self, of_document: LengthUnit) -> Result<(), String> {
        if !self.has_unit() || self.unit == of_document {
            return Ok(());
        }
        let lengths = match of_document {
            LengthUnit::None => "plain numbers",
            LengthUnit::Metre => "in metres",
            LengthUnit::Kilometre => "in kilometres",
            LengthUnit::Degree => "in degrees, which are not lengths on the Earth",
        };
        let advice = match (of_document, self.unit) {
            (LengthUnit::Degree, _) => {
                "Mesh the region in metres, with the projection auto, or give the number alone"
            }
            (LengthUnit::None, LengthUnit::Metre) => {
                "Name a region on the Earth, say its coordinates (crs), or give the number alone"
            }
            _ => "Give the number alone",
        };
        Err(format!("lengths of this domain are {lengths}. {advice}."))
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_on_the_ground_is_no_angle() {
        let on_ground = |text| Length::on_ground(text, LengthUnit::Degree);
        assert_eq!(
            [on_ground("300 m"), on_ground("0.5 nmi"), on_ground("7")],
            [Ok(300.0), Ok(926.0), Ok(7.0)]
        );
        assert_eq!(Length::on_ground("300 m", LengthUnit::Kilometre), Ok(0.3));
        assert!(on_ground("0.1°").is_err() && on_ground("wide").is_err());
    }

    #[test]
    fn lengths_are_written_as_people_like() {
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
            ["3*x", "x", "2", "2m*x", "2 m"].map(|text| Length::with_unit(text).is_some()),
            [false, false, false, false, true]
        );
    }

    #[test]
    fn random_lengths_are_read_in_every_unit() {
        use LengthUnit::{Degree, Metre, None};
        let units: [(&str, f64, LengthUnit); 7] = [
            ("", 1.0, None),
            ("m", 1.0, Metre),
            ("km", 1e3, Metre),
            ("nmi", 1852.0, Metre),
            ("cm", 0.01, Metre),
            ("°", 1.0, Degree),
            ("deg", 1.0, Degree),
        ];
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..2_000 {
            let value = 2e4 * random.f64() - 1e4;
            let number = match random.u8(..3) {
                0 => format!("{value}"),
                1 => format!("{value:e}"),
                _ => format!("{value:.2}"),
            };
            let (symbol, in_unit, unit) = units[random.usize(..units.len())];
            let space = if random.bool() { " " } else { "" };
            let text = format!("{number}{space}{symbol}").trim_end().to_owned();
            let length: Length = text.parse().unwrap_or_else(|message| panic!("{text}: {message}"));
            let expected = number.parse::<f64>().unwrap() * in_unit;
            assert!((length.value - expected).abs() <= 1e-12 * expected.abs(), "{text}: {length:?}");
            assert_eq!((length.unit, length.to_string()), (unit, text));
        }
    }

    #[test]
    fn a_unit_has_a_meaning_only_where_lengths_are_in_it() {
        let length = |text: &str| text.parse::<Length>().unwrap();
        for (text, of_document, sentence) in [
            ("3", LengthUnit::Degree, ""),
            ("3 m", LengthUnit::Metre, ""),
            ("3°", LengthUnit::Degree, ""),
            ("3 m", LengthUnit::None, "lengths of this domain are plain numbers. Name a region on the Earth"),
            ("3 m", LengthUnit::Degree, "in degrees, which are not lengths on the Earth. Mesh the region"),
            ("3 m", LengthUnit::Kilometre, "in kilometres. Give the number alone."),
            ("3°", LengthUnit::Metre, "in metres. Give the number alone."),
        ] {
            let found = length(text).check(of_document).err().unwrap_or_default();
            assert!(found.contains(sentence) && found.is_empty() == sentence.is_empty(), "{text}: {found}");
        }
        let in_kilometres = length("300 m").in_document(LengthUnit::Kilometre);
        assert_eq!((in_kilometres.value, in_kilometres.check(LengthUnit::Kilometre)), (0.3, Ok(())));
        assert_eq!(length("0.1°").in_document(LengthUnit::Kilometre).value, 0.1);
    }
}

//! Lengths with units in a text: `"40 km"` in place of 40000.

use std::str::FromStr;

use super::SavedSettings;
use crate::io::{KeyFault, KeyStep, TextValue};
use meshbrush_mesh::text::{Length, LengthUnit, area, excerpt};

/// The keys with a length, in whichever table they are.
const KEYS: [&str; 13] = [
    "spacing",
    "boundary_diameter",
    "h_min",
    "h_risk",
    "h_max",
    "width",
    "at_zero",
    "range",
    "diameter",
    "smoothing",
    "width_from",
    "width_to",
    "clearance",
];

/// A way to read a number in metres or square metres, or in kilometres where lengths of the document are.
type OnGround = fn(&str, LengthUnit) -> Result<f64, String>;

/// The keys that are in metres, or in square metres, also where coordinates are degrees: they need no plane.
const ON_GROUND: [(&str, OnGround); 2] = [("smallest_inlet", Length::on_ground), ("smallest_island", area)];

/// The projection for lengths in metres: the plane of the region's own coordinates where they are in metres.
pub const METRES: &str = "metres";

/// The lengths with a unit in a text, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenLengths(Vec<WrittenLength>);

#[derive(Clone, Debug, PartialEq)]
struct WrittenLength {
    path: Vec<KeyStep>,
    length: Length,
}

impl WrittenLengths {
    /// Puts numbers in the place of texts that are lengths, and returns those with a unit. `of_document` is
    /// the unit of the document, if it is known.
    ///
    /// # Errors
    /// Fails for the first text in the place of a length that is none.
    pub(in crate::io) fn take(
        tables: &mut TextValue,
        of_document: Option<LengthUnit>,
    ) -> Result<Self, KeyFault> {
        let stated = of_document.or_else(|| stated_unit(tables)).unwrap_or_default();
        let mut taken = Self::default();
        taken.take_from(tables, &mut Vec::new(), stated)?;
        Ok(taken)
    }

    fn take_from(
        &mut self,
        value: &mut TextValue,
        path: &mut Vec<KeyStep>,
        unit: LengthUnit,
    ) -> Result<(), KeyFault> {
        match value {
            TextValue::List(list) => {
                for (index, entry) in list.iter_mut().enumerate() {
                    path.push(index.into());
                    self.take_from(entry, path, unit)?;
                    path.pop();
                }
            }
            TextValue::Table(table) => {
                let is_size = has_word(table, "quantity", "diameter");
                for (key, value) in table {
                    path.push(key.clone().into());
                    match value {
                        TextValue::Text(text) if KEYS.contains(&&**key) => {
                            *value = TextValue::Number(self.number(text, path, unit)?);
                        }
                        TextValue::Text(text) if ON_GROUND.iter().any(|(name, _)| name == key) => {
                            *value = TextValue::Number(on_ground(key, text, path, unit)?);
                        }
                        TextValue::Text(text) if key == "formula" && is_size => {
                            if Length::with_unit(text).is_some() {
                                *text = self.number(text, path, unit)?.to_string();
                            }
                        }
                        TextValue::List(knots) if key == "curve" => self.take_knots(knots, path, unit)?,
                        _ => self.take_from(value, path, unit)?,
                    }
                    path.pop();
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes the diameters of pairs of a value and a diameter.
    fn take_knots(
        &mut self,
        knots: &mut [TextValue],
        path: &mut Vec<KeyStep>,
        unit: LengthUnit,
    ) -> Result<(), KeyFault> {
        for (index, knot) in knots.iter_mut().enumerate() {
            if let TextValue::List(pair) = knot
                && let [_, diameter] = &mut pair[..]
                && let TextValue::Text(text) = diameter
            {
                path.extend([index.into(), 1.into()]);
                *diameter = TextValue::Number(self.number(text, path, unit)?);
                path.truncate(path.len() - 2);
            }
        }
        Ok(())
    }

    /// Returns the number of a length, and keeps its unit in mind.
    fn number(&mut self, text: &str, path: &[KeyStep], unit: LengthUnit) -> Result<f64, KeyFault> {
        let fault = |sentence| KeyFault { path: path.to_owned(), ..KeyFault::here(sentence) };
        if text.trim().is_empty() {
            let sentence = "this text is empty: write a length such as \"40 km\", or a number.";
            return Err(fault(sentence.to_owned()));
        }
        let length = Length::from_str(text).map_err(fault)?.in_document(unit);
        let value = length.value;
        if length.has_unit() {
            self.0.push(WrittenLength { path: path.to_owned(), length });
        }
        Ok(value)
    }

    /// Returns whether one of them is in metres.
    pub fn are_metric(&self) -> bool {
        self.0.iter().any(|written| written.length.unit() == LengthUnit::Metre)
    }

    /// Checks that they have a meaning in a document.
    ///
    /// # Errors
    /// Fails for the first one where lengths of the document are in another unit.
    pub fn check(&self, of_document: LengthUnit) -> Result<(), KeyFault> {
        self.0.iter().try_for_each(|WrittenLength { path, length }| {
            length.check(of_document).map_err(|problem| KeyFault {
                path: path.clone(),
                given: Some(cannot_be_used(length)),
                ..KeyFault::here(problem)
            })
        })
    }

    /// Returns a fault of one of them with the length as it was written.
    pub(in crate::io) fn as_written(&self, fault: KeyFault) -> KeyFault {
        let written = self.0.iter().find(|written| written.path == fault.path && fault.given.is_some());
        match written {
            Some(written) => KeyFault { given: Some(cannot_be_used(&written.length)), ..fault },
            None => fault,
        }
    }
}

/// Returns the number of a length or an area on the ground.
fn on_ground(key: &str, text: &str, path: &[KeyStep], unit: LengthUnit) -> Result<f64, KeyFault> {
    let read = ON_GROUND
        .iter()
        .find(|(name, _)| *name == key)
        .map_or(Length::on_ground as OnGround, |(_, read)| *read);
    read(text, unit).map_err(|sentence| KeyFault { path: path.to_owned(), ..KeyFault::here(sentence) })
}

fn cannot_be_used(length: &Length) -> String {
    format!("\"{}\" cannot be used: ", excerpt(40, &length.to_string()))
}

/// Returns the unit of a document as its tables state it.
fn stated_unit(tables: &TextValue) -> Option<LengthUnit> {
    let value = |tables: &TextValue, key: &str| match tables {
        TextValue::Table(table) => {
            table.iter().find(|(found, _)| found == key).map(|(_, value)| value.clone())
        }
        _ => None,
    };
    match value(&value(tables, "domain")?, "unit")? {
        TextValue::Text(word) => LengthUnit::ALL.into_iter().find(|unit| unit.name() == word),
        _ => None,
    }
}

fn has_word(table: &[(String, TextValue)], key: &str, word: &str) -> bool {
    table.iter().any(|(found, value)| found == key && matches!(value, TextValue::Text(text) if text == word))
}

impl<L> SavedSettings<L> {
    /// Takes lengths with units: those in metres need a plane in metres.
    pub(in crate::io) fn with_lengths(mut self, lengths: WrittenLengths) -> Self {
        if lengths.are_metric() && self.domain.outline_file().is_some() {
            self.domain.projection.get_or_insert_with(|| METRES.to_owned());
        }
        Self { lengths, ..self }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::io::recipe::{Recipe, parse};

    fn parsed(text: &str) -> Result<Recipe, String> {
        let parsed = parse(Path::new("a.toml"), text.to_owned(), &|name| Ok(name.into()));
        parsed.map_err(|error| error.to_string())
    }

    /// A recipe whose lengths are made by `length` from metres.
    fn recipe(unit: &str, length: impl Fn(f64) -> String) -> String {
        let [a, b, c, d] = [300.0, 926.0, 2000.0, 40_000.0].map(length);
        format!(
            r#"
            [domain]
            region = "sea.geojson"
            unit = "{unit}"
            boundary_diameter = {a}
            [mesh]
            spacing = {d}
            [limits]
            h_min = {a}
            h_risk = {b}
            h_max = {c}
            [paths]
            clearance = {b}
            [[layer]]
            kind = "formula"
            quantity = "diameter"
            formula = {c}
            [[layer]]
            kind = "raster"
            file = "depth.asc"
            curve = [[0, {a}], [50, {c}]]
            [[layer]]
            kind = "threats"
            threats = [{{ x = 1, y = 2, range = {d} }}]
            [[layer]]
            kind = "corridor"
            shapes = [{{ line = [[0, 0], [1, 1]] }}]
            width = {b}
            at_zero = {a}
            slope = 0.2
            range = {d}
            [[layer]]
            kind = "band"
            file = "depth.asc"
            between = [1, 2]
            diameter = {c}
            [[layer]]
            kind = "depth"
            file = "depth.asc"
            size = "slope"
            triangles = 20
            smoothing = {b}
            [[layer]]
            kind = "straits"
            across = 3
            width_from = {a}
            width_to = {c}
            "#
        )
    }

    #[test]
    fn every_length_of_a_recipe_may_have_a_unit() {
        let written = recipe("m", |metres| match metres {
            926.0 => "\"0.5 nmi\"".into(),
            300.0 => "\"300 m\"".into(),
            _ => format!("\"{} km\"", metres / 1000.0),
        });
        let numbers =
            recipe("m", |metres| metres.to_string()).replace("formula = 2000", "formula = \"2000\"");
        let (settings, mut expected) =
            (parsed(&written).unwrap().settings, parsed(&numbers).unwrap().settings);
        assert!(settings.lengths.are_metric() && !expected.lengths.are_metric());
        assert_eq!(settings.lengths.0.len(), 17);
        // Metres need a plane in metres.
        assert_eq!(settings.domain.projection.as_deref(), Some("metres"));
        (expected.domain.projection, expected.lengths) =
            (Some("metres".to_owned()), settings.lengths.clone());
        assert_eq!(settings, expected);
        // In a document in kilometres they become kilometres.
        let of_kilometres = parsed(&written.replace("unit = \"m\"", "unit = \"km\"")).unwrap().settings;
        assert_eq!((of_kilometres.mesh.spacing, of_kilometres.limits.h_risk), (Some(40.0), Some(0.926)));
        assert_eq!(of_kilometres.lengths.check(LengthUnit::Kilometre), Ok(()));
    }

    #[test]
    fn widths_and_areas_on_the_ground_may_have_a_unit_and_need_no_plane() {
        let domain = |unit: &str, inlet: &str, island: &str| {
            parsed(&format!(
                "[domain]\nregion = \"depth.asc\"\n{unit}smallest_inlet = {inlet}\nsmallest_island = {island}"
            ))
        };
        let read = |unit: &str, inlet: &str, island: &str| {
            let settings = domain(unit, inlet, island).unwrap().settings;
            assert!(settings.domain.projection.is_none() && !settings.lengths.are_metric());
            [settings.domain.smallest_inlet, settings.domain.smallest_island].map(Option::unwrap)
        };
        assert_eq!(read("", "300", "5000"), [300.0, 5000.0]);
        assert_eq!(read("", "\"0.3 km\"", "\"2 km²\""), [300.0, 2e6]);
        assert_eq!(read("unit = \"km\"\n", "\"300 m\"", "\"5 ha\""), [0.3, 0.05]);
        for (inlet, island, sentence) in [
            ("\"0.1°\"", "1", "line 3, column 18: “0.1°” is an angle"),
            ("1", "\"2 km\"", "line 4, column 19: “2 km” is no area: write a number"),
            ("\"-1 m\"", "1", "smallest inlet"),
        ] {
            let message = domain("", inlet, island).expect_err(inlet);
            assert!(message.contains(sentence), "{message}");
        }
    }

    #[test]
    fn lengths_that_make_no_sense_are_named_with_their_key_and_text() {
        for (text, sentence) in [
            (
                "[mesh]\nspacing = \"\"",
                "line 2, column 11: this text is empty: write a length such as \"40 km\"",
            ),
            ("[mesh]\nspacing = \"2 apples\"", "line 2, column 11: “apples” cannot be converted to m."),
            (
                "[mesh]\nspacing = \"-2 km\"",
                "\"-2 km\" cannot be used: a length must be positive and finite.",
            ),
            ("[mesh]\nspacing = \"0 m\"", "\"0 m\" cannot be used: a length must be positive and finite."),
            (
                "[[layer]]\nkind = \"raster\"\nfile = \"a.asc\"\ncurve = [[0, \"1 km\"], [5, \"1 lb\"]]",
                "line 4, column 27: “lb” cannot be converted to m.",
            ),
            (
                "[[layer]]\nkind = \"threats\"\nthreats = [{ x = 1, y = 1, range = \"far\" }]",
                "line 3, column 36: “far” is not a number.",
            ),
            ("[limits]\ngradation = \"2 m\"", "this must be a number, not the text \"2 m\"."),
        ] {
            let message = parsed(text).expect_err(text);
            assert!(message.contains(sentence), "{text}: {message}");
        }
        let lengths = parsed("[limits]\nh_min = \"2 km\"").unwrap().settings.lengths;
        assert_eq!(lengths.check(LengthUnit::Metre), Ok(()));
        let fault = lengths.check(LengthUnit::Degree).unwrap_err().to_string();
        let sentence = "limits, h_min: \"2 km\" cannot be used: lengths of this domain are in degrees";
        assert!(fault.starts_with(sentence), "{fault}");
    }
}

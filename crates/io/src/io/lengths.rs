//! Lengths with units in a text: `"40 km"` in place of 40000. The type of a field says that it is a length.

use std::cell::RefCell;
use std::ops::Deref;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::layers::positive_length;
use super::{KeyFault, KeyStep};
use meshbrush_mesh::text::{Length, LengthUnit, area, excerpt};

/// The projection for lengths in metres: the plane of the region's own coordinates where they are in metres.
pub const METRES: &str = "metres";

/// A length in world units, which a text may give with a unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, Serialize, Deserialize)]
pub struct SavedLength(pub f64);

/// A length in metres, or in kilometres where lengths of the document are, also where coordinates are
/// degrees: it needs no plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroundLength(pub f64);

/// An area in square metres, or in square kilometres, as [`GroundLength`] is a length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroundArea(pub f64);

impl Deref for SavedLength {
    type Target = f64;

    fn deref(&self) -> &f64 {
        &self.0
    }
}

impl From<f64> for SavedLength {
    fn from(value: f64) -> Self {
        Self(value)
    }
}

impl From<SavedLength> for f64 {
    fn from(length: SavedLength) -> Self {
        length.0
    }
}

impl SavedLength {
    /// Returns the length, in world units.
    ///
    /// # Errors
    /// Fails when it is not positive or not finite, with its key.
    pub fn checked(self, key: &'static str) -> Result<f64, KeyFault> {
        positive_length(self.0).map_err(|fault| fault.within(key))
    }
}

/// What a number of a text measures.
#[derive(Clone, Copy)]
pub enum Measure {
    /// See [`SavedLength`].
    Length,
    /// See [`GroundLength`].
    GroundLength,
    /// See [`GroundArea`].
    GroundArea,
}

impl Measure {
    /// Returns what the type of a field measures, by the name that serde has for it.
    pub fn of_type(name: &str) -> Option<Self> {
        match name {
            "SavedLength" => Some(Self::Length),
            "GroundLength" => Some(Self::GroundLength),
            "GroundArea" => Some(Self::GroundArea),
            _ => None,
        }
    }
}

/// The unit of the lengths of a text, and those that have one of their own, as they are found.
#[derive(Debug, Default)]
pub struct TextContext {
    unit: LengthUnit,
    /// The keys and indices from the root of the text to the value that is read.
    path: RefCell<Vec<KeyStep>>,
    written: RefCell<Vec<WrittenLength>>,
}

impl TextContext {
    /// Returns the context of a text whose lengths are in `unit`.
    pub fn new(unit: LengthUnit) -> Self {
        Self { unit, ..Self::default() }
    }

    /// Reads a value of a list or a table.
    pub fn within<T>(&self, step: KeyStep, read: impl FnOnce() -> T) -> T {
        self.path.borrow_mut().push(step);
        let value = read();
        self.path.borrow_mut().pop();
        value
    }

    /// Returns the number of a text in the place of one.
    ///
    /// # Errors
    /// Fails when it is none, or has a unit of something else.
    pub fn number(&self, measure: Measure, text: &str) -> Result<f64, KeyFault> {
        match measure {
            Measure::Length => self.length(text),
            Measure::GroundLength => Length::on_ground(text, self.unit).map_err(KeyFault::here),
            Measure::GroundArea => area(text, self.unit).map_err(KeyFault::here),
        }
    }

    /// Returns the number of a length, and keeps its unit in mind.
    fn length(&self, text: &str) -> Result<f64, KeyFault> {
        if text.trim().is_empty() {
            let sentence = "this text is empty: write a length such as \"40 km\", or a number.";
            return Err(KeyFault::here(sentence));
        }
        let length = Length::from_str(text).map_err(KeyFault::here)?.in_document(self.unit);
        let value = length.value;
        if length.has_unit() {
            self.written.borrow_mut().push(WrittenLength { path: self.path.borrow().clone(), length });
        }
        Ok(value)
    }

    /// Returns the lengths that were written with a unit, in the order in which they were read.
    pub fn into_written(self) -> WrittenLengths {
        WrittenLengths(self.written.into_inner())
    }
}

/// The lengths with a unit in a text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WrittenLengths(Vec<WrittenLength>);

#[derive(Clone, Debug, PartialEq)]
struct WrittenLength {
    path: Vec<KeyStep>,
    length: Length,
}

impl WrittenLengths {
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
    pub fn as_written(&self, fault: KeyFault) -> KeyFault {
        let written = self.0.iter().find(|written| written.path == fault.path && fault.given.is_some());
        match written {
            Some(written) => KeyFault { given: Some(cannot_be_used(&written.length)), ..fault },
            None => fault,
        }
    }
}

fn cannot_be_used(length: &Length) -> String {
    format!("\"{}\" cannot be used: ", excerpt(40, &length.to_string()))
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
        assert_eq!(
            (of_kilometres.mesh.spacing, of_kilometres.limits.h_risk),
            (Some(SavedLength(40.0)), Some(SavedLength(0.926)))
        );
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
            [settings.domain.smallest_inlet.unwrap().0, settings.domain.smallest_island.unwrap().0]
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

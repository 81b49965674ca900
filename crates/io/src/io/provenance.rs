//! The origin of a file, as text for the formats that have a place for it.

use meshbrush_core::earth::{Coordinates, Projection};
use meshbrush_mesh::mesh::Fingerprint;
use meshbrush_mesh::text::LengthUnit;

/// The origin of a file. It contains no time and only paths that a person typed, so the same input gives the
/// same file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    lines: Vec<(&'static str, String)>,
    unit: LengthUnit,
}

/// The source that a mesh was made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshSource<'a> {
    /// A command, as it was typed.
    Command(&'a str),
    /// A document in the window, by its name.
    Document(&'a str),
}

impl Provenance {
    /// Describes a mesh: the program with its version, the source, the fingerprint, and the meaning of the
    /// coordinates, such as `x, y`.
    pub fn new(source: MeshSource, fingerprint: Fingerprint, coordinates: &str) -> Self {
        let (key, source) = match source {
            MeshSource::Command(command) => ("command", command),
            MeshSource::Document(name) => ("document", name),
        };
        let program = concat!("Meshbrush ", env!("CARGO_PKG_VERSION")).to_owned();
        let lines = [
            ("program", program),
            (key, one_line(source)),
            ("fingerprint", fingerprint.to_string()),
            ("coordinates", one_line(coordinates)),
        ];
        Self { lines: lines.into(), unit: LengthUnit::None }
    }

    /// Adds the unit of coordinates and lengths, if there is one.
    #[must_use]
    pub fn with_unit(mut self, unit: LengthUnit) -> Self {
        if unit != LengthUnit::None {
            self.lines.push(("unit", unit.name().to_owned()));
        }
        self.unit = unit;
        self
    }

    /// Adds a line about the values in the file.
    #[must_use]
    pub fn with_line(mut self, key: &'static str, text: &str) -> Self {
        self.lines.push((key, one_line(text)));
        self
    }

    /// Says what coordinates are, other than those of the plane that the mesh is in, if it is in one. Lengths
    /// stay in metres.
    #[must_use]
    pub fn in_coordinates(mut self, coordinates: &Coordinates, meshed_in: Option<Projection>) -> Self {
        let Some(meshed_in) = meshed_in else { return self };
        self.lines.retain(|(key, _)| !matches!(*key, "coordinates" | "unit"));
        let (meaning, unit) = match coordinates {
            Coordinates::Geographic => ("longitude, latitude in degrees".to_owned(), LengthUnit::Degree),
            Coordinates::OnDatum(system) => {
                (format!("longitude, latitude in {system}"), system.length_unit())
            }
            plane => (format!("x, y in {plane}"), LengthUnit::Metre),
        };
        self.lines.push(("coordinates", format!("{meaning}; meshed in {meshed_in}, with lengths in m")));
        self.unit = unit;
        self
    }

    /// Says that coordinates are those of the plane of a projection, in metres.
    #[must_use]
    pub fn in_plane(mut self, plane: &Projection) -> Self {
        self.lines.retain(|(key, _)| !matches!(*key, "coordinates" | "unit"));
        self.lines.push(("coordinates", format!("x, y in {plane}")));
        self.with_unit(LengthUnit::Metre)
    }

    /// Returns the unit of coordinates.
    pub fn unit(&self) -> LengthUnit {
        self.unit
    }

    /// Returns the entries, as pairs of a key and one line of text.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.lines.iter().map(|(key, text)| (*key, text.as_str()))
    }

    /// Returns the entries as lines, `word: text`.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        self.entries().map(|(key, text)| format!("{key}: {text}"))
    }

    /// Returns all entries in one line, for formats that have a line for a title.
    pub fn line(&self) -> String {
        self.lines().collect::<Vec<_>>().join("; ")
    }

    /// Returns the program and the fingerprint as `N` bytes, padded with blanks, for formats that have room
    /// for no more.
    pub fn title<const N: usize>(&self) -> [u8; N] {
        let kept = self.entries().filter(|(key, _)| matches!(*key, "program" | "fingerprint"));
        let text = kept.map(|(_, text)| text).collect::<Vec<_>>().join(", fingerprint ");
        let mut title = [b' '; N];
        title.iter_mut().zip(text.bytes()).for_each(|(place, byte)| *place = byte);
        title
    }
}

fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

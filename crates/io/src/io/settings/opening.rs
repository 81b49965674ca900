//! `open` in the table `[domain]`: where the boundary is open, in one step.

use std::fmt;
use std::path::PathBuf;

use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use meshbrush_mesh::geometry::Rect;

/// What an entry can be, for sentences.
const RULE: &str =
    "“frame”, “depth>50”, a box “west, south, east, north”, or the name of a file with polygons";

/// Where the boundary is open.
#[derive(Clone, Debug, PartialEq)]
pub enum SavedOpen {
    /// Along the rectangle around the polygons, in the coordinates of their file.
    Frame,
    /// Where the water is deeper than this, in metres.
    Deeper(f64),
    /// In a box, in the coordinates of the region's file.
    Box(Rect),
    /// In the polygons of a file.
    Polygons(PathBuf),
}

impl SavedOpen {
    /// Returns the meaning of a text.
    ///
    /// # Errors
    /// Fails with a sentence for a depth or a box that is none.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if text.eq_ignore_ascii_case("frame") {
            return Ok(Self::Frame);
        }
        let depth = text.get(..5).filter(|word| word.eq_ignore_ascii_case("depth"));
        if let Some(rest) = depth.and_then(|_| text[5..].trim_start().strip_prefix('>')) {
            let number = rest.trim_start_matches('=').trim().trim_end_matches('m').trim();
            let level = number.parse().ok().filter(|level: &f64| level.is_finite());
            let problem = || format!("“{text}”: after depth> comes a number of metres, as in depth>50.");
            return level.map(Self::Deeper).ok_or_else(problem);
        }
        let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
        if numbers.len() == text.split(',').count() {
            return Self::of_box(&numbers);
        }
        if text.is_empty() {
            return Err(format!("an empty text says nothing; write {RULE}."));
        }
        Ok(Self::Polygons(text.into()))
    }

    fn of_box(numbers: &[f64]) -> Result<Self, String> {
        let rect = match *numbers {
            [west, south, east, north] => Some(Rect::new([west, south].into(), [east, north].into())),
            _ => None,
        };
        let proper = rect.filter(|rect| rect.is_proper() && rect.size().is_finite());
        proper.map(Self::Box).ok_or_else(|| {
            let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
            format!("“{}” is no box: write west, south, east and north, in that order.", numbers.join(", "))
        })
    }

    /// Returns the text of it, as in a recipe.
    pub fn text(&self) -> String {
        match self {
            Self::Frame => "frame".to_owned(),
            Self::Deeper(level) => format!("depth>{level}"),
            Self::Box(Rect { min, max }) => format!("{}, {}, {}, {}", min.x, min.y, max.x, max.y),
            Self::Polygons(file) => file.display().to_string(),
        }
    }
}

/// The entries of `open`: one, or a list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedOpenings(pub Vec<SavedOpen>);

impl SavedOpenings {
    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Serialize for SavedOpenings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0[..] {
            [one] => serializer.serialize_str(&one.text()),
            several => serializer.collect_seq(several.iter().map(SavedOpen::text)),
        }
    }
}

impl<'de> Deserialize<'de> for SavedOpenings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OpenVisitor)
    }
}

struct OpenVisitor;

impl<'de> Visitor<'de> for OpenVisitor {
    type Value = SavedOpenings;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{RULE}, or a list of these")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<SavedOpenings, E> {
        Ok(SavedOpenings(vec![SavedOpen::parse(text).map_err(E::custom)?]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<SavedOpenings, A::Error> {
        let (mut openings, mut numbers) = (Vec::new(), Vec::new());
        while let Some(entry) = list.next_element::<OpeningEntry>()? {
            match entry {
                OpeningEntry::Number(number) => numbers.push(number),
                OpeningEntry::Openings(SavedOpenings(more)) => openings.extend(more),
            }
        }
        match (numbers.is_empty(), openings.is_empty()) {
            (true, _) => Ok(SavedOpenings(openings)),
            (false, true) => {
                let of_box = SavedOpen::of_box(&numbers).map_err(A::Error::custom)?;
                Ok(SavedOpenings(vec![of_box]))
            }
            (false, false) => {
                let problem =
                    "a list has numbers beside texts; write a box as a list of its own, or as a text";
                Err(A::Error::custom(problem))
            }
        }
    }
}

/// An entry of a list: a side of a box, or an opening.
enum OpeningEntry {
    Number(f64),
    Openings(SavedOpenings),
}

impl<'de> Deserialize<'de> for OpeningEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EntryVisitor)
    }
}

struct EntryVisitor;

impl<'de> Visitor<'de> for EntryVisitor {
    type Value = OpeningEntry;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        OpenVisitor.expecting(f)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<OpeningEntry, E> {
        Ok(OpeningEntry::Number(number))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<OpeningEntry, E> {
        Ok(OpeningEntry::Number(number as f64))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<OpeningEntry, E> {
        Ok(OpeningEntry::Number(number as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<OpeningEntry, E> {
        OpenVisitor.visit_str(text).map(OpeningEntry::Openings)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<OpeningEntry, A::Error> {
        OpenVisitor.visit_seq(list).map(OpeningEntry::Openings)
    }
}

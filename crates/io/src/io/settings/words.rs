//! Words of several tables: units, refinement rules, names and types of the boundary.

use glam::DVec2;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use meshbrush_core::domain::{BoundaryMarks, BoundaryType};
use meshbrush_core::field::RefinementRule;
use meshbrush_mesh::text::LengthUnit;

/// Returns the word that a text has for one of several choices, such as `"vertex"` for a rule; empty for a
/// value that is no word.
pub fn word_of(choice: &impl Serialize) -> String {
    let word = serde_json::to_value(choice).ok();
    word.as_ref().and_then(|word| word.as_str()).unwrap_or_default().to_owned()
}

/// The units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SavedUnit {
    /// Plain numbers.
    #[default]
    #[serde(rename = "none")]
    None,
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Kilometres.
    #[serde(rename = "km")]
    Kilometre,
    /// Degrees of longitude and latitude.
    #[serde(rename = "degrees")]
    Degree,
}

impl SavedUnit {
    /// Returns whether numbers have no unit.
    pub fn is_none(&self) -> bool {
        *self == Self::None
    }
}

impl From<LengthUnit> for SavedUnit {
    fn from(unit: LengthUnit) -> Self {
        match unit {
            LengthUnit::None => Self::None,
            LengthUnit::Metre => Self::Metre,
            LengthUnit::Kilometre => Self::Kilometre,
            LengthUnit::Degree => Self::Degree,
        }
    }
}

impl From<SavedUnit> for LengthUnit {
    fn from(saved: SavedUnit) -> Self {
        match saved {
            SavedUnit::None => Self::None,
            SavedUnit::Metre => Self::Metre,
            SavedUnit::Kilometre => Self::Kilometre,
            SavedUnit::Degree => Self::Degree,
        }
    }
}

/// The refinement rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedRule {
    /// The three vertices.
    Vertex,
    /// The whole triangle.
    Area,
}

impl From<RefinementRule> for SavedRule {
    fn from(rule: RefinementRule) -> Self {
        match rule {
            RefinementRule::Vertex => Self::Vertex,
            RefinementRule::Area => Self::Area,
        }
    }
}

impl From<SavedRule> for RefinementRule {
    fn from(saved: SavedRule) -> Self {
        match saved {
            SavedRule::Vertex => Self::Vertex,
            SavedRule::Area => Self::Area,
        }
    }
}

/// A name of a piece of the boundary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { at = [1, 2], name = \"harbour\" }")]
pub struct SavedName {
    /// A point of the piece, in world units.
    pub at: [f64; 2],
    /// The name.
    pub name: String,
}

/// A type of a piece of the boundary.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { at = [1, 2], type = \"open\" }")]
pub struct SavedPieceType {
    /// A point of the piece, in world units.
    pub at: [f64; 2],
    /// The type.
    #[serde(rename = "type")]
    pub boundary_type: SavedBoundaryType,
}

/// The types by their words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SavedBoundaryType(BoundaryType);

impl From<BoundaryType> for SavedBoundaryType {
    fn from(boundary_type: BoundaryType) -> Self {
        Self(boundary_type)
    }
}

impl From<SavedBoundaryType> for BoundaryType {
    fn from(saved: SavedBoundaryType) -> Self {
        saved.0
    }
}

impl Serialize for SavedBoundaryType {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.word())
    }
}

impl<'de> Deserialize<'de> for SavedBoundaryType {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let word = String::deserialize(deserializer)?;
        let found = BoundaryType::from_word(&word).map(Self);
        found.ok_or_else(|| D::Error::unknown_variant(&word, &BoundaryType::WORDS))
    }
}

/// Returns the splits, the names and the types of boundary marks as files have them.
pub fn saved_marks(marks: &BoundaryMarks) -> (Vec<[f64; 2]>, Vec<SavedName>, Vec<SavedPieceType>) {
    let name = |(at, name): &(DVec2, String)| SavedName { at: at.to_array(), name: name.clone() };
    let of_piece = |&(at, boundary_type): &(DVec2, BoundaryType)| SavedPieceType {
        at: at.to_array(),
        boundary_type: SavedBoundaryType(boundary_type),
    };
    (
        marks.splits.iter().map(DVec2::to_array).collect(),
        marks.names.iter().map(name).collect(),
        marks.types.iter().map(of_piece).collect(),
    )
}

/// Boundary marks from a file. Names that are not valid are made so, and empty ones are left out.
pub fn marks_of(splits: &[[f64; 2]], names: &[SavedName], types: &[SavedPieceType]) -> BoundaryMarks {
    let name = |saved: &SavedName| {
        let name = BoundaryMarks::valid_name(&saved.name);
        (!name.is_empty()).then(|| (saved.at.into(), name))
    };
    BoundaryMarks {
        splits: splits.iter().copied().map(DVec2::from).collect(),
        names: names.iter().filter_map(name).collect(),
        types: types.iter().map(|saved| (saved.at.into(), saved.boundary_type.0)).collect(),
    }
}

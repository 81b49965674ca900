//! Which parts of a mesh stay, as texts have it.

use serde::de::{Deserializer, Error, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use meshbrush_mesh::mesh::KeptParts;

/// The parts of the mesh that stay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SavedParts {
    /// `"all"`
    All,
    /// `"largest"`
    Largest,
    /// A share of the area.
    Share(f64),
}

impl From<KeptParts> for SavedParts {
    fn from(parts: KeptParts) -> Self {
        match parts {
            KeptParts::All => Self::All,
            KeptParts::Largest => Self::Largest,
            KeptParts::Share(share) => Self::Share(share),
        }
    }
}

impl From<SavedParts> for KeptParts {
    fn from(saved: SavedParts) -> Self {
        match saved {
            SavedParts::All => Self::All,
            SavedParts::Largest => Self::Largest,
            SavedParts::Share(share) => Self::Share(share),
        }
    }
}

impl<'de> Deserialize<'de> for SavedParts {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(PartsVisitor)
    }
}

impl Serialize for SavedParts {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::All => to.serialize_str("all"),
            Self::Largest => to.serialize_str("largest"),
            Self::Share(share) => to.serialize_f64(share),
        }
    }
}

struct PartsVisitor;

impl Visitor<'_> for PartsVisitor {
    type Value = SavedParts;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("\"largest\", \"all\" or a share of the area such as 0.01")
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<SavedParts, E> {
        match word {
            "all" => Ok(SavedParts::All),
            "largest" => Ok(SavedParts::Largest),
            _ => Err(E::unknown_variant(word, &["largest", "all"])),
        }
    }

    fn visit_f64<E: Error>(self, share: f64) -> Result<SavedParts, E> {
        Ok(SavedParts::Share(share))
    }

    fn visit_i64<E: Error>(self, share: i64) -> Result<SavedParts, E> {
        Ok(SavedParts::Share(share as f64))
    }
}

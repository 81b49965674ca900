//! The tables of a recipe as the text has them.

use serde::de::{Deserializer, Error, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::super::layers::{SavedLayer, SavedPolygon};
use super::super::words::{SavedName, SavedRule, SavedUnit};
use meshbrush_mesh::mesh::KeptParts;

/// A whole recipe.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedRecipe {
    /// Ω and how the mesh meets its boundary.
    pub domain: SavedDomain,
    /// The coarse grid, the rule and what the mesh may cost.
    pub mesh: SavedMesh,
    /// Bounds of h̄.
    pub limits: SavedLimits,
    /// The size field, from the bottom layer to the top one.
    pub layer: Vec<SavedLayer>,
    /// Between which places paths are sought, and what they cost.
    pub paths: SavedPaths,
    /// Regions that paths stay out of.
    pub keep_out: Vec<SavedKeepOut>,
    /// Points whose triangles and values the window follows.
    pub pins: SavedPins,
    /// Files to write.
    pub output: Vec<SavedOutput>,
}

/// `[domain]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedDomain {
    /// What the coarse grid covers: x₀, y₀, x₁, y₁.
    pub bounds: Option<[f64; 4]>,
    /// The domain is where this formula is not 0.
    pub inside: Option<String>,
    /// The domain is what the polygons of this file cover.
    pub region: Option<String>,
    /// The unit of coordinates and lengths.
    pub unit: Option<SavedUnit>,
    /// How the mesh meets the outline of a region.
    pub boundary: Option<SavedTreatment>,
    /// Largest diameter of a triangle on the outline.
    pub boundary_diameter: Option<f64>,
    /// The parts of the mesh that stay.
    pub parts: Option<SavedParts>,
    /// Whether pinches stay.
    #[serde(skip_serializing_if = "is_no")]
    pub keep_pinches: bool,
    /// Where the boundary is split.
    pub splits: Vec<[f64; 2]>,
    /// Names of pieces of the boundary.
    pub names: Vec<SavedName>,
}

/// `[mesh]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedMesh {
    /// Longest side of a coarse cell.
    pub spacing: Option<f64>,
    /// Which points of a triangle count.
    pub rule: Option<SavedRule>,
    /// Most triangles.
    pub max_triangles: Option<usize>,
    /// Deepest level.
    pub max_level: Option<u32>,
    /// Most memory, as in `"2GB"`.
    pub max_memory: Option<String>,
}

/// `[limits]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedLimits {
    /// Smallest target diameter.
    pub h_min: Option<f64>,
    /// Largest target diameter.
    pub h_max: Option<f64>,
    /// Exponent of the curve from risk to diameter.
    pub shape: Option<f64>,
    /// How fast h̄ may change with the distance.
    pub gradation: Option<f64>,
}

/// `[paths]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedPaths {
    /// x and y of each place of each path, in world units, from the start to the goal.
    pub routes: Vec<Vec<[f64; 2]>>,
    /// Cost per unit of length, without risk.
    pub length_weight: Option<f64>,
    /// Cost per unit of length where the risk is 1.
    pub risk_weight: Option<f64>,
    /// A formula of x, y and the risk in place of the weights.
    pub cost: Option<String>,
}

/// `[[keep_out]]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedKeepOut {
    /// What a person calls it.
    pub name: Option<String>,
    /// What it covers, in world units.
    pub polygons: Option<Vec<SavedPolygon>>,
    /// A file with the polygons, in their place.
    pub file: Option<String>,
}

/// `[pins]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a table")]
pub struct SavedPins {
    /// x and y of each, in world units.
    pub at: Vec<[f64; 2]>,
}

/// `[[output]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SavedOutput {
    /// The file, whose ending decides the format.
    pub file: String,
    /// Whether a format that is text otherwise is written in its binary form.
    #[serde(default, skip_serializing_if = "is_no")]
    pub binary: bool,
    /// Further values at the nodes, as in `"depth = 20 - x"`.
    #[serde(default)]
    pub quantities: Vec<String>,
    /// Width, or width and height, of a picture in pixels, as in `"1600x900"`.
    #[serde(default)]
    pub size: Option<String>,
    /// Whether a picture shows the edges.
    #[serde(default)]
    pub edges: Option<bool>,
    /// Colours of the levels in a picture.
    #[serde(default)]
    pub colormap: Option<String>,
    /// Whether the background of a picture is light.
    #[serde(default)]
    pub light: Option<bool>,
}

/// The boundary treatments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedTreatment {
    /// As in the report.
    Report,
    /// Refined along the outline.
    Fitted,
    /// With nodes on the outline.
    Outline,
}

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

fn is_no(value: &bool) -> bool {
    !value
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

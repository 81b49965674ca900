//! The words of layers.

use serde::{Deserialize, Serialize};

use meshbrush_core::layers::{Combine, DistanceTo, PositiveDepth, Quantity, SurfaceNorm};

/// See [`Combine`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedCombine {
    /// The smaller target diameter counts.
    #[default]
    Finest,
    /// Nothing below gets finer.
    Floor,
    /// The layer alone counts.
    Replace,
}

/// See [`Quantity`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedQuantity {
    /// Risk, 0 to 1.
    Risk,
    /// Target diameter in world units.
    Diameter,
    /// The largest error from surfaces, in their unit.
    Error,
}

/// The target of a distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedDistanceTo {
    /// The boundary of the domain.
    Outline,
    /// The boundary of the domain without its open parts.
    Coasts,
}

/// See [`SurfaceNorm`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedNorm {
    /// The largest difference.
    Max,
    /// The root mean square of the differences.
    L2,
    /// The root mean square of the differences of the gradient.
    H1,
}

impl From<SavedNorm> for SurfaceNorm {
    fn from(saved: SavedNorm) -> Self {
        match saved {
            SavedNorm::Max => Self::Largest,
            SavedNorm::L2 => Self::RootMeanSquare,
            SavedNorm::H1 => Self::Gradient,
        }
    }
}

impl From<SurfaceNorm> for SavedNorm {
    fn from(norm: SurfaceNorm) -> Self {
        match norm {
            SurfaceNorm::Largest => Self::Max,
            SurfaceNorm::RootMeanSquare => Self::L2,
            SurfaceNorm::Gradient => Self::H1,
        }
    }
}

/// See [`PositiveDepth`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedPositive {
    /// Values are heights.
    Up,
    /// Values are depths.
    Down,
}

/// How the depth decides the target diameter. See [`DepthRule`](meshbrush_core::layers::DepthRule).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedDepthSize {
    /// It does not.
    #[default]
    Nothing,
    /// Triangles in the length of a wave.
    Wavelength,
    /// Triangles in the topographic length.
    Slope,
    /// The distance that a wave travels in a time step.
    Courant,
}

impl SavedDepthSize {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Nothing, Self::Wavelength, Self::Slope, Self::Courant];

    /// Returns the word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Wavelength => "wavelength",
            Self::Slope => "slope",
            Self::Courant => "courant",
        }
    }
}

impl From<SavedPositive> for PositiveDepth {
    fn from(saved: SavedPositive) -> Self {
        match saved {
            SavedPositive::Up => Self::Up,
            SavedPositive::Down => Self::Down,
        }
    }
}

impl From<PositiveDepth> for SavedPositive {
    fn from(positive: PositiveDepth) -> Self {
        match positive {
            PositiveDepth::Up => Self::Up,
            PositiveDepth::Down => Self::Down,
        }
    }
}

/// How the risk of a threat falls with the distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedLaw {
    /// See `ThreatLaw::Radar`.
    #[default]
    Radar,
    /// See `ThreatLaw::Gaussian`.
    Gaussian,
    /// See `ThreatLaw::Disc`.
    Disc,
}

impl SavedDistanceTo {
    /// Returns the word for a target; `None` for one that has shapes, or is some pieces of the boundary.
    pub(super) fn of(to: &DistanceTo) -> Option<Self> {
        match to {
            DistanceTo::Outline => Some(Self::Outline),
            DistanceTo::Coasts => Some(Self::Coasts),
            DistanceTo::Pieces(_) | DistanceTo::Shapes { .. } | DistanceTo::Corridor { .. } => None,
        }
    }
}

impl From<SavedDistanceTo> for DistanceTo {
    fn from(to: SavedDistanceTo) -> Self {
        match to {
            SavedDistanceTo::Outline => Self::Outline,
            SavedDistanceTo::Coasts => Self::Coasts,
        }
    }
}

impl SavedCombine {
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl From<SavedCombine> for Combine {
    fn from(saved: SavedCombine) -> Self {
        match saved {
            SavedCombine::Finest => Self::Finest,
            SavedCombine::Floor => Self::Floor,
            SavedCombine::Replace => Self::Replace,
        }
    }
}

impl From<Combine> for SavedCombine {
    fn from(combine: Combine) -> Self {
        match combine {
            Combine::Finest => Self::Finest,
            Combine::Floor => Self::Floor,
            Combine::Replace => Self::Replace,
        }
    }
}

impl From<SavedQuantity> for Quantity {
    fn from(saved: SavedQuantity) -> Self {
        match saved {
            SavedQuantity::Risk => Self::Risk,
            SavedQuantity::Diameter => Self::Diameter,
            SavedQuantity::Error => Self::Error,
        }
    }
}

impl From<Quantity> for SavedQuantity {
    fn from(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Risk => Self::Risk,
            Quantity::Diameter => Self::Diameter,
            Quantity::Error => Self::Error,
        }
    }
}

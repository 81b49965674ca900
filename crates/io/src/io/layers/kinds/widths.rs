//! The keys of straits and of feature sizes, which ask for triangles across the water.

use serde::{Deserialize, Serialize};

use super::super::checks::number_where;
use super::super::{LayerData, LayerOrigin, Stored};
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use crate::io::lengths::SavedLength;
use meshbrush_core::layers::{FeatureSize, LayerKind, MedialAxis, MedialBalls, Straits};

/// Triangles across the water between two widths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WidthKeys {
    /// Triangles across.
    pub across: f64,
    /// The least width that counts, in world units.
    pub width_from: SavedLength,
    /// The greatest width, in world units.
    pub width_to: SavedLength,
}

/// The keys of straits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StraitKeys(pub WidthKeys);

/// The keys of a feature size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FeatureSizeKeys(pub WidthKeys);

impl WidthKeys {
    fn between(&self) -> [f64; 2] {
        [*self.width_from, *self.width_to]
    }

    fn check(&self) -> Result<(), KeyFault> {
        let Self { across, width_from, width_to } = *self;
        number_where(across, across >= 1.0, "a number of triangles must be 1 or more, and finite")
            .map_err(|fault| fault.within("across"))?;
        width_from.checked("width_from")?;
        let to = width_to.checked("width_to")?;
        let to = number_where(to, width_to > width_from, "it must be above width_from");
        to.map(|_| ()).map_err(|fault| fault.within("width_to"))
    }
}

impl StraitKeys {
    pub(super) fn of(Straits { across, found }: &Straits) -> Self {
        let [width_from, width_to] = found.between().map(SavedLength);
        Self(WidthKeys { across: *across, width_from, width_to })
    }
}

impl FeatureSizeKeys {
    pub(super) fn of(FeatureSize { across, found }: &FeatureSize) -> Self {
        let [width_from, width_to] = found.between().map(SavedLength);
        Self(WidthKeys { across: *across, width_from, width_to })
    }
}

impl KindKeys for StraitKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        self.0.check()
    }
}

impl LoadKind for StraitKeys {
    const WORD: &str = "straits";
    const NAME: &str = "Straits";

    fn load<D: LayerData>(&self, _: &LayerOrigin, _: &mut D) -> Result<LayerKind, D::Error> {
        let found = MedialBalls::unknown(self.0.between());
        Ok(LayerKind::Straits(Straits { across: self.0.across, found }))
    }
}

impl KindKeys for FeatureSizeKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        self.0.check()
    }
}

impl LoadKind for FeatureSizeKeys {
    const WORD: &str = "feature-size";
    const NAME: &str = "Feature size";

    fn load<D: LayerData>(&self, _: &LayerOrigin, _: &mut D) -> Result<LayerKind, D::Error> {
        let found = MedialAxis::unknown(self.0.between());
        Ok(LayerKind::FeatureSize(FeatureSize { across: self.0.across, found }))
    }
}

use serde::{Deserialize, Serialize};

use super::super::{LayerData, LayerOrigin, Stored};
use super::GridKeys;
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use crate::io::layers::key_group::group_of_groups;
use crate::io::lengths::SavedLength;
use meshbrush_core::layers::{BandLayer, LayerKind};
use meshbrush_core::raster::RasterValues;

/// The keys of a band.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BandKeys {
    /// Which raster it is.
    #[serde(flatten)]
    pub grid: GridKeys,
    /// Which of its values count.
    #[serde(flatten)]
    pub step: StepKeys,
}

/// One diameter between two values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepKeys {
    /// The least and the greatest value.
    pub between: [f64; 2],
    /// The target diameter there, in world units.
    pub diameter: SavedLength,
}

group_of_groups!(BandKeys { grid: GridKeys, step: StepKeys });

impl BandKeys {
    pub(super) fn of(BandLayer { between, diameter, .. }: &BandLayer) -> Self {
        let step = StepKeys { between: *between, diameter: SavedLength(*diameter) };
        Self { grid: GridKeys::default(), step }
    }
}

impl KindKeys for BandKeys {
    fn check(&self, stored: Stored) -> Result<(), KeyFault> {
        self.grid.check(Self::missing, stored)?;
        let [least, greatest] = self.step.between;
        if !(least.is_finite() && greatest.is_finite()) || least > greatest {
            let sentence = "write two finite numbers, the least value first.";
            return Err(KeyFault::value("between", sentence));
        }
        self.step.diameter.checked("diameter").map(|_| ())
    }

    fn grid(&self) -> Option<&GridKeys> {
        Some(&self.grid)
    }

    fn grid_mut(&mut self) -> Option<&mut GridKeys> {
        Some(&mut self.grid)
    }
}

impl LoadKind for BandKeys {
    const WORD: &str = "band";
    const NAME: &str = "Band";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        let StepKeys { between, diameter } = self.step;
        let (source, _) = origin.raster(&self.grid, RasterValues::Any, data)?;
        Ok(LayerKind::Band(BandLayer { source, between, diameter: *diameter }))
    }
}

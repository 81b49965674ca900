use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::super::checks::{number_where, positive_length};
use super::super::{LayerData, LayerOrigin, SavedQuantity, Stored, each};
use super::GridKeys;
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::layers::key_group::group_of_groups;
use crate::io::lengths::SavedLength;
use crate::io::{KeyFault, RasterFormat};
use meshbrush_core::layers::{LayerKind, RasterLayer, RasterReading, ValueCurve};
use meshbrush_core::raster::RasterValues;

/// The keys of a raster.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RasterKeys {
    /// Which raster it is.
    #[serde(flatten)]
    pub grid: GridKeys,
    /// What its values mean.
    #[serde(flatten)]
    pub reading: ReadingKeys,
}

group_of_groups!(RasterKeys { grid: GridKeys, reading: ReadingKeys });

/// A value of a raster, and the target diameter there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedKnot(pub f64, pub SavedLength);

/// What the values of a raster mean: one of the keys says it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReadingKeys {
    /// The quantity that the pixels state.
    #[serde(default, rename = "as", skip_serializing_if = "Option::is_none")]
    pub read_as: Option<SavedQuantity>,
    /// Pairs of a value and the target diameter there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<SavedKnot>>,
}

impl SavedKnot {
    fn of([value, diameter]: &[f64; 2]) -> Self {
        Self(*value, SavedLength(*diameter))
    }
}

impl ReadingKeys {
    fn of(reading: &RasterReading) -> Self {
        let read_as = match reading {
            RasterReading::Risk => Some(SavedQuantity::Risk),
            RasterReading::Diameter => Some(SavedQuantity::Diameter),
            RasterReading::Error => Some(SavedQuantity::Error),
            RasterReading::Curve(_) => None,
        };
        let curve = if let RasterReading::Curve(curve) = reading {
            Some(curve.knots().iter().map(SavedKnot::of).collect())
        } else {
            None
        };
        Self { read_as, curve }
    }

    fn checked(&self) -> Result<RasterReading, KeyFault> {
        match (self.read_as, &self.curve) {
            (Some(SavedQuantity::Risk), None) => Ok(RasterReading::Risk),
            (Some(SavedQuantity::Diameter), None) => Ok(RasterReading::Diameter),
            (Some(SavedQuantity::Error), None) => Ok(RasterReading::Error),
            (None, Some(knots)) => Ok(RasterReading::Curve(Arc::new(curve(knots)?))),
            (Some(_), Some(_)) => Err(KeyFault::key("curve", "a raster has `as` or `curve`, not both.")),
            (None, None) => Err(RasterKeys::missing(
                "says what its values mean: as = \"risk\", as = \"diameter\", as = \"error\", or a curve, as in \
                 curve = [[0, 0.1], [50, 2]]",
            )),
        }
    }
}

impl RasterKeys {
    pub(super) fn of(RasterLayer { reading, .. }: &RasterLayer) -> Self {
        Self { grid: GridKeys::default(), reading: ReadingKeys::of(reading) }
    }

    fn values(&self) -> RasterValues {
        match self.reading.read_as {
            Some(SavedQuantity::Risk) => RasterValues::Risk,
            Some(SavedQuantity::Diameter) => RasterValues::Diameter,
            Some(SavedQuantity::Error) => RasterValues::Error,
            None => RasterValues::Any,
        }
    }
}

impl KindKeys for RasterKeys {
    fn check(&self, stored: Stored) -> Result<(), KeyFault> {
        self.grid.check(Self::missing, stored)?;
        self.reading.checked().map(|_| ())
    }

    fn grid(&self) -> Option<&GridKeys> {
        Some(&self.grid)
    }

    fn grid_mut(&mut self) -> Option<&mut GridKeys> {
        Some(&mut self.grid)
    }

    fn is_risk(&self) -> bool {
        self.reading.read_as == Some(SavedQuantity::Risk)
    }

    /// An image has no diameters of its own: black is the smallest, white the largest.
    fn uses_scale(&self) -> bool {
        let format = || RasterFormat::from_path(self.grid.file.as_deref()?).ok();
        let is_image = || format().is_some_and(|format| !format.is_grid());
        self.is_risk() || (self.reading.read_as == Some(SavedQuantity::Diameter) && is_image())
    }
}

impl LoadKind for RasterKeys {
    const WORD: &str = "raster";
    const NAME: &str = "Raster";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        let (source, _) = origin.raster(&self.grid, self.values(), data)?;
        Ok(LayerKind::Raster(RasterLayer { source, reading: self.reading.checked()? }))
    }
}

fn curve(knots: &[SavedKnot]) -> Result<ValueCurve, KeyFault> {
    if knots.is_empty() {
        return Err(KeyFault::value("curve", "a curve needs one pair [value, diameter] at least."));
    }
    let knots = each("curve", knots, |&SavedKnot(value, diameter)| {
        number_where(value, true, "a value of the raster must be finite")?;
        positive_length(*diameter).map(|diameter| [value, diameter])
    })?;
    let unordered = knots.windows(2).position(|pair| pair[0][0] >= pair[1][0]);
    if let Some(first) = unordered {
        let sentence = "the values of a curve must ascend, and none may come twice.";
        return Err(KeyFault::value("curve", sentence).at(first + 1));
    }
    ValueCurve::new(knots).map_err(|error| KeyFault::value("curve", error.to_string()))
}

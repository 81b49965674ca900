//! Layers by the pixels of a raster.

use std::sync::Arc;

use glam::DVec2;

use crate::layers::RasterSource;
use crate::layers::engine::{CompiledPlane, NO_RISK, Reading, Values};
use crate::layers::extent::{Extent, ExtentContext};
use crate::layers::risk_source::RiskSource;
use crate::layers::{LayerSlot, LayerSource, Quantity, ValueCurve};
use crate::raster::{RasterValues, TiledRaster};

/// A raster.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterLayer {
    /// The raster.
    pub source: RasterSource,
    /// The meaning of the raster's values.
    pub reading: RasterReading,
}

/// The meaning of the values of a raster.
#[derive(Clone, Debug, PartialEq)]
pub enum RasterReading {
    /// Risk, 0 to 1.
    Risk,
    /// Target diameter in world units.
    Diameter,
    /// The largest error from surfaces, in their unit.
    Error,
    /// The curve gives the target diameter for a value.
    Curve(Arc<ValueCurve>),
}

impl From<&RasterReading> for RasterValues {
    fn from(reading: &RasterReading) -> Self {
        match reading {
            RasterReading::Risk => Self::Risk,
            RasterReading::Diameter => Self::Diameter,
            RasterReading::Error => Self::Error,
            RasterReading::Curve(_) => Self::Any,
        }
    }
}

impl LayerSource for RasterLayer {
    fn label(&self) -> &'static str {
        "Raster"
    }

    fn change_title(&self) -> &'static str {
        "raster"
    }

    fn compile(&self, _: LayerSlot, plane: &CompiledPlane) -> (Reading, Values) {
        let (reading, gap) = match &self.reading {
            RasterReading::Risk => (plane.reading(Quantity::Risk, NO_RISK), NO_RISK),
            RasterReading::Diameter | RasterReading::Error => (plane.diameters(), f32::INFINITY),
            RasterReading::Curve(curve) => {
                (Reading::Curve { curve: curve.clone(), lengths: plane.lengths().clone() }, f32::INFINITY)
            }
        };
        (reading, Values::of_raster(&self.source.raster, gap, plane.lattice))
    }

    fn quantity(&self) -> Quantity {
        match self.reading {
            RasterReading::Risk => Quantity::Risk,
            RasterReading::Diameter | RasterReading::Curve(_) => Quantity::Diameter,
            RasterReading::Error => Quantity::Error,
        }
    }

    fn raster_source(&self) -> Option<&RasterSource> {
        Some(&self.source)
    }

    fn shared_data(&self) -> Vec<(usize, usize)> {
        let mut data = vec![self.source.shared_data()];
        if let RasterReading::Curve(curve) = &self.reading {
            data.push((Arc::as_ptr(curve).addr(), size_of_val(curve.knots())));
        }
        data
    }

    fn risk_at(&self, point: DVec2, _: Option<&TiledRaster>) -> Option<f64> {
        let raster = (self.reading == RasterReading::Risk).then_some(&self.source.raster);
        raster?.sample(point).map(f64::from)
    }

    fn risks(&self, _: Option<&TiledRaster>) -> Option<RiskSource> {
        (self.reading == RasterReading::Risk).then(|| RiskSource::Raster(self.source.raster.clone()))
    }

    fn error_at(&self, point: DVec2, _: Option<&TiledRaster>) -> Option<f64> {
        let raster = (self.reading == RasterReading::Error).then_some(&self.source.raster);
        raster?.sample(point).map(f64::from)
    }

    fn extent(&self, _: LayerSlot, _: &ExtentContext) -> Extent {
        pixels_of(&self.source)
    }
}

/// Returns where a raster has pixels.
pub(super) fn pixels_of(source: &RasterSource) -> Extent {
    Extent::of([source.raster.raster().bounds()])
}

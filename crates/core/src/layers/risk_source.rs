use std::sync::Arc;

use super::Threats;
use crate::field::Formula;
use crate::raster::{RasterPyramid, TiledRaster};

/// Where the risks of a layer come from.
#[derive(Clone, Debug)]
pub enum RiskSource {
    /// Painted pixels.
    Paint(TiledRaster),
    Raster(Arc<RasterPyramid>),
    Formula(Formula),
    Threats(Threats),
}

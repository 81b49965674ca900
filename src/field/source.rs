use std::sync::Arc;

use glam::DVec2;

use super::{Formula, RiskToDiameter};
use crate::mesh::InvalidTarget;
use crate::raster::Raster;

/// One thing that asks for small triangles somewhere.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Source {
    /// The same target diameter everywhere, in world units.
    Constant(f64),
    /// A formula in x and y for the target diameter, in world units.
    TargetFormula(Formula),
    /// A formula in x and y for the risk, 0 to 1.
    RiskFormula(Formula),
    /// Target diameters by pixel, in world units.
    TargetRaster(Arc<Raster>),
    /// Risks by pixel, 0 to 1.
    RiskRaster(Arc<Raster>),
}

impl Source {
    /// The target diameter at a point in world units; rasters ask for nothing (infinity) beyond their edge.
    ///
    /// Unchecked: a formula may give NaN or a value below zero.
    pub fn target(&self, point: DVec2, transfer: &impl RiskToDiameter) -> f64 {
        match self {
            Self::Constant(diameter) => *diameter,
            Self::TargetFormula(formula) => formula.eval(point.x, point.y),
            Self::RiskFormula(formula) => transfer.diameter(formula.eval(point.x, point.y)),
            Self::TargetRaster(raster) => raster.sample(point).map_or(f64::INFINITY, f64::from),
            Self::RiskRaster(raster) => {
                raster.sample(point).map_or(f64::INFINITY, |risk| transfer.diameter(f64::from(risk)))
            }
        }
    }

    /// The risk at a point, where the source is one of risk.
    pub fn risk(&self, point: DVec2) -> Option<f64> {
        match self {
            Self::RiskFormula(formula) => Some(formula.eval(point.x, point.y)),
            Self::RiskRaster(raster) => raster.sample(point).map(f64::from),
            Self::Constant(_) | Self::TargetFormula(_) | Self::TargetRaster(_) => None,
        }
    }

    /// Whether the source is given by pixels.
    pub fn is_raster(&self) -> bool {
        matches!(self, Self::TargetRaster(_) | Self::RiskRaster(_))
    }
}

/// The smallest target diameter that any of the sources asks for at a point in world units; infinite where
/// none does.
///
/// # Errors
/// When a source gives NaN, infinity, zero or less. Only a raster may ask for nothing, beyond its edge or
/// where it has no value.
pub fn smallest_target<'a>(
    sources: impl IntoIterator<Item = &'a Source>,
    point: DVec2,
    transfer: &impl RiskToDiameter,
) -> Result<f64, InvalidTarget> {
    let mut smallest = f64::INFINITY;
    for source in sources {
        let value = source.target(point, transfer);
        if !(source.is_raster() && value == f64::INFINITY) {
            smallest = smallest.min(checked_target(value, point)?);
        }
    }
    Ok(smallest)
}

/// Returns a target diameter that a mesh can meet: a positive, finite length. Both arguments are in world
/// units.
///
/// # Errors
/// With the point and the value, when no mesh can meet it.
#[inline]
pub fn checked_target(value: f64, at: DVec2) -> Result<f64, InvalidTarget> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(InvalidTarget { at, value }) }
}

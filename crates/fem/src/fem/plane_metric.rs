//! Lengths of the plane that a problem is solved in.

use glam::{DVec2, dvec2};

use crate::domain::Domain;
use crate::earth::{EarthPlane, Ground};
use crate::text::LengthUnit;

/// How long a step of the coordinates is.
///
/// The lengths along x and y are taken at the middle of each triangle. In the plane of a projection, which is
/// conformal, both are 1/k.
#[derive(Clone, Debug)]
pub enum PlaneMetric {
    /// World units.
    World,
    /// Metres on the ellipsoid, for coordinates in the plane of a projection.
    Projected(Ground),
    /// Metres on the ellipsoid, for longitudes and latitudes in degrees.
    Degrees,
}

impl PlaneMetric {
    /// Returns the metric of a domain whose coordinates have a unit.
    pub fn of(domain: &Domain, unit: LengthUnit) -> Self {
        match EarthPlane::new(domain.projection, unit) {
            None => Self::World,
            Some(EarthPlane::Degrees) => Self::Degrees,
            Some(EarthPlane::Projected(_)) => Self::Projected(domain.ground()),
        }
    }

    /// Returns whether it is that of a plane without curvature.
    pub fn is_world(&self) -> bool {
        matches!(self, Self::World)
    }

    /// Returns the lengths of a unit step along x and along y at a point: world units, or metres.
    pub fn at(&self, point: DVec2) -> [f64; 2] {
        match self {
            Self::World => [1.0; 2],
            Self::Projected(ground) => [ground.inverse_scale_at(point); 2],
            Self::Degrees => [dvec2(STEP, 0.0), dvec2(0.0, STEP)].map(|step| {
                let line = [point - 0.5 * step, point + 0.5 * step];
                EarthPlane::Degrees.length(&line) / STEP
            }),
        }
    }
}

/// The step that a degree is measured by, in degrees.
const STEP: f64 = 1e-3;

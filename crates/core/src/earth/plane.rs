//! Planes whose points have longitudes and latitudes.

use glam::DVec2;

use super::{Projection, wrapped};
use crate::geometry::Rect;
use crate::text::LengthUnit;

/// A plane whose points have longitudes and latitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EarthPlane {
    /// x is the longitude and y the latitude, in degrees.
    Degrees,
    /// Coordinates are metres in the plane of a projection.
    Projected(Projection),
}

impl EarthPlane {
    /// Returns the plane of a domain with a projection, or with coordinates in a unit; `None` where it does
    /// not lie on the Earth.
    pub fn new(projection: Option<Projection>, unit: LengthUnit) -> Option<Self> {
        match (projection, unit) {
            (Some(projection), _) => Some(Self::Projected(projection)),
            (None, LengthUnit::Degree) => Some(Self::Degrees),
            (None, _) => None,
        }
    }

    /// Returns the projection, if there is one.
    pub fn projection(self) -> Option<Projection> {
        match self {
            Self::Degrees => None,
            Self::Projected(projection) => Some(projection),
        }
    }

    /// Returns longitude (−180 to 180) and latitude of a point, in degrees.
    pub fn geographic(self, at: DVec2) -> DVec2 {
        match self {
            Self::Degrees => DVec2::new(wrapped(at.x), at.y),
            Self::Projected(projection) => projection.geographic_from_plane(at),
        }
    }

    /// Returns the point of a longitude and latitude, in degrees: in degrees that which lies in `bounds`, if
    /// one of the whole turns around does.
    pub fn point_of(self, geographic: DVec2, bounds: Rect) -> DVec2 {
        match self {
            Self::Degrees => {
                let turned = |turn: f64| geographic + DVec2::new(turn, 0.0);
                [0.0, 360.0, -360.0]
                    .map(turned)
                    .into_iter()
                    .find(|at| bounds.contains(*at))
                    .unwrap_or(geographic)
            }
            Self::Projected(projection) => projection.plane_from_geographic(geographic),
        }
    }
}

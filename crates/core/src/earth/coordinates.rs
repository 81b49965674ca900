use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use std::str::FromStr;

use glam::{DVec2, dvec2};

use super::ellipsoid::A;
use super::{GeographicSystem, Projection, geographic, register, wrapped};
use crate::text::excerpt;

/// What coordinates mean on the Earth.
///
/// Systems on ETRS89, NAD83, GDA2020 and others within a few metres of WGS 84 count as ones on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    /// Longitudes and latitudes, in degrees.
    Geographic,
    /// Longitudes and latitudes of another geographic system.
    OnDatum(GeographicSystem),
    /// Metres in the plane of a projection.
    Plane(Projection),
    /// Web Mercator, in metres: a projection of a sphere that maps on the web have. It does not keep angles
    /// on the ellipsoid, so it is read, and nothing is meshed in it.
    WebMercator,
}

/// A text that names no system of coordinates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "“{text}” is not a coordinate system that is known here. Write lonlat, EPSG and a code, such as EPSG:32633 (UTM zones, \
     geographic systems, 3395, 3857, 3413, 3031, 3995, 3034, 2154, 3006, 3067 and 2193 are known), or a projection as PROJ does: \
     “+proj=tmerc +lon_0=15 +k_0=0.9996 +x_0=500000 +ellps=WGS84 +units=m”."
)]
pub struct CoordinatesTextError {
    /// The beginning of the text.
    text: String,
}

impl Coordinates {
    /// Returns the system of a code of the EPSG register; `None` for one that is not known here.
    pub fn of_epsg(code: u32) -> Option<Self> {
        register::coordinates(code)
    }

    /// Returns the projection, if the coordinates are metres in the plane of one that keeps angles.
    pub fn projection(&self) -> Option<Projection> {
        match self {
            Self::Plane(projection) => Some(*projection),
            Self::Geographic | Self::OnDatum(_) | Self::WebMercator => None,
        }
    }

    /// Returns whether they are longitudes and latitudes in degrees, of any geographic system.
    pub fn are_degrees(&self) -> bool {
        match self {
            Self::Geographic => true,
            Self::OnDatum(system) => system.is_in_degrees(),
            Self::Plane(_) | Self::WebMercator => false,
        }
    }

    /// Returns coordinates whose longitude is less than half a turn from another one, so that those of
    /// neighbours are next to each other across the antimeridian too. Coordinates in a plane stay as they
    /// are.
    pub fn beside(&self, at: DVec2, longitude: f64) -> DVec2 {
        let around = match self {
            Self::Geographic => 360.0,
            Self::OnDatum(system) => 360.0 / system.unit,
            Self::Plane(_) | Self::WebMercator => return at,
        };
        dvec2(at.x - around * ((at.x - longitude) / around).round(), at.y)
    }

    /// Returns longitude and latitude, in degrees, of coordinates.
    pub fn to_geographic(&self, at: DVec2) -> DVec2 {
        match self {
            Self::Geographic => at,
            Self::OnDatum(system) => system.to_wgs_84(at),
            Self::Plane(projection) => projection.geographic_from_plane(at),
            Self::WebMercator => {
                let [east, up] = (at / A).to_array();
                let latitude = 2.0 * libm::atan(libm::exp(up)) - FRAC_PI_2;
                dvec2(wrapped(east.to_degrees()), latitude.to_degrees())
            }
        }
    }

    /// Returns the coordinates of a longitude and latitude, in degrees.
    pub fn from_geographic(&self, at: DVec2) -> DVec2 {
        match self {
            Self::Geographic => at,
            Self::OnDatum(system) => system.of_wgs_84(at),
            Self::Plane(projection) => projection.plane_from_geographic(at),
            Self::WebMercator => {
                let up = libm::asinh(libm::tan(at.y.to_radians()));
                A * dvec2(wrapped(at.x) * (PI / 180.0), up)
            }
        }
    }
}

impl fmt::Display for Coordinates {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Geographic => f.write_str("lonlat"),
            Self::OnDatum(system) => system.fmt(f),
            Self::Plane(projection) => projection.fmt(f),
            Self::WebMercator => f.write_str("EPSG:3857"),
        }
    }
}

impl FromStr for Coordinates {
    type Err = CoordinatesTextError;

    /// Reads `lonlat`, `EPSG:32633`, or a projection as PROJ writes it.
    fn from_str(text: &str) -> Result<Self, CoordinatesTextError> {
        let known = match text.trim().to_lowercase().split_once(':') {
            Some(("epsg", code)) => code.trim().parse().ok().and_then(Self::of_epsg),
            None if text.trim() == "lonlat" => Some(Self::Geographic),
            _ => text.parse().ok().map(Self::Plane).or_else(|| geographic::of_proj(text)),
        };
        known.ok_or_else(|| CoordinatesTextError { text: excerpt(80, text) })
    }
}

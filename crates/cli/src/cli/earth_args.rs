//! Arguments on coordinates: what they are in files, and in which plane a region is meshed.

use std::str::FromStr;

use clap::Args;

use meshbrush_core::earth::{Coordinates, CoordinatesTextError};

/// What the coordinates of files are, and the plane of the mesh.
#[derive(Debug, Args)]
pub struct EarthArguments {
    /// Mesh the region in metres on the Earth, in the plane of a conformal projection
    ///
    /// All lengths are then in metres, and no edge of the mesh is longer on the Earth than its target
    /// diameter, whatever the scale of the plane is. auto chooses what suits the region: merc (Mercator),
    /// tmerc (transverse Mercator), stere (polar stereographic) or lcc (Lambert). EPSG:N is the projection
    /// of a code, such as EPSG:32633 for a zone of UTM. A projection written as PROJ does, with all its
    /// numbers, is also the coordinate system of files that name none. metres keeps the plane of the
    /// region's file if it is known, and is auto otherwise. none takes degrees for lengths in a plane
    /// [default: metres if a length has a unit, as in 2 km; otherwise none]
    #[arg(long, value_name = "auto|metres|none|merc|tmerc|stere|lcc|EPSG:N|PROJ")]
    pub projection: Option<String>,

    /// Coordinate system of files that do not name a known one: lonlat, EPSG:N, or a projection written as
    /// PROJ does
    ///
    /// Without it, coordinates within the range of longitudes and latitudes are taken as degrees.
    #[arg(long, value_name = "lonlat|EPSG:N|PROJ")]
    pub crs: Option<String>,
}

/// Coordinates in files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutputCoordinates {
    /// Degrees, where the domain lies on the Earth.
    Lonlat,
    /// World units.
    Plane,
    /// Those of a plane, in metres.
    Other(Coordinates),
}

impl FromStr for OutputCoordinates {
    type Err = CoordinatesTextError;

    fn from_str(text: &str) -> Result<Self, CoordinatesTextError> {
        if text == "plane" {
            return Ok(Self::Plane);
        }
        Ok(text.parse::<Coordinates>()?.into())
    }
}

impl From<Coordinates> for OutputCoordinates {
    fn from(coordinates: Coordinates) -> Self {
        match coordinates {
            Coordinates::Geographic => Self::Lonlat,
            plane => Self::Other(plane),
        }
    }
}

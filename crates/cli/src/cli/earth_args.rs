//! Arguments on coordinates: what they are in files, and in which plane a region is meshed.

use std::str::FromStr;

use clap::Args;

use meshbrush_core::earth::{Coordinates, CoordinatesTextError};

/// What the coordinates of files are, and the plane of the mesh.
#[derive(Debug, Args)]
pub struct EarthArguments {
    /// Mesh the region in metres on the Earth, in the plane of a conformal projection
    ///
    /// All lengths are then in metres, and no edge of the mesh is longer on the Earth than in the plane. auto
    /// chooses what suits the region: merc (Mercator), tmerc (transverse Mercator), stere (polar
    /// stereographic) or lcc (Lambert). EPSG:N is the projection of a code, such as EPSG:32633 for a zone of
    /// UTM. A projection as PROJ writes it, with all its numbers, is the plane of files that name no
    /// coordinate system, too. metres is the plane of the region's file if that is known, or else
    /// auto. none takes degrees for lengths in a plane [default: metres where a length has a unit, as in
    /// 2 km; or else none]
    #[arg(long, value_name = "auto|metres|none|merc|tmerc|stere|lcc|EPSG:N|PROJ")]
    pub projection: Option<String>,

    /// What coordinates are in files that do not name a coordinate system that is known: lonlat, EPSG:N, or a
    /// projection as PROJ writes it
    ///
    /// Without it, coordinates that can be longitudes and latitudes are that.
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
        Ok(match text.parse()? {
            Coordinates::Geographic => Self::Lonlat,
            plane => Self::Other(plane),
        })
    }
}

//! What the coordinates in files are.

use std::str::FromStr;

use meshbrush_core::earth::{Coordinates, CoordinatesTextError};

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

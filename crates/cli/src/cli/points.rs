//! Points as typed: in world units, or as a longitude and a latitude.

use glam::DVec2;

use super::failure::Failure;
use meshbrush_core::earth::Projection;
use meshbrush_mesh::text::{LengthUnit, typed};

/// A point as typed: `0.5,0.25` in world units, or `24.5°,37.9°` as a longitude and a latitude.
#[derive(Clone, Debug, PartialEq)]
pub struct TypedPoint {
    at: DVec2,
    is_geographic: bool,
    text: String,
}

impl TypedPoint {
    /// Reads a point.
    ///
    /// # Errors
    /// Fails when these are not two finite numbers, or only one has a degree sign.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let coordinate = |part: &str| {
            let part = part.trim();
            let plain = part.parse().ok().filter(|number: &f64| number.is_finite());
            let degrees = || typed::number(part, LengthUnit::Degree.symbol()).ok();
            plain.map(|number| (number, false)).or_else(|| Some((degrees()?, true)))
        };
        let parts: Option<Vec<(f64, bool)>> = text.split(',').map(coordinate).collect();
        match parts.as_deref() {
            Some(&[(x, of_x), (y, of_y)]) if of_x == of_y => {
                Ok(Self { at: DVec2::new(x, y), is_geographic: of_x, text: text.to_owned() })
            }
            _ => Err(Failure::Usage(format!(
                "“{text}” is no point. Write two numbers and a comma, as in 0.5,0.25, or longitude and latitude, as in \
                 24.5°,37.9°."
            ))),
        }
    }

    /// Returns the point in the plane of a domain.
    ///
    /// # Errors
    /// Fails when it is a longitude and a latitude, and the domain has none.
    pub fn in_domain(&self, projection: Option<Projection>, unit: LengthUnit) -> Result<DVec2, Failure> {
        match (self.is_geographic, projection) {
            (true, Some(projection)) => Ok(projection.plane_from_geographic(self.at)),
            (true, None) if unit != LengthUnit::Degree => Err(Failure::Usage(format!(
                "{}: the coordinates of this domain are no longitudes and latitudes. Write them as the domain has them, \
                 without °, or mesh a region on the Earth.",
                self.text
            ))),
            _ => Ok(self.at),
        }
    }
}

//! The Earth: conformal projections of the ellipsoid WGS 84 to a plane in metres.
//!
//! A mesh is made in a plane. A conformal projection has a scale k at each point: lengths in the plane are k
//! times those on the ellipsoid, in every direction. A triangle whose diameter in the plane is at most its
//! target diameter times the least scale in it has no edge that is longer than the target on the ellipsoid:
//! the geodesic between two points is no longer than the line that is straight in the plane.

mod choice;
mod cone;
mod coordinates;
mod degrees;
mod edge_lengths;
mod ellipsoid;
mod extent;
mod geographic;
mod graticule;
mod ground;
mod inverse_scale;
mod length;
mod north;
mod outline;
mod plane;
mod register;
mod reprojection;
mod route;
mod scale_map;
mod speed;
mod squares;
mod text;
mod transverse;

use glam::{DVec2, dvec2};

use crate::geometry::Rect;
use cone::ProjectionCone;
use ellipsoid::{A, Latitude, degrees_from_conformal};
use transverse::Transverse;

pub use choice::{ProjectionChoice, ProjectionError};
pub use coordinates::{Coordinates, CoordinatesTextError};
pub use degrees::{DegreeStyle, GeographicAxis, geographic_from_text};
pub use edge_lengths::{EdgeLengths, LEVELS};
pub use extent::GeographicExtent;
pub use geographic::GeographicSystem;
pub use graticule::{GraticuleLine, graticule};
pub use ground::Ground;
pub use inverse_scale::InverseScale;
pub use length::metres_along;
pub use outline::{projected_line, projected_polygons};
pub use plane::EarthPlane;
pub use reprojection::Reprojection;
pub use route::RoutePoint;
use scale_map::ScaleMap;
pub use speed::{Speed, SpeedError, hours_and_minutes};
pub use text::ProjectionTextError;

/// A family of conformal projections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProjectionKind {
    /// A cylinder that touches the equator.
    Mercator,
    /// A cylinder that touches a meridian.
    TransverseMercator,
    /// A plane at a pole.
    PolarStereographic,
    /// A cone.
    Lambert,
}

impl ProjectionKind {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Mercator, Self::TransverseMercator, Self::PolarStereographic, Self::Lambert];

    /// Returns the name for a person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mercator => "Mercator",
            Self::TransverseMercator => "transverse Mercator",
            Self::PolarStereographic => "polar stereographic",
            Self::Lambert => "Lambert conformal conic",
        }
    }

    /// Returns the word of PROJ for it, which recipes and the command line use too.
    pub fn word(self) -> &'static str {
        match self {
            Self::Mercator => "merc",
            Self::TransverseMercator => "tmerc",
            Self::PolarStereographic => "stere",
            Self::Lambert => "lcc",
        }
    }
}

/// What distinguishes projections of one family. Latitudes are in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Parameters {
    /// The latitude that is true to scale, on both sides of the equator.
    Mercator { true_latitude: f64 },
    /// The scale on the central meridian.
    TransverseMercator { scale: f64 },
    /// The latitude that is true to scale; its sign is that of the pole.
    PolarStereographic { true_latitude: f64 },
    /// The latitude where y = 0, and those that are true to scale.
    Lambert { origin: f64, parallels: [f64; 2] },
}

/// A conformal projection of the ellipsoid WGS 84 to a plane in metres.
///
/// Longitudes and latitudes are in degrees, and a vector of them has the longitude first.
///
/// ```
/// use glam::dvec2;
/// use meshbrush_core::earth::Projection;
///
/// let utm: Projection = "+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m".parse().unwrap();
/// let at = utm.plane_from_geographic(dvec2(18.0, 45.5));
/// assert!(at.distance(dvec2(234_378.661_479_270, 5_042_875.017_343_630)) < 1e-8);
/// assert!(utm.geographic_from_plane(at).distance(dvec2(18.0, 45.5)) < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    central_meridian: f64,
    parameters: Parameters,
    /// What is added to the coordinates in the plane, in metres: false easting and false northing.
    origin: DVec2,
    plane: ProjectionConstants,
}

/// The constants of the formulas.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ProjectionConstants {
    /// The radius of the cylinder, in metres.
    Cylinder(f64),
    Transverse(Transverse),
    Cone(ProjectionCone),
}

impl Projection {
    fn new(central_meridian: f64, parameters: Parameters) -> Self {
        let plane = match parameters {
            Parameters::Mercator { true_latitude } => {
                ProjectionConstants::Cylinder(A * Latitude::from_degrees(true_latitude).parallel())
            }
            Parameters::TransverseMercator { scale } => {
                ProjectionConstants::Transverse(Transverse::new(scale))
            }
            Parameters::PolarStereographic { true_latitude } => {
                ProjectionConstants::Cone(ProjectionCone::polar(true_latitude))
            }
            Parameters::Lambert { origin, parallels } => {
                ProjectionConstants::Cone(ProjectionCone::lambert(origin, parallels))
            }
        };
        Self { central_meridian, parameters, origin: DVec2::ZERO, plane }
    }

    /// Returns the same projection with other coordinates in the plane.
    fn with_origin(self, origin: DVec2) -> Self {
        Self { origin, ..self }
    }

    /// Returns the family.
    pub fn kind(&self) -> ProjectionKind {
        match self.parameters {
            Parameters::Mercator { .. } => ProjectionKind::Mercator,
            Parameters::TransverseMercator { .. } => ProjectionKind::TransverseMercator,
            Parameters::PolarStereographic { .. } => ProjectionKind::PolarStereographic,
            Parameters::Lambert { .. } => ProjectionKind::Lambert,
        }
    }

    /// Returns the longitude from the central meridian, −180 to 180.
    fn east(&self, longitude: f64) -> f64 {
        wrapped(longitude - self.central_meridian)
    }

    /// Returns the point in the plane, in metres, and the scale there.
    fn forward(&self, at: DVec2) -> (DVec2, f64) {
        let east = self.east(at.x);
        let (plane, scale) = match &self.plane {
            ProjectionConstants::Cylinder(radius) => {
                let latitude = Latitude::from_degrees(at.y);
                let up = libm::asinh(latitude.conformal);
                (radius * dvec2(east.to_radians(), up), radius / (A * latitude.parallel()))
            }
            ProjectionConstants::Transverse(transverse) => transverse.forward(east, at.y),
            ProjectionConstants::Cone(cone) => cone.forward(east, at.y),
        };
        (plane + self.origin, scale)
    }

    /// Returns the point in the plane, in metres, of a longitude and latitude.
    pub fn plane_from_geographic(&self, at: DVec2) -> DVec2 {
        self.forward(at).0
    }

    /// Returns the scale k at a longitude and latitude: lengths in the plane are k times those on the
    /// ellipsoid.
    pub fn scale_at(&self, at: DVec2) -> f64 {
        self.forward(at).1
    }

    /// Returns the scale k at a point in the plane.
    pub fn scale_in_plane(&self, at: DVec2) -> f64 {
        self.scale_at(self.geographic_from_plane(at))
    }

    /// Returns a scale that is nowhere less in a rectangle of the plane: the least one, but of a transverse
    /// Mercator projection that on its central meridian.
    pub(crate) fn least_scale_in(&self, rect: &Rect) -> f64 {
        let nearest = DVec2::ZERO.clamp(rect.min - self.origin, rect.max - self.origin);
        match (&self.plane, self.parameters) {
            (ProjectionConstants::Transverse(_), Parameters::TransverseMercator { scale }) => scale,
            // Grows away from the equator.
            (ProjectionConstants::Cone(cone), _) => {
                cone.least_scale_in(&Rect::new(rect.min - self.origin, rect.max - self.origin))
            }
            _ => self.scale_in_plane(nearest + self.origin),
        }
    }

    /// Returns longitude (−180 to 180) and latitude of a point in the plane.
    pub fn geographic_from_plane(&self, at: DVec2) -> DVec2 {
        let at = at - self.origin;
        let from_center = match &self.plane {
            ProjectionConstants::Cylinder(radius) => {
                let [east, up] = (at / *radius).to_array();
                dvec2(east.to_degrees(), degrees_from_conformal(libm::sinh(up)))
            }
            ProjectionConstants::Transverse(transverse) => transverse.inverse(at),
            ProjectionConstants::Cone(cone) => cone.inverse(at),
        };
        dvec2(wrapped(from_center.x + self.central_meridian), from_center.y)
    }
}

/// Returns an angle in degrees from −180 up to 180. Angles within these limits stay as they are.
pub(crate) fn wrapped(degrees: f64) -> f64 {
    if (-180.0..=180.0).contains(&degrees) {
        return degrees;
    }
    let turned = (degrees + 180.0).rem_euclid(360.0);
    turned - 180.0
}

#[cfg(test)]
mod tests;

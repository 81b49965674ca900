//! Lambert's conformal cone and the polar stereographic projection, which is its case n = 1. Formulas:
//! \[Snyder1987\], sections 15 and 21, by the conformal latitude.

use glam::{DVec2, dvec2};

use super::ellipsoid::{A, Latitude, degrees_from_conformal, eccentricity};
use crate::geometry::Rect;

/// A cone whose tip is at the north pole; mirrored for the south.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ProjectionCone {
    /// 1 for the north, −1 for the south.
    mirror: f64,
    /// Angles around the tip are n times the longitudes.
    n: f64,
    /// The distance of a parallel from the tip is this times t(φ)ⁿ, in metres.
    size: f64,
    /// The distance of the origin from the tip, in metres.
    origin: f64,
}

impl ProjectionCone {
    /// The plane that touches or cuts the Earth around a pole, true to scale at a latitude of its half.
    pub(super) fn polar(true_latitude: f64) -> Self {
        let mirror = 1.0_f64.copysign(true_latitude);
        let latitude = Latitude::from_degrees(true_latitude.abs());
        let size = match true_latitude.abs() {
            90.0 => A * pole_ratio(),
            _ => A * latitude.parallel() / latitude.colatitude(),
        };
        Self { mirror, n: 1.0, size, origin: 0.0 }
    }

    /// The cone that is true to scale at two parallels, which may be the same; none of them is the equator's
    /// mirror image of the other. `origin` is the latitude where y = 0. All in degrees.
    pub(super) fn lambert(origin: f64, [first, second]: [f64; 2]) -> Self {
        let mirror = 1.0_f64.copysign(first + second);
        let [a, b] = [first, second].map(|latitude| Latitude::from_degrees(mirror * latitude));
        let n = if first == second {
            libm::sin((mirror * first).to_radians())
        } else {
            libm::log(a.parallel() / b.parallel()) / libm::log(a.colatitude() / b.colatitude())
        };
        let size = A * a.parallel() / (n * libm::pow(a.colatitude(), n));
        let cone = Self { mirror, n, size, origin: 0.0 };
        Self { origin: cone.distance(Latitude::from_degrees(mirror * origin)), ..cone }
    }

    /// Distance of a parallel from the tip, in metres.
    fn distance(&self, latitude: Latitude) -> f64 {
        self.size * libm::pow(latitude.colatitude(), self.n)
    }

    /// Returns the point in the plane, in metres, and the scale there. `east` is the longitude from the
    /// central one; both in degrees.
    pub(super) fn forward(&self, east: f64, latitude: f64) -> (DVec2, f64) {
        let latitude = Latitude::from_degrees(self.mirror * latitude);
        let distance = self.distance(latitude);
        let (sine, cosine) = libm::sincos(self.n * east.to_radians());
        let at = dvec2(distance * sine, self.mirror * (self.origin - distance * cosine));
        (at, self.n * distance / (A * latitude.parallel()))
    }

    /// Returns the least scale in a rectangle of the plane. It depends on the distance from the tip, and
    /// falls up to the parallel where sin φ = n.
    pub(super) fn least_scale_in(&self, rect: &Rect) -> f64 {
        let tip = dvec2(0.0, self.mirror * self.origin);
        let nearest = tip.clamp(rect.min, rect.max).distance(tip);
        let farthest = (rect.max - tip).abs().max((rect.min - tip).abs()).length();
        let best = self.distance(Latitude::from_degrees(libm::asin(self.n).to_degrees()));
        self.scale_at_distance(best.clamp(nearest, farthest))
    }

    /// Returns the scale at a distance from the tip, in metres.
    fn scale_at_distance(&self, distance: f64) -> f64 {
        let latitude = self.inverse(dvec2(0.0, self.mirror * (self.origin - distance))).y;
        self.forward(0.0, latitude).1
    }

    /// Returns longitude from the central one and latitude, in degrees.
    pub(super) fn inverse(&self, at: DVec2) -> DVec2 {
        let down = self.origin - self.mirror * at.y;
        let (distance, angle) = (libm::hypot(at.x, down), libm::atan2(at.x, down));
        let t = libm::pow(distance / self.size, 1.0 / self.n);
        let latitude = degrees_from_conformal(0.5 * (1.0 / t - t));
        dvec2((angle / self.n).to_degrees(), self.mirror * latitude)
    }
}

/// The limit of m(φ) / t(φ) at the pole.
fn pole_ratio() -> f64 {
    let e = eccentricity();
    2.0 / (libm::pow(1.0 + e, 1.0 + e) * libm::pow(1.0 - e, 1.0 - e)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_at_the_pole_is_the_limit() {
        let near = Latitude::from_degrees(89.999_99);
        assert!((near.parallel() / near.colatitude() - pole_ratio()).abs() < 1e-9);
    }
}

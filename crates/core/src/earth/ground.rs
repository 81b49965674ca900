//! Lengths and areas on the Earth of what lies in a plane.

use std::sync::Arc;

use glam::DVec2;

use super::{InverseScale, Projection};
use crate::geometry::{Rect, gauss_mean, signed_area};
use crate::mesh::{Extract, MeshStatistics};

/// Measures what lies in a plane: on the ellipsoid, in metres, where the plane is that of a projection, and
/// otherwise in the plane, in world units.
#[derive(Clone, Debug, Default)]
pub struct Ground {
    inverse_scale: Option<Arc<InverseScale>>,
}

/// Longer lines are measured in pieces, in metres: over one, the scale is nearly linear.
const PIECE: f64 = 1e5;
/// The most pieces of a line.
const MOST_PIECES: f64 = 64.0;

impl Ground {
    /// Returns the measure of a rectangle in the plane of a projection.
    pub fn new(projection: Option<&Projection>, bounds: &Rect) -> Self {
        Self { inverse_scale: projection.map(|projection| Arc::new(InverseScale::new(projection, bounds))) }
    }

    /// Returns the inverse scale 1/k; `None` in a plane without a projection.
    pub fn inverse_scale(&self) -> Option<&Arc<InverseScale>> {
        self.inverse_scale.as_ref()
    }

    /// Returns the inverse scale at a point; 1 in a plane without a projection.
    pub fn inverse_scale_at(&self, point: DVec2) -> f64 {
        self.inverse_scale.as_ref().map_or(1.0, |scale| scale.at(point))
    }

    /// Returns the length of a line that is straight in the plane.
    pub fn length(&self, [from, to]: [DVec2; 2]) -> f64 {
        let length = from.distance(to);
        match &self.inverse_scale {
            Some(scale) => length * mean(length, |share| scale.at(from.lerp(to, share))),
            None => length,
        }
    }

    /// Returns an upper bound of the length on the ground of lines with a given length in the plane that
    /// start at a point.
    pub fn longest(&self, length: f64, from: DVec2) -> f64 {
        self.inverse_scale
            .as_ref()
            .map_or(length, |scale| length * scale.range(&Rect::around(from, length))[1])
    }

    /// Returns an area in the plane around a point as one on the ground. It is small compared with the Earth.
    pub fn area_around(&self, area: f64, point: DVec2) -> f64 {
        let scale = self.inverse_scale_at(point);
        area * (scale * scale)
    }

    /// Returns the area of a triangle that is small compared with the Earth.
    pub fn triangle_area(&self, [a, b, c]: [DVec2; 3]) -> f64 {
        self.area_around(0.5 * (b - a).perp_dot(c - a).abs(), (a + b + c) / 3.0)
    }

    /// Returns the area of a mesh.
    pub fn mesh_area(&self, mesh: &Extract) -> f64 {
        match &self.inverse_scale {
            Some(_) => mesh.area_by(|corners| self.triangle_area(corners)),
            None => mesh.area(),
        }
    }

    /// Returns the figures of a mesh; `None` without triangles.
    pub fn statistics(&self, mesh: &Extract) -> Option<MeshStatistics> {
        mesh.statistics_by(|ends| self.length(ends), |corners| self.triangle_area(corners))
    }

    /// Returns the area that a ring encloses, negative if it runs clockwise. Its sides are straight in the
    /// plane.
    ///
    /// By Green's theorem it is the integral of F dy along the ring, where F is the integral of 1/k² along
    /// x from a place of the ring.
    pub fn signed_area(&self, ring: &[DVec2]) -> f64 {
        let Some(&origin) = ring.first() else { return 0.0 };
        let Some(scale) = &self.inverse_scale else { return signed_area(ring) };
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        let strip = |at: DVec2| {
            let width = at.x - origin.x;
            let squared = |share: f64| {
                let scale = scale.at(DVec2::new(origin.x + share * width, at.y));
                scale * scale
            };
            width * mean(width.abs(), squared)
        };
        sides.map(|(&a, &b)| (b.y - a.y) * mean(a.distance(b), |share| strip(a.lerp(b, share)))).sum()
    }
}

/// Returns the mean of a function over a line of a length in metres, from 0 to 1.
fn mean(length: f64, value: impl Fn(f64) -> f64) -> f64 {
    let pieces = (length / PIECE).ceil().clamp(1.0, MOST_PIECES);
    let of_piece = |n: u32| gauss_mean(|share| value((f64::from(n) + share) / pieces));
    (0..pieces as u32).map(of_piece).sum::<f64>() / pieces
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::earth::EarthPlane;

    /// The area between two parallels over some degrees of longitude, by the authalic function.
    fn area_between(south: f64, north: f64, degrees: f64) -> f64 {
        let (a, f) = (6_378_137.0_f64, 1.0_f64 / 298.257_223_563);
        let e = (f * (2.0 - f)).sqrt();
        let b2 = (a * (1.0 - f)).powi(2);
        let q = |latitude: f64| -> f64 {
            let s = latitude.to_radians().sin();
            s / (1.0 - e * e * s * s) + ((1.0 + e * s) / (1.0 - e * s)).ln() / (2.0 * e)
        };
        0.5 * b2 * (q(north) - q(south)) * degrees.to_radians()
    }

    #[test]
    fn a_rectangle_in_mercator_has_the_area_between_its_parallels() {
        let mercator: Projection = "+proj=merc +lat_ts=0 +ellps=WGS84 +units=m".parse().unwrap();
        for (south, north, west, east) in [(-10.0, 60.0, 0.0, 50.0), (59.0, 59.01, 4.0, 4.01)] {
            let [min, max] =
                [dvec2(west, south), dvec2(east, north)].map(|at| mercator.plane_from_geographic(at));
            let ground = Ground::new(Some(&mercator), &Rect::new(min, max));
            let ring = [min, dvec2(max.x, min.y), max, dvec2(min.x, max.y)];
            let expected = area_between(south, north, east - west);
            let off = ground.signed_area(&ring) / expected - 1.0;
            assert!(off.abs() < 2e-6, "{off:e}");
            let backwards = [ring[3], ring[2], ring[1], ring[0]];
            assert!((ground.signed_area(&backwards) / expected + 1.0).abs() < 2e-6);
        }
    }

    #[test]
    fn lengths_and_triangles_are_those_on_the_ellipsoid() {
        let utm: Projection = "+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m".parse().unwrap();
        let bounds = Rect::new(dvec2(-5e5, 5e6), dvec2(5e5, 6e6));
        let ground = Ground::new(Some(&utm), &bounds);
        let mut random = fastrand::Rng::with_seed(1);
        for _ in 0..200 {
            let mut point = || bounds.min + dvec2(random.f64(), random.f64()) * bounds.size();
            let (a, b, c) = (point(), point(), point());
            let expected = EarthPlane::Projected(utm).length(&[a, b]);
            assert!((ground.length([a, b]) / expected - 1.0).abs() < 1e-9);
            let corners = [a, a.lerp(b, 0.02), a.lerp(c, 0.02)];
            let area = ground.signed_area(&corners).abs();
            assert!((ground.triangle_area(corners) / area - 1.0).abs() < 1e-5, "{area}");
            let near = ground.longest(1e4, a);
            assert!(near >= ground.length([a, a + dvec2(6e3, 8e3)]) && near < 1e4 * 1.01);
        }
        let plain = Ground::default();
        let ring = [dvec2(1.0, 1.0), dvec2(3.0, 1.0), dvec2(1.0, 2.0)];
        assert_eq!((plain.signed_area(&ring), plain.triangle_area(ring)), (1.0, 1.0));
        assert_eq!((plain.length([ring[0], ring[1]]), plain.longest(2.0, ring[0])), (2.0, 2.0));
    }
}

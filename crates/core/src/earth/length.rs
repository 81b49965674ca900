//! Lengths on the ellipsoid of lines in a plane.

use glam::DVec2;

use super::EarthPlane;
use super::ellipsoid::Latitude;
use crate::text::LengthUnit;

/// Places of Gauss's rule with five points on a piece, as shares of its half from the middle, and weights.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];
/// A piece is halved until both halves together differ from it by less than this share.
const ACCURACY: f64 = 1e-12;
/// Most halvings of a piece.
const MOST_HALVINGS: u32 = 12;

/// Returns the length of a line in metres: on the ellipsoid where it lies in a plane on the Earth, else from
/// its unit. `None` where neither is known.
pub fn metres_along(plane: Option<EarthPlane>, unit: LengthUnit, line: &[DVec2]) -> Option<f64> {
    let plain = || line.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    match (plane, unit) {
        (Some(plane), _) => Some(plane.length(line)),
        (None, LengthUnit::Metre) => Some(plain()),
        (None, LengthUnit::Kilometre) => Some(1000.0 * plain()),
        (None, LengthUnit::None | LengthUnit::Degree) => None,
    }
}

impl EarthPlane {
    /// Returns the distance from the first point of a line to each of its points along it, in metres on the
    /// ellipsoid, to about 10⁻¹⁰ of it: in the plane of a projection, the integral of ds / k.
    pub fn distances(self, line: &[DVec2]) -> Vec<f64> {
        let mut distance = 0.0;
        let mut distances = Vec::with_capacity(line.len());
        for (n, &to) in line.iter().enumerate() {
            if let Some(before) = n.checked_sub(1) {
                let piece = [line[before], to];
                distance += self.halved(piece, self.by_gauss(piece), MOST_HALVINGS);
            }
            distances.push(distance);
        }
        distances
    }

    /// Returns the length of a line in metres on the ellipsoid, as [`Self::distances`] does.
    pub fn length(self, line: &[DVec2]) -> f64 {
        self.distances(line).last().copied().unwrap_or(0.0)
    }

    fn halved(self, [from, to]: [DVec2; 2], whole: f64, halvings: u32) -> f64 {
        let middle = from.midpoint(to);
        let halves = [[from, middle], [middle, to]];
        let parts = halves.map(|half| self.by_gauss(half));
        let sum = parts[0] + parts[1];
        if halvings == 0 || (sum - whole).abs() <= ACCURACY * sum {
            return sum;
        }
        (0..2).map(|n| self.halved(halves[n], parts[n], halvings - 1)).sum()
    }

    fn by_gauss(self, [from, to]: [DVec2; 2]) -> f64 {
        let (middle, half) = (from.midpoint(to), 0.5 * (to - from));
        let rate = |at: DVec2| match self {
            Self::Degrees => metres_of_degrees(at.y, half),
            Self::Projected(projection) => half.length() / projection.scale_in_plane(at),
        };
        GAUSS.iter().map(|&(place, weight)| weight * rate(middle + place * half)).sum()
    }
}

/// Returns the length of a small step of degrees from a latitude.
fn metres_of_degrees(latitude: f64, step: DVec2) -> f64 {
    let [along_meridian, along_parallel] = Latitude::from_degrees(latitude).radii();
    libm::hypot(along_parallel * step.x.to_radians(), along_meridian * step.y.to_radians())
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, dvec2, dvec3};

    use super::*;
    use crate::earth::Projection;

    /// The place in space of a longitude and latitude on the ellipsoid, in metres.
    fn in_space(at: DVec2) -> DVec3 {
        let (a, e2) = (6_378_137.0, 6.694_379_990_141_317e-3);
        let [east, north] = at.to_array().map(f64::to_radians);
        let across = a / (1.0 - e2 * north.sin().powi(2)).sqrt();
        let on_equator = across * north.cos();
        dvec3(on_equator * east.cos(), on_equator * east.sin(), across * (1.0 - e2) * north.sin())
    }

    /// The length by many chords, and by twice as many: what is left falls by four.
    fn by_chords(plane: EarthPlane, [from, to]: [DVec2; 2]) -> f64 {
        let chords = |count: u32| {
            let place = |n: u32| in_space(plane.geographic(from.lerp(to, f64::from(n) / f64::from(count))));
            (0..count).map(|n| place(n).distance(place(n + 1))).sum::<f64>()
        };
        let (rough, fine) = (chords(2000), chords(4000));
        fine + (fine - rough) / 3.0
    }

    #[test]
    fn lengths_are_those_in_space() {
        let utm: Projection = "+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m".parse().unwrap();
        let planes = [
            (EarthPlane::Projected(utm), dvec2(-300e3, 6e6), dvec2(400e3, 7e6)),
            (EarthPlane::Projected(utm), dvec2(0.0, 0.0), dvec2(500e3, 10.0)),
            (EarthPlane::Degrees, dvec2(170.0, -50.0), dvec2(200.0, 20.0)),
            (EarthPlane::Degrees, dvec2(3.0, 60.0), dvec2(3.0, 61.0)),
        ];
        for (plane, from, to) in planes {
            let expected = by_chords(plane, [from, to]);
            let via = from.lerp(to, 0.3);
            let distances = plane.distances(&[from, via, via, to]);
            assert!((distances[3] / expected - 1.0).abs() < 1e-9, "{plane:?}: {distances:?} {expected}");
            assert_eq!((distances[0], distances[1]), (0.0, distances[2]));
            assert!((plane.length(&[to, from]) / expected - 1.0).abs() < 1e-9);
        }
        assert_eq!(EarthPlane::Degrees.length(&[]), 0.0);
        let line = [DVec2::ZERO, dvec2(3.0, 4.0)];
        assert_eq!(metres_along(None, LengthUnit::Kilometre, &line), Some(5000.0));
        assert_eq!(metres_along(None, LengthUnit::None, &line), None);
    }
}

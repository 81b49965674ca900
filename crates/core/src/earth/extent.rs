use glam::DVec2;

use super::{Coordinates, Projection, wrapped};
use crate::geometry::Rect;

/// Points along each side of a rectangle whose extent is found.
const POINTS_OF_SIDE: u32 = 64;

/// A part of the Earth between two meridians and two parallels, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeographicExtent {
    /// The western meridian, −180 to 180.
    pub west: f64,
    /// Degrees from there to the eastern meridian, 0 to 360.
    pub width: f64,
    /// The southern parallel.
    pub south: f64,
    /// The northern parallel.
    pub north: f64,
    /// The latitude of the pole that a ring goes around: 90 or −90.
    pub pole: Option<f64>,
}

impl GeographicExtent {
    /// Returns the extent of rings of longitudes and latitudes; `None` without corners.
    ///
    /// Longitudes may be from −180 to 180 or from 0 to 360. An edge goes the shorter way round the Earth. The
    /// extent leaves out the widest range of longitudes without corners.
    pub fn from_rings<'a>(rings: impl Iterator<Item = &'a [DVec2]> + Clone) -> Option<Self> {
        let corners = || rings.clone().flatten();
        let mut longitudes: Vec<f64> = corners().map(|corner| wrapped(corner.x)).collect();
        longitudes.sort_by(f64::total_cmp);
        let (&first, &last) = (longitudes.first()?, longitudes.last()?);
        let mut widest = [first + 360.0 - last, last, first];
        for pair in longitudes.windows(2) {
            if pair[1] - pair[0] > widest[0] {
                widest = [pair[1] - pair[0], pair[0], pair[1]];
            }
        }
        let latitudes = corners().map(|corner| corner.y);
        let (south, north) = (latitudes.clone().reduce(f64::min)?, latitudes.reduce(f64::max)?);
        let pole = rings.clone().find_map(pole_within);
        let goes_round = pole.is_some() || rings.clone().any(goes_along_a_parallel);
        let [gap, _, west] = widest;
        let width = if goes_round { 360.0 } else { 360.0 - gap };
        Some(Self { west, width, south, north, pole })
    }

    /// Returns the extent of a rectangle in the plane of a projection; `None` where the projection has no
    /// longitude and latitude for its sides.
    pub fn from_plane(projection: &Projection, area: Rect) -> Option<Self> {
        Self::from_rectangle(&Coordinates::Plane(*projection), area)
    }

    /// Returns the extent of rings in any coordinates; `None` without corners, and where the coordinates are
    /// of no place on the Earth.
    pub fn from_coordinates<'a>(
        coordinates: &Coordinates,
        rings: impl Iterator<Item = &'a [DVec2]> + Clone,
    ) -> Option<Self> {
        // Other geographic systems are shifted by less than a kilometre.
        if coordinates.are_degrees() {
            return Self::from_rings(rings);
        }
        Self::from_rectangle(coordinates, Rect::holding(rings.flatten().copied())?)
    }

    /// Returns the extent of a rectangle of coordinates.
    fn from_rectangle(coordinates: &Coordinates, area: Rect) -> Option<Self> {
        let Rect { min, max } = area;
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        let side = |n: usize| {
            let (from, to) = (corners[n], corners[(n + 1) % 4]);
            (0..POINTS_OF_SIDE).map(move |m| from.lerp(to, f64::from(m) / f64::from(POINTS_OF_SIDE)))
        };
        let places = (0..4).flat_map(side).map(|at| coordinates.to_geographic(at));
        let ring: Vec<DVec2> = places.filter(|at| at.is_finite()).collect();
        let extent = Self::from_rings([ring.as_slice()].into_iter())?;
        // The sides bulge between their points.
        let margin = (extent.north - extent.south).max(extent.width) / f64::from(POINTS_OF_SIDE);
        let [pole_south, pole_north] = [-90.0, 90.0].map(|pole| extent.pole == Some(pole));
        Some(Self {
            west: wrapped(extent.west - margin),
            width: (extent.width + 2.0 * margin).min(360.0),
            south: if pole_south { -90.0 } else { (extent.south - margin).max(-90.0) },
            north: if pole_north { 90.0 } else { (extent.north + margin).min(90.0) },
            pole: extent.pole,
        })
    }

    /// The meridian in the middle, −180 to 180.
    pub fn middle_longitude(&self) -> f64 {
        wrapped(self.west + 0.5 * self.width)
    }

    /// The parallel in the middle.
    pub fn middle_latitude(&self) -> f64 {
        0.5 * (self.south + self.north)
    }
}

fn edges(ring: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&from, &to)| (from, to))
}

/// Returns the pole that a ring goes around.
fn pole_within(ring: &[DVec2]) -> Option<f64> {
    let turn: f64 = edges(ring).map(|(from, to)| wrapped(to.x - from.x)).sum();
    let middle = ring.iter().map(|corner| corner.y).sum::<f64>();
    (turn.abs() > 180.0).then_some(90.0_f64.copysign(middle))
}

/// Returns whether a ring has an edge from −180° to 180° along a parallel, as rectangles around the whole
/// Earth have.
fn goes_along_a_parallel(ring: &[DVec2]) -> bool {
    edges(ring).any(|(from, to)| (to.x - from.x).abs() == 360.0 && from.y == to.y && from.y.abs() < 90.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    fn extent(corners: &[[f64; 2]]) -> GeographicExtent {
        let ring: Vec<DVec2> = corners.iter().map(|&corner| corner.into()).collect();
        GeographicExtent::from_rings([ring.as_slice()].into_iter()).unwrap()
    }

    #[test]
    fn an_extent_may_lie_over_the_antimeridian() {
        let pacific = extent(&[[170.0, -20.0], [-170.0, -20.0], [-175.0, -10.0]]);
        let same = extent(&[[170.0, -20.0], [190.0, -20.0], [185.0, -10.0]]);
        assert_eq!(pacific, same);
        assert_eq!((pacific.west, pacific.width, pacific.middle_longitude()), (170.0, 20.0, 180.0));
        let greenwich = extent(&[[-10.0, 50.0], [10.0, 50.0], [355.0, 60.0]]);
        assert_eq!((greenwich.west, greenwich.width, greenwich.pole), (-10.0, 20.0, None));
    }

    #[test]
    fn a_rectangle_around_a_pole_ends_there() {
        let rect = Rect::new(DVec2::splat(-1e6), DVec2::splat(1e6));
        for pole in [-90.0, 90.0] {
            let text = format!(
                "+proj=stere +lat_0={pole} +lat_ts={} +lon_0=0 +ellps=WGS84 +units=m",
                pole / 90.0 * 70.0
            );
            let projection = text.parse::<Projection>().unwrap();
            let extent = GeographicExtent::from_rectangle(&Coordinates::Plane(projection), rect).unwrap();
            assert_eq!((extent.pole, extent.width), (Some(pole), 360.0));
            let ends = [extent.south, extent.north];
            assert!(ends.contains(&pole) && ends.iter().all(|end| end.signum() == pole.signum()), "{ends:?}");
            assert!(ends.iter().any(|end| (70.0..85.0).contains(&end.abs())), "{ends:?}");
            // Beside the pole, the margin does not reach beyond it.
            let beside = Rect::new(DVec2::new(1e3, -1e6), DVec2::splat(1e6));
            let extent = GeographicExtent::from_rectangle(&Coordinates::Plane(projection), beside).unwrap();
            assert!(extent.pole.is_none() && [extent.south, extent.north].contains(&pole), "{extent:?}");
        }
    }

    #[test]
    fn the_extent_of_a_rectangle_in_a_plane_contains_its_points() {
        use super::super::ProjectionChoice;
        let mut random = fastrand::Rng::with_seed(8);
        for _ in 0..200 {
            let south = -85.0 + 160.0 * random.f64();
            let west = 360.0 * random.f64() - 180.0;
            let (width, height) = (0.1 + 40.0 * random.f64(), 0.1 + 9.0 * random.f64());
            let place = GeographicExtent { west, width, south, north: south + height, pole: None };
            let Ok(projection) = ProjectionChoice::Automatic.projection(&place) else { continue };
            let corner = |east: f64, up: f64| {
                projection.plane_from_geographic(dvec2(west + east * width, south + up * height))
            };
            let area = Rect::new(corner(0.0, 0.0), corner(0.0, 0.0))
                .union(&Rect::new(corner(1.0, 1.0), corner(1.0, 1.0)));
            let found = GeographicExtent::from_plane(&projection, area).unwrap();
            for _ in 0..200 {
                let share = dvec2(random.f64(), random.f64());
                let at = projection.geographic_from_plane(area.min + share * area.size());
                let east = (at.x - found.west).rem_euclid(360.0);
                assert!(east <= found.width && found.south <= at.y && at.y <= found.north, "{at} {found:?}");
            }
        }
    }

    #[test]
    fn a_ring_around_a_pole_is_recognised() {
        let around: Vec<DVec2> = (0..36).map(|n| dvec2(wrapped(10.0 * f64::from(n)), -65.0)).collect();
        let found = GeographicExtent::from_rings([around.as_slice()].into_iter()).unwrap();
        assert_eq!((found.pole, found.width), (Some(-90.0), 360.0));
        // As files have it: along the edge of a map in degrees.
        let mut cut: Vec<DVec2> = (-18..=18).map(|n| dvec2(10.0 * f64::from(n), -65.0)).collect();
        cut.extend([dvec2(180.0, -90.0), dvec2(-180.0, -90.0)]);
        let found = GeographicExtent::from_rings([cut.as_slice()].into_iter()).unwrap();
        assert_eq!((found.pole, found.width, found.south), (Some(-90.0), 360.0, -90.0));
        let globe = extent(&[[-180.0, -75.0], [180.0, -75.0], [180.0, 75.0], [-180.0, 75.0]]);
        assert_eq!((globe.pole, globe.width), (None, 360.0));
    }
}

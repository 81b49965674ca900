use glam::{DVec2, dvec2};

use super::Projection;

/// Half the length of the piece of a meridian that gives its direction, in degrees: 11 m.
const HALF_PIECE: f64 = 1e-4;

impl Projection {
    /// Returns the direction to the north at a point in the plane, as a vector of length 1: that of the
    /// meridian there. There is none at a pole.
    pub fn north_at(&self, at: DVec2) -> Option<DVec2> {
        let place = self.geographic_from_plane(at);
        if place.is_nan() || place.y.abs() > 90.0 - 10.0 * HALF_PIECE {
            return None;
        }
        let end = |up: f64| self.plane_from_geographic(place + dvec2(0.0, up * HALF_PIECE));
        (end(1.0) - end(-1.0)).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a conformal plane the latitude grows fastest to the north.
    #[test]
    fn north_is_where_the_latitude_grows() {
        let mut random = fastrand::Rng::with_seed(3);
        for text in [
            "+proj=merc +lon_0=20",
            "+proj=tmerc +lon_0=15 +k_0=0.9996",
            "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45",
            "+proj=stere +lat_0=-90 +lat_ts=-71 +lon_0=0",
            "+proj=lcc +lat_1=40 +lat_2=60 +lat_0=50 +lon_0=10",
        ] {
            let projection: Projection = text.parse().unwrap();
            let south = if text.contains("lat_0=-90") { -80.0 } else { 35.0 };
            for _ in 0..50 {
                let longitude = projection.central_meridian + 50.0 * (random.f64() - 0.5);
                let at = projection.plane_from_geographic(dvec2(longitude, south + 30.0 * random.f64()));
                let north = projection.north_at(at).unwrap();
                let growth = |along: DVec2| {
                    let latitude = |by: f64| projection.geographic_from_plane(at + by * along).y;
                    latitude(10.0) - latitude(-10.0)
                };
                let expected = dvec2(growth(DVec2::X), growth(DVec2::Y)).normalize();
                assert!(north.distance(expected) < 1e-5, "{text} at {at}: {north}, {expected}");
            }
        }
    }

    #[test]
    fn far_from_the_central_meridian_of_a_pole_north_is_turned_and_at_the_pole_there_is_none() {
        let arctic: Projection = "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=0".parse().unwrap();
        for (longitude, north) in
            [(0.0, dvec2(0.0, 1.0)), (90.0, dvec2(-1.0, 0.0)), (180.0, dvec2(0.0, -1.0))]
        {
            let at = arctic.plane_from_geographic(dvec2(longitude, 75.0));
            assert!(arctic.north_at(at).unwrap().distance(north) < 1e-6, "{longitude}");
        }
        assert_eq!(arctic.north_at(DVec2::ZERO), None);
        assert_eq!(arctic.north_at(DVec2::NAN), None);
    }
}

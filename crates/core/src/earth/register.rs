//! Codes of the EPSG register that are known here.

use glam::dvec2;

use super::{Coordinates, Parameters, Projection, geographic};

/// Returns the system of a code: longitudes and latitudes of any geographic system, the UTM zones, national
/// grids with a conformal projection, and systems of the oceans and the poles.
pub(super) fn coordinates(code: u32) -> Option<Coordinates> {
    match code {
        3857 | 900_913 => Some(Coordinates::WebMercator),
        _ => projection(code).map(Coordinates::Plane).or_else(|| geographic::of_code(code)),
    }
}

fn projection(code: u32) -> Option<Projection> {
    Some(match code {
        32601..=32660 => utm(code - 32600, 0.0),
        32701..=32760 => utm(code - 32700, 10_000_000.0),
        // UTM on ETRS89, NAD83 and GDA2020.
        25828..=25838 => utm(code - 25800, 0.0),
        26901..=26923 => utm(code - 26900, 0.0),
        7846..=7859 => utm(code - 7800, 10_000_000.0),
        // Finland, Sweden, New Zealand.
        3067 => transverse(27.0, [500_000.0, 0.0]),
        3006 => transverse(15.0, [500_000.0, 0.0]),
        2193 => transverse(173.0, [1_600_000.0, 10_000_000.0]),
        // The oceans and the poles.
        3395 => Projection::new(0.0, Parameters::Mercator { true_latitude: 0.0 }),
        3413 => polar(-45.0, 70.0),
        3031 => polar(0.0, -71.0),
        3995 => polar(0.0, 71.0),
        // Europe, France.
        3034 => lambert([10.0, 52.0], [35.0, 65.0], [4_000_000.0, 2_800_000.0]),
        2154 => lambert([3.0, 46.5], [49.0, 44.0], [700_000.0, 6_600_000.0]),
        _ => return None,
    })
}

fn utm(zone: u32, north: f64) -> Projection {
    transverse(6.0 * f64::from(zone) - 183.0, [500_000.0, north])
}

fn transverse(meridian: f64, origin: [f64; 2]) -> Projection {
    Projection::new(meridian, Parameters::TransverseMercator { scale: 0.9996 }).with_origin(origin.into())
}

fn polar(meridian: f64, true_latitude: f64) -> Projection {
    Projection::new(meridian, Parameters::PolarStereographic { true_latitude })
}

fn lambert([meridian, latitude]: [f64; 2], parallels: [f64; 2], [x, y]: [f64; 2]) -> Projection {
    Projection::new(meridian, Parameters::Lambert { origin: latitude, parallels }).with_origin(dvec2(x, y))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of PROJ for the codes of the register, at one place each. Ellipsoids differ by 0.1 mm.
    #[test]
    fn coordinates_are_those_of_the_register() {
        for (code, geographic, plane) in [
            (32633, [18.0, 45.5], [734_378.661_479, 5_042_875.017_344]),
            (32733, [12.0, -33.9], [222_584.016_482, 6_244_878.757_064]),
            (25833, [15.0, 60.0], [500_000.0, 6_651_411.190_24]),
            (26918, [-74.006, 40.7128], [583_959.372_325, 4_507_350.998_128]),
            (7856, [151.2, -33.85], [333_471.814_853, 6_253_018.169_389]),
            (3067, [24.94, 60.17], [385_700.421_385, 6_672_126.743_011]),
            (3006, [18.07, 59.33], [674_647.882_135, 6_580_824.575_593]),
            (2193, [174.76, -36.85], [1_756_911.944_85, 5_920_321.818_19]),
            (3395, [12.5, 41.9], [1_391_493.634_916, 5_117_468.353_526]),
            (3857, [12.5, 41.9], [1_391_493.634_916, 5_146_011.679_283]),
            (3413, [15.6, 78.2], [1_117_433.721_86, -629_641.543_184]),
            (3031, [166.7, -77.85], [304_792.096_544, -1_289_361.303_218]),
            (3995, [33.0, 80.0], [593_209.647_67, -913_462.752_644]),
            (3034, [24.94, 60.17], [4_806_909.632_289, 3_764_951.245_298]),
            (2154, [-1.5, 48.6], [368_371.866_931, 6_842_762.998_312]),
        ] {
            let system = coordinates(code).unwrap();
            let at = system.from_geographic(geographic.into());
            assert!(at.distance(plane.into()) < 2e-4, "{code}: {at}");
            assert!(system.to_geographic(at).distance(geographic.into()) < 1e-10, "{code}");
            let Some(projection) = system.projection() else { continue };
            assert_eq!(projection.to_string().parse(), Ok(projection), "{projection}");
        }
        for code in [3035, 32661, 27700, 0] {
            assert_eq!(coordinates(code), None, "{code}");
        }
    }

    #[test]
    fn a_system_is_named_by_its_code_or_as_proj_does() {
        assert_eq!("epsg: 4326".parse(), Ok(Coordinates::Geographic));
        assert_eq!("lonlat".parse(), Ok(Coordinates::Geographic));
        let utm: Coordinates = "EPSG:32633".parse().unwrap();
        assert_eq!("+proj=tmerc +lon_0=15 +k_0=0.9996 +x_0=500000 +ellps=WGS84 +units=m".parse(), Ok(utm));
        for text in ["EPSG:27700", "EPSG:", "merc", "", "+proj=laea"] {
            let error = text.parse::<Coordinates>().unwrap_err().to_string();
            assert!(error.contains(&format!("“{text}”")) && error.contains("EPSG:32633"), "{error}");
        }
    }
}

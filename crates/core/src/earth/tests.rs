//! Reference values: 40-digit evaluations of the closed formulas, which PROJ confirms.

use super::*;

/// A projection, with longitude and latitude, x and y, and k of some points.
type Reference = (&'static str, &'static [[f64; 5]]);

const REFERENCES: [Reference; 6] = [
    (
        "+proj=merc +lon_0=0 +lat_ts=0",
        &[
            [12.5, 41.9, 1_391_493.634_915_92, 5_117_468.353_525_54, 1.341_516_252_537],
            [-74.006, 40.7128, -8_238_310.235_647_004, 4_942_194.778_102_55, 1.317_400_898_782],
            [179.9, -17.5, 20_026_376.393_709_916, -1_966_264.470_265_127, 1.048_211_722_739],
            [25.0, 70.0, 2_782_987.269_831_839, 11_028_513.630_920_078, 2.915_149_868_919],
            [0.0, 0.0, 0.0, 0.0, 1.0],
        ],
    ),
    (
        "+proj=merc +lon_0=20 +lat_ts=60",
        &[
            [20.0, 60.0, 0.0, 4_191_885.794_938_864, 1.0],
            [22.25, 60.45, 125_550.003_537_981, 4_242_367.136_586_362, 1.013_799_566_562],
            [17.0, 59.0, -167_400.004_717_308, 4_082_124.456_915_174, 0.970_851_862_664],
            [30.0, 65.5, 558_000.015_724_361, 4_863_423.513_369_851, 1.205_393_969_746],
            [10.0, 54.0, -558_000.015_724_361, 3_576_771.683_473_058, 0.850_924_028_463],
        ],
    ),
    (
        "+proj=tmerc +lat_0=0 +lon_0=15 +k_0=0.9996",
        &[
            [15.0, 60.0, 0.0, 6_651_411.190_362_716, 0.9996],
            [18.0, 45.5, 234_378.661_479_27, 5_042_875.017_343_63, 1.000_275_447_689],
            [12.0, -33.9, -277_415.983_517_909, -3_755_121.242_936_467, 1.000_548_837_712],
            [25.0, 72.0, 343_485.984_498_813, 8_017_526.696_051_309, 1.001_043_129_308],
        ],
    ),
    (
        "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45",
        &[
            [-45.0, 70.0, 0.0, -2_187_927.649_279_021, 1.0],
            [15.6, 78.2, 1_117_433.721_859_591, -629_641.543_184_092, 0.980_213_971_470],
            [-156.8, 71.3, -1_897_054.088_194_474, 758_767.501_084_177, 0.996_142_119_909],
            [179.99, 60.0, -2_349_419.003_994_69, 2_350_239.249_105_37, 1.039_428_076_339],
            [33.0, 90.0, 0.0, 0.0, 0.969_858_190_326],
        ],
    ),
    (
        "+proj=stere +lat_0=-90 +lat_ts=-71 +lon_0=0",
        &[
            [0.0, -71.0, 0.0, 2_082_760.108_542_913, 1.0],
            [166.7, -77.85, 304_792.096_543_694, -1_289_361.303_217_76, 0.983_785_800_023],
            [-60.0, -62.0, -2_686_281.161_173_979, 1_550_925.151_522_817, 1.033_193_010_961],
            [180.0, -60.0, 0.0, -3_333_134.027_630_276, 1.042_547_698_084],
        ],
    ),
    (
        "+proj=lcc +lat_1=35 +lat_2=65 +lat_0=52 +lon_0=10",
        &[
            [10.0, 52.0, 0.0, 0.0, 0.965_821_648_623],
            [-9.14, 38.72, -1_622_820.783_847_485, -1_223_047.541_245_644, 0.985_921_607_133],
            [24.94, 60.17, 806_909.632_279_252, 964_951.245_295_482, 0.979_577_430_024],
            [31.2, 46.5, 1_554_266.855_449_153, -366_594.331_515_121, 0.968_309_923_632],
            [5.3, 60.4, -253_816.339_214_181, 916_287.452_962_82, 0.980_315_216_694],
        ],
    ),
];

#[test]
fn projections_have_the_values_of_the_closed_formulas() {
    for (text, points) in REFERENCES {
        let projection: Projection = text.parse().unwrap();
        for &[longitude, latitude, x, y, scale] in points {
            let at = dvec2(longitude, latitude);
            // Two nanometres, or two steps between numbers of that size.
            let tolerance = 2e-9_f64.max(2.0 * f64::EPSILON * x.abs().max(y.abs()));
            let found = projection.plane_from_geographic(at);
            assert!((found - dvec2(x, y)).abs().max_element() <= tolerance, "{text}: {at} is at {found}");
            let found = projection.scale_at(at);
            assert!((found - scale).abs() < 1e-9, "{text}: the scale at {at} is {found}");
        }
    }
}

#[test]
fn the_way_back_leads_to_the_same_place() {
    let mut random = fastrand::Rng::with_seed(1);
    for (text, _) in REFERENCES {
        let projection: Projection = text.parse().unwrap();
        for _ in 0..2000 {
            let (low, high) = match projection.kind() {
                ProjectionKind::PolarStereographic if text.contains("-90") => (-90.0, -20.0),
                ProjectionKind::PolarStereographic => (20.0, 90.0),
                ProjectionKind::Lambert => (-20.0, 89.0),
                _ => (-84.0, 84.0),
            };
            let width = if projection.kind() == ProjectionKind::TransverseMercator { 35.0 } else { 179.0 };
            let east = width * (2.0 * random.f64() - 1.0);
            let at = dvec2(wrapped(projection.central_meridian + east), low + (high - low) * random.f64());
            let back = projection.geographic_from_plane(projection.plane_from_geographic(at));
            let off = (back - at) * dvec2(at.y.to_radians().cos(), 1.0);
            assert!(off.length() < 1e-10, "{text}: {at} comes back as {back}");
        }
    }
}

/// Angles are kept: small steps to the east and to the north have the same length, at a right angle, and it
/// is the scale times that on the ellipsoid.
#[test]
fn the_scale_is_the_same_in_every_direction() {
    for (text, points) in REFERENCES {
        let projection: Projection = text.parse().unwrap();
        for &[longitude, latitude, ..] in points.iter().filter(|point| point[1].abs() < 89.0) {
            let at = dvec2(longitude, latitude);
            let step = 1e-5_f64;
            let along = |by: DVec2| {
                (projection.plane_from_geographic(at + by) - projection.plane_from_geographic(at - by))
                    / (2.0 * step.to_radians())
            };
            let here = Latitude::from_degrees(latitude);
            let e2 = ellipsoid::eccentricity().powi(2);
            let meridian = A * (1.0 - e2) / here.flattened.powi(3);
            let east = along(dvec2(step, 0.0)) / (A * here.parallel());
            let north = along(dvec2(0.0, step)) / meridian;
            let scale = projection.scale_at(at);
            assert!((east.length() - scale).abs() < 1e-7, "{text}: {at}");
            assert!((north.length() - scale).abs() < 1e-7, "{text}: {at}");
            assert!(east.dot(north).abs() < 1e-7 && east.perp_dot(north) > 0.0, "{text}: {at}");
        }
    }
}

#[test]
fn a_projection_is_written_as_it_is_read() {
    for (text, _) in REFERENCES {
        let projection: Projection = text.parse().unwrap();
        assert_eq!(projection.to_string().parse::<Projection>(), Ok(projection), "{projection}");
    }
    for (text, problem) in [
        ("+proj=laea +lat_0=52", "keep angles"),
        ("+proj=merc +lat_ts=89", "lat_ts is from -85 to 85"),
        ("+proj=stere +lat_0=45", "lat_0 is 90 or -90"),
        ("+proj=lcc +lat_1=30 +lat_2=-30", "opposite sides"),
        ("+proj=tmerc +lon_0=nan", "finite"),
        ("+proj=tmerc +ellps=bessel", "“+ellps=bessel” is not known"),
        ("lon_0=3", "no +proj"),
        ("", "no +proj"),
    ] {
        let error = text.parse::<Projection>().unwrap_err().to_string();
        assert!(error.contains(problem), "{error}");
    }
}

use glam::dvec2;

use super::*;
use crate::domain::{BoundaryKind, BoundaryMarks, BoundaryPieces, Domain};

/// Hills and basins over 20 × 14 pixels, with some pixels that have no value.
fn raster(random: &mut fastrand::Rng, gaps: bool, bounds: Rect) -> Raster {
    let waves: Vec<[f64; 4]> = (0..6).map(|_| [0, 1, 2, 3].map(|_| 2.0 * random.f64() - 1.0)).collect();
    let mut raster = Raster::filled(bounds, [20, 14], 0.0);
    for (x, y) in raster.all().pixels() {
        let [u, v] = [f64::from(x), f64::from(y)];
        let height: f64 = waves.iter().map(|[a, b, c, d]| 9.0 * a * (b * u + c * v + 3.0 * d).sin()).sum();
        // Whole metres: many heights are exactly 0.
        let is_gap = gaps && random.u8(..12) == 0;
        raster.set(x, y, if is_gap { f32::NAN } else { height.round() as f32 });
    }
    raster
}

fn is_inside(polygons: &[Polygon], at: DVec2) -> bool {
    let edges = polygons
        .iter()
        .flatten()
        .flat_map(|ring| (0..ring.len()).map(move |n| (ring[n], ring[(n + 1) % ring.len()])));
    let crossings = edges.filter(|(a, b)| {
        (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossings.count() % 2 == 1
}

fn center(raster: &Raster, x: u32, y: u32) -> DVec2 {
    raster.bounds().min + dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5) * raster.pixel_size()
}

const BOUNDS: Rect = Rect { min: dvec2(100.0, -40.0), max: dvec2(140.0, 16.0) };

#[test]
fn centres_are_inside_where_they_are_deep_and_the_outline_is_where_the_depth_is_that_of_the_level() {
    let mut random = fastrand::Rng::with_seed(1);
    let (mut between, mut at_gaps) = (0, 0);
    for round in 0..60 {
        let raster = raster(&mut random, round % 2 == 0, BOUNDS);
        let contour = DepthContour { level: [0.0, 2.5, -3.0][round % 3], ..DepthContour::SHORE };
        let Ok(polygons) = contour.polygons(&raster, PixelLengths::Plane, |height| -height) else { continue };
        let depth = |x: u32, y: u32| -f64::from(raster.get(x, y));
        for (x, y) in raster.all().pixels() {
            let is_deep = depth(x, y) > contour.level;
            assert_eq!(is_inside(&polygons, center(&raster, x, y)), is_deep, "round {round}: {x}, {y}");
            for (u, v) in [(x + 1, y), (x, y + 1)] {
                if u > 19 || v > 13 || is_deep == (depth(u, v) > contour.level) {
                    continue;
                }
                let (here, there) = (center(&raster, x, y), center(&raster, u, v));
                let share = match depth(x, y).is_nan() || depth(u, v).is_nan() {
                    true => 0.5,
                    false => {
                        ((depth(x, y) - contour.level) / (depth(x, y) - depth(u, v))).clamp(0.001, 0.999)
                    }
                };
                at_gaps += usize::from(share == 0.5);
                between += 1;
                for (step, expected) in [(-2e-4, is_deep), (2e-4, !is_deep)] {
                    let at = here.lerp(there, share + step);
                    // A hair beside the line, which corners of the outline lie on.
                    let at = at + 1e-9 * (there - here).perp();
                    assert_eq!(is_inside(&polygons, at), expected, "round {round}: {x}, {y} to {u}, {v}");
                }
            }
        }
        // Rings neither touch themselves nor others, and run with the water on their left.
        let mut points: Vec<DVec2> = polygons.iter().flatten().flatten().copied().collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        assert!(points.windows(2).all(|pair| pair[0].distance(pair[1]) > 1e-4), "round {round}");
        for polygon in &polygons {
            assert!(
                signed_area(&polygon[0]) > 0.0 && polygon[1..].iter().all(|hole| signed_area(hole) < 0.0)
            );
            assert!(polygon[1..].iter().all(|hole| is_inside(&[vec![polygon[0].clone()]], hole[0])));
        }
        assert!(polygons.windows(2).all(|pair| signed_area(&pair[0][0]) >= signed_area(&pair[1][0])));
        assert!(Domain::of_polygons(&polygons).is_ok());
    }
    assert!(between > 2000 && at_gaps > 300, "{between} {at_gaps}");
}

#[test]
fn the_sides_of_the_raster_are_open_and_islands_have_numbers() {
    let mut raster = Raster::filled(Rect::UNIT, [8, 8], 20.0);
    for (x, y) in [(3, 3), (5, 5), (5, 6)] {
        raster.set(x, y, -10.0);
    }
    let polygons = DepthContour::SHORE.polygons(&raster, PixelLengths::Plane, |depth| depth).unwrap();
    assert_eq!((polygons.len(), polygons[0].len(), polygons[0][0].len()), (1, 3, 4));
    let domain = Domain::of_polygons(&polygons).unwrap();
    assert_eq!(domain.bounds, Rect::UNIT);
    let pieces = BoundaryPieces::of_domain(&domain, &BoundaryMarks::default()).unwrap();
    let names: Vec<&str> = pieces.list().iter().map(|piece| piece.name.as_str()).collect();
    assert_eq!(names, ["open south", "open east", "open north", "open west", "island 1", "island 2"]);
    assert!(pieces.list()[4..].iter().all(|piece| piece.kind == BoundaryKind::Island));
    // The larger island has the lower number. The shore is a third of the way from land to water.
    let [large, small] = [&polygons[0][1], &polygons[0][2]].map(|ring| -signed_area(ring) * 64.0);
    assert!((small - 2.0 / 9.0).abs() < 1e-12 && large > 2.0 * small, "{large} {small}");
}

#[test]
fn water_meets_at_a_corner_where_the_mean_is_deep() {
    for (heights, waters) in
        [([-9.0, 1.0, 1.0, -9.0], 1), ([-1.0, 9.0, 9.0, -1.0], 2), ([-9.0, f32::NAN, 1.0, -9.0], 2)]
    {
        let raster = Raster::from_values(Rect::UNIT, [2, 2], heights.to_vec());
        let polygons = DepthContour::SHORE.polygons(&raster, PixelLengths::Plane, |height| -height).unwrap();
        assert_eq!(polygons.len(), waters, "{heights:?}");
    }
}

#[test]
fn islands_and_waters_are_left_out_by_their_area() {
    let mut random = fastrand::Rng::with_seed(4);
    let (mut fewer, degrees) = (0, Rect::new(dvec2(-10.0, 40.0), dvec2(0.0, 47.0)));
    for round in 0..40 {
        let (bounds, lengths) = [(BOUNDS, PixelLengths::Plane), (degrees, PixelLengths::Degrees)][round % 2];
        let raster = raster(&mut random, false, bounds);
        let of = |contour: DepthContour| contour.polygons(&raster, lengths, |height| -height);
        let all = of(DepthContour::SHORE).unwrap();
        let rings: Vec<&Ring> = all.iter().flatten().collect();
        let median = rings.iter().map(|ring| lengths.area(ring).abs()).sum::<f64>() / rings.len() as f64;
        let large = of(DepthContour { smallest_island: median, ..DepthContour::SHORE }).unwrap();
        let kept: Vec<&Ring> = large.iter().flatten().collect();
        // Rings within one that is left out are smaller still.
        let expected = rings.iter().filter(|ring| lengths.area(ring).abs() >= median).count();
        assert_eq!(kept.len(), expected, "round {round}");
        assert!(kept.iter().all(|ring| rings.contains(ring)), "others stay as they are");
        fewer += usize::from(kept.len() < rings.len());
    }
    assert!(fewer > 20, "{fewer}");
    // A square of a degree at 45° N has 8,743 km² on a sphere.
    let square = vec![dvec2(0.0, 44.5), dvec2(1.0, 44.5), dvec2(1.0, 45.5), dvec2(0.0, 45.5)];
    let area = PixelLengths::Degrees.area(&square);
    assert!((area / 8.743e9 - 1.0).abs() < 2e-3, "{area}");
}

/// The definition, by looking at all pairs of centres.
fn opened(
    raster: &Raster,
    lengths: PixelLengths,
    width: f64,
    is_water: impl Fn(u32, u32) -> bool,
) -> Vec<bool> {
    let pixels: Vec<(u32, u32)> = raster.all().pixels().collect();
    let distance = |from: (u32, u32), to: (u32, u32)| {
        // Lengths along a row are those of the row of the first.
        let pixel = lengths.pixel(raster, from.1);
        let steps = dvec2(f64::from(from.0.abs_diff(to.0)), f64::from(from.1.abs_diff(to.1)));
        (steps * pixel).length()
    };
    let radius = |at: (u32, u32)| 0.5 * (width + lengths.pixel(raster, at.1).max_element());
    let fits = |at: (u32, u32)| {
        let land = pixels.iter().filter(|&&(x, y)| !is_water(x, y));
        is_water(at.0, at.1) && land.into_iter().all(|&land| distance(at, land) >= radius(at) * (1.0 - 1e-6))
    };
    let middles: Vec<(u32, u32)> = pixels.iter().copied().filter(|&at| fits(at)).collect();
    let is_near = |at: (u32, u32)| middles.iter().any(|&to| distance(at, to) < radius(at) * (1.0 - 1e-6));
    pixels.iter().map(|&at| is_water(at.0, at.1) && is_near(at)).collect()
}

#[test]
fn inlets_that_are_closed_are_those_of_the_definition() {
    let mut random = fastrand::Rng::with_seed(7);
    let (mut closed, degrees) = (0, Rect::new(dvec2(5.0, 55.0), dvec2(7.0, 56.0)));
    for round in 0..60 {
        let (bounds, lengths, side) =
            [(BOUNDS, PixelLengths::Plane, 4.0), (degrees, PixelLengths::Degrees, 8000.0)][round % 2];
        let raster = raster(&mut random, round % 3 == 0, bounds);
        let width = side * (0.3 + 2.0 * random.f64());
        let water = |x: u32, y: u32| -raster.get(x, y) > 0.0;
        let expected = opened(&raster, lengths, width, water);
        let mut found: Vec<bool> = raster.all().pixels().map(|(x, y)| water(x, y)).collect();
        let before = found.clone();
        opening::open(&mut found, &raster, lengths, width);
        assert_eq!(found, expected, "round {round}");
        closed += usize::from(found != before);
        let contour = DepthContour { smallest_inlet: width, ..DepthContour::SHORE };
        match contour.polygons(&raster, lengths, |height| -height) {
            Ok(polygons) => {
                for ((x, y), stays) in raster.all().pixels().zip(expected) {
                    assert_eq!(is_inside(&polygons, center(&raster, x, y)), stays, "round {round}");
                }
            }
            Err(error) => assert!(!expected.contains(&true), "{error}"),
        }
    }
    assert!(closed > 30, "{closed}");
}

#[test]
fn a_channel_is_closed_by_its_width() {
    // Two basins with a channel of three pixels of 10 m between them.
    let mut raster = Raster::filled(Rect::new(DVec2::ZERO, dvec2(300.0, 110.0)), [30, 11], -5.0);
    for (x, y) in raster.all().pixels() {
        if (10..20).contains(&x) && !(4..7).contains(&y) {
            raster.set(x, y, 5.0);
        }
    }
    for (smallest_inlet, waters) in [(0.0, 1), (25.0, 1), (30.0, 1), (31.0, 2)] {
        let contour = DepthContour { smallest_inlet, ..DepthContour::SHORE };
        let polygons = contour.polygons(&raster, PixelLengths::Plane, |height| -height).unwrap();
        assert_eq!(polygons.len(), waters, "{smallest_inlet}");
    }
}

#[test]
fn water_that_is_not_there_is_refused_with_a_sentence() {
    let raster = Raster::filled(Rect::UNIT, [3, 3], 7.0);
    let of = |contour: DepthContour| {
        contour.polygons(&raster, PixelLengths::Plane, |height| -height).unwrap_err().to_string()
    };
    assert!(of(DepthContour::SHORE).contains("the greatest depth is -7 m"), "{}", of(DepthContour::SHORE));
    let nan = of(DepthContour { level: f64::NAN, ..DepthContour::SHORE });
    assert!(nan.contains("level of the contour is NaN"), "{nan}");
    let high = of(DepthContour { level: -9.0, smallest_island: 2.0, ..DepthContour::SHORE });
    assert!(high.contains("Choose smaller ones"), "{high}");
}

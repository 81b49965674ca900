use std::f64::consts::{PI, TAU};

use glam::{DVec2, dvec2};

use super::*;
use crate::domain::Polygon;

fn bounds(reach: f64) -> Rect {
    Rect::new(DVec2::splat(-reach), DVec2::splat(reach))
}

fn traced(formula: &str, bounds: Rect) -> Arc<Region> {
    ZeroLineTracer::new(Formula::parse(formula).unwrap(), bounds).finish().unwrap()
}

/// Returns the largest value of a function that is a distance from the line, over all corners and the middles
/// of all edges.
fn farthest(region: &Region, distance: impl Fn(DVec2) -> f64) -> f64 {
    let places = region.edges().flat_map(|[a, b]| [a, 0.5 * (a + b)]);
    places.map(|at| distance(at).abs()).fold(0.0, f64::max)
}

/// Returns the largest distance from a place to the nearest corner of the polygons.
fn farthest_from_corners(region: &Region, places: &[DVec2]) -> f64 {
    let corners: Vec<DVec2> = region.rings().flatten().copied().collect();
    let nearest = |at: &DVec2| corners.iter().map(|p| p.distance(*at)).fold(f64::INFINITY, f64::min);
    places.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_disc_is_followed_to_a_few_steps_of_the_grid() {
    let region = traced("x^2 + y^2 < 0.2", bounds(0.5));
    let off = farthest(&region, |p| p.length() - 0.2_f64.sqrt());
    assert!(off < 1.5e-9, "{off}");
    assert!((region.area() - 0.2 * PI).abs() < 1e-8, "{}", region.area());
    assert!((1_000..150_000).contains(&region.corner_count()), "{}", region.corner_count());
}

#[test]
fn corners_of_straight_and_curved_sides_are_single_points() {
    let diamond = traced("abs(x) + abs(y) < 0.4", bounds(0.5));
    assert_eq!(diamond.corner_count(), 4);
    let places = [dvec2(0.4, 0.0), dvec2(0.0, 0.4), dvec2(-0.4, 0.0), dvec2(0.0, -0.4)];
    assert!(farthest_from_corners(&diamond, &places) < 2e-9);
    // Two discs meet in a lens, and its outline turns by 60° there.
    let lens = traced("(x + 0.2)^2 + y^2 < 0.16 and (x - 0.2)^2 + y^2 < 0.16", bounds(0.5));
    let tips = [dvec2(0.0, 0.12_f64.sqrt()), dvec2(0.0, -0.12_f64.sqrt())];
    assert!(farthest_from_corners(&lens, &tips) < 2e-9, "{}", farthest_from_corners(&lens, &tips));
    let turns = sharp_turns(&lens);
    assert_eq!(turns.len(), 2, "{turns:?}");
    assert!(turns.iter().all(|turn| (turn - TAU / 6.0).abs() < 0.02), "{turns:?}");
}

/// Returns the angles by which the outline turns where that is more than 20°.
fn sharp_turns(region: &Region) -> Vec<f64> {
    let turns_of = |ring: &Ring| {
        let count = ring.len();
        let side = |n: usize| ring[(n + 1) % count] - ring[n];
        (0..count).map(|n| side((n + count - 1) % count).angle_to(side(n))).collect::<Vec<f64>>()
    };
    region.rings().flat_map(turns_of).filter(|turn| turn.abs() > 0.35).collect()
}

#[test]
fn the_frame_closes_what_it_cuts_and_holes_are_holes() {
    let half = traced("x < 0.3", Rect::UNIT);
    assert_eq!(half.corner_count(), 4);
    assert!((half.area() - 0.3).abs() < 1e-9);
    let ring = traced("0.1 < r and r < 0.4", bounds(0.5));
    assert_eq!((ring.polygons().len(), ring.hole_count()), (1, 1));
    assert!((ring.area() - PI * 0.15).abs() < 1e-8);
    // Where the rectangle is not a square, and far from the origin.
    let far = Rect::new(dvec2(5e5, -3e6), dvec2(5e5 + 9e3, -3e6 + 1e3));
    let disc = traced("(x - 503000)^2 + (y + 2999600)^2 <= 250000", far);
    let off = farthest(&disc, |p| {
        let at = p - dvec2(503_000.0, -2_999_600.0);
        (at.length() - 500.0).abs().min((p.y - far.min.y).abs()).min((p.y - far.max.y).abs())
    });
    assert!(off < 2e-9 * 9e3, "{off}");
}

#[test]
fn everywhere_is_one_rectangle_and_nowhere_is_an_error() {
    assert_eq!(traced("x > -9", Rect::UNIT).area(), 1.0);
    assert_eq!(traced("x*0 == 0", Rect::UNIT).corner_count(), 4);
    for nothing in ["x > 9", "x*0", "sqrt(-1 - x^2)", "x == y"] {
        let line = ZeroLineTracer::new(Formula::parse(nothing).unwrap(), Rect::UNIT).finish();
        assert_eq!(line, Err(ZeroLineError::NoArea), "{nothing}");
    }
}

#[test]
fn jumps_nan_and_ends_of_lines_are_followed() {
    // NaN on one side, a jump, a line that ends within the other side, and lines that branch.
    for (formula, area) in [
        ("sqrt(x - 0.25) >= 0", 0.75),
        ("if(x < 0.5, 1, 0)", 0.5),
        ("if(x < 0.5, y > 0.5, 1)", 0.75),
        ("(x - 0.5)*(y - 0.5) > 0", 0.5),
        ("ln(x - 0.125)", 0.875),
        ("floor(4*x) % 2 == 0", 0.5),
    ] {
        let region = traced(formula, Rect::UNIT);
        assert!((region.area() - area).abs() < 1e-8, "{formula}: {}", region.area());
    }
}

#[test]
fn a_line_without_end_is_refused_in_bounded_time() {
    for formula in ["sin(1e9*x)*sin(1e9*y) > 0", "sin(3e5*(x + y)) > sin(1e5*x*y)"] {
        let mut tracer = ZeroLineTracer::new(Formula::parse(formula).unwrap(), Rect::UNIT);
        let steps = (0..).find(|_| tracer.advance() == Progress::Done).unwrap();
        assert!(steps < 3000, "{formula}: {steps}");
        assert_eq!(tracer.finish(), Err(ZeroLineError::TooLong), "{formula}");
    }
}

#[test]
fn mirrored_formulas_have_mirrored_outlines() {
    let polygons = |formula: &str| -> Vec<Polygon> { traced(formula, bounds(0.5)).polygons().to_vec() };
    let area = |polygons: &[Polygon]| -> f64 {
        polygons.iter().flatten().map(|ring| crate::geometry::signed_area(ring)).sum()
    };
    let [one, other] = ["(x - 0.1)^2 + 2*y^2 < 0.1", "(x + 0.1)^2 + 2*y^2 < 0.1"].map(polygons);
    assert!((area(&one) - area(&other)).abs() < 1e-12);
    assert!((area(&one) - 0.1 * PI / 2.0_f64.sqrt()).abs() < 1e-8);
}

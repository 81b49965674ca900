//! Lower bounds hold for costs that are smaller on a line, in a strip of any width or at a point, and for
//! domains that the mesh covers only partly. The border of a domain is no such line for a risk of pixels.

use std::sync::Arc;

use crate::many_directions::directions;
use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::Domain;
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::{Layer, PaintLayers, RasterLayer, RasterReading, RasterSource, RiskField};
use meshbrush_core::path::{
    CertificateTask, CostDensity, FormulaCost, PathCertificate, PathError, PathMesh, PathRequest, Planner,
    Solution, Waypoint, WeightedCost, Weights,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

fn cost(formula: &str) -> FormulaCost {
    FormulaCost { formula: CostFormula::parse(formula).unwrap(), risk: RiskField::default() }
}

fn square(cells: f64, diameter: f64) -> PathMesh {
    let lattice = Lattice::covering(Rect::UNIT, 1.0 / cells, 100_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| element.diameter() > diameter).unwrap();
    PathMesh::new(mesh.view())
}

fn certified(
    solution: &Solution,
    density: &FormulaCost,
    domain: &Domain,
) -> Result<PathCertificate, PathError> {
    let path = solution.points.clone();
    let task =
        CertificateTask::in_rectangle(domain.bounds, Arc::new(density.clone()), path, solution.upper, 0.02);
    let task = CertificateTask { most_nodes: 600, ..task.unwrap().in_domain(domain) };
    let mut certificate = PathCertificate::new(solution, &task)?;
    while certificate.advance()?.is_none() {}
    Ok(certificate)
}

/// A straight line on which the cost is 1, in a plane where it is greater.
struct Line {
    through: DVec2,
    along: DVec2,
    /// The cost elsewhere.
    elsewhere: f64,
}

impl Line {
    /// Returns the cost of the best path that goes to the line, follows it, and leaves it again: it leaves by
    /// the angle at which the cost falls no more.
    fn by_way(&self, from: DVec2, to: DVec2) -> f64 {
        let [p, q] = [from, to].map(|place| {
            let arm = place - self.through;
            dvec2(arm.dot(self.along), arm.perp_dot(self.along).abs())
        });
        let way = (q.x - p.x).abs();
        let shift = (p.y + q.y) / (self.elsewhere * self.elsewhere - 1.0).sqrt();
        if shift >= way {
            return self.elsewhere * from.distance(to);
        }
        let access = (self.elsewhere * self.elsewhere - 1.0).sqrt() * (p.y + q.y);
        (way + access).min(self.elsewhere * from.distance(to))
    }
}

#[test]
fn no_bound_is_above_the_cost_by_way_of_a_cheap_line() {
    for seed in seeds(10) {
        let mut random = fastrand::Rng::with_seed(2700 + seed);
        // On a line of the meshes, or off it, along an axis or a diagonal.
        let at = if random.bool() { f64::from(random.u32(1..8)) / 8.0 } else { 0.2 + 0.6 * random.f64() };
        let half_width = [0.0, 1e-300, 1e-15, 1e-12, 1e-11, 1e-9, 1e-7][random.usize(..7)];
        let elsewhere = [1.5, 3.0, 10.0, 100.0][random.usize(..4)];
        let (through, along, distance) = match random.u32(0..4) {
            0 => (dvec2(at, 0.0), DVec2::Y, format!("x - {at}")),
            1 => (dvec2(0.0, at), DVec2::X, format!("y - {at}")),
            2 => (DVec2::ZERO, DVec2::ONE.normalize(), "x - y".to_owned()),
            _ => (dvec2(0.0, 0.0), DVec2::Y, "x".to_owned()),
        };
        let formula = match half_width {
            0.0 => format!("if(({distance}) == 0, 1, {elsewhere})"),
            width => format!("if(abs({distance}) < {width:e}, 1, {elsewhere})"),
        };
        let line = Line { through, along, elsewhere };
        let density = cost(&formula);
        let near = |random: &mut fastrand::Rng| {
            let away = [0.0, 0.01, 0.1, 0.3][random.usize(..4)];
            let place = through + along * random.f64() + away * along.perp() * (random.f64() - 0.5);
            place.clamp(DVec2::ZERO, DVec2::ONE)
        };
        let places = [near(&mut random), near(&mut random)];
        let possible = line.by_way(places[0], places[1]);
        for (cells, diameter) in [(8.0, 0.2), (5.0, 0.1)] {
            let mut planner = Planner::new(square(cells, diameter), &density).unwrap();
            let solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
            let message = format!("{seed} {formula} {places:?}: possible {possible}");
            assert!(solution.lower <= possible * (1.0 + 1e-6) + 1e-9, "{} {message}", solution.lower);
            assert!(solution.lower <= solution.upper, "{message}");
            if cells == 8.0 && solution.upper > 0.0 {
                let certificate = certified(&solution, &density, &Domain::rectangle(Rect::UNIT)).unwrap();
                let lower = certificate.lower();
                assert!(lower <= possible * (1.0 + 1e-6) + 1e-9, "certified {lower} {message}");
            }
        }
    }
}

#[test]
fn paths_follow_cheap_lines_that_have_bounds_of_their_own() {
    for (at, half_width) in [(0.5, 1e-11), (0.53, 1e-9), (0.53, 0.0), (0.47, 1e-6), (0.3, 1e-3)] {
        let condition =
            if half_width == 0.0 { format!("x == {at}") } else { format!("abs(x - {at}) < {half_width:e}") };
        let density = cost(&format!("if({condition}, 1, 10)"));
        let line = Line { through: dvec2(at, 0.0), along: DVec2::Y, elsewhere: 10.0 };
        let places = [dvec2(0.4, 0.1), dvec2(0.45, 0.9)];
        let mut planner = Planner::new(square(8.0, 0.2), &density).unwrap();
        let solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        let best = line.by_way(places[0], places[1]);
        assert!(solution.upper <= best * 1.002, "{condition}: {} {best}", solution.upper);
        // The way to the strip is shorter than that to the line.
        let least = best - 20.0 * half_width - 1e-9;
        assert!(solution.upper >= least && solution.lower <= best, "{condition}: {} {least}", solution.upper);
    }
}

#[test]
fn a_cost_that_is_smaller_at_a_point_only_costs_no_bound() {
    let domain = Domain::rectangle(Rect::UNIT);
    for formula in ["if(hypot(x - 0.5, y - 0.5) < 1e-12, 1, 2)", "if(x == 0.375 && y == 0.25, 1e-3, 2)"] {
        let density = cost(formula);
        let places = [dvec2(0.1, 0.1), dvec2(0.8, 0.9)];
        let mut planner = Planner::new(square(8.0, 0.2), &density).unwrap();
        let solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        let exact = 2.0 * places[0].distance(places[1]);
        let certificate = certified(&solution, &density, &domain).unwrap();
        assert!(solution.lower <= exact && certificate.lower() <= exact, "{formula}");
        assert!(certificate.lower() >= 0.9 * exact, "{formula} {} {exact}", certificate.lower());
    }
}

#[test]
fn no_bound_is_above_what_a_search_finds_around_a_narrow_valley() {
    for seed in seeds(6) {
        let mut random = fastrand::Rng::with_seed(2720 + seed);
        let [x, y, width] = [random.f64(), random.f64(), 0.004 + 0.05 * random.f64()];
        let formula = format!("if(abs(x - {x}) < {width}, 1, 4) + if(abs(y - {y}) < {width}, 0, 2)");
        let density = cost(&formula);
        let places =
            [(); 2].map(|()| dvec2(f64::from(random.u32(0..=64)), f64::from(random.u32(0..=64))) / 64.0);
        let found = directions(&|p| density.at(p), Rect::UNIT, places, 64, 4);
        for diameter in [0.3, 0.1, 0.04] {
            let mut planner = Planner::new(square(4.0, diameter), &density).unwrap();
            let solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
            // The search takes the mean of a step at four of its points: it can be too cheap by a part of it.
            let message = format!("{seed} {formula} {places:?} {diameter}: {} {found}", solution.lower);
            assert!(solution.lower <= found * 1.05 + 0.05, "{message}");
        }
    }
}

#[test]
fn the_border_of_a_domain_is_no_cheap_way_where_a_raster_of_risk_ends_there() {
    let raster = Raster::from_values(Rect::UNIT, [6, 7], vec![0.5; 42]);
    let source = RasterSource { name: String::new(), raster: RasterPyramid::new(raster).into() };
    let stack = Layer::stack([RasterLayer { source, reading: RasterReading::Risk }]);
    let risk = RiskField::new(&stack, PaintLayers::blank()).within(&Rect::UNIT);
    let density = WeightedCost::new(Weights { length: 1.0, risk: 10.0 }, risk).unwrap();
    for places in [[dvec2(0.1, 0.02), dvec2(0.9, 0.03)], [dvec2(0.0, 0.0), dvec2(1.0, 0.9)]] {
        let mut planner = Planner::new(square(8.0, 0.05), &density).unwrap();
        let solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        let straight = 6.0 * places[0].distance(places[1]);
        assert!((solution.cost - straight).abs() < 1e-9 * straight, "{} {straight}", solution.cost);
        assert!(solution.gap() < 0.01, "{}", solution.gap());
    }
}

/// Returns two squares beside each other, joined by a strait.
fn with_strait(low: f64, high: f64) -> Domain {
    let ring = [
        (0.0, 0.0),
        (0.45, 0.0),
        (0.45, low),
        (0.55, low),
        (0.55, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (0.55, 1.0),
        (0.55, high),
        (0.45, high),
        (0.45, 1.0),
        (0.0, 1.0),
    ];
    Domain::of_polygons(&[vec![ring.map(|(x, y)| dvec2(x, y)).to_vec()]]).unwrap()
}

#[test]
fn bounds_hold_where_the_mesh_leaves_a_strait_out() {
    for seed in seeds(8) {
        let mut random = fastrand::Rng::with_seed(2740 + seed);
        let (width, low) = (0.001 + 0.06 * random.f64(), 0.1 + 0.7 * random.f64());
        let domain = with_strait(low, low + width);
        let middle = low + 0.5 * width;
        let places = [dvec2(0.05 + 0.3 * random.f64(), middle), dvec2(0.65 + 0.3 * random.f64(), middle)];
        let shortest = places[0].distance(places[1]);
        let density = cost("1");
        // A mesh that joins the squares only above.
        let lattice = Lattice::covering(Rect::UNIT, 0.05, 10_000).unwrap();
        let mesh =
            Mesh::coarse_grid(&lattice, |p| (p.x - 0.5).abs() > 0.04 || p.y > 0.94, &Limits::default());
        let mesh = PathMesh::new(mesh.unwrap().view());
        let mut planner = Planner::new(mesh, &density).unwrap();
        let mut solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        assert!(solution.upper > shortest && solution.lower == 0.0, "{seed} {}", solution.lower);
        let certificate = certified(&solution, &density, &domain).unwrap();
        assert!(certificate.lower() <= shortest * (1.0 + 1e-9), "{seed} {} {shortest}", certificate.lower());
        solution.take(certificate.solution());
        assert!(solution.lower <= shortest * (1.0 + 1e-9) && solution.lower > 0.5 * shortest, "{seed}");
    }
}

#[test]
fn a_certificate_from_beyond_the_outline_says_so() {
    // The mesh covers the square, the domain its lower half.
    let half = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (0.0, 0.5)].map(|(x, y)| dvec2(x, y));
    let domain = Domain::of_polygons(&[vec![half.to_vec()]]).unwrap();
    let density = cost("1");
    let places = [dvec2(0.1, 0.1), dvec2(0.5, 0.4), dvec2(0.9, 0.9)];
    let solution = Planner::new(square(8.0, 0.2), &density)
        .unwrap()
        .solve(&density, &places, PathRequest::FULL)
        .unwrap();
    let path = solution.points.clone();
    let task = CertificateTask::in_rectangle(Rect::UNIT, Arc::new(density), path, solution.upper, 0.02);
    let Err(error) =
        PathCertificate::new(&solution, &task.unwrap().in_domain(&Domain { bounds: Rect::UNIT, ..domain }))
    else {
        panic!("a bound from outside the domain")
    };
    assert!(matches!(error, PathError::BeyondOutline { which: Waypoint::Goal, .. }), "{error}");
    assert!(error.to_string().starts_with("No bound is proved from the goal (0.9, 0.9): "), "{error}");
}

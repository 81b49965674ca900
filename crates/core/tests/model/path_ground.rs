//! Paths on the Earth: where the cost is the same everywhere, the best one is a geodesic of the ellipsoid,
//! whatever the plane is.

use std::sync::Arc;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::PathCost;
use meshbrush_core::domain::Domain;
use meshbrush_core::earth::{EarthPlane, Projection};
use meshbrush_core::field::{CostFormula, Formula};
use meshbrush_core::layers::{Layer, LayerKind, Mask, PaintLayers, RiskField};
use meshbrush_core::path::{
    Certificate, CertificateTask, CostDensity, PathFigures, PathMesh, PathRequest, Planner, Solution, Weights,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

use crate::runs::seeds;

/// Planes in which the scale varies by 5 % to the twofold, with rectangles of them, in metres.
fn planes() -> [(Projection, Rect); 4] {
    let rect = |min: DVec2, size: DVec2| Rect::new(min, min + size);
    [
        ("+proj=merc +lat_ts=0 +ellps=WGS84 +units=m", rect(dvec2(1e6, 5e6), dvec2(4e6, 6e6))),
        ("+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m", rect(dvec2(1e6, 4e6), dvec2(2e6, 2e6))),
        (
            "+proj=stere +lat_0=90 +lat_ts=70 +lon_0=0 +ellps=WGS84 +units=m",
            rect(DVec2::splat(-2e6), dvec2(5e6, 5e6)),
        ),
        (
            "+proj=lcc +lat_1=35 +lat_2=65 +lat_0=52 +lon_0=10 +ellps=WGS84 +units=m",
            rect(dvec2(-3e6, -3e6), dvec2(5e6, 5e6)),
        ),
    ]
    .map(|(text, bounds)| (text.parse().unwrap(), bounds))
}

/// The length of the geodesic between two longitudes and latitudes, in metres, by Vincenty's formulas
/// (Survey Review 23, 1975).
fn geodesic(from: DVec2, to: DVec2) -> f64 {
    let (a, f) = (6_378_137.0, 1.0 / 298.257_223_563);
    let b = a * (1.0 - f);
    let reduced = |latitude: f64| ((1.0 - f) * latitude.to_radians().tan()).atan();
    let ((s1, c1), (s2, c2)) = (reduced(from.y).sin_cos(), reduced(to.y).sin_cos());
    let east = (to.x - from.x).to_radians();
    let mut lambda = east;
    for _ in 0..200 {
        let (sl, cl) = lambda.sin_cos();
        let sine = (c2 * sl).hypot(c1 * s2 - s1 * c2 * cl);
        let cosine = s1 * s2 + c1 * c2 * cl;
        let sigma = sine.atan2(cosine);
        let alpha = c1 * c2 * sl / sine;
        let cos2 = 1.0 - alpha * alpha;
        let middle = cosine - 2.0 * s1 * s2 / cos2;
        let c = f / 16.0 * cos2 * (4.0 + f * (4.0 - 3.0 * cos2));
        let square = 2.0 * middle * middle - 1.0;
        let next = east + (1.0 - c) * f * alpha * (sigma + c * sine * (middle + c * cosine * square));
        if (next - lambda).abs() < 1e-13 {
            let u2 = cos2 * (a * a - b * b) / (b * b);
            let big_a = 1.0 + u2 / 16384.0 * (4096.0 + u2 * (-768.0 + u2 * (320.0 - 175.0 * u2)));
            let big_b = u2 / 1024.0 * (256.0 + u2 * (-128.0 + u2 * (74.0 - 47.0 * u2)));
            let last = big_b / 6.0 * middle * (4.0 * sine * sine - 3.0) * (4.0 * middle * middle - 3.0);
            let delta = big_b * sine * (middle + big_b / 4.0 * (cosine * square - last));
            return b * big_a * (sigma - delta);
        }
        lambda = next;
    }
    panic!("{from} {to}");
}

/// A rectangle of a plane with a mesh over it, and a cost.
struct Sea {
    projection: Projection,
    bounds: Rect,
    mesh: Mesh,
    density: Arc<dyn CostDensity>,
}

impl Sea {
    fn new(plane: (Projection, Rect), cost: &PathCost) -> Self {
        Self::with_risk(plane, cost, RiskField::default(), 40.0)
    }

    /// A sea whose triangles have a part of its width as diameter.
    fn with_risk(
        (projection, bounds): (Projection, Rect),
        cost: &PathCost,
        risk: RiskField,
        part: f64,
    ) -> Self {
        let lattice = Lattice::covering(bounds, bounds.size().max_element() / 24.0, 100_000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let diameter = bounds.size().max_element() / part;
        mesh.refine(&Limits::default(), |element| element.diameter() > diameter).unwrap();
        let domain = Domain { projection: Some(projection), ..Domain::rectangle(bounds) };
        let density = cost.density(risk, &domain).unwrap();
        Self { projection, bounds, mesh, density }
    }

    /// A random place whose geodesics to others like it lie in the rectangle.
    fn place(&self, random: &mut Rng) -> DVec2 {
        self.bounds.min + self.bounds.size() * (0.25 + 0.5 * dvec2(random.f64(), random.f64()))
    }

    fn geodesic(&self, from: DVec2, to: DVec2) -> f64 {
        let [from, to] = [from, to].map(|at| self.projection.geographic_from_plane(at));
        geodesic(from, to)
    }

    /// The cost of a line, by the risk and the scale at many places of it.
    fn cost_of(&self, line: &[DVec2], cost_at: impl Fn(DVec2) -> f64) -> f64 {
        let mut sum = 0.0;
        for pair in line.windows(2) {
            let pieces = (200_000 / line.len()).max(20) as u32;
            for n in 0..pieces {
                let [a, b] = [n, n + 1].map(|n| pair[0].lerp(pair[1], f64::from(n) / f64::from(pieces)));
                let at = a.midpoint(b);
                sum += cost_at(at) * a.distance(b) / self.projection.scale_in_plane(at);
            }
        }
        sum
    }

    fn path(&self, from: DVec2, to: DVec2, keep_out: &[Mask]) -> Solution {
        let mesh = PathMesh::with_keep_out(self.mesh.view(), keep_out);
        let mut planner = Planner::new(mesh, &*self.density).unwrap();
        planner.solve(&*self.density, &[from, to], PathRequest::FULL).unwrap()
    }

    fn certificate(&self, solution: &Solution, width: f64) -> Certificate {
        let (cost, points) = (Arc::clone(&self.density), solution.points.clone());
        let task = CertificateTask::in_rectangle(self.bounds, cost, points, solution.upper, width).unwrap();
        let mut certificate = Certificate::new(task).unwrap();
        while certificate.advance().unwrap().is_none() {}
        certificate
    }
}

fn length_only() -> PathCost {
    PathCost::Weighted(Weights { length: 1.0, risk: 0.0 })
}

#[test]
fn a_path_of_one_cost_is_a_geodesic() {
    for (number, plane) in planes().into_iter().enumerate() {
        let sea = Sea::new(plane, &length_only());
        for seed in seeds(2) {
            let mut random = Rng::with_seed(seed + number as u64);
            let (from, to) = (sea.place(&mut random), sea.place(&mut random));
            let (exact, path) = (sea.geodesic(from, to), sea.path(from, to, &[]));
            let of_exact = |value: f64| value / exact - 1.0;
            let figures = [path.lower, path.cost, path.upper].map(of_exact);
            let what = format!("{}: {from} {to}, off by {figures:?}", sea.projection);
            assert!(figures[0] <= 1e-9 && figures[0] > -0.06, "{what}");
            assert!(figures[1].abs() < 1e-6 && figures[2] > -1e-9 && figures[2] < 3e-5, "{what}");
            // By other code: the scale itself, along the line.
            let length = EarthPlane::Projected(sea.projection).length(&path.points);
            assert!((length / path.cost - 1.0).abs() < 1e-7, "{what}: {length}");
        }
    }
}

/// On this plane, the line between these places is only 1.5 · 10⁻⁶ longer than the geodesic: a rule with two
/// points for each piece finds no difference.
#[test]
fn a_straight_line_does_not_replace_a_path_that_costs_less() {
    let is_conic = |(projection, _): &(Projection, Rect)| projection.to_string().starts_with("+proj=lcc");
    let sea = Sea::new(planes().into_iter().find(is_conic).unwrap(), &length_only());
    let (from, to) = (dvec2(354_980.0, 416_821.0), dvec2(-1_173_879.0, -693_072.0));
    let (exact, path) = (sea.geodesic(from, to), sea.path(from, to, &[]));
    assert!(path.cost / exact - 1.0 < 1e-8, "{} points: {} {exact}", path.points.len(), path.cost);
}

#[test]
fn what_is_proved_holds_for_the_geodesic() {
    for (number, plane) in planes().into_iter().enumerate() {
        let sea = Sea::new(plane, &length_only());
        let mut random = Rng::with_seed(40 + number as u64);
        let (from, to) = (sea.place(&mut random), sea.place(&mut random));
        let (exact, path) = (sea.geodesic(from, to), sea.path(from, to, &[]));
        let certificate = sea.certificate(&path, 1e-3);
        let off = certificate.lower() / exact - 1.0;
        assert!(
            off <= 1e-9 && certificate.width() <= 1e-3,
            "{}: {off} {:?}",
            sea.projection,
            certificate.end()
        );
    }
}

#[test]
fn around_a_cape_it_is_about_two_geodesics() {
    for (number, plane) in planes().into_iter().enumerate() {
        let sea = Sea::new(plane, &length_only());
        let mut random = Rng::with_seed(80 + number as u64);
        // A wedge from below, whose tip both look past.
        let Rect { min, max } = sea.bounds;
        let (center, size) = (sea.bounds.center(), max - min);
        let tip = center + size * dvec2(0.1 * random.f64() - 0.05, 0.15 * random.f64());
        let foot = |x: f64| dvec2(tip.x + x * size.x, min.y - 0.1 * size.y);
        let wedge = Mask::new(&[vec![vec![foot(-0.05), foot(0.05), tip]]]).unwrap();
        let [from, to] = [-0.25, 0.25].map(|x| tip + size * dvec2(x, -0.05 - 0.1 * random.f64()));
        let exact = sea.geodesic(from, tip) + sea.geodesic(tip, to);
        let path = sea.path(from, to, &[wedge]);
        let off = path.cost / exact - 1.0;
        // It stays out of the triangles that the wedge touches.
        assert!(off > -1e-9 && off < 0.01, "{}: {off}", sea.projection);
        assert!(path.lower <= exact * (1.0 + 1e-9), "{}: {} {exact}", sea.projection, path.lower);
    }
}

#[test]
fn costs_add_up_over_lengths_on_the_ellipsoid() {
    let formula = "2 + sin(x / 300000) * cos(y / 200000)";
    let cost = PathCost::Formula(CostFormula::parse(formula).unwrap());
    for (number, plane) in planes().into_iter().enumerate() {
        let sea = Sea::new(plane, &cost);
        let mut random = Rng::with_seed(120 + number as u64);
        let line: Vec<DVec2> = (0..6).map(|_| sea.place(&mut random)).collect();
        let figures = PathFigures::new(&line, &*sea.density, 1e-6);
        let cost_at = |at: DVec2| 2.0 + (at.x / 3e5).sin() * (at.y / 2e5).cos();
        let sum = sea.cost_of(&line, cost_at);
        let off = figures.cost / sum - 1.0;
        assert!(off.abs() < 1e-6 && figures.upper >= sum * (1.0 - 1e-8), "{}: {off}", sea.projection);
        // The profile knows the cost per metre.
        let sample = Solution::joined([sea.path(line[0], line[1], &[])]).samples(&*sea.density)[0];
        let expected = 2.0 + (line[0].x / 3e5).sin() * (line[0].y / 2e5).cos();
        assert!((sample.density - expected).abs() < 1e-9, "{} {expected}", sample.density);
    }
}

/// Hills of risk in a sea, and a wedge that paths stay out of.
fn hills(bounds: &Rect, random: &mut Rng) -> (RiskField, Vec<Mask>) {
    let mut point = || bounds.min + bounds.size() * (0.1 + 0.8 * dvec2(random.f64(), random.f64()));
    let hills: Vec<String> = (0..4)
        .map(|n| {
            let (DVec2 { x, y }, width) = (point(), (0.06 + 0.03 * f64::from(n)) * bounds.size().y);
            format!("0.{}*gauss(hypot(x-{x}, y-{y}), {width})", 9 - n)
        })
        .collect();
    let formula = Formula::parse(&format!("max(0, {})", hills.join(", "))).unwrap();
    let stack = Layer::stack([LayerKind::risk(formula)]);
    let center = point();
    let wedge = [0.0, 2.1, 4.2].map(|turn| center + 0.06 * bounds.size().y * DVec2::from_angle(turn));
    (RiskField::new(&stack, PaintLayers::blank()), vec![Mask::new(&[vec![wedge.to_vec()]]).unwrap()])
}

/// Risk, a region to stay out of, two meshes, a certificate and an edit: whatever is proved holds for all.
#[test]
fn intervals_over_risk_on_the_earth_overlap_and_follow_edits() {
    let weights = PathCost::Weighted(Weights { length: 1.0, risk: 8.0 });
    for seed in seeds(1) {
        for (number, plane) in planes().into_iter().enumerate() {
            let mut random = Rng::with_seed(1000 * seed + 200 + number as u64);
            let (risk, keep_out) = hills(&plane.1, &mut random);
            let seas = [30.0, 55.0].map(|part| Sea::with_risk(plane, &weights, risk.clone(), part));
            let (from, to) = (seas[0].place(&mut random), seas[0].place(&mut random));
            let is_kept_out = |at| keep_out.iter().any(|mask| mask.contains(at));
            if is_kept_out(from) || is_kept_out(to) {
                continue;
            }
            let paths = seas.each_ref().map(|sea| sea.path(from, to, &keep_out));
            let (cost, points) = (Arc::clone(&seas[0].density), paths[0].points.clone());
            let task = CertificateTask::in_rectangle(plane.1, cost, points, paths[0].upper, 0.05).unwrap();
            let task = CertificateTask { most_nodes: 1500, ..task.outside_of(keep_out.clone()) };
            let mut certificate = Certificate::new(task).unwrap();
            while certificate.advance().unwrap().is_none() {}
            let lowers = [paths[0].lower, paths[1].lower, certificate.lower()];
            for path in &paths {
                let what = format!("{} {seed}: {lowers:?} {}", plane.0, path.upper);
                assert!(lowers.iter().all(|&lower| lower > 0.0 && lower <= path.upper), "{what}");
                let sum = seas[0].cost_of(&path.points, |at| 1.0 + 8.0 * risk.at(at));
                assert!(
                    (path.cost / sum - 1.0).abs() < 1e-4 && path.upper >= sum * (1.0 - 1e-7),
                    "{what} {sum}"
                );
                assert!(path.points.iter().all(|&at| !is_kept_out(at)), "{what}");
            }
            // Another risk: a planner that follows finds what a new one does.
            let (other, _) = hills(&plane.1, &mut random);
            let changed = Sea::with_risk(plane, &weights, other, 30.0);
            let mesh = Arc::new(PathMesh::with_keep_out(seas[0].mesh.view(), &keep_out));
            let mut planner = Planner::new(Arc::clone(&mesh), &*seas[0].density).unwrap();
            planner.update(&*changed.density, &[plane.1]).unwrap();
            let followed = planner.solve(&*changed.density, &[from, to], PathRequest::FULL).unwrap();
            let mut fresh = Planner::new(mesh, &*changed.density).unwrap();
            let expected = fresh.solve(&*changed.density, &[from, to], PathRequest::FULL).unwrap();
            assert_eq!(followed, expected, "{} {seed}", plane.0);
        }
    }
}

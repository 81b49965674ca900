//! Corridor, front and alternatives of a path.

use glam::{DVec2, dvec2};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::{Layer, PaintLayers, RiskField, Threat, ThreatLaw, Threats};
use meshbrush_core::path::{
    Alternatives, CostDensity, Difference, FormulaCost, Front, PathMesh, PathRequest, Planner, WeightedCost,
    Weights,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

fn mesh(diameter: f64) -> PathMesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.125, 100_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| element.diameter() > diameter).unwrap();
    PathMesh::new(mesh.view())
}

fn threats(places: &[(f64, f64)], range: f64) -> RiskField {
    let threat = |&(x, y): &(f64, f64)| Threat { at: dvec2(x, y), range, peak: 1.0, law: ThreatLaw::Disc };
    let threats = Threats::new(places.iter().map(threat).collect()).unwrap();
    RiskField::new(&Layer::stack([threats]), &PaintLayers::default())
}

#[test]
fn the_corridor_of_a_straight_path_is_an_ellipse() {
    let one = FormulaCost { formula: CostFormula::parse("1").unwrap(), risk: RiskField::default() };
    let mut planner = Planner::new(mesh(0.03), &one).unwrap();
    let [p, q] = [dvec2(0.2, 0.3), dvec2(0.8, 0.5)];
    let corridor = planner.corridor(&[p, q]).unwrap();
    assert!(corridor.excess().iter().all(|&excess| excess >= 0.0));
    for n in 0..400 {
        let at = dvec2(f64::from(n % 20), f64::from(n / 20)) / 19.0;
        let exact = (p.distance(at) + at.distance(q)) / p.distance(q) - 1.0;
        let found = corridor.excess_at(planner.mesh(), at).unwrap();
        assert!((found - exact).abs() < 0.06 + 0.03 * exact, "{at}: {found} {exact}");
    }
    let [narrow, wide] = [0.05, 0.4].map(|share| corridor.triangles(planner.mesh(), share).count());
    assert!(0 < narrow && 2 * narrow < wide && wide < planner.mesh().triangle_count());
}

#[test]
fn the_front_goes_from_the_shortest_path_to_the_safest() {
    let risk = threats(&[(0.5, 0.45)], 0.3);
    let places = vec![dvec2(0.1, 0.5), dvec2(0.9, 0.5)];
    let mut front = Front::new(mesh(0.05), risk, places.clone(), 8);
    let mut steps = 0;
    while front.advance().unwrap() {
        steps += 1;
        assert!(steps < 20);
    }
    let points = front.points();
    assert!(points.len() >= 4 && front.remaining() == 0);
    assert!((points[0].solution.length - 0.8).abs() < 1e-6 && points[0].weights.risk == 0.0);
    for pair in points.windows(2) {
        let [a, b] = [&pair[0].solution, &pair[1].solution];
        assert!(a.length < b.length && a.risk > b.risk && pair[0].weights.risk < pair[1].weights.risk);
    }
    assert!(points[points.len() - 1].solution.risk < 0.01);
    let texts = points.iter().map(|point| point.weights.risk.to_string());
    assert!(texts.clone().all(|text| text.len() <= 6), "few digits: {:?}", texts.collect::<Vec<_>>());
}

#[test]
fn the_risk_of_a_straight_path_counts_between_its_points() {
    let risk = threats(&[(0.3, 0.47)], 0.1);
    let density = WeightedCost::new(Weights { length: 1.0, risk: 0.0 }, risk.clone()).unwrap();
    let [p, q] = [dvec2(0.1, 0.5), dvec2(0.9, 0.5)];
    let mut planner = Planner::new(mesh(0.05), &density).unwrap();
    let solution = planner.solve(&density, &[p, q], PathRequest::FULL).unwrap();
    assert_eq!(solution.points, [p, q]);
    let risks = || (0..100_000).map(|n| risk.at(p.lerp(q, (f64::from(n) + 0.5) / 1e5)));
    let (integral, highest) = (risks().sum::<f64>() * p.distance(q) / 1e5, risks().fold(0.0, f64::max));
    assert!(integral > 0.01 && (solution.risk / integral - 1.0).abs() < 0.01, "{} {integral}", solution.risk);
    assert!((solution.highest_risk - highest).abs() < 0.01, "{} {highest}", solution.highest_risk);
}

#[test]
fn a_profile_has_the_place_of_the_highest_risk() {
    // So narrow that places at equal distances miss it.
    let risk = threats(&[(0.437, 0.5), (0.7, 0.47)], 0.004);
    let density = WeightedCost::new(Weights { length: 1.0, risk: 0.0 }, risk).unwrap();
    let mut planner = Planner::new(mesh(0.05), &density).unwrap();
    for places in
        [vec![dvec2(0.1, 0.5), dvec2(0.9, 0.5)], vec![dvec2(0.1, 0.5), dvec2(0.2, 0.5), dvec2(0.9, 0.5)]]
    {
        let solution = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        let profile = solution.profile(&density, 21);
        assert_eq!(profile.len(), 22);
        assert!(profile.windows(2).all(|pair| pair[0].distance < pair[1].distance));
        let top = profile.iter().max_by(|a, b| a.risk.total_cmp(&b.risk)).unwrap();
        assert_eq!(top.risk, solution.highest_risk);
        assert!(top.risk > 0.5 && (top.point.x - 0.437).abs() < 0.004, "{top:?}");
    }
}

#[test]
fn a_path_that_is_best_for_many_weights_is_in_the_front_once() {
    let risk = threats(&[(0.5, 0.1)], 0.1);
    let mut front = Front::new(mesh(0.1), risk, vec![dvec2(0.1, 0.8), dvec2(0.9, 0.8)], 8);
    while front.advance().unwrap() {}
    assert_eq!(front.points().len(), 1);
}

#[test]
fn alternatives_go_through_other_gaps() {
    // Discs with gaps of different widths between them, and around them.
    let risk = threats(&[(0.5, 0.28), (0.5, 0.72)], 0.2);
    let density = WeightedCost::new(Weights { length: 1.0, risk: 20.0 }, risk).unwrap();
    let places = vec![dvec2(0.1, 0.45), dvec2(0.9, 0.45)];
    let mesh = mesh(0.05);
    let request = PathRequest { has_bounds: false, ..PathRequest::FULL };
    let best = Planner::new(mesh.clone(), &density).unwrap().solve(&density, &places, request).unwrap();
    let mut search = Alternatives::new(mesh, places, best, Difference::default());
    let mut rounds = 0;
    while !search.is_done() && search.paths().len() < 3 && rounds < 20 {
        search.advance(&density).unwrap();
        rounds += 1;
    }
    let paths = search.paths();
    assert_eq!(paths.len(), 3, "{rounds}");
    let height = |points: &[DVec2]| {
        let middle = points.iter().min_by(|p, q| (p.x - 0.5).abs().total_cmp(&(q.x - 0.5).abs())).unwrap();
        (middle.y > 0.28, middle.y > 0.72)
    };
    let mut gaps: Vec<_> = paths.iter().map(|path| height(&path.points)).collect();
    gaps.sort_unstable();
    assert_eq!(gaps, [(false, false), (true, false), (true, true)]);
    for path in &paths[1..] {
        assert!(path.cost > paths[0].cost && path.cost <= 2.0 * paths[0].cost);
        let mean = path.points.windows(2).map(|p| density.at(p[0].midpoint(p[1])) * p[0].distance(p[1]));
        assert!((mean.sum::<f64>() - path.cost).abs() < 1e-3 * path.cost);
    }
}

/// Returns whether a point is within an odd number of closed lines.
fn is_within(lines: &[Vec<DVec2>], p: DVec2) -> bool {
    let crosses = |ends: &&[DVec2]| {
        let [a, b] = [ends[0], ends[1]];
        (a.y <= p.y) != (b.y <= p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    lines.iter().flat_map(|line| line.windows(2)).filter(crosses).count() % 2 == 1
}

#[test]
fn the_outlines_of_a_corridor_are_closed_and_part_it_from_the_rest() {
    let risk = threats(&[(0.5, 0.3), (0.45, 0.72)], 0.2);
    let density = WeightedCost::new(Weights { length: 1.0, risk: 20.0 }, risk).unwrap();
    let mut planner = Planner::new(mesh(0.05), &density).unwrap();
    let corridor = planner.corridor(&[dvec2(0.1, 0.45), dvec2(0.95, 0.5)]).unwrap();
    let other = planner.corridor(&[dvec2(0.1, 0.1), dvec2(0.2, 0.9)]).unwrap();
    let mesh = planner.mesh();
    let mut random = fastrand::Rng::with_seed(20);
    for (corridor, share) in
        [(&corridor, 0.03), (&corridor, 0.2), (&corridor, 5.0), (&other.joined(corridor.clone()), 0.1)]
    {
        let lines = corridor.outlines(mesh, share);
        assert!(
            !lines.is_empty() && lines.iter().all(|line| line.len() > 3 && line[0] == line[line.len() - 1])
        );
        let mut within = 0;
        for _ in 0..2_000 {
            let at = dvec2(random.f64(), random.f64());
            let excess = corridor.excess_at(mesh, at).unwrap();
            within += usize::from(excess <= share);
            assert_eq!(is_within(&lines, at), excess <= share, "{at} {excess} {share}");
        }
        assert!(within > 20, "{share}: {within}");
        let twice_area: f64 =
            lines.iter().flat_map(|line| line.windows(2)).map(|p| p[0].perp_dot(p[1])).sum();
        assert!((0.5 * twice_area - within as f64 / 2_000.0).abs() < 0.03, "the corridor is to the left");
    }
}

//! Paths of least cost: exact families, quadratures, and a search in many directions as referees.
//!
//! `MESHBRUSH_TABLE=1` prints the table of the exact families.

use std::sync::Arc;

use crate::many_directions::directions;
use crate::path_referees::Radial;
use crate::runs::{prints_table, runs};
use glam::{DVec2, dvec2};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::{Mask, RiskField};
use meshbrush_core::path::{
    CostDensity, CostRange, FormulaCost, PathError, PathFigures, PathMesh, PathRequest, Planner, Solution,
    Waypoint,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

const SQUARE: Rect = Rect::new(DVec2::splat(-2.0), DVec2::splat(2.0));

/// Returns a mesh whose triangles have at most the given diameters.
fn mesh(bounds: Rect, diameter: impl Fn(DVec2) -> f64) -> Mesh {
    let lattice = Lattice::covering(bounds, bounds.size().x / 4.0, 100_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| {
        let corners = element.world_corners();
        let least = corners.map(&diameter).into_iter().fold(f64::INFINITY, f64::min);
        element.diameter() > least
    })
    .unwrap();
    mesh
}

fn cost(formula: &str) -> FormulaCost {
    FormulaCost { formula: CostFormula::parse(formula).unwrap(), risk: RiskField::default() }
}

fn solve(
    mesh: &Mesh,
    density: &dyn CostDensity,
    places: &[DVec2],
    keep_out: &[Mask],
) -> Result<Solution, PathError> {
    let mesh = PathMesh::with_keep_out(mesh.view(), keep_out);
    Planner::new(mesh, density)?.solve(density, places, PathRequest::FULL)
}

/// A cost with a known least cost between two places.
struct Family {
    name: &'static str,
    formula: &'static str,
    start: DVec2,
    goal: DVec2,
    exact: f64,
    /// Where graded meshes are finest.
    finest: DVec2,
    hole: Option<[DVec2; 4]>,
    /// The largest error of the path's cost and width of the interval on the finest mesh of the test.
    limits: [f64; 2],
}

/// z ↦ zⁿ for points of the plane.
fn power(z: DVec2, n: f64) -> DVec2 {
    DVec2::from_angle(z.to_angle() * n) * z.length().powf(n)
}

/// Returns the least of a convex function, by ternary search.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if f(a) < f(b) { high = b } else { low = a }
    }
    f(low)
}

fn families() -> Vec<Family> {
    let family = |name, formula, start: DVec2, goal: DVec2, exact, limits| Family {
        name,
        formula,
        start,
        goal,
        exact,
        finest: DVec2::ZERO,
        hole: None,
        limits,
    };
    let polar = |angle: f64, radius: f64| DVec2::from_angle(angle.to_radians()) * radius;
    let logarithm = |z: DVec2| dvec2(z.length().ln(), z.to_angle());
    let exponential = |z: DVec2| DVec2::from_angle(z.y) * z.x.exp();
    let (a, b) = (dvec2(-1.4, -0.93), dvec2(1.3, 1.1));
    let (c, d) = (polar(10.0, 0.6), polar(130.0, 1.5));
    let (e, f) = (polar(15.0, 0.7), polar(60.0, 1.3));
    let (below, above) = (dvec2(-1.1, -0.9), dvec2(0.9, 1.2));
    let snell = least(-2.0, 2.0, |x| below.distance(dvec2(x, 0.0)) + 2.5 * above.distance(dvec2(x, 0.0)));
    let corner = 0.5;
    let around = |p: DVec2, q: DVec2| {
        let corners = [dvec2(-corner, corner), dvec2(corner, -corner)];
        corners
            .map(|corner| p.distance(corner) + corner.distance(q))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    let (p, q) = (dvec2(-1.3, -1.1), dvec2(1.2, 1.4));
    vec![
        family("1", "1", a, b, a.distance(b), [1e-9, 0.02]),
        family("1/r", "1/max(r, 0.02)", c, d, (logarithm(c) - logarithm(d)).length(), [3e-5, 0.1]),
        family("1/r^2", "1/max(r, 0.02)^2", e, f, power(e, -1.0).distance(power(f, -1.0)), [2e-5, 0.2]),
        family(
            "1/r^4",
            "1/max(r, 0.02)^4",
            e,
            f,
            power(e, -3.0).distance(power(f, -3.0)) / 3.0,
            [3e-5, 0.27],
        ),
        family("e^x", "exp(x)", a, b, exponential(a).distance(exponential(b)), [7e-6, 0.12]),
        family("half-planes", "if(y < 0, 1, 2.5)", below, above, snell, [2e-3, 0.052]),
        Family {
            hole: Some([dvec2(-0.5, -0.5), dvec2(0.5, -0.5), dvec2(0.5, 0.5), dvec2(-0.5, 0.5)]),
            ..family("1 with a square hole", "1", p, q, around(p, q), [2e-4, 0.12])
        },
    ]
}

#[test]
fn the_interval_contains_the_exact_cost_of_every_family_on_every_mesh() {
    let sizes: &[u32] = if prints_table() { &[3, 4, 5, 6] } else { &[2, 3, 4] };
    if prints_table() {
        eprintln!("| cost | mesh | nodes | error of the path | lower bound below | width |");
        eprintln!("|---|---|---|---|---|---|");
    }
    for family in families() {
        for (kind, &size) in
            ["uniform", "graded"].iter().flat_map(|kind| sizes.iter().map(move |s| (kind, s)))
        {
            let h = 1.5 / f64::from(1u32 << size);
            let grading = |x: DVec2| match *kind {
                "graded" => h * (0.35 + 0.9 * x.distance(family.finest)),
                _ => h,
            };
            let mesh = mesh(SQUARE, grading);
            // A mesh with a hole: the triangles within are closed, and none is touched from outside.
            let keep_out: Vec<Mask> = family.hole.iter().map(inner_mask).collect();
            let density = cost(family.formula);
            let solution = solve(&mesh, &density, &[family.start, family.goal], &keep_out).unwrap();
            let error = (solution.cost - family.exact) / family.exact;
            let below = (family.exact - solution.lower) / family.exact;
            if prints_table() {
                let nodes = mesh.nodes().count();
                let width = 100.0 * solution.gap();
                let percents = format!("{:.5} % | {:.3} % | {width:.3} %", 100.0 * error, 100.0 * below);
                eprintln!("| {} | {kind} | {nodes} | {percents} |", family.name);
            }
            let message = format!("{} {kind} {size}: {solution:.6?} {}", family.name, family.exact);
            let message = &message[..message.len().min(300)];
            assert!(solution.lower <= family.exact * (1.0 + 1e-12), "{message}");
            assert!(solution.upper >= family.exact * (1.0 - 1e-12), "{message}");
            assert!(solution.cost <= solution.upper && solution.lower > 0.0, "{message}");
            if size == *sizes.last().unwrap() && !prints_table() {
                assert!(error.abs() < family.limits[0], "{error} {message}");
                assert!(solution.gap() < family.limits[1], "{} {message}", solution.gap());
            }
        }
    }
}

/// Returns the mask of a hole on lines of the mesh, a little smaller so that it does not touch triangles
/// around it.
fn inner_mask(ring: &[DVec2; 4]) -> Mask {
    Mask::new(&[vec![ring.map(|corner| 0.9999 * corner).to_vec()]]).unwrap()
}

#[test]
fn the_interval_contains_the_exact_cost_of_random_radial_costs() {
    let mut random = fastrand::Rng::with_seed(1405);
    let meshes = [mesh(SQUARE, |_| 0.2), mesh(SQUARE, |x| 0.06 + 0.15 * x.length())];
    let mut done = 0;
    while done < runs(30) {
        let radial = Radial::random(&mut random);
        let [p, q] = [(); 2].map(|()| DVec2::from_angle(6.3 * random.f64()) * (0.2 + 1.3 * random.f64()));
        if !radial.is_simple(2.9) || p.angle_to(q).abs() < 0.05 || p.angle_to(q).abs() > 2.9 {
            continue;
        }
        done += 1;
        let exact = radial.exact(p, q);
        for mesh in &meshes {
            let solution = solve(mesh, &radial, &[p, q], &[]).unwrap();
            let message = format!("{radial:?} {p} {q}: {exact} {} {}", solution.lower, solution.upper);
            // The quadrature is exact to about seven digits.
            assert!(solution.lower <= exact * (1.0 + 1e-6), "{message}");
            assert!(solution.upper >= exact * (1.0 - 1e-6), "{message}");
            assert!(solution.cost <= exact * 1.002, "{} {message}", solution.cost);
            assert!(solution.gap() < 0.35, "{message}");
            // Nowhere does a metre cost less than that.
            assert!(solution.lower >= radial.floor * p.distance(q) * (1.0 - 1e-9), "{message}");
        }
    }
}

/// A cost of hills, for searches.
struct Hills(Vec<[f64; 4]>);

impl Hills {
    fn random(random: &mut fastrand::Rng) -> Self {
        let hill = |random: &mut fastrand::Rng| {
            [0.5 + 4.0 * random.f64(), 0.15 + 0.35 * random.f64(), random.f64(), random.f64()]
        };
        Self((0..random.usize(2..7)).map(|_| hill(random)).collect())
    }

    fn at_squared(&self, squared: impl Fn(DVec2) -> f64) -> f64 {
        let hill =
            |&[height, width, x, y]: &[f64; 4]| height * (-squared(dvec2(x, y)) / (width * width)).exp();
        1.0 + self.0.iter().map(hill).sum::<f64>()
    }
}

impl CostDensity for Hills {
    fn at(&self, point: DVec2) -> f64 {
        self.at_squared(|center| center.distance_squared(point))
    }

    fn range(&self, rectangle: &Rect) -> CostRange {
        let nearest = |center: DVec2| center.distance_squared(center.clamp(rectangle.min, rectangle.max));
        let farthest = |center: DVec2| {
            (center - rectangle.min).abs().max((center - rectangle.max).abs()).length_squared()
        };
        CostRange {
            least: self.at_squared(farthest) * (1.0 - 1e-13),
            greatest: self.at_squared(nearest) * (1.0 + 1e-13),
        }
    }
}

#[test]
fn a_search_on_a_fine_grid_with_many_directions_finds_nothing_better() {
    let mut random = fastrand::Rng::with_seed(1406);
    let mesh = mesh(Rect::UNIT, |_| 0.035);
    for _ in 0..20 {
        let hills = Hills::random(&mut random);
        let place = |random: &mut fastrand::Rng| {
            dvec2(f64::from(random.u32(0..=60)) / 60.0, f64::from(random.u32(0..=60)) / 60.0)
        };
        let places = [place(&mut random), place(&mut random)];
        let found = directions(&|p| hills.at(p), Rect::UNIT, places, 60, 5);
        let solution = solve(&mesh, &hills, &places, &[]).unwrap();
        // 80 directions are off by 0.3 % at most, and the grid misses narrow valleys.
        let message = format!("{places:?} {:?}: {found} {}", hills.0, solution.cost);
        assert!(solution.cost <= found * 1.002, "{message}");
        assert!(solution.cost >= found * 0.985, "{message}");
        assert!(solution.lower <= found * 1.002, "{message}");
    }
}

#[test]
fn the_intervals_of_two_meshes_of_one_field_overlap() {
    let mut random = fastrand::Rng::with_seed(1407);
    let meshes = [mesh(Rect::UNIT, |_| 0.06), mesh(Rect::UNIT, |x| 0.03 + 0.1 * x.length())];
    let (mut done, mut apart) = (0, 0);
    while done < runs(20) {
        let hills = Hills::random(&mut random);
        let keep_out: Vec<Mask> = (0..random.u32(0..3))
            .map(|_| {
                // On lines of both meshes, but for a margin: both close the same triangles.
                let corner = dvec2(f64::from(random.u32(1..6)), f64::from(random.u32(1..6))) / 8.0;
                let ring = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
                let ring = ring.map(|(x, y)| corner + 1e-6 + (0.125 - 2e-6) * dvec2(x, y));
                Mask::new(&[vec![ring.to_vec()]]).unwrap()
            })
            .collect();
        let places = [(); 2].map(|()| dvec2(random.f64(), random.f64()));
        let solutions = [0, 1].map(|n| solve(&meshes[n], &hills, &places, &keep_out));
        done += 1;
        let [Ok(a), Ok(b)] = solutions else {
            apart += 1;
            continue;
        };
        let message = format!("{places:?} {:?}: {} {} {} {}", hills.0, a.lower, a.upper, b.lower, b.upper);
        assert!(a.lower <= b.upper && b.lower <= a.upper, "{message}");
        // Between places within one or two triangles the bound says little.
        let is_resolved = places[0].distance(places[1]) > 0.2;
        assert!(!is_resolved || (a.gap() < 0.4 && b.gap() < 0.4), "{message}");
        for path in [&a.points, &b.points] {
            let is_free = |p: DVec2| !keep_out.iter().any(|mask| mask.contains(p));
            let places = (0..8).map(|n| f64::from(n) / 8.0);
            let free = |pair: &[DVec2]| places.clone().all(|share| is_free(pair[0].lerp(pair[1], share)));
            assert!(path.windows(2).all(free), "{message}");
        }
    }
    assert!(apart < done / 2, "{apart} of {done}");
}

#[test]
fn via_points_are_visited_in_order() {
    let mesh = mesh(Rect::UNIT, |_| 0.1);
    let places = [dvec2(0.1, 0.1), dvec2(0.9, 0.2), dvec2(0.3, 0.9), dvec2(0.5, 0.5)];
    let solution = solve(&mesh, &cost("2"), &places, &[]).unwrap();
    let exact: f64 = places.windows(2).map(|pair| 2.0 * pair[0].distance(pair[1])).sum();
    assert!((solution.cost - exact).abs() < 1e-6 * exact, "{} {exact}", solution.cost);
    assert!(solution.lower <= exact && solution.upper >= exact && solution.gap() < 0.05);
    assert_eq!(solution.stops.iter().map(|&stop| solution.points[stop]).collect::<Vec<_>>(), places);
    let simplified = solution.simplified(&cost("2"), 1e-3).unwrap();
    assert_eq!(simplified.points, places);
    assert!((simplified.cost - exact).abs() < 1e-9 && simplified.upper >= exact);
    let profile = solution.profile(&cost("2"), 101);
    assert!((profile[100].cost - exact).abs() < 1e-6 && (profile[50].cost - exact / 2.0).abs() < 1e-6);
}

#[test]
fn sentences_have_few_digits() {
    let at = dvec2(1.0 / 3.0, 4_512_345.671_234_5);
    let sentence = PathError::Outside { which: Waypoint::Goal, at }.to_string();
    assert!(sentence.starts_with("The goal (0.3333333, 4512346) lies outside"), "{sentence}");
    let sentence = PathError::CostOutOfRange { at, value: 1e103 / 3.0 }.to_string();
    assert!(sentence.contains("is 3.33333e102. Only"), "{sentence}");
}

#[test]
fn bad_input_has_a_sentence() {
    let mesh = mesh(Rect::UNIT, |_| 0.2);
    let (inside, outside) = (dvec2(0.3, 0.4), dvec2(1.3, 0.4));
    let one = cost("1");
    let ring = vec![dvec2(0.45, -0.1), dvec2(0.55, -0.1), dvec2(0.55, 1.1), dvec2(0.45, 1.1)];
    let wall = [Mask::new(&[vec![ring]]).unwrap()];
    let refused = |density: &FormulaCost, places: &[DVec2], keep_out: &[Mask]| {
        solve(&mesh, density, places, keep_out).unwrap_err()
    };
    assert_eq!(
        refused(&one, &[inside, outside], &[]),
        PathError::Outside { which: Waypoint::Goal, at: outside }
    );
    assert_eq!(
        refused(&one, &[inside, dvec2(0.5, 0.5), inside], &wall),
        PathError::KeptOut { which: Waypoint::Via(1), at: dvec2(0.5, 0.5) }
    );
    let apart = refused(&one, &[dvec2(0.1, 0.4), dvec2(0.9, 0.5)], &wall);
    let (from, to) = (Waypoint::Start, Waypoint::Goal);
    assert_eq!(apart, PathError::Enclosed { which: Waypoint::Goal, from, to });
    assert!(apart.to_string().starts_with("No path leads from the start to the goal: keep-out"), "{apart}");
    let nowhere = refused(&one, &[dvec2(f64::NAN, 0.0), inside], &[]);
    assert!(matches!(nowhere, PathError::NotAPlace { which: Waypoint::Start, .. }));
    assert_eq!(refused(&one, &[inside], &[]), PathError::TooFewPlaces);
    for bad in ["x - 0.5", "0", "inf", "1/(x - 0.5)", "0/0"] {
        let error = refused(&cost(bad), &[inside, dvec2(0.9, 0.5)], &[]);
        assert!(matches!(error, PathError::InvalidCost { .. }), "{bad}: {error}");
    }
    let same = solve(&mesh, &one, &[inside, inside], &[]).unwrap();
    assert_eq!((same.cost, same.lower, same.upper, same.length), (0.0, 0.0, 0.0, 0.0));
    // A mesh of two triangles.
    let lattice = Lattice::covering(Rect::UNIT, 1.0, 10).unwrap();
    let coarse = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    for places in [[dvec2(0.1, 0.05), dvec2(0.9, 0.2)], [dvec2(0.0, 0.0), dvec2(1.0, 1.0)]] {
        let solution = solve(&coarse, &one, &places, &[]).unwrap();
        let exact = places[0].distance(places[1]);
        assert!((solution.cost - exact).abs() < 1e-9 && solution.lower <= exact && solution.upper >= exact);
    }
}

#[test]
fn the_upper_bound_holds_for_a_formula_that_loses_digits() {
    // A staircase with steps of 125, though its derivative is 1000.
    let density = cost("1 + 1000*((1e15 + x) - 1e15)");
    let [p, q] = [dvec2(0.12, 0.5), dvec2(0.24, 0.5)];
    let places = (0..100_000).map(|n| (f64::from(n) + 0.5) / 1e5);
    let sum = places.map(|share| density.at(p.lerp(q, share))).sum::<f64>() * p.distance(q) / 1e5;
    let figures = PathFigures::new(&[p, q], &density, 2e-5);
    assert!(figures.upper >= sum * (1.0 - 1e-6), "{} {sum}", figures.upper);
    assert!(figures.upper <= sum * 1.01, "{} {sum}", figures.upper);
}

#[test]
fn a_planner_adapts_to_an_edit_as_a_new_one_does() {
    let mut random = fastrand::Rng::with_seed(2607);
    let mesh = Arc::new(PathMesh::new(mesh(Rect::UNIT, |_| 0.1).view()));
    let places = [dvec2(0.1, 0.1), dvec2(0.9, 0.1)];
    let new = |density: &dyn CostDensity| Planner::new(Arc::clone(&mesh), density).unwrap();
    let mut planner = new(&cost("1"));
    let mut bisected = 0;
    for round in 0..12 {
        let (at, high) = (0.1 + 0.8 * random.f64(), 1.0 + 50.0 * random.f64());
        let wall = format!("1 + {high}*(abs(y - {at}) > 0.004)");
        let density = cost(if round % 3 == 2 { "1 + x" } else { &wall });
        if round % 4 == 1 {
            planner.follow(&cost("3"), &[Rect::UNIT]).unwrap();
        }
        planner.update(&density, &[Rect::UNIT]).unwrap();
        bisected += usize::from(planner.mesh().triangle_count() > mesh.triangle_count());
        let followed = planner.solve(&density, &places, PathRequest::FULL).unwrap();
        let expected = new(&density).solve(&density, &places, PathRequest::FULL).unwrap();
        assert!(followed == expected, "{round}: {} {}", followed.cost, expected.cost);
    }
    assert!(bisected > 4, "{bisected}");
}

#[test]
fn a_planner_follows_edits_as_a_new_one_does() {
    let mut random = fastrand::Rng::with_seed(1408);
    let mesh = mesh(Rect::UNIT, |x| 0.05 + 0.1 * x.y);
    let places = [dvec2(0.07, 0.1), dvec2(0.5, 0.93), dvec2(0.9, 0.2)];
    let mut hills = Hills::random(&mut random);
    let paths = Arc::new(PathMesh::new(mesh.view()));
    let new = |hills: &Hills| Planner::on_mesh(Arc::clone(&paths), hills).unwrap();
    let mut planner = new(&hills);
    planner.solve(&hills, &places, PathRequest::FULL).unwrap();
    for round in 0..10 {
        let n = random.usize(..hills.0.len());
        hills.0[n][0] = 4.0 * random.f64();
        planner.update(&hills, &[Rect::UNIT]).unwrap();
        // Live paths pause their marches, and a dragged goal lets them go on.
        let goal = dvec2(0.5 + 0.4 * random.f64(), 0.9 * random.f64());
        let places = [places[0], places[1], if round % 3 == 0 { goal } else { places[2] }];
        let request = if round % 2 == 0 { PathRequest::FULL } else { PathRequest::LIVE };
        let followed = planner.solve(&hills, &places, request).unwrap();
        let expected = new(&hills).solve(&hills, &places, request).unwrap();
        assert!(followed == expected, "{round}: {} {}", followed.cost, expected.cost);
    }
}

//! Paths stay on the polygons of random coasts, with the clearance from land and from keep-out regions.
//!
//! The referee looks at each edge of the polygons for each piece of a path, and shares no code with what it
//! checks. `MESHBRUSH_TABLE=1` prints what became of the paths.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::random_coast::random_coast;
use crate::runs::{prints_table, seeds};
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::build::MeshBuilder;
use meshbrush_core::document::{PathPlan, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain, Polygon, Ring};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::{Mask, PaintLayers, RiskField};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::path::{
    CertificateTask, FormulaCost, PathArea, PathCertificate, PathError, PathMesh, PathRequest, Planner,
    Solution,
};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::Progress;

fn cost(formula: &str) -> FormulaCost {
    FormulaCost { formula: CostFormula::parse(formula).unwrap(), risk: RiskField::default() }
}

/// What a path keeps from: edges, and whether a point is on the wrong side of them.
struct Kept<'a> {
    edges: Vec<[DVec2; 2]>,
    polygons: &'a [Polygon],
    covers: bool,
}

impl<'a> Kept<'a> {
    /// The land: what polygons do not cover. Sides of the rectangle are no coast.
    fn land(polygons: &'a [Polygon], bounds: &Rect) -> Self {
        let step = 1e-8 * bounds.size();
        let along = |a: DVec2, b: DVec2| {
            let beside = |of: fn(DVec2) -> f64, side: f64, step| {
                (of(a) - side).abs() < step && (of(b) - side).abs() < step
            };
            let [x, y]: [fn(DVec2) -> f64; 2] = [|p| p.x, |p| p.y];
            beside(x, bounds.min.x, step.x)
                || beside(x, bounds.max.x, step.x)
                || beside(y, bounds.min.y, step.y)
                || beside(y, bounds.max.y, step.y)
        };
        let mut kept = Self { edges: edges(polygons), polygons, covers: false };
        kept.edges.retain(|&[a, b]| !along(a, b));
        kept
    }

    fn region(polygons: &'a [Polygon]) -> Self {
        Self { edges: edges(polygons), polygons, covers: true }
    }

    /// Whether a point is where no path may be: by its winding angle.
    fn holds(&self, p: DVec2) -> bool {
        let winds = |ring: &Ring| {
            let angle = |n: usize| (ring[n] - p).angle_to(ring[(n + 1) % ring.len()] - p);
            ((0..ring.len()).map(angle).sum::<f64>() / TAU).round() as i32
        };
        let covered = self.polygons.iter().any(|rings| rings.iter().map(winds).sum::<i32>() % 2 != 0);
        covered == self.covers
    }

    fn distance(&self, p: DVec2, q: DVec2) -> f64 {
        self.edges.iter().map(|&[a, b]| between([p, q], [a, b])).fold(f64::INFINITY, f64::min)
    }
}

fn edges(polygons: &[Polygon]) -> Vec<[DVec2; 2]> {
    let of_ring =
        |ring: &Ring| (0..ring.len()).map(|n| [ring[n], ring[(n + 1) % ring.len()]]).collect::<Vec<_>>();
    polygons.iter().flatten().flat_map(of_ring).collect()
}

/// The distance between two segments; 0 where they cross.
fn between([a, b]: [DVec2; 2], [p, q]: [DVec2; 2]) -> f64 {
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if turn(a, b, p) * turn(a, b, q) < 0.0 && turn(p, q, a) * turn(p, q, b) < 0.0 {
        return 0.0;
    }
    let to = |p: DVec2, a: DVec2, b: DVec2| {
        let along = b - a;
        let share = if along == DVec2::ZERO { 0.0 } else { (p - a).dot(along) / along.dot(along) };
        (p - (a + share.clamp(0.0, 1.0) * along)).length()
    };
    to(p, a, b).min(to(q, a, b)).min(to(a, p, q)).min(to(b, p, q))
}

/// Returns the mesh of a domain, as files and paths get it.
fn settings(random: &mut Rng, domain: Domain) -> Settings {
    let extent = domain.bounds.size().max_element();
    let mut settings = Settings::for_domain("coast".into(), domain);
    settings.spacing = extent / random.f64().mul_add(8.0, 4.0);
    let diameter = extent * (0.01 + 0.05 * random.f64());
    settings.boundary = match random.u8(..3) {
        0 => BoundaryTreatment::Report,
        1 => BoundaryTreatment::Fitted { diameter },
        _ => BoundaryTreatment::OnOutline { diameter },
    };
    settings
}

/// A coast, with what paths keep from, and the triangles for them.
struct Coast {
    domain: Domain,
    keep_out: Vec<Mask>,
    clearance: f64,
    mesh: Arc<PathMesh>,
    places: Vec<DVec2>,
}

impl Coast {
    /// A random coast, and places where paths may begin.
    fn random(random: &mut Rng) -> Option<Self> {
        let domain = Domain::of_polygons(&random_coast(random)).ok()?;
        let (bounds, extent) = (domain.bounds, domain.bounds.size().min_element());
        let point = |random: &mut Rng| bounds.min + dvec2(random.f64(), random.f64()) * bounds.size();
        let region = |random: &mut Rng| {
            let centre = point(random);
            let corner = |n: usize| centre + 0.08 * extent * DVec2::from_angle(TAU * n as f64 / 5.0);
            Mask::new(&[vec![(0..5).map(corner).collect()]]).unwrap()
        };
        let keep_out: Vec<Mask> = (0..random.usize(..3)).map(|_| region(random)).collect();
        let clearance = [0.0, 0.002, 0.01, 0.03][random.usize(..4)] * extent;
        let settings = settings(random, domain);
        let mut builder = MeshBuilder::new(settings.mesh_spec().ok()?);
        while builder.advance(None, 100_000).unwrap() != Progress::Done {}
        let built = builder.finish();
        let targets = built.edge_targets(PaintLayers::blank());
        let derived = DerivedMesh::new(&built.mesh, &built.domain, targets, &settings.derived_cleaning());
        let plan = PathPlan { clearance, ..PathPlan::default() };
        let area = plan.area(&settings.domain, settings.boundary).unwrap();
        let area = match keep_out.is_empty() {
            true => area,
            false => PathArea::new(&settings.domain, settings.boundary, keep_out.clone(), clearance).unwrap(),
        };
        let mesh = Arc::new(PathMesh::in_area(derived.extract(&built.mesh).view(), &area));
        let mut coast = Self { domain: settings.domain, keep_out, clearance, mesh, places: Vec::new() };
        let places = (0..40).map(|_| point(random)).filter(|&p| coast.least_distance(&[p, p]) > clearance);
        coast.places = places.collect();
        Some(coast)
    }

    /// The least distance of a polyline from what it must not meet, by each edge; −∞ where it begins inside.
    fn least_distance(&self, points: &[DVec2]) -> f64 {
        let region = self.domain.region().expect("the domain has polygons");
        let land = Kept::land(region.polygons(), &self.domain.bounds);
        let regions = self.keep_out.iter().map(|mask| Kept::region(mask.polygons()));
        let kept: Vec<Kept> = std::iter::once(land).chain(regions).collect();
        if kept.iter().any(|kept| kept.holds(points[0])) {
            return f64::NEG_INFINITY;
        }
        let pieces =
            points.windows(2).flat_map(|pair| kept.iter().map(|kept| kept.distance(pair[0], pair[1])));
        pieces.fold(f64::INFINITY, f64::min)
    }

    fn assert_is_kept(&self, points: &[DVec2], seed: u64) {
        let distance = self.least_distance(points);
        let least = self.clearance * (1.0 - 1e-9);
        assert!(distance > 0.0 && distance >= least, "{seed}: {distance} of {least}, {points:?}");
    }

    fn solve(&self, density: &FormulaCost, places: &[DVec2]) -> Result<(Solution, Arc<PathMesh>), PathError> {
        let mesh = self.mesh.detailed(&[places.to_vec()]);
        let mut planner = Planner::new(mesh, density)?;
        let solution = planner.solve(density, places, PathRequest::FULL)?;
        Ok((solution, Arc::clone(planner.mesh())))
    }
}

#[test]
fn paths_stay_on_the_polygons_with_the_clearance() {
    let mut counts = [0; 4];
    for seed in seeds(60) {
        let mut random = Rng::with_seed(seed);
        let Some(coast) = Coast::random(&mut random) else { continue };
        let extent = coast.domain.bounds.size().max_element();
        let density = cost(&["1".to_owned(), format!("1 + 2*(sin(9*x/{extent}) + 1)")][random.usize(..2)]);
        for pair in coast.places.windows(2).take(4) {
            match coast.solve(&density, pair) {
                Ok((solution, _)) => {
                    coast.assert_is_kept(&solution.points, seed);
                    let simplified = solution.simplified(&density, 0.03 * extent).unwrap();
                    coast.assert_is_kept(&simplified.points, seed);
                    counts[0] += 1;
                }
                Err(PathError::Enclosed { .. }) => counts[1] += 1,
                Err(PathError::Apart { .. }) => counts[2] += 1,
                Err(PathError::Outside { .. }) => counts[3] += 1,
                Err(error) => panic!("{seed}: {error}"),
            }
        }
    }
    if prints_table() {
        eprintln!("found, enclosed, apart, not in the mesh: {counts:?}");
    }
    assert!(counts[0] > 60 && counts[1] > 0, "{counts:?}");
}

#[test]
fn paths_that_a_proof_finds_keep_the_clearance() {
    let mut found = 0;
    for seed in seeds(6) {
        let mut random = Rng::with_seed(1000 + seed);
        let Some(coast) = Coast::random(&mut random) else { continue };
        let density = cost("1");
        let Some(pair) = coast.places.windows(2).next() else { continue };
        let Ok((solution, mesh)) = coast.solve(&density, pair) else { continue };
        let path = solution.points.clone();
        let task = CertificateTask::in_rectangle(
            coast.domain.bounds,
            Arc::new(cost("1")),
            path,
            solution.upper,
            0.01,
        );
        let task = task.unwrap().in_domain(&coast.domain).in_area(mesh.area().clone());
        let task = CertificateTask { most_nodes: 1500, ..task };
        let Ok(certificate) = PathCertificate::new(&solution, &task) else { continue };
        let mut certificate = certificate.with_search(mesh);
        while matches!(certificate.advance(), Ok(None)) {}
        let proved = certificate.solution();
        coast.assert_is_kept(&proved.points, seed);
        assert!(proved.lower <= proved.upper && proved.upper <= solution.upper, "{seed}");
        found += 1;
    }
    assert!(found > 0);
}

/// The unit square with a square island in the middle.
fn island() -> Domain {
    let square =
        |low: f64, high: f64| vec![dvec2(low, low), dvec2(high, low), dvec2(high, high), dvec2(low, high)];
    Domain::of_polygons(&[vec![square(0.0, 1.0), square(0.4, 0.6)]]).unwrap()
}

/// Triangles for the paths around the island.
fn around_island(clearance: f64, spacing: f64) -> Arc<PathMesh> {
    let settings = Settings { spacing, ..Settings::for_domain("island".into(), island()) };
    let mut builder = MeshBuilder::new(settings.mesh_spec().unwrap());
    while builder.advance(None, 100_000).unwrap() != Progress::Done {}
    let area = PathArea::new(&settings.domain, settings.boundary, Vec::new(), clearance).unwrap();
    Arc::new(PathMesh::in_area(builder.finish().mesh.extract().view(), &area))
}

#[test]
fn a_path_around_an_island_is_as_long_as_the_clearance_makes_it() {
    let (density, ends) = (cost("1"), [dvec2(0.05, 0.5), dvec2(0.95, 0.5)]);
    for (clearance, spacing) in [(0.0, 0.2), (0.05, 0.2), (0.2, 0.2), (0.2, 0.05)] {
        // Along a tangent to the circle around the corner, an arc, and straight past the island.
        let corner = dvec2(0.4, 0.6) - ends[0];
        let tangent = (corner.length_squared() - clearance * clearance).sqrt();
        let steepness = corner.to_angle() + (clearance / corner.length()).asin();
        let exact = 2.0 * (tangent + clearance * steepness) + 0.2;
        let mesh = around_island(clearance, spacing).detailed(&[ends.to_vec()]);
        let mut planner = Planner::new(mesh, &density).unwrap();
        let solution = planner.solve(&density, &ends, PathRequest::FULL).unwrap();
        let excess = solution.length / exact - 1.0;
        if prints_table() {
            eprintln!("clearance {clearance}, cells of {spacing}: {:.3} % longer", 100.0 * excess);
        }
        assert!((0.0..0.02).contains(&excess), "{clearance} {spacing}: {excess}");
        let path = solution.points.clone();
        let task = CertificateTask::in_rectangle(Rect::UNIT, Arc::new(cost("1")), path, solution.upper, 0.01);
        let task = task.unwrap().in_domain(&island()).in_area(planner.mesh().area().clone());
        let mut certificate =
            PathCertificate::new(&solution, &task).unwrap().with_search(Arc::clone(planner.mesh()));
        while certificate.advance().unwrap().is_none() {}
        assert!(certificate.lower() <= exact && certificate.upper() >= exact, "{clearance} {spacing}");
        assert!(certificate.lower() > 0.98 * exact, "{clearance} {spacing}: {}", certificate.lower());
    }
}

#[test]
fn places_that_are_too_close_are_refused_with_the_distance() {
    let density = cost("1");
    let solve = |clearance: f64, from: DVec2| {
        let places = [from, dvec2(0.9, 0.9)];
        let mesh = around_island(clearance, 0.2).detailed(&[places.to_vec()]);
        Planner::new(mesh, &density).unwrap().solve(&density, &places, PathRequest::FULL)
    };
    // A place 1 mm from the coast is no nearer than paths may be, but in a triangle that the coast crosses.
    assert!(solve(0.0, dvec2(0.399, 0.5)).is_ok());
    assert!(solve(0.05, dvec2(0.349, 0.5)).is_ok());
    let text = |clearance, from| solve(clearance, from).unwrap_err().to_string();
    assert_eq!(
        text(0.05, dvec2(0.38, 0.5)),
        "The start (0.38, 0.5) is only 0.02 from the outline of the domain or a keep-out region, and the clearance of \
         paths is 0.05. Choose a place farther away, or a smaller clearance."
    );
    for clearance in [0.0, 0.05] {
        let expected = "The start (0.41, 0.5) lies on the outline of the domain or beyond it";
        let text = text(clearance, dvec2(0.41, 0.5));
        assert!(
            text.starts_with(expected) || text.starts_with("The start (0.41, 0.5) lies outside"),
            "{text}"
        );
    }
    // Between the island and the sides of the rectangle there is room: they are no coast.
    assert!(solve(0.39, dvec2(0.001, 0.5)).is_ok());
    assert!(text(0.41, dvec2(0.001, 0.5)).contains("the clearance of paths is 0.41"));
    for clearance in [-1.0, f64::NAN, f64::INFINITY] {
        let error = PathArea::new(&island(), BoundaryTreatment::Report, Vec::new(), clearance)
            .unwrap_err()
            .to_string();
        assert!(error.ends_with("is no distance: it must be a finite number from 0."), "{error}");
    }
}

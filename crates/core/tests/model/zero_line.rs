//! Meshes of domains by formulas whose zero lines are known, by a checker that reads triangles and knows the
//! line, and nothing of how the mesh was made.

use std::f64::consts::PI;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainShape};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_core::outline::{DerivedMesh, OutlineFit};
use meshbrush_mesh::geometry::{LatticePoint, Rect};
use meshbrush_mesh::mesh::{Extract, NodeId};

use crate::runs::{prints_table, seeds};

/// A domain by a formula, with what is known about its line.
struct Shape {
    formula: String,
    /// Returns the distance of a point from the line, apart from factors near 1.
    distance: Box<dyn Fn(DVec2) -> f64>,
    corners: Vec<DVec2>,
    area: f64,
}

/// Returns a point as the formula of a coordinate from it.
fn from_point(p: DVec2) -> [String; 2] {
    [format!("(x - ({:?}))", p.x), format!("(y - ({:?}))", p.y)]
}

fn disc(center: DVec2, radius: f64) -> Shape {
    let [x, y] = from_point(center);
    Shape {
        formula: format!("{x}^2 + {y}^2 < {radius:?}^2"),
        distance: Box::new(move |p| p.distance(center) - radius),
        corners: Vec::new(),
        area: PI * radius * radius,
    }
}

fn ring(center: DVec2, radius: f64) -> Shape {
    let [x, y] = from_point(center);
    let inner = 0.4 * radius;
    Shape {
        formula: format!("not (hypot({x}, {y}) > {radius:?}) and hypot({x}, {y}) >= {inner:?}"),
        distance: Box::new(move |p| {
            let r = p.distance(center);
            (r - radius).abs().min((r - inner).abs())
        }),
        corners: Vec::new(),
        area: PI * (radius * radius - inner * inner),
    }
}

/// A square that is turned.
fn square(center: DVec2, half: f64, angle: f64) -> Shape {
    let [x, y] = from_point(center);
    let (sin, cos) = angle.sin_cos();
    let [along, across] = [format!("({cos:?}*{x} + {sin:?}*{y})"), format!("({cos:?}*{y} - {sin:?}*{x})")];
    let [u, v] = [dvec2(cos, sin), dvec2(-sin, cos)];
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    Shape {
        formula: format!("max(abs{along}, abs{across}) - {half:?} < 0"),
        distance: Box::new(move |p| {
            let [a, b] = [u.dot(p - center).abs(), v.dot(p - center).abs()];
            a.max(b) - half
        }),
        corners: corners.map(|[a, b]| center + half * (a * u + b * v)).to_vec(),
        area: 4.0 * half * half,
    }
}

/// What two discs have in common, with two corners.
fn lens(center: DVec2, radius: f64, angle: f64) -> Shape {
    let (sin, cos) = angle.sin_cos();
    let [towards, up] = [dvec2(cos, sin), dvec2(-sin, cos)];
    let apart = 0.5 * radius;
    let centers = [center - apart * towards, center + apart * towards];
    let [[x, y], [z, w]] = centers.map(from_point);
    let tip = (radius * radius - apart * apart).sqrt() * up;
    Shape {
        formula: format!("{x}^2 + {y}^2 < {radius:?}^2 and hypot({z}, {w}) < {radius:?}"),
        distance: Box::new(move |p| {
            centers.map(|c| p.distance(c) - radius).into_iter().fold(f64::NEG_INFINITY, f64::max)
        }),
        corners: vec![center + tip, center - tip],
        area: 2.0 * radius * radius * (apart / radius).acos() - 2.0 * apart * tip.length(),
    }
}

/// A half-plane by a jump, and without values on the other side.
fn half_plane(through: DVec2, angle: f64, bounds: &Rect) -> Shape {
    let [x, y] = from_point(through);
    let normal = DVec2::from_angle(angle);
    let text = format!("if({:?}*{x} + {:?}*{y} < 0, 1, sqrt(-1))", normal.x, normal.y);
    let corners = [
        dvec2(bounds.min.x, bounds.min.y),
        dvec2(bounds.max.x, bounds.min.y),
        bounds.max,
        dvec2(bounds.min.x, bounds.max.y),
    ];
    Shape {
        formula: text,
        distance: Box::new(move |p| normal.dot(p - through)),
        corners: Vec::new(),
        area: clipped_area(&corners, through, normal),
    }
}

/// Returns the area of the part of a polygon where a normal points away from it.
fn clipped_area(ring: &[DVec2], through: DVec2, normal: DVec2) -> f64 {
    let height = |p: DVec2| normal.dot(p - through);
    let mut kept = Vec::new();
    for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        if height(a) < 0.0 {
            kept.push(a);
        }
        if (height(a) < 0.0) != (height(b) < 0.0) {
            kept.push(a.lerp(b, height(a) / (height(a) - height(b))));
        }
    }
    shoelace(&kept)
}

fn shoelace(ring: &[DVec2]) -> f64 {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| 0.5 * a.perp_dot(*b)).sum()
}

fn random_shape(random: &mut Rng, bounds: &Rect) -> Shape {
    let side = bounds.size().min_element();
    let center = bounds.center() + 0.1 * side * dvec2(random.f64() - 0.5, random.f64() - 0.5);
    let (radius, angle) = (side * (0.15 + 0.25 * random.f64()), 6.0 * random.f64());
    match random.u32(0..5) {
        0 => disc(center, radius),
        1 => ring(center, radius),
        2 => square(center, 0.7 * radius, angle),
        3 => lens(center, radius, angle),
        _ => half_plane(center, angle, bounds),
    }
}

/// A mesh of a domain by a formula, as files get it.
struct Finished {
    follower: Follower,
    derived: DerivedMesh,
    missed: Vec<DVec2>,
}

impl Finished {
    fn new(settings: Settings) -> Self {
        let mut document = Document::new(settings, None).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        let (mesh, domain) = (follower.mesh(), follower.domain());
        let targets = follower.edge_targets(document.paint());
        let derived = DerivedMesh::new(mesh, domain, targets, &document.settings().derived_cleaning());
        let extract = derived.extract(mesh);
        assert_eq!(derived.violations(&extract), []);
        let missed = document.settings().outline().unwrap().missed_corners(&extract);
        Self { derived, missed, follower }
    }

    fn extract(&self) -> Extract<'_> {
        self.derived.extract(self.follower.mesh())
    }

    fn fit(&self) -> OutlineFit {
        self.derived.fit().unwrap()
    }
}

fn settings_of(formula: &str, bounds: Rect) -> Settings {
    let shape = DomainShape::from(Formula::parse(formula).unwrap());
    Settings::for_domain("formula".into(), Domain { bounds, shape, projection: None })
}

/// What a checker finds about a mesh.
#[derive(Debug)]
struct Found {
    /// Nodes of the boundary, but those on the sides of the rectangle.
    boundary_nodes: usize,
    /// Those that are farther from the line than the lattice explains.
    off_line: usize,
    /// The largest distance of the others, in lattice steps.
    farthest_steps: f64,
    area: f64,
    /// The largest distance of a known corner to the nearest node, of those that are not listed.
    farthest_corner: f64,
    smallest_angle: f64,
}

/// More than this many lattice steps from the line, a node is off it: the grid of polygons, their corners on
/// the lattice and the node itself are rounded, each by up to half a diagonal, besides the tolerance of chords.
const STEPS: f64 = 2.7;

fn check(finished: &Finished, shape: &Shape, bounds: &Rect) -> Found {
    let extract = finished.extract();
    let world = |node: usize| extract.world(NodeId::from_index(node));
    let [low, high] = [0, 1].map(|n| extract.lattice().world_from_lattice(LatticePoint::new(n, n)));
    let step = (high - low).max_element();
    let on_side = |p: DVec2| {
        let margin = 2.0 * step;
        ((p - bounds.min).abs().min_element() < margin) || ((p - bounds.max).abs().min_element() < margin)
    };
    let nodes: Vec<DVec2> =
        extract.boundary_loops().iter().flatten().map(|&n| world(n)).filter(|&p| !on_side(p)).collect();
    let steps: Vec<f64> = nodes.iter().map(|&p| (shape.distance)(p).abs() / step).collect();
    let near =
        |at: DVec2, places: &[DVec2]| places.iter().map(|p| p.distance(at)).fold(f64::INFINITY, f64::min);
    let is_listed = |at: &&DVec2| near(**at, &finished.missed) < 1e-6 * bounds.size().max_element();
    let corners = shape.corners.iter().filter(|at| !is_listed(at));
    let triangles: Vec<[DVec2; 3]> =
        extract.triangles().iter().map(|triangle| triangle.vertices.map(|n| world(n.index()))).collect();
    let angle = |[a, b, c]: [DVec2; 3]| (b - a).angle_to(c - a).abs().to_degrees();
    let turned = |[a, b, c]: [DVec2; 3]| [[a, b, c], [b, c, a], [c, a, b]];
    Found {
        boundary_nodes: nodes.len(),
        off_line: steps.iter().filter(|&&at| at > STEPS).count(),
        farthest_steps: steps.iter().copied().filter(|&at| at <= STEPS).fold(0.0, f64::max),
        area: triangles.iter().map(|corners| shoelace(corners).abs()).sum(),
        farthest_corner: corners.map(|&at| near(at, &nodes)).fold(0.0, f64::max),
        smallest_angle: triangles.into_iter().flat_map(turned).map(angle).fold(180.0, f64::min),
    }
}

#[test]
fn the_disc_of_the_report_has_its_area_at_the_settings_of_the_window() {
    let bounds = Rect::new(DVec2::splat(-1.0), DVec2::ONE);
    let shape = disc(DVec2::ZERO, 0.447);
    let finished = Finished::new(settings_of(&shape.formula, bounds));
    let found = check(&finished, &shape, &bounds);
    assert!((found.area - shape.area).abs() < 1e-4, "{found:?}");
    assert_eq!((found.off_line, finished.fit().nodes), (0, found.boundary_nodes), "{found:?}");
}

#[test]
fn the_area_converges_with_the_second_order() {
    let bounds = Rect::new(DVec2::splat(-0.5), DVec2::splat(0.5));
    let shape = disc(dvec2(0.01, 0.02), 0.2_f64.sqrt());
    let error = |diameter: f64| {
        let mut settings = settings_of(&shape.formula, bounds);
        settings.boundary = BoundaryTreatment::OnOutline { diameter };
        (check(&Finished::new(settings), &shape, &bounds).area - shape.area).abs()
    };
    let errors = [0.02, 0.01, 0.005].map(error);
    let orders = [0, 1].map(|n| (errors[n] / errors[n + 1]).log2());
    if prints_table() {
        eprintln!("{errors:?} {orders:?}");
    }
    assert!(orders.iter().all(|order| (1.8..2.2).contains(order)), "{errors:?} {orders:?}");
}

#[test]
fn nodes_of_random_formulas_lie_on_their_lines_and_corners_are_nodes_or_listed() {
    let (mut nodes, mut off, mut corners, mut missed) = (0, 0, 0, 0);
    let mut farthest_steps: f64 = 0.0;
    for seed in seeds(12) {
        let mut random = Rng::with_seed(seed);
        let size = 10f64.powi(random.i32(-3..4)) * dvec2(1.0, 0.5 + random.f64());
        let min = size * dvec2(random.f64() - 0.5, 3.0 * random.f64() - 2.0);
        let bounds = Rect::new(min, min + size);
        let shape = random_shape(&mut random, &bounds);
        let mut settings = settings_of(&shape.formula, bounds);
        let side = size.min_element();
        let diameter = side * 0.05 * 0.2f64.powf(random.f64());
        settings.spacing = side / f64::from(random.u32(3..12));
        settings.boundary = BoundaryTreatment::OnOutline { diameter };
        settings.transfer = Transfer::between(0.01 * diameter, 10.0 * side);
        settings.layers = Layer::default_stack(LayerKind::constant(diameter * (1.0 + 5.0 * random.f64())));
        let finished = Finished::new(settings);
        let found = check(&finished, &shape, &bounds);
        if prints_table() {
            eprintln!("{seed}: {} {found:?} {:?} {:?}", shape.formula, finished.fit(), finished.missed);
        }
        let fit = finished.fit();
        assert!(found.off_line <= fit.nodes - fit.on_outline, "seed {seed}: {found:?} {fit:?}");
        assert!(found.farthest_corner < 1e-6 * size.max_element(), "seed {seed}: {found:?}");
        // A chord of length d is at most d²/8r beside an arc.
        let perimeter = found.boundary_nodes as f64 * diameter;
        let slack = perimeter * diameter * diameter / (0.5 * side) + off_area(&found, diameter);
        assert!((found.area - shape.area).abs() <= slack, "seed {seed}: {found:?} {}", shape.area);
        assert!(found.smallest_angle > 18.4 || !shape.corners.is_empty(), "seed {seed}: {found:?}");
        nodes += found.boundary_nodes;
        off += found.off_line;
        corners += shape.corners.len();
        missed += finished.missed.len();
        farthest_steps = farthest_steps.max(found.farthest_steps);
    }
    if prints_table() {
        eprintln!("{off} of {nodes} nodes off, the others at most {farthest_steps} steps");
        eprintln!("{missed} of {corners} corners missed");
    }
    assert!(nodes > 500 && 100 * off <= 3 * nodes, "{off} of {nodes}");
    assert!(corners > 5 && 2 * missed <= corners, "{missed} of {corners}");
}

/// Returns the area that nodes beside the line can cost.
fn off_area(found: &Found, diameter: f64) -> f64 {
    found.off_line as f64 * diameter * diameter
}

#[test]
fn as_in_the_report_it_is_a_staircase_and_fitted_follows_the_line_by_centroids() {
    let bounds = Rect::new(DVec2::splat(-0.5), DVec2::splat(0.5));
    let shape = disc(DVec2::ZERO, 0.447);
    let area = |boundary: BoundaryTreatment| {
        let settings = Settings { boundary, ..settings_of(&shape.formula, bounds) };
        let mut document = Document::new(settings, None).unwrap();
        let follower = Follower::new(&mut document).unwrap();
        follower.mesh().area()
    };
    assert!((area(BoundaryTreatment::Report) - shape.area).abs() > 0.02);
    let diameter = 0.002;
    assert!((area(BoundaryTreatment::Fitted { diameter }) - shape.area).abs() < 1e-3);
}

#[test]
fn what_has_no_line_is_as_in_the_report() {
    for formula in ["x*0 == 0", "sin(1e9*x)*sin(1e9*y) > 0", "x > -9"] {
        let at = |boundary: BoundaryTreatment| {
            let settings = Settings { boundary, ..settings_of(formula, Rect::UNIT) };
            let mut document = Document::new(settings, None).unwrap();
            Follower::new(&mut document).unwrap().mesh().fingerprint()
        };
        let [report, outline] =
            [BoundaryTreatment::Report, BoundaryTreatment::default_for(1.0 / 24.0)].map(at);
        assert_eq!(report, outline, "{formula}");
    }
}

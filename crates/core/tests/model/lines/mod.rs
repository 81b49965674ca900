//! Meshes with edges along lines, against a checker that knows only nodes, triangles and lines.

mod judge;
pub mod random;

use std::sync::Arc;

use crate::outline::shape;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use judge::{edges, judge, smallest_angle, smallest_feature};
use meshbrush_core::build::{BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain, Line, LineKind};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{Layer, LayerKind, LineGaps, LineSizes, PaintLayers, SizeFieldSpec};
use meshbrush_core::outline::{DerivedMesh, LineProblem, MeshDerivation};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress, Updater};
use random::{hostile_lines, in_other_order, line, lines};

use crate::formula_mesh::formula_mesh;
use crate::random_coast::random_coast;
use crate::runs::{prints_table, seeds};

/// What angles are held to, in degrees, where nothing meets at less.
const LEAST_ANGLE: f64 = 18.4;

fn square() -> Domain {
    Domain::rectangle(Rect::UNIT)
}

fn derived(built: &BuiltMesh, lines: &[Line]) -> DerivedMesh {
    let domain = built.domain.clone().with_lines(lines);
    DerivedMesh::new(&built.mesh, &domain, None, &Cleaning::NONE)
}

/// Returns the smallest angle that lines leave: 18.4°, or 0.8 times the angle at which they meet.
fn bound(lines: &[Line]) -> f64 {
    let angle = smallest_angle(lines);
    (if angle < LEAST_ANGLE { 0.8 * angle } else { LEAST_ANGLE }) - 1e-4
}

/// Checks what holds of each mesh with lines: the area, angles, and what is said of the lines. Returns the
/// length of lines on edges, and how much of it is in the domain.
fn check(built: &BuiltMesh, lines: &[Line], bound: f64, name: &str) -> [f64; 2] {
    let derived = derived(built, lines);
    let extract = derived.extract(&built.mesh);
    let found = judge(&extract, lines, name);
    assert_eq!(derived.violations(&extract), [], "{name}");
    assert!(found.smallest_angle >= bound, "{name}: {} instead of {bound}", found.smallest_angle);
    assert_eq!(derived.line_fits().len(), lines.len(), "{name}");
    let mut sums = [0.0; 2];
    let rounding = 1e-6f64.max(200.0 * built.mesh.lattice().step().max_element());
    for ((fit, line), on_edges) in derived.line_fits().iter().zip(lines).zip(found.on_edges) {
        let length: f64 = edges(line).iter().map(|[a, b]| a.distance(*b)).sum();
        let left_out: f64 = fit.unresolved.iter().map(|place| place.length).sum();
        let outside = fit.unresolved.iter().filter(|place| place.problem != LineProblem::TooCoarse);
        let outside: f64 = outside.map(|place| place.length).sum();
        assert!((fit.length - length).abs() < 1e-9 * length.max(1.0), "{name}: {fit:?}");
        // Corners are rounded, and a line may lie on edges by chance.
        assert!((fit.length_on_edges + left_out - length).abs() < rounding, "{name}: {length} {fit:?}");
        assert!(fit.length_on_edges <= on_edges + rounding, "{name}: {on_edges} {fit:?}");
        assert_eq!(fit.farthest > rounding, left_out > rounding, "{name}: {fit:?}");
        let coarse = fit.unresolved.iter().filter(|place| place.problem == LineProblem::TooCoarse);
        assert!(coarse.into_iter().all(|place| place.diameter.is_some_and(|d| d >= 0.0)), "{name}");
        sums = [sums[0] + fit.length_on_edges, sums[1] + length - outside];
    }
    sums
}

/// Checks that other orders and directions of the lines give the same mesh.
fn check_order(built: &BuiltMesh, lines: &[Line], random: &mut Rng, name: &str) {
    let others = in_other_order(lines, random);
    let [one, other] = [lines, &others].map(|lines| derived(built, lines));
    let [one, other] = [one, other].map(|derived| shape(&derived.extract(&built.mesh)));
    assert!(one == other, "{name}: another mesh for lines in another order");
}

/// Where nothing is nearer to each other than the triangles are large, all of every line is on edges.
#[test]
fn lines_that_the_mesh_resolves_lie_on_edges() {
    let built = formula_mesh(&square(), 0.11, BoundaryTreatment::Report, "0.02");
    let (mut cases, mut length) = (0, 0.0);
    for seed in seeds(200) {
        let random = &mut Rng::with_seed(seed);
        let lines = lines(random);
        if smallest_angle(&lines) < 25.0 || smallest_feature(&lines) < 0.03 {
            continue;
        }
        let name = format!("seed {seed}");
        let [on_edges, inside] = check(&built, &lines, LEAST_ANGLE, &name);
        assert!(inside - on_edges < 1e-6, "{name}: {on_edges} of {inside}");
        check_order(&built, &lines, random, &name);
        (cases, length) = (cases + 1, length + on_edges);
    }
    if prints_table() {
        eprintln!("{cases} sets of lines, {length} on edges");
    }
    assert!(cases > 5, "{cases}");
}

/// Lines that meet anywhere and anyhow, in meshes of one size or of many.
#[test]
fn any_lines_keep_the_angles_of_the_mesh() {
    let (mut sums, mut counts) = ([0.0; 2], 0);
    for target in ["0.1", "0.03", "0.01 + 0.2 * hypot(x - 0.3, y - 0.6)"] {
        let built = formula_mesh(&square(), 0.11, BoundaryTreatment::Report, target);
        for seed in seeds(10) {
            let random = &mut Rng::with_seed(seed);
            let lines = if random.bool() { lines(random) } else { hostile_lines(random) };
            let name = format!("{target}, seed {seed}");
            let [on_edges, inside] = check(&built, &lines, bound(&lines), &name);
            check_order(&built, &lines, random, &name);
            sums = [sums[0] + on_edges, sums[1] + inside];
            counts += 1;
        }
    }
    if prints_table() {
        eprintln!("{counts} sets of lines, {} of {} on edges", sums[0], sums[1]);
    }
    assert!(sums[0] > 0.8 * sums[1], "{sums:?}");
}

#[test]
fn the_area_of_a_square_does_not_change() {
    let built = formula_mesh(&square(), 0.2, BoundaryTreatment::Report, "0.05");
    for seed in seeds(20) {
        let lines = hostile_lines(&mut Rng::with_seed(seed));
        let extract = derived(&built, &lines);
        let found = judge(&extract.extract(&built.mesh), &lines, "square");
        assert!((found.area - 1.0).abs() < 1e-12, "seed {seed}: {}", found.area);
    }
}

/// A breakwater, a closed basin, a T and a crossing, whose figures a person can check.
#[test]
fn simple_lines_lie_on_edges_with_the_figures_that_are_said() {
    let built = formula_mesh(&square(), 0.1, BoundaryTreatment::Report, "0.05");
    let lines = [
        line(&[[0.0, 0.31], [0.4, 0.37]], false),
        line(&[[0.5, 0.5], [0.83, 0.52], [0.8, 0.81], [0.51, 0.79]], true),
        line(&[[0.2, 0.34], [0.23, 0.91]], false),
        line(&[[0.1, 0.7], [0.42, 0.62]], false),
    ];
    let derived = derived(&built, &lines);
    for (fit, line) in derived.line_fits().iter().zip(&lines) {
        let length: f64 = edges(line).iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((fit.length_on_edges - length).abs() < 1e-12, "{fit:?}");
        assert!(fit.farthest == 0.0 && fit.unresolved.is_empty(), "{fit:?}");
        let is_chain = fit.edges.windows(2).all(|pair| pair[0][1] == pair[1][0]);
        assert!(is_chain && fit.edges.len() >= (length / 0.07) as usize, "{fit:?}");
    }
    let found = judge(&derived.extract(&built.mesh), &lines, "simple lines");
    assert!(found.smallest_angle > 25.0, "{found:?}");
}

/// What cannot be edges is listed with its place and a reason.
#[test]
fn what_has_no_edges_is_listed() {
    let built = formula_mesh(&square(), 0.1, BoundaryTreatment::Report, "0.05");
    let problems = |lines: &[Line]| {
        let derived = derived(&built, lines);
        let problem = |fit: &meshbrush_core::outline::LineFit| {
            fit.unresolved.iter().map(|place| (place.problem, place.place)).collect::<Vec<_>>()
        };
        derived.line_fits().iter().map(problem).collect::<Vec<_>>()
    };
    let nan = f64::NAN;
    let beyond = line(&[[0.5, 0.5], [2.5, 0.5]], false);
    assert_eq!(problems(&[beyond]), [vec![(LineProblem::OutsideDomain, dvec2(1.75, 0.5))]]);
    let far = line(&[[1e300, 3.0], [-1e300, 3.0]], false);
    assert!(problems(&[far])[0].iter().all(|(problem, _)| *problem == LineProblem::OutsideDomain));
    let point = line(&[[0.3, 0.4]; 3], true);
    assert_eq!(problems(&[point]), [vec![(LineProblem::NoLength, dvec2(0.3, 0.4))]]);
    assert_eq!(problems(&[line(&[], true)])[0][0].0, LineProblem::NoLength);
    let not_finite = line(&[[0.3, 0.4], [nan, 0.5], [0.6, 0.4], [0.8, 0.4]], false);
    assert_eq!(problems(&[not_finite])[0][0].0, LineProblem::NotFinite);
    // Two lines a hundredth of a triangle apart: one of them has edges.
    let near = [line(&[[0.2, 0.3], [0.7, 0.3]], false), line(&[[0.2, 0.3005], [0.7, 0.3005]], false)];
    let found = problems(&near);
    assert!(found[0].is_empty() != found[1].is_empty(), "{found:?}");
    assert!(found.iter().flatten().all(|(problem, _)| *problem == LineProblem::TooCoarse), "{found:?}");
}

#[test]
fn lines_that_are_nearly_equal_are_one() {
    let built = formula_mesh(&square(), 0.1, BoundaryTreatment::Report, "0.05");
    let one = line(&[[0.21, 0.33], [0.72, 0.41], [0.6, 0.8]], false);
    let mut other = one.clone();
    other.points.iter_mut().for_each(|p| *p += dvec2(1e-12, -1e-12));
    other.points.insert(1, one.points[0].lerp(one.points[1], 0.37) + dvec2(0.0, 1e-12));
    let derived = derived(&built, &[one, other]);
    assert!(derived.line_fits().iter().all(|fit| fit.unresolved.is_empty()), "{:?}", derived.line_fits());
}

/// The mesh of a random coast with lines in it.
#[test]
fn lines_on_coasts_keep_the_coast() {
    let mut sums = [0.0; 2];
    for seed in seeds(5) {
        let random = &mut Rng::with_seed(seed);
        let domain = Domain::of_polygons(&random_coast(random)).unwrap();
        let spacing = domain.bounds.size().max_element() / (2.0 + 6.0 * random.f64());
        let diameter = spacing * 0.04 * 12f64.powf(random.f64());
        let target = format!("{}", spacing * (0.1 + random.f64()));
        let built = formula_mesh(&domain, spacing, BoundaryTreatment::OnOutline { diameter }, &target);
        let mut lines = if random.bool() { lines(random) } else { hostile_lines(random) };
        // One along a part of the outline.
        let ring = domain.region().unwrap().rings().next().unwrap().to_vec();
        let part = ring[..ring.len().min(5)].to_vec();
        lines.push(Line { name: "outline".into(), points: part, closed: false, kind: LineKind::Edges });
        let name = format!("seed {seed}");
        let without = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::NONE);
        let before = judge(&without.extract(&built.mesh), &[], &name);
        let [on_edges, inside] = check(&built, &lines, 0.0, &name);
        check_order(&built, &lines, random, &name);
        let with = derived(&built, &lines);
        let after = judge(&with.extract(&built.mesh), &lines, &name);
        // Nodes move along the outline.
        assert!((after.area - before.area).abs() < 0.02 * before.area, "{name}: {before:?} {after:?}");
        let [fit, former] = [with.fit().unwrap(), without.fit().unwrap()];
        assert_eq!(fit, former, "{name}: the fit before lines");
        sums = [sums[0] + on_edges, sums[1] + inside];
    }
    assert!(sums[0] > 0.5 * sums[1], "{sums:?}");
}

/// A staircase of whole coarse cells, which touches itself in nodes.
#[test]
fn lines_in_a_domain_by_formula_end_at_its_stairs() {
    let formula = Formula::parse("sin(9 * x) * sin(7 * y) > 0.1").unwrap();
    let domain = Domain { shape: formula.into(), ..square() };
    let built = formula_mesh(&domain, 0.09, BoundaryTreatment::Report, "0.04");
    for seed in seeds(15) {
        let random = &mut Rng::with_seed(seed);
        let lines = if random.bool() { lines(random) } else { hostile_lines(random) };
        let name = format!("seed {seed}");
        check(&built, &lines, 0.0, &name);
        let extract = derived(&built, &lines).extract(&built.mesh).into_owned();
        let area = built.mesh.extract().area();
        assert!((judge(&extract, &lines, &name).area - area).abs() < 1e-9, "{name}: another area");
        check_order(&built, &lines, random, &name);
        let on_lattice = built.domain.clone().with_lines(&lines);
        let cleaned = DerivedMesh::new(&built.mesh, &on_lattice, None, &Cleaning::FOR_SOLVERS);
        let extract = cleaned.extract(&built.mesh);
        assert_eq!(cleaned.violations(&extract), [], "{name}");
        let found = judge(&extract, &lines, &name);
        for (fit, on_edges) in cleaned.line_fits().iter().zip(found.on_edges) {
            assert!(fit.length_on_edges <= on_edges + 1e-6, "{name}: {on_edges} {fit:?}");
        }
    }
}

fn built_by_area(target: f64) -> BuiltMesh {
    built_by(LayerKind::constant(target))
}

fn built_by(layer: impl Into<LayerKind>) -> BuiltMesh {
    let domain = square();
    let limits = Limits::default();
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, 0.11, limits.max_triangles).unwrap(),
        domain,
        boundary: BoundaryTreatment::Report,
        lines: Default::default(),
        field: SizeFieldSpec {
            layers: Layer::stack([layer.into()]),
            transfer: Transfer::between(1e-3, f64::MAX),
            unasked: f64::MAX,
            outline: None,
            gradation: None,
            projection: None,
        },
        rule: RefinementRule::Area,
        cleaning: Cleaning::NONE,
        limits,
    });
    while builder.advance(None, 1000).unwrap() == Progress::More {}
    builder.finish()
}

#[test]
fn no_edge_is_longer_than_its_target_beside_lines() {
    let target = 0.04;
    let built = built_by_area(target);
    let paint = PaintLayers::default();
    let (mut any, mut triangles, mut sums) = (0.0f64, [0; 2], [0.0; 2]);
    for seed in seeds(20) {
        let lines = lines(&mut Rng::with_seed(seed));
        let domain = built.domain.clone().with_lines(&lines);
        let kept = [built.edge_targets(&paint), None].map(|targets| {
            let derived = DerivedMesh::new(&built.mesh, &domain, targets, &Cleaning::NONE);
            let on_edges: f64 = derived.line_fits().iter().map(|fit| fit.length_on_edges).sum();
            (judge(&derived.extract(&built.mesh), &lines, &format!("seed {seed}")), on_edges)
        });
        let [(kept, on_edges), (free, free_on_edges)] = kept;
        assert!(kept.longest_edge <= target * (1.0 + 1e-9), "seed {seed}: {}", kept.longest_edge);
        assert!(kept.smallest_angle >= bound(&lines), "seed {seed}: {}", kept.smallest_angle);
        any = any.max(free.longest_edge / target);
        triangles = [triangles[0] + kept.triangles, triangles[1] + free.triangles];
        sums = [sums[0] + on_edges, sums[1] + free_on_edges];
    }
    // The checker would find them.
    assert!(any > 1.05, "{any}");
    assert!(100 * triangles[0] <= 105 * triangles[1], "{triangles:?}");
    assert!(sums[0] > 0.98 * sums[1], "{sums:?}");
}

/// The order of the mesh's entries, the number of threads, and work in slices make no difference.
#[test]
fn the_result_depends_on_mesh_and_lines_alone() {
    let built = formula_mesh(&square(), 0.11, BoundaryTreatment::Report, "0.02 + 0.05 * x");
    let lines: Vec<Line> = (0..4).flat_map(|seed| lines(&mut Rng::with_seed(seed))).collect();
    let expected = derived(&built, &lines);
    let mut mesh = built.mesh.clone();
    let all = LatticeRect { min: LatticePoint::new(0, 0), max: mesh.lattice().extent() };
    let part =
        LatticeRect { min: LatticePoint::new(0, 0), max: LatticePoint::new(all.max.x / 2, all.max.y / 3) };
    let mut updater = Updater::new(Limits::default());
    for (area, fine) in [(all, None), (part, Some(part)), (all, Some(all))] {
        updater.add(area);
        let criterion = built.criterion(None);
        let exceeds = |corners: [LatticePoint; 3], level: u32| {
            let is_fine = fine.is_some_and(|area| area.touches(corners));
            (is_fine || level < 3) && criterion.exceeds_at(corners, level)
        };
        while updater.advance(&mut mesh, &|| exceeds, 1000).unwrap() == Progress::More {}
    }
    assert_eq!(mesh.fingerprint(), built.mesh.fingerprint());
    assert!(mesh.raw_nodes() != built.mesh.raw_nodes());
    let domain = built.domain.clone().with_lines(&lines);
    let found = DerivedMesh::new(&mesh, &domain, None, &Cleaning::NONE);
    assert!(shape(&found.extract(&mesh)) == shape(&expected.extract(&built.mesh)));
    assert_eq!(found.line_fits(), expected.line_fits());

    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let on_one = pool.install(|| derived(&built, &lines));
    assert_eq!((on_one.patch(), on_one.line_fits()), (expected.patch(), expected.line_fits()));

    let mut derivation =
        MeshDerivation::new(Arc::new(built.mesh.clone()), domain, None, Cleaning::NONE, false);
    while derivation.advance() == Progress::More {}
    let in_slices = derivation.take_derived().unwrap();
    assert_eq!((in_slices.patch(), in_slices.line_fits()), (expected.patch(), expected.line_fits()));
}

/// A line with a hundred thousand corners, far more than the mesh resolves.
#[test]
fn more_corners_than_the_mesh_resolves_are_listed() {
    let built = formula_mesh(&square(), 0.11, BoundaryTreatment::Report, "0.05");
    let count = 100_000;
    let corner = |k: usize| {
        let angle = k as f64 / count as f64 * std::f64::consts::TAU;
        dvec2(0.5, 0.5) + (0.3 + 0.05 * (40.0 * angle).sin()) * DVec2::from_angle(angle)
    };
    let curve = Line {
        name: "curve".into(),
        points: (0..count).map(corner).collect(),
        closed: true,
        kind: LineKind::Edges,
    };
    let derived = derived(&built, &[curve]);
    let found = judge(&derived.extract(&built.mesh), &[], "curve");
    assert!(found.smallest_angle >= LEAST_ANGLE, "{found:?}");
    let fit = &derived.line_fits()[0];
    assert!(fit.length_on_edges < 0.1 * fit.length && !fit.unresolved.is_empty(), "{fit:?}");
    assert!(fit.unresolved.iter().all(|place| place.diameter.is_some_and(|d| d < 1e-3)), "{fit:?}");
}

/// A document whose layer asks for what its lines need, in a mesh that is coarse elsewhere.
#[test]
fn a_layer_of_lines_makes_the_mesh_fine_enough() {
    let (mut sums, mut counts) = ([0.0; 2], [0; 2]);
    for seed in seeds(12) {
        let random = &mut Rng::with_seed(seed);
        let lines = lines(random);
        let name = format!("seed {seed}");
        let built = built_by(LineSizes {
            gaps: LineGaps::of(&Arc::new(lines.clone()), &square()),
            ..LineSizes::default()
        });
        let [on_edges, inside] = check(&built, &lines, bound(&lines), &name);
        sums = [sums[0] + on_edges, sums[1] + inside];
        counts = [counts[0] + 1, counts[1] + built.mesh.triangle_count()];
    }
    if prints_table() {
        eprintln!(
            "{} sets of lines, {} of {} on edges, {} triangles",
            counts[0], sums[0], sums[1], counts[1]
        );
    }
    // What is left has gaps below the smallest diameter, or meets at small angles.
    assert!(sums[0] > 0.98 * sums[1], "{sums:?}");
}

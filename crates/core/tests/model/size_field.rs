//! The size field against closed forms: gradation over slopes, layers of any size, and the meaning of risk 0.

use std::sync::Arc;

use crate::closure;
use closure::Triangle;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::build::{MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    Combine, DistanceLayer, DistanceTo, Layer, LayerKind, Mask, PaintLayers, RasterLayer, RasterReading,
    RasterSource, ShapeList, Shapes, SizeField, SizeFieldSpec, Threat, ThreatLaw, Threats,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress};

const TRANSFER: Transfer = Transfer::between(1e-4, 0.5);

fn field_on(lattice: &Lattice, layers: Vec<Layer>, gradation: Option<f64>) -> SizeField {
    let spec = SizeFieldSpec {
        layers,
        transfer: TRANSFER,
        unasked: 0.5,
        outline: None,
        gradation,
        projection: None,
    };
    SizeField::new(spec, lattice)
}

fn field(layers: Vec<Layer>, gradation: Option<f64>) -> SizeField {
    field_on(&Lattice::covering(Rect::UNIT, 0.25, 1000).unwrap(), layers, gradation)
}

fn distance_to(at: DVec2, at_zero: f64, slope: f64, range: f64) -> LayerKind {
    let shapes = Shapes::new(ShapeList { points: vec![at], ..ShapeList::default() }, false).unwrap();
    DistanceLayer { to: DistanceTo::Shapes { name: "point".into(), shapes }, at_zero, slope, range }.into()
}

/// Returns the triangle with a right angle at the lower left corner of a dyadic square of 2^bits steps.
fn triangle_at(lattice: &Lattice, at: DVec2, bits: u32) -> [LatticePoint; 3] {
    let place = lattice.lattice_from_world(at);
    let [x, y] = [place.x as u32 >> bits << bits, place.y as u32 >> bits << bits];
    let side = 1 << bits;
    [LatticePoint::new(x, y), LatticePoint::new(x + side, y), LatticePoint::new(x, y + side)]
}

/// With h = d₀ + s |x − c| and the gradation g, h̄ = d₀ + min(s, g) |x − c|.
#[test]
fn a_cone_is_limited_to_the_slope_of_gradation() {
    let mut random = Rng::with_seed(1);
    let (center, gradation) = (dvec2(0.37, 0.61), 0.3);
    for slope in [0.5, 0.31, 0.3, 0.27, 0.1] {
        let text = format!("0.01 + {slope}*hypot(x - {}, y - {})", center.x, center.y);
        let kinds = [
            LayerKind::target(Formula::parse(&text).unwrap()),
            distance_to(center, 0.01, slope, f64::INFINITY),
        ];
        for kind in kinds {
            let field = field(Layer::stack([kind]), Some(gradation));
            for _ in 0..40 {
                let point = dvec2(random.f64(), random.f64());
                let expected = 0.01 + slope.min(gradation) * point.distance(center);
                let found = field.target_at(PaintLayers::blank(), point);
                assert!((found / expected - 1.0).abs() < 2e-6, "slope {slope}: {found} for {expected}");
                let vertex = field.target_by_rule(RefinementRule::Vertex, PaintLayers::blank(), point);
                assert_eq!(vertex, found);
            }
        }
    }
}

/// A referee by brute force: the least of h(y) + g |x − y| over a fine grid is never below h̄, and above it
/// by at most what h and the distance change within a square of the grid.
#[test]
fn gradation_is_that_of_a_fine_grid_of_points() {
    let mut random = Rng::with_seed(2);
    const SIDE: usize = 300;
    for _ in 0..30 {
        let slope = [0.1, 0.3, 0.31, 0.8][random.usize(..4)];
        let gradation = [0.2, 0.3, 0.5][random.usize(..3)];
        let at = dvec2(random.f64(), random.f64());
        let (a, b) = (3.0 + 5.0 * random.f64(), 0.02 * random.f64());
        let wave = format!("0.1 + {b}*sin({a}*x)*cos({a}*y)");
        let kinds = [
            LayerKind::target(Formula::parse(&wave).unwrap()),
            distance_to(at, 0.02 + 0.05 * random.f64(), slope, 0.3),
        ];
        let layers = Layer::stack(kinds);
        let [plain, graded] = [None, Some(gradation)].map(|gradation| field(layers.clone(), gradation));
        let places: Vec<DVec2> = (0..SIDE * SIDE)
            .map(|n| (dvec2((n % SIDE) as f64, (n / SIDE) as f64) + 0.5) / SIDE as f64)
            .collect();
        let blank = PaintLayers::blank();
        let ungraded: Vec<f64> = places.iter().map(|&place| plain.target_at(blank, place)).collect();
        for _ in 0..10 {
            let x = dvec2(random.f64(), random.f64());
            let carried = places.iter().zip(&ungraded).map(|(y, h)| h + gradation * y.distance(x));
            let expected = carried.fold(f64::INFINITY, f64::min);
            let found = graded.target_at(blank, x);
            let error = (slope.max(a * b * 1.5) + gradation) * 0.75 / SIDE as f64;
            assert!(found <= expected * (1.0 + 1e-6), "{found} above {expected}");
            assert!(found >= expected - error, "{found} far below {expected}, {error}");
        }
    }
}

/// Returns the distance of a point from a triangle in units of the world, by its edges.
fn distance_from(p: DVec2, corners: [DVec2; 3]) -> f64 {
    let side = |n: usize| (corners[(n + 1) % 3] - corners[n]).perp_dot(p - corners[n]);
    if (0..3).all(|n| side(n) >= 0.0) || (0..3).all(|n| side(n) <= 0.0) {
        return 0.0;
    }
    let from_edge = |n: usize| {
        let (a, b) = (corners[n], corners[(n + 1) % 3]);
        p.distance(a.lerp(b, ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0)))
    };
    (0..3).map(from_edge).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_mesh_around_a_point_is_the_smallest_that_meets_the_closed_form() {
    for (spacing, at, slope, gradation) in [
        (0.1, dvec2(0.3, 0.3), 0.3, 0.2),
        (0.1, dvec2(0.3001, 0.7), 0.31, 0.3),
        (0.25, dvec2(0.4, 0.45), 0.15, 0.3),
        (0.05, dvec2(0.5, 0.5), 0.5, 0.3),
    ] {
        let lattice = Lattice::covering(Rect::UNIT, spacing, 1000).unwrap();
        let cone = format!("0.01 + {slope}*hypot(x - {}, y - {})", at.x, at.y);
        let kinds =
            [distance_to(at, 0.01, slope, f64::INFINITY), LayerKind::target(Formula::parse(&cone).unwrap())];
        for kind in kinds {
            let layers = Layer::stack([kind]);
            let mut builder = MeshBuilder::new(MeshSpec {
                domain: Domain::rectangle(lattice.bounds()),
                boundary: BoundaryTreatment::Report,
                lines: Default::default(),
                lattice,
                field: SizeFieldSpec {
                    layers,
                    transfer: TRANSFER,
                    unasked: 0.5,
                    outline: None,
                    gradation: Some(gradation),
                    projection: None,
                },
                rule: RefinementRule::Area,
                cleaning: Cleaning::NONE,
                limits: Limits::default(),
            });
            while builder.advance(None, 1000).unwrap() == Progress::More {}
            let mesh = builder.finish().mesh;
            let found = mesh
                .raw_triangles()
                .iter()
                .map(|t| t.vertices.map(|v| [i64::from(mesh.node(v).x), i64::from(mesh.node(v).y)]));
            let [columns, rows] = lattice.cells().map(i64::from);
            let cell = i64::from(lattice.cell_steps());
            let asks = |t: &Triangle| {
                let corners = t.map(|[x, y]| dvec2(x as f64, y as f64) * lattice.step());
                let least = 0.01 + slope.min(gradation) * distance_from(at, corners);
                let level = closure::level(cell, t);
                let whole = lattice.spacing() / f64::from(1u32 << (level / 2));
                let length = if level.is_multiple_of(2) { whole * 2f64.sqrt() } else { whole };
                least < length * (1.0 - 1e-7)
            };
            let expected = closure::refine(closure::coarse(columns, rows, cell, |_, _| true), asks);
            assert!(
                closure::set_of(found) == closure::set_of(expected),
                "{spacing} {at} {slope} {gradation}"
            );
        }
    }
}

#[test]
fn layers_of_any_size_are_seen_where_they_touch_a_triangle() {
    let mut random = Rng::with_seed(3);
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1000).unwrap();
    let blank = PaintLayers::blank();
    for size in [1e-3, 1e-5, 1e-7, 1e-8] {
        for round in 0..60 {
            let at = dvec2(0.1 + 0.8 * random.f64(), 0.1 + 0.8 * random.f64());
            let square = Rect::around(at, size);
            let kind = match round % 4 {
                0 => {
                    let threat = Threat { at, range: 2.0 * size, peak: 1.0, law: ThreatLaw::Radar };
                    Threats::new(vec![threat]).unwrap().into()
                }
                1 => LayerKind::constant(0.001),
                2 => distance_to(at, 0.001, 0.1, size),
                _ => {
                    let raster = Raster::from_values(square, [1, 1], vec![0.001]);
                    let source =
                        RasterSource { name: "pixel".into(), raster: Arc::new(RasterPyramid::new(raster)) };
                    RasterLayer { source, reading: RasterReading::Diameter }.into()
                }
            };
            let mut layers = Layer::stack([kind]);
            if round % 4 == 1 {
                let Rect { min, max } = square;
                let ring = vec![min, dvec2(max.x, min.y), max, dvec2(min.x, max.y)];
                layers[0].mask = Some(Mask::new(&[vec![ring]]).unwrap());
            }
            let field = field_on(&lattice, layers, None);
            let corners = triangle_at(&lattice, at, 24);
            let [right_angle, _, upper] = corners;
            let inside = lattice.lattice_from_world(at) - right_angle.as_dvec2();
            let is_inside = inside.x + inside.y < f64::from(upper.y - right_angle.y);
            let margin = 10.0 * size / lattice.step().x;
            let distance = (f64::from(upper.y - right_angle.y) - inside.x - inside.y).abs();
            if distance > margin && inside.min_element() > margin {
                assert_eq!(
                    field.asks_for_more(blank, corners, 10),
                    is_inside,
                    "round {round}, {size} at {at}"
                );
            }
        }
    }
}

#[test]
fn huge_pixels_far_from_the_domain_are_those_of_near_pixels() {
    let line = 500_000.0;
    let bounds = Rect::around(dvec2(line, line), 0.0045);
    let lattice = Lattice::covering(bounds, 0.001, 1000).unwrap();
    let source = |bounds: Rect| {
        let raster = Raster::from_values(bounds, [2, 2], vec![5e-5, 0.01, 0.01, 5e-4]);
        RasterSource { name: "raster".into(), raster: Arc::new(RasterPyramid::new(raster)) }
    };
    let far = source(Rect::new(DVec2::ZERO, dvec2(2.0 * line, 2.0 * line)));
    let near = source(Rect::around(dvec2(line, line), 1.0));
    let fields = [far, near].map(|source| {
        let kind = LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter });
        let transfer = Transfer::between(1e-5, TRANSFER.h_max);
        let layers = Layer::stack([kind]);
        let spec = SizeFieldSpec {
            layers,
            transfer,
            unasked: 0.5,
            outline: None,
            gradation: None,
            projection: None,
        };
        SizeField::new(spec, &lattice)
    });
    let mut random = Rng::with_seed(4);
    let mut asked = 0;
    for _ in 0..2000 {
        let at = bounds.min + dvec2(random.f64(), random.f64()) * 0.99 * bounds.size();
        let (corners, level) = (triangle_at(&lattice, at, random.u32(4..20)), random.u32(0..14));
        let [far, near] = [0, 1].map(|n| fields[n].asks_for_more(PaintLayers::blank(), corners, level));
        assert_eq!(far, near, "{corners:?} at level {level}");
        asked += usize::from(near);
    }
    assert!(asked > 200 && asked < 1800, "{asked}");
}

#[test]
fn threats_ask_for_nothing_beyond_their_ranges() {
    let threat = Threat { at: dvec2(0.2, 0.2), range: 0.1, peak: 1.0, law: ThreatLaw::Radar };
    for combine in [Combine::Floor, Combine::Replace, Combine::Finest] {
        let mut layers =
            Layer::stack([LayerKind::constant(0.1), LayerKind::Threats(Threats::new(vec![threat]).unwrap())]);
        layers[1].combine = combine;
        let threats = layers[1].id;
        let field = field(layers, None);
        for rule in [RefinementRule::Area, RefinementRule::Vertex] {
            let beyond = field.target_by_rule(rule, PaintLayers::blank(), dvec2(0.9, 0.9));
            assert_eq!(beyond, 0.1, "{combine:?} {rule:?}");
        }
        let decision = field.decision_at(PaintLayers::blank(), dvec2(0.9, 0.9));
        assert_ne!(decision.layer, Some(threats));
        assert_eq!(decision.asked[1], (threats, None));
        let within = field.decision_at(PaintLayers::blank(), dvec2(0.2, 0.2));
        let expected = if combine == Combine::Floor { 0.1 } else { TRANSFER.h_min };
        assert_eq!(within.target, expected, "{combine:?}");
    }
}

#[test]
fn the_diameter_for_a_risk_is_that_of_the_formula() {
    let values: Vec<f32> = (1..64).map(|n| n as f32 / 64.3).collect();
    let raster = Raster::from_values(Rect::UNIT, [63, 1], values.clone());
    let source = RasterSource { name: "risk".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    let field = field(Layer::stack([RasterLayer { source, reading: RasterReading::Risk }]), None);
    for (n, risk) in values.iter().enumerate() {
        let found = field.target_at(PaintLayers::blank(), dvec2((n as f64 + 0.5) / 63.0, 0.5));
        let expected = TRANSFER.h_max * (TRANSFER.h_min / TRANSFER.h_max).powf(f64::from(*risk));
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
    }
}

/// Any risk at all asks for more than a length of h_max.
#[test]
fn many_threats_that_lie_apart_ask_where_they_are_and_nowhere_else() {
    let mut random = Rng::with_seed(9);
    let lattice = Lattice::covering(Rect::UNIT, 0.1, 1_000_000).unwrap();
    let transfer = Transfer::between(1e-6, 0.1);
    for range in [1e-2, 1e-4, 1e-6] {
        let threat = |random: &mut Rng| Threat {
            at: dvec2(random.f64(), random.f64()),
            range,
            peak: 0.2 + 0.8 * random.f64(),
            law: ThreatLaw::ALL[random.usize(..3)].0,
        };
        let threats: Vec<Threat> = (0..60).map(|_| threat(&mut random)).collect();
        let layers = Layer::stack([Threats::new(threats.clone()).unwrap()]);
        let spec = SizeFieldSpec {
            layers,
            transfer,
            unasked: 0.1,
            outline: None,
            gradation: None,
            projection: None,
        };
        let field = SizeField::new(spec, &lattice);
        let mut asked = 0;
        for n in 0..200 {
            let near = threats[n % threats.len()].at;
            let corners = triangle_at(&lattice, near, random.u32(22..27));
            let world = corners.map(|corner| lattice.world_from_lattice(corner));
            let distance =
                threats.iter().map(|t| distance_from(t.at, world) / range).fold(f64::INFINITY, f64::min);
            // At the rim, the risk is too small to tell.
            if (0.9..1.1).contains(&distance) {
                continue;
            }
            let asks = field.asks_for_more(PaintLayers::blank(), corners, 1);
            assert_eq!(asks, distance < 1.0, "{corners:?} at {distance} ranges");
            asked += usize::from(asks);
        }
        assert!((20..180).contains(&asked), "{asked} of range {range}");
    }
}

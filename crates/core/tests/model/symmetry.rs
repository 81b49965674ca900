//! Mirrored, turned, moved and scaled inputs give mirrored (…) meshes, and a layer that asks for nothing
//! changes nothing.
//!
//! Every place is a multiple of 2⁻²⁰ in the unit square, so that lattices map onto each other exactly.

use std::sync::Arc;

use crate::runs::seeds;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::build::{BuiltMesh, MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain, OutlineOnEarth, Polygon, corners};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    BandLayer, Combine, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, Mask, PaintLayers, Quantity,
    RasterLayer, RasterReading, RasterSource, ShapeList, Shapes, SizeFieldSpec, Threat, ThreatLaw, Threats,
    ValueCurve,
};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, NodeId, Progress};

const SPACING: f64 = 0.25;

/// A symmetry of the unit square, then a scale, then a move. All numbers are sums of few powers of two.
#[derive(Clone, Copy, Debug)]
struct Map {
    /// Quarter turns, after the mirror.
    turns: u32,
    /// Whether x is mirrored first.
    mirrors: bool,
    scale: f64,
    offset: DVec2,
}

const IDENTITY: Map = Map { turns: 0, mirrors: false, scale: 1.0, offset: DVec2::ZERO };

impl Map {
    fn square(&self, [x, y]: [f64; 2], side: f64) -> [f64; 2] {
        let mut p = if self.mirrors { [side - x, y] } else { [x, y] };
        for _ in 0..self.turns {
            p = [side - p[1], p[0]];
        }
        p
    }

    fn point(&self, p: DVec2) -> DVec2 {
        DVec2::from(self.square(p.to_array(), 1.0)) * self.scale + self.offset
    }

    fn points(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|&p| self.point(p)).collect()
    }

    /// Returns a polygon whose outer ring still runs anticlockwise.
    fn polygon(&self, polygon: &Polygon) -> Polygon {
        let ring = |ring: &Vec<DVec2>| {
            let mut ring = self.points(ring);
            if self.mirrors {
                ring.reverse();
            }
            ring
        };
        polygon.iter().map(ring).collect()
    }

    fn rect(&self, rect: &Rect) -> Rect {
        Rect::spanning(self.point(rect.min), self.point(rect.max))
    }

    /// Returns a formula in x and y of the unit square, as one of the mapped point.
    fn formula(&self, text: &str) -> Formula {
        let inverse = |name: &str, offset: f64| format!("(({name} - ({offset})) / {})", self.scale);
        let mut place = [inverse("u", self.offset.x), inverse("v", self.offset.y)];
        for _ in 0..self.turns {
            place = [place[1].clone(), format!("(1 - {})", place[0])];
        }
        if self.mirrors {
            place[0] = format!("(1 - {})", place[0]);
        }
        let [x, y] = place;
        let text = text.replace('x', "X").replace('y', "Y").replace("eXp", "exp").replace("hYpot", "hypot");
        let text = text.replace('X', &x).replace('Y', &y).replace('u', "x").replace('v', "y");
        let text = format!("{} * ({text})", self.scale);
        Formula::parse(&text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    /// Returns where the pixel of a square picture comes from.
    fn pixels(&self, side: u32, values: &[f32]) -> Vec<f32> {
        let mut mapped = values.to_vec();
        for (number, &value) in values.iter().enumerate() {
            let at = [number as u32 % side, number as u32 / side].map(|n| f64::from(n) + 0.5);
            let [x, y] = self.square(at, f64::from(side)).map(|v| v as u32);
            mapped[(y * side + x) as usize] = value;
        }
        mapped
    }
}

/// Returns a place with coordinates that are multiples of 2⁻²⁰.
fn place(random: &mut Rng) -> DVec2 {
    let coordinate = |random: &mut Rng| f64::from(random.u32(1..1 << 20)) / f64::from(1 << 20);
    dvec2(coordinate(random), coordinate(random))
}

/// Returns a length that is a multiple of 2⁻²⁰, from 2⁻¹² to 0.2.
fn length(random: &mut Rng) -> f64 {
    let steps = 256.0 * (0.2 * 4096f64).powf(random.f64());
    steps.round() / f64::from(1 << 20)
}

fn square(centre: DVec2, half: f64) -> Vec<DVec2> {
    corners(&Rect::around(centre, half))
}

/// Returns a layer of a random kind, mapped.
fn layer(random: &mut Rng, id: u32, map: &Map) -> Layer {
    let (size, at, s) = (length(random), place(random), map.scale);
    let diameter = (0.2 + random.f64()) * size;
    let end = at + size * dvec2(1.0, if random.bool() { 0.5 } else { -1.0 });
    let [p, q] = [at, end].map(|p| map.point(p));
    let number = random.usize(..8);
    let kind = match number {
        0 => {
            let text = format!("if(hypot(x - {}, y - {}) < {size}, {diameter}, inf)", at.x, at.y);
            LayerKind::target(map.formula(&text))
        }
        1 => LayerKind::target(map.formula(&format!("0.05 + {} * hypot(x - {}, y - {})", 0.5, at.x, at.y))),
        2 => {
            let values: Vec<f32> = (0..64).map(|_| 0.05 + 0.2 * random.f32()).collect();
            let values: Vec<f32> = map.pixels(8, &values).iter().map(|value| value * s as f32).collect();
            let bounds = map.rect(&Rect::new(DVec2::splat(0.125), DVec2::splat(0.625)));
            let raster = Arc::new(RasterPyramid::new(Raster::from_values(bounds, [8, 8], values)));
            let source = RasterSource { name: "pixels".into(), raster };
            match random.usize(..3) {
                0 => LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter }),
                1 => {
                    let knots = vec![[0.1 * s, 0.02 * s], [0.2 * s, 0.2 * s]];
                    let curve = Arc::new(ValueCurve::new(knots).unwrap());
                    RasterLayer { source, reading: RasterReading::Curve(curve) }.into()
                }
                _ => LayerKind::Band(BandLayer { source, between: [0.1 * s, 0.2 * s], diameter: 0.03 * s }),
            }
        }
        3 => {
            let law = ThreatLaw::ALL[random.usize(..3)].0;
            let mut threat = || Threat { at: p, range: s * size * 4.0, peak: 0.5 * random.f64(), law };
            LayerKind::Threats(Threats::new(vec![threat(), Threat { at: q, ..threat() }]).unwrap())
        }
        _ => {
            let list = match number {
                4 => ShapeList { points: vec![p, q], ..ShapeList::default() },
                5 => ShapeList { lines: vec![vec![p, q]], ..ShapeList::default() },
                _ => {
                    ShapeList { polygons: vec![map.polygon(&vec![square(at, size)])], ..ShapeList::default() }
                }
            };
            let shapes = Shapes::new(list, random.bool()).unwrap();
            let to = DistanceTo::Shapes { name: String::new(), shapes };
            let slope = 0.2 + random.f64();
            let range = if random.bool() { f64::INFINITY } else { s * 2.0 * length(random) };
            DistanceLayer { to, at_zero: s * diameter, slope, range }.into()
        }
    };
    let combine = [Combine::Finest, Combine::Finest, Combine::Floor, Combine::Replace][random.usize(..4)];
    let polygon = vec![square(place(random), 0.2 + 0.2 * random.f64())];
    let mask = random.bool().then(|| Mask::new(&[map.polygon(&polygon)]).unwrap());
    // Floors and replacements everywhere would leave nothing to compare.
    let combine = if mask.is_some() { combine } else { Combine::Finest };
    Layer { combine, mask, ..Layer::new(LayerId(id), "layer", kind) }
}

/// Returns a random stack, mapped. The base layer bisects every coarse triangle, after which the grid has all
/// symmetries of the square.
fn spec(seed: u64, map: &Map, domain: &Domain) -> SizeFieldSpec {
    let mut random = Rng::with_seed(seed);
    let s = map.scale;
    let mut layers = Layer::stack([LayerKind::constant(0.2 * s)]);
    for id in 1..random.u32(2..5) {
        layers.push(layer(&mut random, id, map));
    }
    if random.usize(..3) == 0 {
        let distance = LayerKind::Distance(DistanceLayer {
            to: DistanceTo::Outline,
            at_zero: 0.04 * s,
            slope: 0.5,
            range: f64::INFINITY,
        });
        layers.push(Layer::new(LayerId(9), "outline", distance));
    }
    SizeFieldSpec {
        layers,
        transfer: Transfer::between(1e-4 * s, 0.25 * s),
        unasked: 0.25 * s,
        outline: domain.as_region().and_then(|region| Shapes::outline(&region).ok()),
        gradation: (random.usize(..3) == 0).then(|| 0.25 + random.f64()),
        projection: None,
    }
}

fn built(domain: Domain, boundary: BoundaryTreatment, field: SizeFieldSpec, scale: f64) -> BuiltMesh {
    let lattice = Lattice::covering(domain.bounds, SPACING * scale, 1000).unwrap();
    let (rule, cleaning, limits) = (RefinementRule::Area, Cleaning::FOR_SOLVERS, Limits::default());
    let mut builder = MeshBuilder::new(MeshSpec {
        domain,
        boundary,
        lines: Default::default(),
        lattice,
        field,
        rule,
        cleaning,
        limits,
    });
    while builder.advance(None, 10_000).unwrap() == Progress::More {}
    builder.finish()
}

/// Returns the triangles as corners in lattice coordinates, mapped, in the order of their corners.
fn triangles(built: &BuiltMesh, map: &Map, derived: bool) -> Vec<[[i64; 2]; 3]> {
    let (mesh, cleaning) = (&built.mesh, Cleaning::NONE);
    let side = f64::from(mesh.lattice().extent().x);
    let mapped = |p: LatticePoint| {
        map.square([f64::from(p.x), f64::from(p.y)], side).map(|coordinate| coordinate as i64)
    };
    let whole = mesh.extract();
    let derived_mesh =
        DerivedMesh::new(mesh, &built.domain, built.edge_targets(PaintLayers::blank()), &cleaning);
    let extract = if derived { derived_mesh.extract(mesh) } else { whole };
    let corners = |corners: [usize; 3]| {
        let mut corners = corners.map(|node| mapped(extract.node(NodeId::from_index(node))));
        corners.sort_unstable();
        corners
    };
    let mut triangles: Vec<_> = extract.cells().map(|cell| corners(cell.corners)).collect();
    triangles.sort_unstable();
    triangles
}

fn any_map(random: &mut Rng) -> Map {
    let symmetry = Map { turns: random.u32(..4), mirrors: random.bool(), ..IDENTITY };
    let moved = |random: &mut Rng| f64::from(random.i32(-64..64)) / 8.0;
    match random.usize(..3) {
        0 => symmetry,
        1 => Map { scale: 2f64.powi(random.i32(-20..20)), ..symmetry },
        _ => Map { offset: dvec2(moved(random), moved(random)), ..symmetry },
    }
}

#[test]
fn mirrored_turned_moved_and_scaled_stacks_give_such_meshes() {
    let mut count = 0;
    for seed in seeds(30) {
        let map = any_map(&mut Rng::with_seed(seed));
        let mesh = |map: &Map| {
            let domain = Domain::rectangle(map.rect(&Rect::UNIT));
            let field = spec(seed, map, &domain);
            built(domain, BoundaryTreatment::Report, field, map.scale)
        };
        let (plain, mapped) = (mesh(&IDENTITY), mesh(&map));
        assert!(
            triangles(&plain, &map, false) == triangles(&mapped, &IDENTITY, false),
            "stack {seed} with {map:?}: {} and {} triangles",
            plain.mesh.triangle_count(),
            mapped.mesh.triangle_count()
        );
        count += plain.mesh.triangle_count();
    }
    assert!(count > 30 * 200, "{count}");
}

/// Returns a polygon with a hole, which reaches the sides of its frame.
fn coast(random: &mut Rng) -> Polygon {
    let round = |p: DVec2| (p * 1024.0).round() / 1024.0;
    let outer = (0..12).map(|n| {
        let angle = std::f64::consts::TAU * f64::from(n) / 12.0;
        let radius = 0.3 + 0.2 * random.f64();
        round(DVec2::splat(0.5) + radius * dvec2(angle.cos(), angle.sin()))
    });
    let mut outer: Vec<DVec2> = outer.collect();
    outer[0].x = 1.0;
    (outer[3].y, outer[6].x, outer[9].y) = (1.0, 0.0, 0.0);
    let mut hole = square(round(DVec2::splat(0.5)), 0.125);
    hole.reverse();
    vec![outer, hole]
}

/// Compares meshes of polygons; with `derived`, those with nodes on the outline.
fn compare_coasts(derived: bool, default: u64) {
    for seed in seeds(default) {
        let mut random = Rng::with_seed(1000 + seed);
        let (map, polygon) = (any_map(&mut random), coast(&mut random));
        let mesh = |map: &Map| {
            let polygons = vec![map.polygon(&polygon)];
            let domain =
                Domain::of_stored_polygons(polygons, map.rect(&Rect::UNIT), &OutlineOnEarth::default())
                    .unwrap();
            let boundary = BoundaryTreatment::OnOutline { diameter: 0.05 * map.scale };
            let field = spec(seed, map, &domain);
            built(domain, boundary, field, map.scale)
        };
        let (plain, mapped) = (mesh(&IDENTITY), mesh(&map));
        let [plain, mapped] = [triangles(&plain, &map, derived), triangles(&mapped, &IDENTITY, derived)];
        let differing = plain.iter().filter(|triangle| mapped.binary_search(triangle).is_err()).count();
        // Where two places are equally good for a node, smoothing takes the first in the order of its search,
        // and the triangles around that node differ.
        let allowed = if derived { plain.len() / 50 } else { 0 };
        assert!(
            differing <= allowed && plain.len() == mapped.len(),
            "coast {seed} with {map:?}: {differing} of {} and {}",
            plain.len(),
            mapped.len()
        );
    }
}

#[test]
fn mirrored_turned_moved_and_scaled_coasts_give_such_meshes() {
    compare_coasts(false, 12);
}

#[test]
fn nodes_on_mirrored_turned_moved_and_scaled_coasts_are_mapped_too() {
    compare_coasts(true, 12);
}

#[test]
fn a_layer_that_asks_for_nothing_changes_nothing() {
    for seed in seeds(4) {
        let domain = Domain::rectangle(Rect::UNIT);
        let stack = spec(seed, &IDENTITY, &domain);
        let mesh = |field: SizeFieldSpec| {
            built(Domain::rectangle(Rect::UNIT), BoundaryTreatment::Report, field, 1.0).mesh.fingerprint()
        };
        let expected = mesh(stack.clone());
        let threat = Threat { at: dvec2(0.4, 0.6), range: 0.3, peak: 0.0, law: ThreatLaw::Radar };
        let infinite = Formula::parse("if(x > 5, 0.01, inf)").unwrap();
        let elsewhere = Mask::new(&[vec![square(dvec2(3.0, 3.0), 0.5)]]).unwrap();
        let fine = || LayerKind::constant(0.001);
        let layer = |kind| Layer::new(LayerId(50), "nothing", kind);
        let neutral = [
            layer(LayerKind::paint(Quantity::Risk)),
            layer(LayerKind::paint(Quantity::Diameter)),
            layer(LayerKind::constant(f64::INFINITY)),
            layer(LayerKind::target(infinite)),
            layer(LayerKind::Threats(Threats::new(vec![threat]).unwrap())),
            Layer { visible: false, ..layer(fine()) },
            Layer { mask: Some(elsewhere), ..layer(fine()) },
        ];
        for (number, layer) in neutral.into_iter().enumerate() {
            for combine in Combine::ALL {
                for place in [0, stack.layers.len()] {
                    let mut with = stack.clone();
                    with.layers.insert(place, Layer { combine, ..layer.clone() });
                    assert_eq!(mesh(with), expected, "layer {number} by {combine:?} in stack {seed}");
                }
            }
        }
    }
}

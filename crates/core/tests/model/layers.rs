//! The size field against its definition, on random stacks of layers.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::closure;
use crate::stacks::{Bounds, Definition, Field, GRAIN, combined, touches};
use closure::{Point, Triangle};
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::build::{MeshBuilder, MeshSpec};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{
    Combine, DistanceLayer, DistanceTo, FormulaLayer, Layer, LayerId, LayerKind, LevelCache, PaintLayers,
    Quantity, RasterLayer, RasterReading, RasterSource, Shapes, SizeField, SizeFieldSpec,
};
use meshbrush_core::raster::{
    PixelGrid, Raster, RasterPyramid, TILE, Tile, TilePlace, TiledRaster, ValueRanges,
};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress};

const SPACING: f64 = 0.25;

/// A random stack on a domain, with its definition.
struct Case {
    spec: SizeFieldSpec,
    paint: PaintLayers,
    lattice: Lattice,
    visible: Vec<Definition>,
    bounds: Bounds,
}

fn combine(random: &mut Rng) -> Combine {
    [Combine::Finest, Combine::Finest, Combine::Floor, Combine::Replace][random.usize(..4)]
}

/// Diameters of triangles.
const ROUND: [f32; 5] = [0.03125, 0.0625, 0.125, 0.25, 0.5];

/// Returns a risk on a knot of the table of the transfer curve, or a diameter that a 32-bit float has
/// exactly: now and then that of triangles.
fn value(random: &mut Rng, quantity: Quantity) -> f32 {
    match quantity {
        Quantity::Diameter | Quantity::Error if random.u32(..4) == 0 => ROUND[random.usize(..ROUND.len())],
        Quantity::Risk => random.u32(..=64) as f32 / 64.0,
        Quantity::Diameter | Quantity::Error => random.u32(1..200) as f32 / 256.0,
    }
}

fn quantity(random: &mut Rng) -> Quantity {
    if random.bool() { Quantity::Risk } else { Quantity::Diameter }
}

/// Returns the diameter for a value. `nothing` is the risk that asks for nothing, if one does.
fn reading(quantity: Quantity, transfer: Transfer, nothing: Option<f64>) -> impl Fn(f64) -> f64 {
    move |value| match quantity {
        _ if value.is_nan() => f64::INFINITY,
        Quantity::Diameter => value,
        Quantity::Error => f64::INFINITY,
        Quantity::Risk if Some(value) == nothing => f64::INFINITY,
        Quantity::Risk if value <= 0.0 => transfer.h_max,
        Quantity::Risk if value >= 1.0 => transfer.h_risk,
        Quantity::Risk => {
            transfer.h_max * (transfer.h_risk / transfer.h_max).powf(value.powf(transfer.shape))
        }
    }
}

impl Case {
    fn random(seed: u64, h_min: f64) -> Self {
        let mut random = Rng::with_seed(seed);
        let size = dvec2(1.0, if random.bool() { 1.0 } else { 0.75 });
        let lattice = Lattice::covering(Rect::new(DVec2::ZERO, size), SPACING, 1000).unwrap();
        let h_max = if random.bool() { 0.41 } else { 7.0 };
        let h_risk = if seed.is_multiple_of(2) { h_min } else { (2.5 * h_min).min(h_max) };
        let transfer = Transfer { h_min, h_risk, h_max, shape: 1.3 };
        let unasked = if h_max > 1.0 { SPACING * 2f64.sqrt() } else { h_max };
        let gradation = random.bool().then(|| 0.1 + random.f64());
        let bounds = Bounds { h_min, h_max, unasked, gradation };
        let mut case = Self {
            spec: SizeFieldSpec {
                layers: Vec::new(),
                transfer,
                unasked,
                outline: None,
                gradation,
                projection: None,
            },
            paint: PaintLayers::default(),
            lattice,
            visible: Vec::new(),
            bounds,
        };
        for id in 0..random.u32(0..6) {
            let id = LayerId(2 * id + 1);
            let (kind, definition) = match random.u32(..4) {
                0 => formula(&mut random, transfer),
                1 => raster(&mut random, transfer),
                _ => case.painted(&mut random, id),
            };
            let mut layer = Layer { combine: combine(&mut random), ..Layer::new(id, "layer", kind) };
            layer.visible = random.u32(..5) > 0;
            if layer.visible {
                case.visible.push(Definition { combine: layer.combine, ..definition });
            }
            case.spec.layers.push(layer);
        }
        case
    }

    fn field(&self) -> SizeField {
        SizeField::new(self.spec.clone(), &self.lattice)
    }

    /// Returns lattice steps per grain, the same along both axes.
    fn steps(&self) -> i64 {
        let steps = GRAIN / self.lattice.step();
        assert!(steps.x == steps.y && steps.x.fract() == 0.0);
        steps.x as i64
    }

    fn definition(&self) -> Field {
        let size = (self.lattice.bounds().size() / GRAIN).to_array().map(|side| side as i64);
        Field::new(&self.visible, size, &self.bounds, self.steps())
    }

    fn painted(&mut self, random: &mut Rng, id: LayerId) -> (LayerKind, Definition) {
        let quantity = quantity(random);
        let (tiles, raster) = tiles(random, quantity);
        let grid = *raster.grid();
        self.paint.insert(id, raster);
        let deepest = tiles.keys().map(|place| place.depth).max().unwrap_or(0);
        let lines = [0, 1].map(|axis| {
            let pixel = (grid.pixel[axis] / GRAIN) as i64 >> deepest;
            let origin = (grid.origin[axis] / GRAIN) as i64;
            (-8192 / pixel..=8192 / pixel).map(|n| origin + n * pixel).collect()
        });
        let blank = if quantity == Quantity::Risk { 0.0 } else { f64::INFINITY };
        let pixel_at = move |point: DVec2| {
            // The deepest tile over a point counts.
            let found = tiles.iter().rev().find_map(|(place, values)| {
                let side = grid.pixel / f64::from(1 << place.depth);
                let at = ((point - grid.origin) / side).floor()
                    - f64::from(TILE) * dvec2(place.x.into(), place.y.into());
                let is_inside = at.min_element() >= 0.0 && at.max_element() < f64::from(TILE);
                is_inside.then(|| values[(at.y * f64::from(TILE) + at.x) as usize])
            });
            found.map_or(blank, f64::from)
        };
        let diameter = reading(quantity, self.spec.transfer, Some(0.0));
        let diameter = Box::new(move |point| diameter(pixel_at(point)));
        (LayerKind::paint(quantity), Definition { combine: Combine::Finest, diameter, lines })
    }
}

type Tiles = BTreeMap<TilePlace, Vec<f32>>;

/// Tiles of up to four depths, with pixels of an eighth to a sixty-fourth.
fn tiles(random: &mut Rng, quantity: Quantity) -> (Tiles, TiledRaster) {
    let blank = if quantity == Quantity::Risk { 0.0 } else { f32::INFINITY };
    let origin = dvec2(random.i32(-16..=16).into(), random.i32(-16..=16).into()) / 64.0;
    let grid = PixelGrid { origin, pixel: DVec2::splat(0.125) };
    let mut tiles = Tiles::new();
    for depth in 0..random.u8(0..5) {
        for (x, y) in (-1..3).flat_map(|y| (-1..3).map(move |x| (x, y))) {
            let place = TilePlace { depth, x, y };
            let has_parent = place.parent().is_none_or(|parent| tiles.contains_key(&parent));
            if has_parent && random.u32(..4) > 0 {
                let share = random.f64();
                let pixel =
                    |random: &mut Rng| if random.f64() < share { value(random, quantity) } else { blank };
                // Now and then one value all over.
                let one = (random.u32(..4) == 0).then(|| pixel(random));
                let values = (0..TILE * TILE).map(|_| one.unwrap_or_else(|| pixel(random))).collect();
                tiles.insert(place, values);
            }
        }
    }
    let of_values =
        |(place, values): (&TilePlace, &Vec<f32>)| (*place, Arc::new(Tile::from_values(values).unwrap()));
    let raster = TiledRaster::from_tiles(grid, blank, tiles.iter().map(of_values)).unwrap();
    (tiles, raster)
}

/// Returns one value in a quarter of the plane, another one elsewhere.
fn formula(random: &mut Rng, transfer: Transfer) -> (LayerKind, Definition) {
    let quantity = quantity(random);
    let [a, b] = [0, 1].map(|_| random.i32(-20..276));
    let mut number = || match quantity {
        Quantity::Diameter if random.u32(..3) == 0 => f64::INFINITY,
        _ => value(random, quantity).into(),
    };
    let (inside, outside) = (number(), number());
    let text = format!("if(x < {a} / 256 and y > {b} / 256, {inside}, {outside})");
    let kind = LayerKind::Formula(FormulaLayer { quantity, formula: Formula::parse(&text).unwrap() });
    let diameter = reading(quantity, transfer, None);
    let diameter = Box::new(move |point: DVec2| {
        let is_inside = point.x < f64::from(a) / 256.0 && point.y > f64::from(b) / 256.0;
        diameter(if is_inside { inside } else { outside })
    });
    let lines = [vec![16 * i64::from(a)], vec![16 * i64::from(b)]];
    (kind, Definition { combine: Combine::Finest, diameter, lines })
}

/// Returns a raster of a few pixels, on the domain, around it, or beside it; some pixels have no value.
fn raster(random: &mut Rng, transfer: Transfer) -> (LayerKind, Definition) {
    let quantity = quantity(random);
    let size = [0, 1].map(|_| random.u32(1..12));
    let min = [0, 1].map(|_| random.i64(-2048..4096));
    let pixel = [0, 1].map(|_| random.i64(1..700));
    let max = [0, 1].map(|axis| min[axis] + pixel[axis] * i64::from(size[axis]));
    let [low, high] = [min, max].map(|[x, y]: Point| dvec2(x as f64, y as f64) * GRAIN);
    let gaps = random.u32(..3);
    let mut pixel_value = || if random.u32(..8) < gaps { f32::NAN } else { value(random, quantity) };
    let values: Vec<f32> = (0..size[0] * size[1]).map(|_| pixel_value()).collect();
    let pyramid =
        Arc::new(RasterPyramid::new(Raster::from_values(Rect::new(low, high), size, values.clone())));
    let source = RasterSource { name: "raster.asc".into(), raster: pyramid };
    let of = if quantity == Quantity::Risk { RasterReading::Risk } else { RasterReading::Diameter };
    let lines = [0, 1].map(|axis| (0..=i64::from(size[axis])).map(|n| min[axis] + n * pixel[axis]).collect());
    let diameter = reading(quantity, transfer, None);
    let diameter = Box::new(move |point: DVec2| {
        let at = [0, 1].map(|axis| (point[axis] / GRAIN - min[axis] as f64) / pixel[axis] as f64);
        let is_inside = (0..2).all(|axis| 0.0 <= at[axis] && at[axis] < f64::from(size[axis]));
        let index = || at[1] as usize * size[0] as usize + at[0] as usize;
        if is_inside { diameter(values[index()].into()) } else { f64::INFINITY }
    });
    (
        LayerKind::Raster(RasterLayer { source, reading: of }),
        Definition { combine: Combine::Finest, diameter, lines },
    )
}

/// ℓ_b of Eq. (1) in world units.
fn length(level: u32) -> f64 {
    let whole = SPACING / f64::from(1u32 << (level / 2));
    if level.is_multiple_of(2) { whole * 2f64.sqrt() } else { whole }
}

/// Returns a triangle of the coarse grid and triangles within, each half of the one before.
fn chain(random: &mut Rng, lattice: &Lattice, count: usize) -> Vec<Triangle> {
    let [columns, rows] = lattice.cells().map(i64::from);
    let coarse = closure::coarse(columns, rows, lattice.cell_steps().into(), |_, _| true);
    let mut chain = vec![coarse[random.usize(..coarse.len())]];
    for _ in 1..count {
        let [right_angle, a, b] = chain[chain.len() - 1];
        let middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
        chain.push([middle, right_angle, if random.bool() { a } else { b }]);
    }
    chain
}

fn corners(triangle: &Triangle) -> [LatticePoint; 3] {
    triangle.map(|[x, y]| LatticePoint::new(x as u32, y as u32))
}

#[test]
fn a_triangle_asks_for_more_where_the_definition_has_a_finer_point() {
    let [mut asked, mut refused] = [0; 2];
    for seed in 0..300 {
        let case = Case::random(seed, 0.02);
        let (field, definition) = (case.field(), case.definition());
        let mut random = Rng::with_seed(seed + 1000);
        for _ in 0..6 {
            for triangle in chain(&mut random, &case.lattice, 22) {
                let least = definition.least_within(&triangle);
                for level in 0..24 {
                    // Distances are rounded: what gradation carries is rounded up to 32 bits.
                    let below = length(level) - least;
                    if (-1e-12..2.4e-7 * least).contains(&below) && case.bounds.gradation.is_some() {
                        continue;
                    }
                    let asks = field.asks_for_more(&case.paint, corners(&triangle), level);
                    assert_eq!(
                        asks,
                        least < length(level),
                        "seed {seed}: {triangle:?} at level {level}, {least}"
                    );
                    *(if asks { &mut asked } else { &mut refused }) += 1;
                }
            }
        }
    }
    assert!(asked > 20_000 && refused > 200_000, "{asked} {refused}");
}

#[test]
fn a_tiny_raster_in_a_huge_domain_needs_no_long_search() {
    let lattice = Lattice::covering(Rect::UNIT, SPACING, 1000).unwrap();
    let corner = dvec2(0.3, 0.4);
    let bounds = Rect::new(corner, corner + 4.0 * lattice.step());
    let grid = PixelGrid::filling(&bounds, [1, 1]);
    assert!(grid.pixel.max_element() < 1e-6, "{}", grid.pixel);
    let raster = Arc::new(RasterPyramid::new(Raster::from_values(bounds, [1, 1], vec![0.01])));
    let source = RasterSource { name: "raster.asc".into(), raster };
    let mut painted = TiledRaster::new(grid, f32::INFINITY);
    painted.exchange(TilePlace { depth: 0, x: 0, y: 0 }, Some(Arc::new(Tile::filled(0.01))));
    let kinds = [
        LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter }),
        LayerKind::paint(Quantity::Diameter),
    ];
    let [columns, rows] = lattice.cells().map(i64::from);
    let coarse = closure::coarse(columns, rows, lattice.cell_steps().into(), |_, _| true);
    for kind in kinds {
        let mut case = Case::random(0, 0.005);
        case.spec.layers = Layer::stack([kind]);
        case.spec.gradation = None;
        case.paint.insert(case.spec.layers[0].id, painted.clone());
        let field = SizeField::new(case.spec.clone(), &lattice);
        let asking = coarse.iter().filter(|triangle| field.asks_for_more(&case.paint, corners(triangle), 5));
        assert_eq!(asking.count(), 1);
    }
}

#[test]
fn h_at_a_point_is_that_of_the_definition() {
    let mut decided = 0;
    for seed in 0..150 {
        let case = Case::random(seed, 0.02);
        let (field, definition) = (case.field(), case.definition());
        let (mut random, mut squares) = (Rng::with_seed(seed + 1000), LevelCache::default());
        for _ in 0..20 {
            // Between two grains: on no line.
            let odd =
                |random: &mut Rng, side: f64| (f64::from(random.u32(..(4096.0 * side) as u32)) + 0.5) * GRAIN;
            let size = case.lattice.bounds().size();
            let point = dvec2(odd(&mut random, size.x), odd(&mut random, size.y));
            let (found, expected) = (field.target_at(&case.paint, point), definition.at(point));
            assert!(
                (found - expected).abs() < 1e-9 * expected,
                "seed {seed}: {found} for {expected} at {point}"
            );
            let decision = field.decision_at(&case.paint, point);
            assert_eq!(decision.target, found);
            let quick = field.quick_decision_at(&mut squares, &case.paint, point).target;
            // What was asked before changes nothing, not even the last bit.
            let alone = field.quick_decision_at(&mut LevelCache::default(), &case.paint, point).target;
            assert_eq!(quick.to_bits(), alone.to_bits(), "seed {seed}: {quick} and {alone} at {point}");
            let compared = field.compared_target_at(&mut squares, &case.paint, point);
            let most = 2.0_f64.sqrt() * case.lattice.spacing();
            assert!(
                (compared - found.min(most)).abs() < 2e-3 * most.min(found),
                "seed {seed}: {compared} for {found}, at most {most}"
            );
            assert!((0.0..=1e-3 * found).contains(&(quick - found)), "seed {seed}: {quick} for {found}");
            assert_eq!(decision.asked.len(), case.visible.len());
            for ((id, asked), layer) in decision.asked.iter().zip(&case.visible) {
                let expected = (layer.diameter)(point);
                let expected = (expected < f64::INFINITY).then_some(expected);
                let is_close = |(a, b): (f64, f64)| (a - b).abs() < 1e-9 * b;
                assert!(
                    asked.is_some() == expected.is_some(),
                    "seed {seed}: {id:?} {asked:?} for {expected:?}"
                );
                assert!(asked.zip(expected).is_none_or(is_close), "seed {seed}: {asked:?} for {expected:?}");
            }
            if case.bounds.gradation.is_none() {
                assert_eq!(decision.from, point);
            }
            decided += usize::from(decision.layer.is_some());
        }
    }
    assert!(decided > 1000, "{decided}");
}

#[test]
fn meshes_are_the_smallest_refinements_that_meet_the_definition() {
    let mut triangles = 0;
    for seed in 0..60 {
        let case = Case::random(seed + 5000, 0.035);
        let mut builder = MeshBuilder::new(MeshSpec {
            domain: Domain::rectangle(case.lattice.bounds()),
            boundary: BoundaryTreatment::Report,
            lines: Default::default(),
            lattice: case.lattice,
            field: case.spec.clone(),
            rule: RefinementRule::Area,
            cleaning: Cleaning::NONE,
            limits: Limits::default(),
        });
        while builder.advance(Some(&case.paint), 1000).unwrap() == Progress::More {}
        let mesh = builder.finish().mesh;
        let point = |p: LatticePoint| [i64::from(p.x), i64::from(p.y)];
        let found = mesh.raw_triangles().iter().map(|t| t.vertices.map(|v| point(mesh.node(v))));
        let definition = case.definition();
        let [columns, rows] = case.lattice.cells().map(i64::from);
        let cell = i64::from(case.lattice.cell_steps());
        let coarse = closure::coarse(columns, rows, cell, |_, _| true);
        let mut known = BTreeMap::new();
        let known = std::cell::RefCell::new(&mut known);
        let expected = closure::refine(coarse, |t| {
            let mut known = known.borrow_mut();
            let least = *known.entry(*t).or_insert_with(|| definition.least_within(t));
            least < length(closure::level(cell, t))
        });
        triangles += expected.len();
        assert!(closure::set_of(found) == closure::set_of(expected), "seed {seed}");
    }
    assert!(triangles > 60 * 200, "{triangles}");
}

/// A function that is ℓ along a line of the lattice, a diagonal or a circle.
struct Smooth {
    layer: fn() -> LayerKind,
    diameter: fn(DVec2) -> f64,
    /// Returns a place at which the function has a value.
    place: fn(f64, f64) -> DVec2,
}

const SMOOTH: [Smooth; 5] = [
    Smooth {
        layer: || formula_of("0.005 + 0.25*hypot(x - 0.4, y - 0.3)"),
        diameter: |p| 0.005 + 0.25 * (p - dvec2(0.4, 0.3)).length(),
        place: |value, share| {
            dvec2(0.4, 0.3) + (value - 0.005) / 0.25 * DVec2::from_angle(share * std::f64::consts::TAU)
        },
    },
    Smooth {
        layer: || formula_of("0.0625 + 0.25*abs(x - 0.25)"),
        diameter: |p| 0.0625 + 0.25 * (p.x - 0.25).abs(),
        place: |value, share| dvec2(0.25 + (value - 0.0625) / 0.25, share),
    },
    Smooth {
        layer: || formula_of("0.0625 + 0.125*abs(x + y - 0.25)"),
        diameter: |p| 0.0625 + 0.125 * (p.x + p.y - 0.25).abs(),
        place: |value, share| {
            let sum = 0.25 + (value - 0.0625) / 0.125;
            dvec2(share * sum, (1.0 - share) * sum)
        },
    },
    Smooth {
        layer: || distance_to([dvec2(0.25, -1.0), dvec2(0.25, 2.0)]),
        diameter: |p| 0.0625 + 0.25 * (p.x - 0.25).abs(),
        place: |value, share| dvec2(0.25 + (value - 0.0625) / 0.25, share),
    },
    Smooth {
        layer: || distance_to([dvec2(0.5, 0.5); 2]),
        diameter: |p| 0.0625 + 0.25 * (p - dvec2(0.5, 0.5)).length(),
        place: |value, share| {
            dvec2(0.5, 0.5) + (value - 0.0625) / 0.25 * DVec2::from_angle(share * std::f64::consts::TAU)
        },
    },
];

fn formula_of(text: &str) -> LayerKind {
    LayerKind::target(Formula::parse(text).unwrap())
}

fn distance_to(line: [DVec2; 2]) -> LayerKind {
    let shapes = Shapes::lines(vec![line.to_vec()]).unwrap();
    let to = DistanceTo::Shapes { name: String::new(), shapes };
    DistanceLayer { to, at_zero: 0.0625, slope: 0.25, range: f64::INFINITY }.into()
}

/// Smooth formulas have one value on each cell of the lattice, that at its centre.
#[test]
fn smooth_formulas_are_asked_at_the_centres_of_cells() {
    let lattice = Lattice::covering(Rect::UNIT, SPACING, 1000).unwrap();
    let squares = i64::from(lattice.extent().x);
    let transfer = Transfer::between(0.001, 0.4);
    let bounds = Bounds { h_min: transfer.h_min, h_max: transfer.h_max, unasked: 0.4, gradation: None };
    let [mut asked, mut refused] = [0; 2];
    let mut random = Rng::with_seed(3);
    for round in 0..1500 {
        let smooth = &SMOOTH[round % SMOOTH.len()];
        let combine = combine(&mut random);
        let mut layers = Layer::stack([formula_of("0.02 + 0.1*x*y"), (smooth.layer)()]);
        layers[1].combine = combine;
        let field = SizeField::new(
            SizeFieldSpec {
                layers,
                transfer,
                unasked: 0.4,
                outline: None,
                gradation: None,
                projection: None,
            },
            &lattice,
        );
        let definition = |diameter: fn(DVec2) -> f64, combine| {
            let diameter = Box::new(move |p: DVec2| {
                let (value, rounded) = (diameter(p), diameter(p) as f32);
                f64::from(if f64::from(rounded) < value { rounded.next_up() } else { rounded })
            });
            Definition { combine, diameter, lines: [vec![], vec![]] }
        };
        let layers =
            [definition(|p| 0.02 + 0.1 * p.x * p.y, Combine::Finest), definition(smooth.diameter, combine)];
        // A small triangle on the line on which the function is ℓ, or near it.
        let level = random.u32(3..8);
        let beside = if random.bool() { 0.0 } else { 100.0 / squares as f64 * (random.f64() - 0.4) };
        let place = (smooth.place)(length(level) + 0.25 * beside, random.f64());
        let place = place.clamp(DVec2::ZERO, DVec2::splat(0.999)) * lattice.extent().as_dvec2();
        let side = 1 << random.u32(2..6);
        let corner = place.to_array().map(|v| v as i64 / side * side);
        let [first, last] = [0, side].map(|to| corner.map(|v| v + to));
        let turned = [first, [last[0], first[1]], last, [first[0], last[1]]];
        let turn = random.usize(..4);
        let triangle = [0, 1, 3].map(|n| turned[(turn + n) % 4]);
        let mut least = f64::INFINITY;
        for j in (first[1] - 1).max(0)..=last[1].min(squares - 1) {
            for i in (first[0] - 1).max(0)..=last[0].min(squares - 1) {
                if touches(&triangle, [i, j], [i + 1, j + 1]) {
                    let center = (dvec2(i as f64, j as f64) + 0.5) / squares as f64;
                    least = least.min(combined(&layers, &bounds, center));
                }
            }
        }
        let asks = field.asks_for_more(&PaintLayers::default(), corners(&triangle), level);
        assert_eq!(asks, least < length(level), "{triangle:?} at level {level}: {least}");
        *(if asks { &mut asked } else { &mut refused }) += 1;
    }
    assert!(asked > 100 && refused > 100, "{asked} {refused}");
}

//! Refinement in blocks: the mesh of the report's order, and the same arrays for any number of threads.

use std::sync::Arc;

use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{
    Combine, Layer, LayerKind, LevelCache, PaintLayers, RasterLayer, RasterReading, RasterSource, SizeField,
    SizeFieldSpec,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{
    BlockRefiner, Limits, Mesh, Progress, TreeTriangle, TriangleId, bisection_edge_length,
};

/// h̄ around some places: it grows with the distance.
struct Spots {
    spots: Vec<(DVec2, f64, f64)>,
    most: f64,
}

impl Spots {
    fn random(random: &mut fastrand::Rng, most: f64) -> Self {
        let spot = |random: &mut fastrand::Rng| {
            let at = dvec2(random.f64(), random.f64());
            let finest = 10f64.powf(-3.0 + 1.5 * random.f64());
            (at, finest, 0.02 + 0.3 * random.f64())
        };
        Self { spots: (0..random.usize(1..5)).map(|_| spot(random)).collect(), most }
    }

    /// Returns whether h̄ is below the diameter at a point of the triangle, by the distance of its rectangle.
    fn exceeds(&self, lattice: &Lattice, corners: [LatticePoint; 3], level: u32) -> bool {
        let length = bisection_edge_length(lattice.spacing(), level);
        let points = corners.map(|corner| lattice.world_from_lattice(corner));
        let [a, b, c] = points;
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        let least =
            self.spots.iter().map(|&(at, finest, slope)| finest + slope * at.distance(at.clamp(min, max)));
        length > least.fold(self.most, f64::min)
    }
}

fn coarse(contains: impl Fn(DVec2) -> bool) -> Mesh {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
    Mesh::coarse_grid(&lattice, contains, &Limits::default()).unwrap()
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn in_blocks(coarse: &Mesh, spots: &Spots, threads: usize, visits: usize) -> Mesh {
    let mut mesh = coarse.clone();
    let lattice = *coarse.lattice();
    on_threads(threads, || {
        let mut refiner = BlockRefiner::new(&mesh, Limits::default());
        let rule = || |corners, level| spots.exceeds(&lattice, corners, level);
        while refiner.advance(&mut mesh, &rule, visits).unwrap() == Progress::More {}
        mesh
    })
}

fn one_by_one(coarse: &Mesh, spots: &Spots) -> Mesh {
    let mut mesh = coarse.clone();
    let lattice = *coarse.lattice();
    mesh.refine(&Limits::default(), |element| {
        spots.exceeds(&lattice, element.corners, element.triangle.level())
    })
    .unwrap();
    mesh
}

#[test]
fn blocks_make_the_smallest_conforming_mesh() {
    let mut largest = 0;
    for (number, seed) in seeds(12).enumerate() {
        let mut random = fastrand::Rng::with_seed(seed);
        let has_hole = random.bool();
        let coarse = coarse(|x| !has_hole || x.distance(dvec2(0.5, 0.5)) > 0.1);
        let most = 0.004 + 0.1 * random.f64();
        let mut spots = Spots::random(&mut random, most);
        if number == 0 {
            // Several blocks, whatever the seed.
            spots.spots.push((dvec2(0.3, 0.6), 0.001, 0.008));
        }
        let expected = one_by_one(&coarse, &spots);
        let mesh = in_blocks(&coarse, &spots, 2, 20_000);
        largest = largest.max(mesh.raw_triangle_count());
        assert_eq!(mesh.raw_triangle_count(), expected.raw_triangle_count(), "seed {seed}");
        assert_eq!(mesh.violations(), [], "seed {seed}");
        assert_eq!(mesh.fingerprint(), expected.fingerprint(), "seed {seed}");
    }
    assert!(largest > 200_000, "there were several blocks");
}

#[test]
fn the_arrays_do_not_depend_on_threads_or_slices() {
    let mut random = fastrand::Rng::with_seed(77);
    let coarse = coarse(|_| true);
    for _ in seeds(2) {
        let spots = Spots::random(&mut random, 0.006);
        let expected = in_blocks(&coarse, &spots, 1, usize::MAX);
        for (threads, visits) in [(2, 1), (3, 100_000), (8, usize::MAX)] {
            let mesh = in_blocks(&coarse, &spots, threads, visits);
            assert!(mesh.raw_triangles() == expected.raw_triangles(), "{threads} threads");
            assert!(mesh.raw_nodes() == expected.raw_nodes(), "{threads} threads");
        }
    }
}

#[test]
fn limits_count_in_blocks_as_well() {
    let coarse = coarse(|_| true);
    let lattice = *coarse.lattice();
    let spots = Spots { spots: vec![(DVec2::ZERO, 0.001, 0.01)], most: 0.004 };
    let exceeds = |corners, level| spots.exceeds(&lattice, corners, level);
    let count = one_by_one(&coarse, &spots).raw_triangle_count();
    for (max_triangles, fits) in [(count, true), (count - 1, false), (count / 3, false)] {
        let limits = Limits { max_triangles, ..Limits::default() };
        let made = coarse.clone().refine_in_blocks(&limits, &|| exceeds);
        assert_eq!(made.is_ok(), fits, "{max_triangles} of {count}");
        assert!(made.err().is_none_or(|error| error.is_over_budget()));
    }
    let limits = Limits { max_level: Some(13), ..Limits::default() };
    let mut mesh = coarse.clone();
    let capped = mesh.refine_in_blocks(&limits, &|| exceeds).unwrap();
    let deepest =
        mesh.triangles().filter(|(id, t)| t.level() == 13 && exceeds(mesh.corners(*id), 13)).count();
    assert_eq!(mesh.level_counts().len(), 14);
    assert_eq!(capped, deepest);
    assert!(capped > 0);
}

#[test]
fn what_is_settled_for_squares_is_what_each_triangle_is_told() {
    let mut random = fastrand::Rng::with_seed(5);
    for run in seeds(6) {
        // Also a lattice of one cell, which has the most halvings.
        let spacing = [0.25, 1.0][(run % 2) as usize];
        let lattice = Lattice::covering(Rect::UNIT, spacing, 1_000_000).unwrap();
        let field = random_field(&mut random, &lattice);
        let mut squares = LevelCache::default();
        let paint = PaintLayers::blank();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let limits = Limits { max_triangles: 60_000, ..Limits::default() };
        let refined = mesh.refine(&limits, |element| {
            let (corners, level) = (element.corners, element.triangle.level());
            let nearby = field.asks_for_more_nearby(&mut squares, paint, corners, level);
            assert_eq!(nearby, field.asks_for_more(paint, corners, level), "run {run}, level {level}");
            nearby
        });
        assert!(refined.is_ok() || refined.is_err_and(|error| error.is_over_budget()));
    }
}

#[test]
fn levels_within_a_triangle_are_those_of_the_triangles_inside() {
    let mut random = fastrand::Rng::with_seed(6);
    let (mut known, mut uniform) = (0, 0);
    for _ in seeds(8) {
        let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
        let (field, paint) = (random_field(&mut random, &lattice), PaintLayers::blank());
        let mut squares = LevelCache::default();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        for _ in 0..400 {
            let id = TriangleId::from_index(random.usize(..mesh.raw_triangle_count()));
            let mut triangle = TreeTriangle::from_mesh(&mesh, id);
            for _ in 0..random.usize(..14) {
                triangle = triangle.children()[random.usize(..2)];
            }
            let levels = field.levels_within(&mut squares, paint, triangle.corners(), triangle.level());
            uniform += usize::from(levels.one_level().is_some());
            for _ in 0..10 {
                if let Some(exceeds) = levels.exceeds(triangle.level()) {
                    known += 1;
                    let (corners, level) = (triangle.corners(), triangle.level());
                    assert_eq!(field.asks_for_more(paint, corners, level), exceeds, "{levels:?} at {level}");
                }
                triangle = triangle.children()[random.usize(..2)];
            }
        }
    }
    assert!(known > 10_000 && uniform > 100, "{known} {uniform}");
}

/// Returns a raster with steps of many sizes, a formula and a floor, with a limit of gradation at times.
fn random_field(random: &mut fastrand::Rng, lattice: &Lattice) -> SizeField {
    let side = [4, 37, 256][random.usize(..3)];
    let steps = |random: &mut fastrand::Rng| 10f32.powf(-2.5 + 2.0 * random.f32());
    let values = (0..side * side).map(|_| if random.u8(..8) == 0 { steps(random) } else { 0.2 }).collect();
    let raster = Raster::from_values(Rect::UNIT, [side; 2], values);
    let source = RasterSource { name: "steps".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    let formula = format!("{} + 0.2*hypot(x - {}, y - 0.3)", 0.004 + 0.02 * random.f64(), random.f64());
    let mut layers = Layer::stack([
        LayerKind::Raster(RasterLayer { source, reading: RasterReading::Diameter }),
        LayerKind::target(Formula::parse(&formula).unwrap()),
        LayerKind::constant(0.02),
    ]);
    layers[2].combine = Combine::Floor;
    layers[2].visible = random.bool();
    let spec = SizeFieldSpec {
        layers,
        transfer: Transfer::between(0.003, 0.3),
        unasked: 0.3,
        outline: None,
        gradation: random.bool().then_some(0.2),
        projection: None,
    };
    SizeField::new(spec, lattice)
}

//! Updates in place: the same dab on meshes of ten thousand to ten million triangles, beside a mesh made from
//! scratch.
//!
//! The field is a paint layer under the area rule, as in the window; the cost of changing its pixels is not
//! counted. *same place*: one dab is painted and erased repeatedly. *moving*: a dab is painted at the next of
//! eight places and the oldest of three is erased, so that entries are removed from the middle of the arrays
//! and others fill the gaps. *dab counted*, *erasing counted*: a forecast of what painting or erasing the dab
//! would change.
//!
//! Throughput counts the triangles added and removed; for a mesh made from scratch, all its triangles.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput};
use meshbrush_core::field::Transfer;
use meshbrush_core::layers::{Layer, LayerId, LayerKind, PaintLayers, Quantity, SizeField, SizeFieldSpec};
use meshbrush_core::raster::{PixelGrid, PixelRect, TILE, TilePlace, TiledRaster};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
use meshbrush_mesh::mesh::{
    Element, Forecast, InvalidTarget, Limits, Mesh, Progress, Refiner, Updater, bisection_edge_length,
};

/// Pixels along a side of the field.
const SIDE: u32 = 2048;
/// Radius of a dab in pixels, and the level that it asks for: about ten thousand triangles.
const RADIUS: u32 = 78;
const LEVEL: u8 = 12;
/// The layer that is painted on.
const LAYER: LayerId = LayerId(0);
/// Centres of the dabs, in the left half.
const PLACES: [[u32; 2]; 8] =
    [[200, 200], [600, 300], [250, 700], [800, 750], [300, 1200], [750, 1100], [200, 1700], [700, 1800]];

/// A mesh on the unit square with 512 coarse triangles, with the field that it satisfies.
struct Scene {
    coarse: Mesh,
    mesh: Mesh,
    paint: PaintLayers,
    field: SizeField,
}

impl Scene {
    /// Returns a rule by which the right half needs `level` below the given row, which determines the size of
    /// the mesh.
    fn new(level: u8, rows: u32) -> Self {
        let lattice = Lattice::covering(Rect::UNIT, 1.0 / 16.0, 1_000_000).expect("a square has a grid");
        let coarse =
            Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).expect("within the default limits");
        let mut paint = PaintLayers::default();
        let grid = PixelGrid::filling(&Rect::UNIT, [SIDE; 2]);
        paint.insert(LAYER, TiledRaster::new(grid, f32::INFINITY));
        let transfer = Transfer::between(1e-9, 1.0);
        let layers = Layer::stack([LayerKind::Paint(Quantity::Diameter)]);
        let spec = SizeFieldSpec { layers, transfer, unasked: 1.0, outline: None, gradation: None };
        let field = SizeField::new(spec, &lattice);
        let mut scene = Self { mesh: coarse.clone(), coarse, paint, field };
        scene.set(PixelRect { min: [SIDE / 2 + 1, 0], max: [SIDE, rows] }, |_, _| Some(level));
        // The same finest pixel in every mesh: the rule returns early where nothing is finer than a triangle.
        scene.set(PixelRect { min: [SIDE - 1; 2], max: [SIDE; 2] }, |_, _| Some(16));
        scene.mesh.refine(&Limits::default(), rule(&scene.field, &scene.paint)).expect("within the limits");
        scene
    }

    /// Paints or erases the dab at `place` and returns the part of the lattice that may change.
    fn stamp(&mut self, place: [u32; 2], level: u8) -> LatticeRect {
        let area = PixelRect { min: place.map(|c| c - RADIUS), max: place.map(|c| c + RADIUS + 1) };
        self.set(area, |x, y| {
            let [dx, dy] = [x.abs_diff(place[0]), y.abs_diff(place[1])];
            (dx * dx + dy * dy <= RADIUS * RADIUS && level > 0).then_some(level)
        });
        // A pixel is a whole number of lattice steps.
        let pixel = self.coarse.lattice().extent().x / SIDE;
        let point = |[x, y]: [u32; 2]| LatticePoint::new(x * pixel, y * pixel);
        LatticeRect { min: point(area.min), max: point(area.max) }
    }

    /// Lets each pixel of an area ask for a level, or for nothing.
    fn set(&mut self, area: PixelRect, level: impl Fn(u32, u32) -> Option<u8>) {
        let spacing = self.coarse.lattice().spacing();
        let diameter = |level: u8| bisection_edge_length(spacing, u32::from(level)) as f32;
        let raster = self.paint.get_mut(LAYER).expect("inserted at the beginning");
        let side = TILE as u32;
        let tiles = PixelRect { min: area.min.map(|v| v / side), max: area.max.map(|v| v.div_ceil(side)) };
        for (column, row) in tiles.pixels() {
            let place = TilePlace { depth: 0, x: column as i32, y: row as i32 };
            if raster.tile(place).is_none() {
                let blank = raster.inherited(place);
                raster.exchange(place, Some(blank.into()));
            }
            raster.change(place, |tile| {
                let [x0, y0] = [column * side, row * side];
                for (x, y) in (PixelRect { min: [x0, y0], max: [x0 + side, y0 + side] }).pixels() {
                    if area.contains(x, y) {
                        let value = level(x, y).map_or(f32::INFINITY, diameter);
                        tile.set((x - x0) as i32, (y - y0) as i32, value);
                    }
                }
            });
        }
    }

    fn update(&mut self, updater: &mut Updater, area: LatticeRect) -> Duration {
        let start = Instant::now();
        updater.add(area);
        let progress = updater.advance(&mut self.mesh, rule(&self.field, &self.paint), usize::MAX);
        let time = start.elapsed();
        assert_eq!(progress, Ok(Progress::Done));
        black_box(updater.take_changes());
        time
    }
}

/// Returns the area rule.
fn rule(field: &SizeField, paint: &PaintLayers) -> impl Fn(&Element) -> Result<bool, InvalidTarget> {
    move |element| Ok(field.exceeds(paint, element))
}

/// Level of the right half, and the rows that it fills.
const SIZES: [(u8, u32); 5] = [(5, 2048), (9, 1500), (12, 1950), (13, 2048), (16, 1220)];

fn same_place(group: &mut BenchmarkGroup<WallTime>, scene: &mut Scene) {
    let count = scene.mesh.raw_triangle_count();
    let mut updater = Updater::new(Limits::default());
    let dab = |scene: &mut Scene, updater: &mut Updater, level| {
        let area = scene.stamp(PLACES[3], level);
        scene.update(updater, area)
    };
    dab(scene, &mut updater, LEVEL);
    let changed = 2 * (scene.mesh.raw_triangle_count() - count) as u64;
    dab(scene, &mut updater, 0);
    group.throughput(Throughput::Elements(changed));
    group.bench_function(BenchmarkId::new("same place", count), |b| {
        b.iter_custom(|rounds| {
            (0..rounds).map(|_| dab(scene, &mut updater, LEVEL) + dab(scene, &mut updater, 0)).sum()
        });
    });
    assert_eq!(scene.mesh.raw_triangle_count(), count);
}

/// Forecasts of what painting the dab of `same place` would add and what erasing it would remove.
fn counted(group: &mut BenchmarkGroup<WallTime>, scene: &mut Scene) {
    let count = scene.mesh.raw_triangle_count();
    let once = |scene: &Scene, area| {
        let start = Instant::now();
        let mut forecast = Forecast::new(&scene.mesh, area, &Limits::default());
        let exceeds = |corners, level| scene.field.asks_for_more(&scene.paint, corners, level);
        assert_eq!(forecast.advance(&scene.mesh, exceeds, |_, _| true, usize::MAX), Ok(Progress::Done));
        (start.elapsed(), forecast.added() + forecast.removed())
    };
    let mut updater = Updater::new(Limits::default());
    for (name, from, to) in [("dab counted", 0, LEVEL), ("erasing counted", LEVEL, 0)] {
        let area = scene.stamp(PLACES[3], from);
        scene.update(&mut updater, area);
        scene.stamp(PLACES[3], to);
        group.throughput(Throughput::Elements(once(scene, area).1 as u64));
        group.bench_function(BenchmarkId::new(name, count), |b| {
            b.iter_custom(|rounds| (0..rounds).map(|_| once(scene, area).0).sum());
        });
        scene.update(&mut updater, area);
    }
    assert_eq!(scene.mesh.raw_triangle_count(), count);
}

fn moving(group: &mut BenchmarkGroup<WallTime>, scene: &mut Scene) {
    let count = scene.mesh.raw_triangle_count();
    let mut updater = Updater::new(Limits::default());
    let mut at = 0;
    let mut step = |scene: &mut Scene| {
        let painted = scene.stamp(PLACES[at % 8], LEVEL);
        let time = scene.update(&mut updater, painted);
        let erased = scene.stamp(PLACES[(at + 5) % 8], 0);
        at += 1;
        time + scene.update(&mut updater, erased)
    };
    for _ in 0..16 {
        step(scene);
    }
    let changed = 2 * (scene.mesh.raw_triangle_count() - count) as u64 / 3;
    group.throughput(Throughput::Elements(changed));
    group.bench_function(BenchmarkId::new("moving", count), |b| {
        b.iter_custom(|rounds| (0..rounds).map(|_| step(scene)).sum());
    });
}

fn from_scratch(group: &mut BenchmarkGroup<WallTime>, scene: &Scene) {
    let count = scene.mesh.raw_triangle_count();
    group.throughput(Throughput::Elements(count as u64));
    let (mut mesh, mut refiner) = (scene.coarse.clone(), Refiner::new(&scene.coarse, Limits::default()));
    group.bench_function(BenchmarkId::new("from scratch", count), |b| {
        b.iter_custom(|rounds| {
            let once = |_| {
                let start = Instant::now();
                mesh.clone_from(&scene.coarse);
                refiner.restart(&mesh);
                let made = refiner.advance(&mut mesh, rule(&scene.field, &scene.paint), usize::MAX);
                assert_eq!(made, Ok(Progress::Done));
                start.elapsed()
            };
            (0..rounds).map(once).sum()
        });
    });
}

/// Prints the memory of an update in place, in bytes per triangle, after one that touched the whole mesh.
fn memory(level: u8) {
    let before = resident();
    let mut scene = Scene::new(level, SIDE);
    let mut updater = Updater::new(Limits::default());
    scene.update(
        &mut updater,
        LatticeRect { min: LatticePoint::new(0, 0), max: scene.mesh.lattice().extent() },
    );
    let count = scene.mesh.raw_triangle_count() as f64;
    let (arrays, marks) = (scene.mesh.bytes() as f64 / count, updater.bytes() as f64 / count);
    // The pixels of the paint, and the ranges of their values above them: a third more.
    let field = (SIDE * SIDE) as usize * 4 / 3;
    let resident = resident().saturating_sub(before + field) as f64 / count;
    eprintln!(
        "memory/{count}: {arrays:.2} in arrays, {marks:.2} in marks, {resident:.2} resident bytes per triangle"
    );
}

/// Resident memory of this process in bytes; zero where the system does not report it.
fn resident() -> usize {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = statm.split(' ').nth(1).and_then(|pages| pages.parse().ok());
    pages.map_or(0, |pages: usize| 4096 * pages)
}

fn main() {
    memory(13);
    memory(17);
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("update");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_millis(1000));
    for (level, rows) in SIZES {
        let mut scene = Scene::new(level, rows);
        same_place(&mut group, &mut scene);
        counted(&mut group, &mut scene);
        from_scratch(&mut group, &scene);
        moving(&mut group, &mut scene);
    }
    group.finish();
    criterion.final_summary();
}

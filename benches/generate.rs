//! Mesh generation: the report's series, extended to 33 million triangles.
//!
//! - *in order*: Algorithm 12, one triangle after the other.
//! - *blocks*: on one and on two threads, in blocks; the rule answers for all triangles within a triangle.
//! - *asked*: as *blocks*, but the rule is asked about each triangle.
//! - *field*: in blocks by the area rule on the pixels of a raster, as the window works.
//! - *graded*: as *field*, where the target diameter changes everywhere; the number of triangles is another.
//! - *writes*: 38 bytes for each triangle and nothing else: what the memory of this machine permits.
//!
//! *fresh* builds in newly allocated memory, as a first mesh does; mapping its pages takes a third of the
//! time or more. *reused* builds into the arrays of the previous mesh. The time to drop a mesh is not
//! counted.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, BenchmarkId, Criterion, SamplingMode, Throughput};
use meshbrush_benches::{diamond, field, memory};
use meshbrush_core::layers::SizeField;
use meshbrush_mesh::mesh::{Limits, Mesh, Refiner, SharedRule, bisection_edge_length};
use rayon::ThreadPool;

/// Level, and the number of triangles there.
const SERIES: [(u32, u64); 7] = [
    (5, 9_560),
    (7, 35_176),
    (9, 135_544),
    (11, 532_872),
    (13, 2_113_944),
    (15, 8_421_800),
    (17, 33_620_408),
];

/// Measures `make` in new memory and in the memory of the mesh before.
fn measure(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    triangles: u64,
    mut make: impl FnMut(&mut Mesh),
) {
    let coarse = diamond::coarse();
    group.bench_function(BenchmarkId::new(format!("{name}, fresh"), triangles), |b| {
        b.iter_custom(|rounds| {
            let fresh = |_| {
                let start = Instant::now();
                let mut mesh = coarse.clone();
                make(&mut mesh);
                let time = start.elapsed();
                black_box(mesh);
                time
            };
            (0..rounds).map(fresh).sum()
        });
    });
    let mut mesh = coarse.clone();
    make(&mut mesh);
    group.bench_function(BenchmarkId::new(format!("{name}, reused"), triangles), |b| {
        b.iter_custom(|rounds| {
            let reused = |_| {
                let start = Instant::now();
                mesh.clone_from(&coarse);
                make(&mut mesh);
                start.elapsed()
            };
            (0..rounds).map(reused).sum()
        });
    });
}

fn in_blocks(mesh: &mut Mesh, pool: &ThreadPool, rule: &impl SharedRule<Error: std::fmt::Debug>) {
    pool.install(|| mesh.refine_in_blocks(&Limits::default(), rule)).expect("within the default limits");
}

fn graded_triangles(field: &SizeField) -> u64 {
    let mut mesh = diamond::coarse();
    mesh.refine_in_blocks(&Limits::default(), &field::rule(field)).expect("within the default limits");
    mesh.raw_triangle_count() as u64
}

/// First writes to memory, and writes to memory that is mapped, each by all threads of the pool.
fn writes(group: &mut BenchmarkGroup<WallTime>, pool: &ThreadPool, triangles: u64) {
    let threads = pool.current_num_threads();
    let unmapped = || memory::unmapped(triangles as usize);
    let write = |memory: &mut Vec<u64>| pool.install(|| memory::write(memory));
    group.bench_function(BenchmarkId::new(format!("writes, {threads} threads, reused"), triangles), |b| {
        let mut memory = unmapped();
        write(&mut memory);
        b.iter(|| write(&mut memory));
    });
    group.bench_function(BenchmarkId::new(format!("writes, {threads} threads, fresh"), triangles), |b| {
        b.iter_custom(|rounds| {
            let fresh = |_| {
                let start = Instant::now();
                let mut memory = unmapped();
                write(&mut memory);
                let time = start.elapsed();
                black_box(memory);
                time
            };
            (0..rounds).map(fresh).sum()
        });
    });
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("generate");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).warm_up_time(Duration::from_millis(500));
    let pools =
        [1, 2].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("a pool of threads"));
    for (level, triangles) in SERIES {
        group.measurement_time(Duration::from_millis(if level < 15 { 1500 } else { 100 }));
        group.throughput(Throughput::Elements(triangles));
        let coarse = diamond::coarse();
        let rule = diamond::rule(&coarse, level);
        let mut refiner = Refiner::new(&coarse, Limits::default());
        measure(&mut group, "in order", triangles, |mesh| {
            refiner.restart(mesh);
            refiner.advance(mesh, &rule, usize::MAX).expect("within the default limits");
            assert_eq!(mesh.raw_triangle_count() as u64, triangles);
        });
        let (within, rule) = (diamond::rule_within(&coarse, level), diamond::rule_at(&coarse, level));
        let length = bisection_edge_length(1.0, level);
        let (field, graded) = (field::diamond(length), field::graded(length));
        for pool in &pools {
            let threads = pool.current_num_threads();
            measure(&mut group, &format!("blocks, {threads} threads"), triangles, |mesh| {
                in_blocks(mesh, pool, &within);
                assert_eq!(mesh.raw_triangle_count() as u64, triangles);
            });
            measure(&mut group, &format!("asked, {threads} threads"), triangles, |mesh| {
                in_blocks(mesh, pool, &|| &rule);
                assert_eq!(mesh.raw_triangle_count() as u64, triangles);
            });
            measure(&mut group, &format!("field, {threads} threads"), triangles, |mesh| {
                in_blocks(mesh, pool, &field::rule(&field));
            });
            let made = graded_triangles(&graded);
            group.throughput(Throughput::Elements(made));
            measure(&mut group, &format!("graded, {threads} threads"), made, |mesh| {
                in_blocks(mesh, pool, &field::rule(&graded));
            });
            group.throughput(Throughput::Elements(triangles));
            writes(&mut group, pool, triangles);
        }
    }
    group.finish();
    criterion.final_summary();
}

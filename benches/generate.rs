//! Mesh generation: the report's series, extended to 33 million triangles.
//!
//! *fresh* builds in newly allocated memory, as a first mesh does; mapping its pages takes a third of the
//! time or more. *reused* builds into the arrays of the previous mesh, as an edit under the vertex rule does.
//! The time to drop a mesh is not counted.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};
use meshbrush::internals::mesh::{Limits, Mesh, Refiner};
use meshbrush_benches::diamond;

fn fresh(level: u32) -> (Duration, Mesh) {
    let start = Instant::now();
    let mesh = diamond::mesh(level);
    (start.elapsed(), mesh)
}

fn reused(coarse: &Mesh, mesh: &mut Mesh, refiner: &mut Refiner, level: u32) -> Duration {
    let start = Instant::now();
    mesh.clone_from(coarse);
    refiner.restart(mesh);
    refiner.advance(mesh, diamond::rule(coarse, level), usize::MAX).expect("within the default limits");
    start.elapsed()
}

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

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("generate");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).warm_up_time(Duration::from_millis(500));
    for (level, triangles) in SERIES {
        group.measurement_time(Duration::from_millis(if level < 15 { 1500 } else { 100 }));
        group.throughput(Throughput::Elements(triangles));
        group.bench_function(BenchmarkId::new("fresh", triangles), |b| {
            b.iter_custom(|rounds| {
                (0..rounds)
                    .map(|_| {
                        let (time, mesh) = fresh(level);
                        assert_eq!(mesh.raw_triangle_count() as u64, triangles);
                        black_box(mesh);
                        time
                    })
                    .sum()
            });
        });
        group.bench_function(BenchmarkId::new("reused", triangles), |b| {
            let coarse = diamond::coarse();
            let mut mesh = coarse.clone();
            let mut refiner = Refiner::new(&mesh, Limits::default());
            reused(&coarse, &mut mesh, &mut refiner, level);
            b.iter_custom(|rounds| {
                (0..rounds).map(|_| reused(&coarse, &mut mesh, &mut refiner, level)).sum()
            });
        });
    }
    group.finish();
    criterion.final_summary();
}

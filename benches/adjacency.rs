//! Adjacency rows (Algorithm 13) of the report's meshes.

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use meshbrush_benches::diamond;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("adjacency");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    for level in [5, 9, 13] {
        let mesh = diamond::mesh(level);
        group.throughput(Throughput::Elements(mesh.raw_nodes().len() as u64));
        group.bench_function(BenchmarkId::new("rows", mesh.raw_nodes().len()), |b| {
            b.iter(|| mesh.adjacency())
        });
    }
    group.finish();
    criterion.final_summary();
}

//! Point location in the report's meshes: our walk, our search tree, and spade's Delaunay triangulation of
//! the same nodes.
//!
//! All three answer the same random points, one after the other, on one core.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::{DVec2, dvec2};
use meshbrush_benches::diamond;
use meshbrush_mesh::mesh::{Locator, Mesh, NodeId};
use spade::{
    DelaunayTriangulation, HierarchyHintGenerator, HintGenerator, LastUsedVertexHintGenerator, Point2,
    Triangulation,
};

const POINTS: usize = 100_000;

fn points() -> Vec<DVec2> {
    let mut random = fastrand::Rng::with_seed(1);
    std::iter::repeat_with(|| 20.0 * dvec2(random.f64(), random.f64()) - 10.0).take(POINTS).collect()
}

type Spade<H> = DelaunayTriangulation<Point2<f64>, (), (), (), H>;

fn spade_of<H: HintGenerator<f64> + Default>(mesh: &Mesh) -> Spade<H> {
    let world = (0..mesh.raw_nodes().len()).map(|n| mesh.world(NodeId::from_index(n)));
    Spade::bulk_load(world.map(|p| Point2::new(p.x, p.y)).collect()).expect("every node is a finite point")
}

/// Takes an answer, so that the search for it is not optimised away.
fn consume<T>(answer: T) {
    black_box(answer);
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("locate");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(2))
        .throughput(Throughput::Elements(POINTS as u64));
    let points = points();
    for level in [9, 13] {
        let mesh = diamond::mesh(level);
        let triangles = mesh.raw_triangle_count();
        let locator = Locator::new(&mesh);
        let hierarchy = spade_of::<HierarchyHintGenerator<f64>>(&mesh);
        let last_used = spade_of::<LastUsedVertexHintGenerator>(&mesh);
        group.throughput(Throughput::Elements(POINTS as u64));
        group.bench_function(BenchmarkId::new("Mesh::locate", triangles), |b| {
            b.iter(|| points.iter().for_each(|&p| consume(mesh.locate(p))));
        });
        group.bench_function(BenchmarkId::new("Locator::locate", triangles), |b| {
            b.iter(|| points.iter().for_each(|&p| consume(locator.locate(p))));
        });
        group.bench_function(BenchmarkId::new("spade, hierarchy", triangles), |b| {
            b.iter(|| points.iter().for_each(|&p| consume(hierarchy.locate(Point2::new(p.x, p.y)))));
        });
        // Walks across the whole mesh: a hundredth of the points will do.
        let few = &points[..POINTS / 100];
        group.throughput(Throughput::Elements(few.len() as u64));
        group.bench_function(BenchmarkId::new("spade, last used vertex", triangles), |b| {
            b.iter(|| few.iter().for_each(|&p| consume(last_used.locate(Point2::new(p.x, p.y)))));
        });
        group.throughput(Throughput::Elements(triangles as u64));
        group.bench_function(BenchmarkId::new("Locator::new", triangles), |b| {
            b.iter(|| Locator::new(&mesh));
        });
    }
    group.finish();
    criterion.final_summary();
}

//! Why a triangle is there: the time of one answer, which must not grow with the mesh.
//!
//! Random triangles of the report's diamond: the cause with the replayed chain, and the place in the field
//! that decides.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::DVec2;
use meshbrush_core::build::{BuiltMesh, MeshBuilder, MeshSpec, RefinementCriterion};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::explain::Explanation;
use meshbrush_core::field::{Formula, RefinementRule, Transfer};
use meshbrush_core::layers::{Layer, LayerKind, PaintLayers, SizeFieldSpec};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Cleaning, Limits, Progress, TreeTriangle, TriangleId, bisection_edge_length};

const TRIANGLES: usize = 1_000;

/// Returns the report's diamond refined to a level by the area rule.
fn built(level: u32, limits: Limits) -> BuiltMesh {
    let domain = Domain::rectangle(Rect::around(DVec2::ZERO, 10.0));
    let target = bisection_edge_length(1.0, level) * (1.0 + 1e-12);
    let formula = format!("if(abs(x) + abs(y) < 8, {target:?}, 20)");
    let field = SizeFieldSpec {
        layers: Layer::stack([LayerKind::target(Formula::parse(&formula).expect("a valid formula"))]),
        transfer: Transfer::between(0.5 * target, 20.0),
        unasked: 20.0,
        outline: None,
        gradation: None,
        projection: None,
    };
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, 1.0, 1_000_000).expect("a square has a grid"),
        domain,
        boundary: BoundaryTreatment::default_for(1.0),
        lines: Default::default(),
        field,
        rule: RefinementRule::Area,
        cleaning: Cleaning::NONE,
        limits,
    });
    while builder.advance(None, usize::MAX).expect("within the limits") == Progress::More {}
    builder.finish()
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("explain");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(2))
        .throughput(Throughput::Elements(TRIANGLES as u64));
    for level in [5, 9, 13, 15] {
        let limits = Limits::default();
        let built = built(level, limits);
        let criterion = RefinementCriterion::by_area(&built.domain, &built.field, PaintLayers::blank());
        let count = built.mesh.raw_triangle_count();
        let mut random = fastrand::Rng::with_seed(3);
        let triangles: Vec<_> =
            (0..TRIANGLES).map(|_| TriangleId::from_index(random.usize(..count))).collect();
        group.bench_function(BenchmarkId::new("Explanation::new", count), |b| {
            b.iter(|| {
                for &id in &triangles {
                    let triangle = TreeTriangle::from_mesh(&built.mesh, id);
                    black_box(Explanation::new(&built.mesh, triangle, &criterion, &limits));
                }
            });
        });
    }
    group.finish();
}

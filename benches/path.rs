//! Paths: marches beside Dijkstra's algorithm, the work on costs and paths on one and on all threads, and how
//! wide intervals are.
//!
//! *march* and *dijkstra* find the distances of all nodes from one on the report's mesh: fast marching, and
//! the crate `pathfinding` on the edges of the mesh.
//!
//! *coasts* is a table: the triangles that paths go through, without the outline of a domain and with it, in a
//! lake of 1.8 million triangles and 200,000 corners.
//!
//! *intervals* and *certificates* are tables: the width of the interval that a planner finds, and the time of
//! a certificate of 0.1 %, for 50 random risks on 100 thousand nodes.

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::{DVec2, dvec2};
use meshbrush_benches::diamond;
use meshbrush_benches::documents::lake_document;
use meshbrush_benches::risks::{RandomRisk, mesh, processor_time};
use meshbrush_core::document::Follower;
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::RiskField;
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::path::{
    CertificateEnd, CertificateTask, CostDensity, FormulaCost, March, MeshPlace, Passage, PathArea,
    PathCertificate, PathMesh, PathRequest, Planner, Waypoint,
};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, Limits, Mesh, NodeId};
use pathfinding::prelude::dijkstra_all;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Costs on a scale of integers: the crate compares costs exactly.
const SCALE: f64 = 1e9;
/// Runs of which the shortest counts.
const RUNS: usize = 5;
/// Random risks of the tables.
const RISKS: u64 = 50;
/// The level of the mesh of the tables: 103 thousand nodes.
const LEVEL: u32 = 8;
/// The width of the certificates.
const WIDTH: f64 = 1e-3;

fn main() {
    let filter = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let tables: [(&str, fn()); 3] =
        [("coasts", coasts), ("intervals", intervals), ("certificates", certificates)];
    if !tables.iter().any(|(name, _)| filter.as_deref() == Some(*name)) {
        let mut criterion = Criterion::default().configure_from_args();
        for level in [9, 12, 13] {
            marches(&mut criterion, &diamond::mesh(level));
        }
        work(&mut criterion);
        criterion.final_summary();
    }
    for (name, print) in tables {
        if filter.as_ref().is_none_or(|filter| filter == name) {
            print();
        }
    }
}

fn density(formula: &str) -> FormulaCost {
    let formula = CostFormula::parse(formula).expect("it is a formula");
    FormulaCost { formula, risk: RiskField::default() }
}

/// The costs before and after an edit within a brush of radius 0.5 on the report's mesh.
fn densities() -> [FormulaCost; 2] {
    let plain = "1 + 5*exp(-0.1*((x - 2)^2 + (y + 1)^2))";
    [plain, &format!("{plain} + 2*max(0, 1 - 4*((x - 3)^2 + (y - 3)^2))")].map(density)
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("the system gives threads")
}

/// Marches on one thread, and paths for one frame.
fn marches(criterion: &mut Criterion, mesh: &Mesh) {
    let [density, edited] = &densities();
    let paths = PathMesh::new(mesh.view());
    let costs = paths.costs(density).expect("the cost is positive").mean;
    let place = MeshPlace::find(&paths, dvec2(-6.0, -6.1), Waypoint::Start).expect("it is in the square");
    let seeds = place.seeds(&paths, &costs);
    let nodes = paths.node_count();
    let mut group = criterion.benchmark_group("path");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(3))
        .throughput(Throughput::Elements(nodes as u64));
    let mut march = March::default();
    group.bench_function(BenchmarkId::new("march", nodes), |b| {
        b.iter(|| march.run(&paths, &costs, Passage::Open, &seeds, None));
    });
    let graph = Graph::new(mesh, density);
    let start = seeds[0].0;
    group.bench_function(BenchmarkId::new("dijkstra on edges (pathfinding)", nodes), |b| {
        b.iter(|| black_box(dijkstra_all(&start, |&node| graph.steps(node))));
    });
    let raised = paths.costs(edited).expect("the cost is positive").mean;
    let changed: Vec<u32> =
        (0..costs.len() as u32).filter(|&t| costs[t as usize] != raised[t as usize]).collect();
    let (mut is_raised, mut redone) = (false, 0);
    march.run(&paths, &costs, Passage::Open, &seeds, None);
    group.bench_function(BenchmarkId::new("march after an edit", nodes), |b| {
        b.iter(|| {
            is_raised = !is_raised;
            let costs = if is_raised { &raised } else { &costs };
            redone = march.resolve(&paths, costs, Passage::Open, &seeds, &changed);
        });
    });
    eprintln!("after an edit, {redone} of {nodes} nodes are computed again");
    let mut planner = Planner::on_mesh(paths.clone(), density).expect("the cost is positive");
    let places = [dvec2(-6.0, -6.1), dvec2(6.2, 5.0)];
    let mut n = 0.0;
    group.bench_function(BenchmarkId::new("path", nodes), |b| {
        b.iter(|| {
            // Another start each time: the planner would keep its march.
            n += 1e-9;
            let places = [places[0] + dvec2(n, 0.0), places[1]];
            black_box(planner.solve(density, &places, PathRequest::LIVE).expect("there is a path"))
        });
    });
    group.finish();
}

/// The parts of the work on paths, on one thread and on all.
fn work(criterion: &mut Criterion) {
    let mesh = Arc::new(PathMesh::new(mesh(LEVEL).view()));
    let RandomRisk { cost, places } = RandomRisk::new(0);
    let mut group = criterion.benchmark_group("work");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    for threads in [1, 2] {
        let pool = pool(threads);
        group.bench_function(BenchmarkId::new("costs", threads), |b| {
            b.iter(|| pool.install(|| black_box(mesh.costs(&cost).expect("the cost is positive"))));
        });
        group.bench_function(BenchmarkId::new("a planner", threads), |b| {
            b.iter(|| pool.install(|| black_box(Planner::new(Arc::clone(&mesh), &cost).is_ok())));
        });
        let fresh = Planner::new(Arc::clone(&mesh), &cost).expect("the cost is positive");
        let via = [places[0], dvec2(0.1, 0.9), dvec2(0.5, 0.4), dvec2(0.9, 0.1), places[1]];
        let live = PathRequest { has_bounds: true, ..PathRequest::LIVE };
        for (name, places, request) in [
            ("a path in full", &places[..], PathRequest::FULL),
            ("four legs in full", &via[..], PathRequest::FULL),
            ("four legs, sketched, with bounds", &via[..], live),
        ] {
            group.bench_function(BenchmarkId::new(name, threads), |b| {
                let solve = |mut planner: Planner| {
                    pool.install(|| black_box(planner.solve(&cost, places, request).expect("a path")))
                };
                b.iter_batched(|| fresh.clone(), solve, criterion::BatchSize::LargeInput);
            });
        }
        after_a_dab(&mut group, &pool, &mesh, &places);
        after_a_stroke(&mut group, &pool, &cost, &places);
    }
    group.finish();
}

type Group<'a> = criterion::BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// A path for one frame while a person paints, and the one after it with its interval.
fn after_a_dab(group: &mut Group<'_>, pool: &ThreadPool, mesh: &Arc<PathMesh>, places: &[DVec2; 2]) {
    let plain = "1 + 5*exp(-10*((x - 0.6)^2 + (y - 0.4)^2))";
    let dab = format!("{plain} + 2*max(0, 1 - 400*((x - 0.3)^2 + (y - 0.6)^2))");
    let densities = [density(plain), density(&dab)];
    let area = [Rect::around(dvec2(0.3, 0.6), 0.05)];
    let threads = pool.current_num_threads();
    let mut planner = Planner::new(Arc::clone(mesh), &densities[0]).expect("the cost is positive");
    let mut is_painted = false;
    let mut bench = |name: &str, request: PathRequest| {
        group.bench_function(BenchmarkId::new(name, threads), |b| {
            b.iter(|| {
                is_painted = !is_painted;
                let density = &densities[usize::from(is_painted)];
                pool.install(|| {
                    match request == PathRequest::LIVE {
                        true => planner.follow(density, &area).expect("the cost is positive"),
                        false => planner.update(density, &area).expect("the cost is positive"),
                    }
                    black_box(planner.solve(density, places, request).expect("there is a path"));
                });
            });
        });
    };
    bench("after a dab, live", PathRequest::LIVE);
    bench("after a dab, in full", PathRequest::FULL);
}

/// The paths after a stroke that makes the mesh finer in a disc, and after its undo: with the planner that is
/// known, and with a new one.
fn after_a_stroke(group: &mut Group<'_>, pool: &ThreadPool, cost: &dyn CostDensity, places: &[DVec2; 2]) {
    let plain = mesh(LEVEL);
    let mut finer = plain.clone();
    let at = dvec2(0.3, 0.6);
    let stroke = finer.refine(&Limits::default(), |element| {
        let [a, b, c] = element.world_corners();
        element.triangle.level() < LEVEL + 2 && ((a + b + c) / 3.0).distance(at) < 0.03
    });
    stroke.expect("within the default limits");
    let threads = pool.current_num_threads();
    let mut planner: Option<Planner> = None;
    let mut is_stroked = false;
    for keeps in [false, true] {
        let name = if keeps { "after a stroke, kept" } else { "after a stroke, new" };
        group.bench_function(BenchmarkId::new(name, threads), |b| {
            b.iter(|| {
                is_stroked = !is_stroked;
                pool.install(|| {
                    let mesh = Arc::new(PathMesh::new(if is_stroked { &finer } else { &plain }.view()));
                    let planner: &mut Planner = match planner.take().filter(|_| keeps) {
                        Some(known) => {
                            let known = planner.insert(known);
                            known.move_to(mesh, cost, &[]).expect("the cost is positive");
                            known
                        }
                        None => planner.insert(Planner::new(mesh, cost).expect("the cost is positive")),
                    };
                    black_box(planner.solve(cost, places, PathRequest::FULL).expect("there is a path"));
                });
            });
        });
    }
}

/// Prints how long it takes to find the triangles that paths may cross.
fn coasts() {
    let mut document = lake_document();
    let domain = document.settings().domain.clone();
    let follower = Follower::new(&mut document).expect("it has a mesh");
    let derived = DerivedMesh::new(
        follower.mesh(),
        follower.domain(),
        follower.edge_targets(document.paint()),
        &Cleaning::FOR_SOLVERS,
    );
    let extract = derived.extract(follower.mesh());
    let area = |clearance| {
        PathArea::new(&domain, document.settings().boundary, Vec::new(), clearance).expect("a distance")
    };
    for threads in [1, 2] {
        let pool = pool(threads);
        let report = |name: &str, mesh: &(dyn Fn() -> PathMesh + Sync)| {
            let runs = (0..RUNS).map(|_| {
                let began = Instant::now();
                let triangles = pool.install(|| mesh().triangle_count());
                (began.elapsed(), triangles)
            });
            let (time, triangles) = runs.min().expect("some runs");
            eprintln!(
                "coasts/{threads}: {name:22} {triangles:9} triangles {:8.1} ms",
                1e3 * time.as_secs_f64()
            );
        };
        report("without the outline", &|| PathMesh::new(extract.view()));
        report("with the outline", &|| PathMesh::in_area(extract.view(), &area(0.0)));
        report("and with a clearance", &|| PathMesh::in_area(extract.view(), &area(0.002)));
    }
}

/// Prints how wide intervals are.
fn intervals() {
    let mesh = Arc::new(PathMesh::new(mesh(LEVEL).view()));
    // All stay, and with them the times of their threads.
    let pools = [1, 2].map(pool);
    for (threads, pool) in (1..).zip(&pools) {
        let [mut gaps, mut times] = [(); 2].map(|()| Vec::new());
        let began = processor_time();
        for number in 0..RISKS {
            let RandomRisk { cost, places } = RandomRisk::new(number);
            let began = Instant::now();
            let solution = pool.install(|| {
                let mut planner = Planner::new(Arc::clone(&mesh), &cost).expect("the cost is positive");
                planner.solve(&cost, &places, PathRequest::FULL).expect("there is a path")
            });
            times.push(1e3 * began.elapsed().as_secs_f64());
            gaps.push(100.0 * solution.gap());
        }
        let processor = 1e3 * (processor_time() - began).as_secs_f64() / RISKS as f64;
        let ([median_gap, most_gap], [median, most]) = (median_and_most(gaps), median_and_most(times));
        eprintln!(
            "intervals/{threads}: width {median_gap:.2} % (at most {most_gap:.2}), {median:.0} ms (at most \
             {most:.0}), mean processor time {processor:.0} ms"
        );
    }
}

/// Prints how long certificates take, after the path is known.
fn certificates() {
    let mesh = Arc::new(PathMesh::new(mesh(LEVEL).view()));
    // All stay, and with them the times of their threads.
    let pools = [1, 2].map(pool);
    for (threads, pool) in (1..).zip(&pools) {
        let [mut widths, mut times] = [(); 2].map(|()| Vec::new());
        let (mut reached, mut processor) = (0, Duration::ZERO);
        for number in 0..RISKS {
            let RandomRisk { cost, places } = RandomRisk::new(number);
            pool.install(|| {
                let cost = Arc::new(cost);
                let mut planner = Planner::new(Arc::clone(&mesh), &*cost).expect("the cost is positive");
                let found = planner.solve(&*cost, &places, PathRequest::FULL).expect("there is a path");
                let before = (processor_time(), Instant::now());
                let (path, upper) = (found.points.clone(), found.upper);
                let task = CertificateTask::in_rectangle(Rect::UNIT, cost, path, upper, WIDTH);
                let certificate = PathCertificate::new(&found, &task.expect("a square")).expect("a path");
                let mut certificate = certificate.with_search(Arc::clone(planner.mesh()));
                let end = loop {
                    if let Some(end) = certificate.advance().expect("the cost is positive") {
                        break end;
                    }
                };
                times.push(before.1.elapsed().as_secs_f64());
                processor += processor_time() - before.0;
                widths.push(100.0 * certificate.width());
                reached += u32::from(end == CertificateEnd::Reached);
            });
        }
        let processor = processor.as_secs_f64() / RISKS as f64;
        let ([width, most_width], [median, most]) = (median_and_most(widths), median_and_most(times));
        eprintln!(
            "certificates/{threads}: {reached} of {RISKS} reached, width {width:.3} % (at most {most_width:.3}), \
             {median:.2} s (at most {most:.2}), mean processor time {processor:.2} s"
        );
    }
}

/// Returns the median and the greatest of some numbers.
fn median_and_most(mut numbers: Vec<f64>) -> [f64; 2] {
    numbers.sort_by(f64::total_cmp);
    [numbers[numbers.len() / 2], numbers[numbers.len() - 1]]
}

/// The edges of a mesh with their costs.
struct Graph {
    starts: Vec<usize>,
    steps: Vec<(u32, u64)>,
}

impl Graph {
    fn new(mesh: &Mesh, density: &dyn CostDensity) -> Self {
        let adjacency = mesh.adjacency();
        let (mut starts, mut steps) = (vec![0], Vec::new());
        for node in 0..adjacency.len() {
            let p = mesh.world(NodeId::from_index(node));
            for &other in adjacency.of(NodeId::from_index(node)) {
                let q = mesh.world(other);
                let cost = p.distance(q) * density.at(p.midpoint(q));
                steps.push((other.index() as u32, (SCALE * cost) as u64));
            }
            starts.push(steps.len());
        }
        Self { starts, steps }
    }

    fn steps(&self, node: u32) -> impl Iterator<Item = (u32, u64)> + '_ {
        self.steps[self.starts[node as usize]..self.starts[node as usize + 1]].iter().copied()
    }
}

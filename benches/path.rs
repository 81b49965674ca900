//! Fast marching on the report's meshes beside Dijkstra's algorithm on their edges, from the crate
//! `pathfinding`: the distances of all nodes from one, and the same after a small edit.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use glam::dvec2;
use meshbrush_benches::diamond;
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{
    CostDensity, FormulaCost, March, Passage, PathMesh, PathRequest, Place, Planner, Waypoint,
};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Mesh, NodeId};
use pathfinding::prelude::dijkstra_all;

/// Costs on a scale of integers: the crate compares costs exactly.
const SCALE: f64 = 1e9;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let density = |formula: &str| {
        let formula = CostFormula::parse(formula).expect("it is a formula");
        FormulaCost { formula, risk: RiskField::default() }
    };
    let plain = "1 + 5*exp(-0.1*((x - 2)^2 + (y + 1)^2))";
    let density = [plain, &format!("{plain} + 2*max(0, 1 - 4*((x - 3)^2 + (y - 3)^2))")].map(density);
    for level in [9, 12, 13] {
        bench(&mut criterion, &diamond::mesh(level), &density);
    }
    criterion.final_summary();
}

/// `density` has the costs before and after an edit within a brush of radius 0.5.
fn bench(criterion: &mut Criterion, mesh: &Mesh, [density, edited]: &[FormulaCost; 2]) {
    let paths = PathMesh::new(mesh.view());
    let costs = paths.costs(density).expect("the cost is positive").mean;
    let place = Place::find(&paths, dvec2(-6.0, -6.1), Waypoint::Start).expect("it is in the square");
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
    let raised = paths.costs(edited).expect("the cost is positive").mean;
    let changed: Vec<u32> =
        (0..costs.len() as u32).filter(|&t| costs[t as usize] != raised[t as usize]).collect();
    let (mut is_raised, mut redone) = (false, 0);
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
    let area = [Rect::around(dvec2(3.0, 3.0), 0.5)];
    let mut is_edited = false;
    group.bench_function(BenchmarkId::new("path after an edit", nodes), |b| {
        b.iter(|| {
            is_edited = !is_edited;
            let density = if is_edited { edited } else { density };
            planner.follow(density, &area).expect("the cost is positive");
            black_box(planner.solve(density, &places, PathRequest::LIVE).expect("there is a path"))
        });
    });
    let graph = Graph::new(mesh, density);
    let start = place.seeds(&paths, &costs)[0].0;
    group.bench_function(BenchmarkId::new("dijkstra on edges (pathfinding)", nodes), |b| {
        b.iter(|| black_box(dijkstra_all(&start, |&node| graph.steps(node))));
    });
    group.finish();
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

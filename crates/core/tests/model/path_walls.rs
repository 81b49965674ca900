//! Paths between any two places stay in the domain, and their figures are their own.
//!
//! The domains are squares without random cells. An exact test tells whether a segment enters a cell, and
//! the shortest paths are found by brute force over all corners.

use std::sync::Arc;

use crate::exact_segments::enters;
use crate::runs::seeds;
use glam::{DVec2, dvec2};
use meshbrush_core::field::CostFormula;
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::{
    CertificateTask, CostDensity, FormulaCost, Passage, PathCertificate, PathError, PathMesh, PathRequest,
    Placement, PlacementTest, Planner, Solution,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh};

/// Cells per side of the square.
const CELLS: i32 = 8;

fn cost(formula: &str) -> FormulaCost {
    FormulaCost { formula: CostFormula::parse(formula).unwrap(), risk: RiskField::default() }
}

/// The unit square without some of its cells.
struct Maze {
    closed: Vec<bool>,
}

impl Maze {
    fn random(random: &mut fastrand::Rng) -> Self {
        let share = 0.1 + 0.25 * random.f64();
        Self { closed: (0..CELLS * CELLS).map(|_| random.f64() < share).collect() }
    }

    fn is_closed(&self, x: i32, y: i32) -> bool {
        let inside = (0..CELLS).contains(&x) && (0..CELLS).contains(&y);
        !inside || self.closed[(y * CELLS + x) as usize]
    }

    /// Open rectangles that cover the interior of what is closed: cells, pairs of them, and blocks of four.
    fn forbidden(&self) -> Vec<Rect> {
        let mut found = Vec::new();
        for (x, y) in (-1..=CELLS).flat_map(|x| (-1..=CELLS).map(move |y| (x, y))) {
            for (wide, high) in [(1, 1), (2, 1), (1, 2), (2, 2)] {
                let mut cells = (0..wide).flat_map(|i| (0..high).map(move |j| (x + i, y + j)));
                if cells.all(|(x, y)| self.is_closed(x, y)) {
                    let corner = |x: i32, y: i32| dvec2(f64::from(x), f64::from(y)) / f64::from(CELLS);
                    found.push(Rect::new(corner(x, y), corner(x + wide, y + high)));
                }
            }
        }
        found
    }

    fn at(&self, p: DVec2) -> bool {
        let cell = (p * f64::from(CELLS)).floor();
        self.is_closed(cell.x as i32, cell.y as i32)
    }

    /// Returns the triangles, of random sizes.
    fn mesh(&self, random: &mut fastrand::Rng) -> PathMesh {
        let lattice = Lattice::covering(Rect::UNIT, 1.0 / f64::from(CELLS), 10_000).unwrap();
        let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let (near, finest) = (dvec2(random.f64(), random.f64()), 0.02 + 0.15 * random.f64());
        mesh.refine(&Limits::default(), |element| {
            let [a, b, c] = element.world_corners();
            element.diameter() > finest + 0.3 * ((a + b + c) / 3.0).distance(near)
        })
        .unwrap();
        PathMesh::with_passages(mesh.view(), |&[a, b, c], _| match self.at((a + b + c) / 3.0) {
            true => Passage::Closed,
            false => Passage::Open,
        })
    }

    /// Returns a place inside, on a wall, at a corner, or on the frame.
    fn place(&self, random: &mut fastrand::Rng) -> DVec2 {
        loop {
            let line = |random: &mut fastrand::Rng| f64::from(random.i32(0..=CELLS)) / f64::from(CELLS);
            let place = match random.u32(0..4) {
                0 => dvec2(random.f64(), random.f64()),
                1 => dvec2(line(random), line(random)),
                2 => dvec2(line(random), random.f64()),
                _ => dvec2(random.f64(), line(random)),
            };
            let steps = [dvec2(1e-9, 1e-9), dvec2(-1e-9, 1e-9), dvec2(1e-9, -1e-9), dvec2(-1e-9, -1e-9)];
            if steps.iter().any(|&step| !self.at(place + step)) {
                return place;
            }
        }
    }

    /// Returns the length of the shortest path, over all corners of cells.
    fn shortest(&self, from: DVec2, to: DVec2) -> f64 {
        let forbidden = self.forbidden();
        let corners = (0..=CELLS).flat_map(|x| (0..=CELLS).map(move |y| dvec2(f64::from(x), f64::from(y))));
        let corners = corners.map(|corner| corner / f64::from(CELLS));
        let nodes: Vec<DVec2> = [from, to].into_iter().chain(corners).collect();
        let is_free = |p: DVec2, q: DVec2| forbidden.iter().all(|open| enters(p, q, open) == Some(false));
        let mut best = vec![f64::INFINITY; nodes.len()];
        let mut is_done = vec![false; nodes.len()];
        best[0] = 0.0;
        while let Some(at) =
            (0..nodes.len()).filter(|&n| !is_done[n]).min_by(|&a, &b| best[a].total_cmp(&best[b]))
        {
            if at == 1 || best[at] == f64::INFINITY {
                break;
            }
            is_done[at] = true;
            for n in (0..nodes.len()).filter(|&n| !is_done[n]) {
                let length = best[at] + nodes[at].distance(nodes[n]);
                if length < best[n] && is_free(nodes[at], nodes[n]) {
                    best[n] = length;
                }
            }
        }
        best[1]
    }
}

/// Returns the cost of a polyline by a fine sum, and the length.
fn integrated(density: &dyn CostDensity, points: &[DVec2]) -> f64 {
    let piece = |pair: &[DVec2]| {
        let count = 8.0 + (2000.0 * pair[0].distance(pair[1])).ceil();
        let places = (0..count as u32).map(|n| (f64::from(n) + 0.5) / count);
        let mean = places.map(|share| density.at(pair[0] + share * (pair[1] - pair[0]))).sum::<f64>() / count;
        mean * pair[0].distance(pair[1])
    };
    points.windows(2).map(piece).sum()
}

fn assert_stays_inside(forbidden: &[Rect], points: &[DVec2], message: &str) {
    for pair in points.windows(2) {
        for open in forbidden {
            assert_ne!(
                enters(pair[0], pair[1], open),
                Some(true),
                "{} {} {open:?} {message}",
                pair[0],
                pair[1]
            );
        }
    }
}

/// Fewer points, no farther from the path than the tolerance, that cost at most 1 % more. The costs of both
/// are computed to a share of 10⁻³.
fn assert_is_simplified(path: &Solution, simplified: &Solution, tolerance: f64, message: &str) {
    assert!(simplified.points.len() <= path.points.len(), "{message}");
    let pieces = || simplified.points.windows(2);
    for &point in &path.points {
        let distances = pieces().map(|pair| distance_to_segment(point, [pair[0], pair[1]]));
        let distance = distances.fold(f64::INFINITY, f64::min);
        assert!(distance <= tolerance * (1.0 + 1e-12), "{point} at {distance} {message}");
    }
    let costs = [simplified.cost, path.cost];
    assert!(costs[0] <= 1.011 * costs[1], "{costs:?} {message}");
    assert!(simplified.upper <= 1.011 * path.upper, "{} {} {message}", simplified.upper, path.upper);
}

fn distance_to_segment(point: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let share = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    point.distance(if share.is_nan() { a } else { a + share * along })
}

#[test]
fn paths_between_any_places_stay_in_the_domain_and_cost_what_they_say() {
    let formulas =
        ["1", "exp(4*x)", "1 + 3*abs(x - y)", "if(x < 0.5, 1, 5)", "1/(0.05 + y)", "1 + 9*(x - 0.4)^2"];
    let (mut found, mut apart) = (0, 0);
    for seed in seeds(20) {
        let mut random = fastrand::Rng::with_seed(2600 + seed);
        let maze = Maze::random(&mut random);
        let forbidden = maze.forbidden();
        let mesh = Arc::new(maze.mesh(&mut random));
        let formula = formulas[random.usize(..formulas.len())];
        let density = cost(formula);
        let mut planner = Planner::new(Arc::clone(&mesh), &density).unwrap();
        for _ in 0..4 {
            let places = [maze.place(&mut random), maze.place(&mut random)];
            let shortest = maze.shortest(places[0], places[1]);
            let message = format!("{seed} {formula} {places:?}");
            let solution = match planner.solve(&density, &places, PathRequest::FULL) {
                Ok(solution) => solution,
                Err(PathError::Enclosed { .. }) => {
                    assert_eq!(shortest, f64::INFINITY, "{message}");
                    apart += 1;
                    continue;
                }
                Err(error) => panic!("{message}: {error}"),
            };
            found += 1;
            let simplified = solution.simplified(&density, 0.04).unwrap();
            assert_is_simplified(&solution, &simplified, 0.04, &message);
            for path in [&solution, &simplified] {
                assert_stays_inside(&forbidden, &path.points, &message);
                let sum = integrated(&density, &path.points);
                let is_smooth = !formula.starts_with("if");
                let tolerance = if is_smooth { 2e-3 } else { 5e-2 };
                assert!((sum - path.cost).abs() <= tolerance * sum, "{sum} {} {message}", path.cost);
                assert!(path.lower <= path.upper && path.cost <= path.upper, "{message}");
                assert!(path.length >= shortest * (1.0 - 1e-12), "{} {shortest} {message}", path.length);
            }
            if formula == "1" {
                assert!(solution.cost <= shortest * (1.0 + 1e-12), "{} {shortest} {message}", solution.cost);
                assert!(solution.upper >= shortest * (1.0 - 1e-12), "{message}");
                assert!(
                    solution.lower <= shortest * (1.0 + 1e-12),
                    "{} {shortest} {message}",
                    solution.lower
                );
            }
        }
    }
    assert!(found > 2 * apart && found > 20, "{found} {apart}");
}

#[test]
fn where_the_cost_is_constant_paths_are_the_shortest() {
    let density = cost("1");
    let mut found = 0;
    // The first of them once took the longer way around a cell.
    for seed in [702].into_iter().chain(seeds(60)) {
        let mut random = fastrand::Rng::with_seed(2600 + seed);
        let maze = Maze::random(&mut random);
        let mesh = Arc::new(maze.mesh(&mut random));
        let _ = random.usize(..6);
        let mut planner = Planner::new(Arc::clone(&mesh), &density).unwrap();
        for _ in 0..4 {
            let places = [maze.place(&mut random), maze.place(&mut random)];
            let Ok(solution) = planner.solve(&density, &places, PathRequest::FULL) else { continue };
            let shortest = maze.shortest(places[0], places[1]);
            let message = format!("{seed} {places:?}: {} {shortest}", solution.cost);
            assert!((solution.cost - shortest).abs() <= 1e-12 * shortest, "{message}");
            assert!(solution.lower <= shortest * (1.0 + 1e-12), "{message}");
            found += 1;
        }
    }
    assert!(found > 150, "{found}");
}

/// Returns the maze as a certificate is asked about it.
fn certified(maze: &Arc<Maze>, solution: &Solution, density: &FormulaCost) -> PathCertificate {
    let (maze, path) = (Arc::clone(maze), solution.points.clone());
    let task = CertificateTask::in_rectangle(Rect::UNIT, Arc::new(density.clone()), path, 1.0, 0.05).unwrap();
    let placement: PlacementTest = Arc::new(move |element| {
        let [a, b, c] = element.world_corners();
        if maze.at((a + b + c) / 3.0) { Placement::Outside } else { Placement::Inside }
    });
    let task = CertificateTask { placement, most_nodes: 700, ..task };
    let mut certificate = PathCertificate::new(solution, &task).unwrap();
    while certificate.advance().unwrap().is_none() {}
    certificate
}

#[test]
fn certificates_between_places_on_walls_are_below_the_shortest_path() {
    for seed in seeds(12) {
        let mut random = fastrand::Rng::with_seed(2650 + seed);
        let maze = Arc::new(Maze::random(&mut random));
        let mesh = maze.mesh(&mut random);
        let places = [maze.place(&mut random), maze.place(&mut random)];
        let density = cost("1");
        let Ok(solution) = Planner::new(mesh, &density).unwrap().solve(&density, &places, PathRequest::FULL)
        else {
            continue;
        };
        let shortest = maze.shortest(places[0], places[1]);
        let certificate = certified(&maze, &solution, &density);
        let message = format!("{seed} {places:?}: {} {shortest}", certificate.lower());
        assert!(certificate.lower() <= shortest * (1.0 + 1e-12), "{message}");
        assert!(certificate.lower() >= 0.8 * shortest || shortest < 0.1, "{message}");
    }
}

/// A cost of hills that goes through a map of the square to itself.
struct Mapped<'a> {
    density: &'a dyn CostDensity,
    map: fn(DVec2) -> DVec2,
}

impl CostDensity for Mapped<'_> {
    fn at(&self, point: DVec2) -> f64 {
        self.density.at((self.map)(point))
    }

    fn range(&self, rectangle: &Rect) -> meshbrush_core::path::CostRange {
        let [a, b] = [rectangle.min, rectangle.max].map(self.map);
        self.density.range(&Rect::spanning(a, b))
    }
}

#[test]
fn mirrored_turned_and_moved_costs_have_mirrored_turned_and_moved_paths() {
    // Each is its own inverse or given with it; a cost at x is that of the map of x.
    let maps: [fn(DVec2) -> DVec2; 4] =
        [|p| dvec2(1.0 - p.x, p.y), |p| dvec2(p.x, 1.0 - p.y), |p| dvec2(p.y, p.x), |p| 1.0 - p];
    let lattice = Lattice::covering(Rect::UNIT, 0.125, 10_000).unwrap();
    let mut mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    mesh.refine(&Limits::default(), |element| element.diameter() > 0.05).unwrap();
    let mesh = Arc::new(PathMesh::new(mesh.view()));
    for seed in seeds(12) {
        let mut random = fastrand::Rng::with_seed(2680 + seed);
        let mut hill = || {
            let [x, y, width] = [random.f64(), random.f64(), 0.1 + 0.3 * random.f64()];
            format!("{}*gauss(hypot(x - {x}, y - {y}), {width})", 4.0 * random.f64())
        };
        let density = cost(&format!("1 + {} + {}", hill(), hill()));
        let places = [(); 2].map(|()| dvec2(random.f64(), random.f64()));
        let solve = |density: &dyn CostDensity, places: &[DVec2]| {
            Planner::new(Arc::clone(&mesh), density)
                .unwrap()
                .solve(density, places, PathRequest::FULL)
                .unwrap()
        };
        let solution = solve(&density, &places);
        for map in maps {
            let mapped = Mapped { density: &density, map };
            let other = solve(&mapped, &places.map(map));
            let message = format!("{seed} {places:?}: {} {}", solution.cost, other.cost);
            // Two valleys may cost nearly the same.
            assert!((other.cost - solution.cost).abs() <= 5e-3 * solution.cost, "{message}");
            assert!(other.lower <= solution.upper && solution.lower <= other.upper, "{message}");
        }
    }
}

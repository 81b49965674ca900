//! Meshes fitted to polygons, against a plain closure that asks every edge in whole numbers: which triangles
//! there are, where points lie among them, what files get of them, and their parts and holes.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::f64::consts::{SQRT_2, TAU};
use std::path::Path;

use crate::closure;
use crate::formula_mesh::formula_mesh;
use closure::{Point, Triangle};
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::domain::{BoundaryTreatment, Domain, Polygon, Ring, signed_area};
use meshbrush_io::io::geojson;
use meshbrush_mesh::geometry::{Lattice, LatticePoint};
use meshbrush_mesh::mesh::{Location, Locator, Mesh, NodeId, Topology, TriangleId};

/// A region, a grid over it and a rule, at random.
struct Case {
    domain: Domain,
    spacing: f64,
    diameter: f64,
    /// Target diameter: `finest` at the focus, growing with the distance.
    focus: DVec2,
    finest: f64,
    slope: f64,
}

/// Returns a closed line round `centre`, slanted, its corners at times on a coarse grid; it runs either way.
fn star(random: &mut Rng, centre: DVec2, radius: f64) -> Ring {
    let (corners, start, on_grid) = (random.usize(3..14), random.f64() * TAU, random.u32(0..3) == 0);
    let mut ring: Ring = (0..corners)
        .map(|k| {
            let angle = start + TAU * k as f64 / corners as f64;
            let p = centre + radius * (0.4 + 0.6 * random.f64()) * DVec2::from_angle(angle);
            if on_grid { (p * 32.0).round() / 32.0 } else { p }
        })
        .collect();
    if random.bool() {
        ring.reverse();
    }
    ring
}

/// Returns a bar between two points.
fn bar(from: DVec2, to: DVec2, half_width: f64) -> Ring {
    let across = half_width * (to - from).normalize().perp();
    vec![from - across, to - across, to + across, from + across]
}

fn place(random: &mut Rng) -> DVec2 {
    dvec2(random.f64(), random.f64())
}

/// Polygons about the unit square.
fn polygons(random: &mut Rng) -> Vec<Polygon> {
    let middle = DVec2::splat(0.5);
    let radius = 0.5 + random.f64() * 0.3;
    let mut polygons = vec![vec![star(random, middle, radius)]];
    match random.u32(0..6) {
        // Holes of any size, the smallest far below a coarse cell.
        0 => {
            for _ in 0..random.usize(1..9) {
                let (centre, radius) = (place(random), 0.25 * 0.003f64.powf(random.f64()));
                polygons[0].push(star(random, centre, radius));
            }
        }
        // Islands, one of them within a hole.
        1 => {
            polygons[0].push(star(random, middle, 0.2));
            polygons.push(vec![star(random, middle, 0.08)]);
            for _ in 0..random.usize(1..5) {
                let (centre, radius) = (2.0 * place(random) - middle, 0.1 * 0.01f64.powf(random.f64()));
                polygons.push(vec![star(random, centre, radius)]);
            }
        }
        // Holes that touch each other at a corner, and one that touches the outer ring.
        2 => {
            let (at, reach) = (middle + 0.1 * place(random), 0.05 + 0.05 * random.f64());
            let [a, b, c] = [0, 1, 2].map(|k| DVec2::from_angle(k as f64 * 2.1 + random.f64()) * reach);
            polygons[0].push(vec![at, at + a, at + b]);
            polygons[0].push(vec![at, at - a, at - b]);
            let outer = polygons[0][0][0];
            polygons[0].push(vec![outer, outer.lerp(middle, 0.2) + 0.1 * c, outer.lerp(middle, 0.2)]);
        }
        // A strait between two lands, narrower than the coarse spacing.
        3 => {
            let (from, to) = (dvec2(-1.0, random.f64()), dvec2(2.0, random.f64()));
            polygons[0].push(bar(from, to, 0.2 * 0.005f64.powf(random.f64())));
        }
        // Polygons that share an edge, or overlap.
        4 => {
            let (p, q) = (place(random), place(random));
            polygons.push(vec![vec![p, q, q + dvec2(0.3, 0.2)]]);
            polygons.push(vec![vec![p, q, p - dvec2(0.3, 0.1)]]);
        }
        // A thin wall, and a ring that crosses itself.
        _ => {
            let (from, to) = (place(random), place(random));
            polygons.push(vec![bar(from, to, 0.001 + 0.01 * random.f64())]);
            polygons.push(vec![(0..6).map(|_| place(random)).collect()]);
        }
    }
    polygons
}

impl Case {
    fn random(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let scale = 10f64.powi(random.i32(-3..5)) * dvec2(0.3 + random.f64(), 0.3 + random.f64());
        let shift = scale * (place(&mut random) - DVec2::splat(0.5)) * 1000f64.powf(random.f64());
        let mut polygons = polygons(&mut random);
        for p in polygons.iter_mut().flatten().flatten() {
            *p = *p * scale + shift;
        }
        let domain = Domain::of_polygons(&polygons).expect("a star covers something");
        let longer = domain.bounds.size().max_element();
        let spacing = longer / (1.5 + 5.0 * random.f64());
        let diameter = spacing * 0.04 * 30f64.powf(random.f64());
        let focus = domain.bounds.min + domain.bounds.size() * place(&mut random);
        let finest = spacing * 0.01 * 200f64.powf(random.f64());
        Self { domain, spacing, diameter, focus, finest, slope: 0.2 + random.f64() }
    }

    fn exceeds(&self, diameter: f64, corners: [DVec2; 3]) -> bool {
        corners.iter().any(|p| diameter > self.finest + self.slope * p.distance(self.focus))
    }

    fn mesh(&self) -> Mesh {
        let Self { focus, finest, slope, .. } = *self;
        // As `exceeds` computes it, to the last bit.
        let (dx, dy) = (format!("(x - ({:?}))", focus.x), format!("(y - ({:?}))", focus.y));
        let target = format!("{finest:?} + {slope:?} * sqrt({dx} * {dx} + {dy} * {dy})");
        fitted(&self.domain, self.spacing, self.diameter, &target)
    }
}

/// Returns the mesh as the program makes it, for a formula of the target diameter under the vertex rule.
fn fitted(domain: &Domain, spacing: f64, boundary_diameter: f64, target: &str) -> Mesh {
    let boundary = BoundaryTreatment::Fitted { diameter: boundary_diameter };
    let mesh = formula_mesh(domain, spacing, boundary, target).mesh;
    assert_eq!(mesh.violations(), []);
    mesh
}

/// The edges of a region in whole lattice coordinates, asked one after the other.
struct Outline {
    edges: Vec<[Point; 2]>,
    extent: Point,
}

/// Greater than 0 where `p` lies left of the line from `a` to `b`.
fn turn(a: Point, b: Point, p: Point) -> i128 {
    let [ax, ay, bx, by, px, py] = [a[0], a[1], b[0], b[1], p[0], p[1]].map(i128::from);
    ((bx - ax) * (py - ay) - (by - ay) * (px - ax)).signum()
}

fn on_segment(a: Point, b: Point, p: Point) -> bool {
    turn(a, b, p) == 0 && [0, 1].iter().all(|&i| a[i].min(b[i]) <= p[i] && p[i] <= a[i].max(b[i]))
}

fn segments_meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    let crossing = turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
    crossing || on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b)
}

fn touches([a, b]: [Point; 2], triangle: &Triangle) -> bool {
    let apart = |i: usize| {
        let along = triangle.map(|corner| corner[i]);
        a[i].max(b[i]) < *along.iter().min().unwrap() || a[i].min(b[i]) > *along.iter().max().unwrap()
    };
    if apart(0) || apart(1) {
        return false;
    }
    let sides = [0, 1, 2].map(|k| (triangle[k], triangle[(k + 1) % 3]));
    let turns = sides.map(|(from, to)| turn(from, to, a));
    let within = turns.iter().all(|&t| t >= 0) || turns.iter().all(|&t| t <= 0);
    within || sides.iter().any(|&(from, to)| segments_meet(a, b, from, to))
}

impl Outline {
    fn new(domain: &Domain, lattice: &Lattice) -> Self {
        let step = lattice.step();
        let nearest = |p: DVec2| {
            let nearest = lattice.nearest(p);
            let off = (p - lattice.bounds().min) / step - nearest.as_dvec2();
            assert!(off.abs().max_element() < 0.500001, "{p} is not moved farther than half a step");
            [i64::from(nearest.x), i64::from(nearest.y)]
        };
        let extent = [i64::from(lattice.extent().x), i64::from(lattice.extent().y)];
        Self { edges: domain.region().unwrap().edges().map(|ends| ends.map(nearest)).collect(), extent }
    }

    fn on_frame(&self, [a, b]: [Point; 2]) -> bool {
        [0, 1].iter().any(|&i| a[i] == b[i] && (a[i] == 0 || a[i] == self.extent[i]))
    }

    /// Returns whether an edge that is not part of the frame has a point in common with the closed triangle.
    fn cuts(&self, triangle: &Triangle) -> bool {
        self.edges.iter().any(|&edge| edge[0] != edge[1] && !self.on_frame(edge) && touches(edge, triangle))
    }

    fn misses(&self, triangle: &Triangle) -> bool {
        !self.edges.iter().any(|&edge| edge[0] != edge[1] && touches(edge, triangle))
            && self.has_centroid(triangle) == Some(false)
    }

    /// Returns whether the centroid lies inside; `None` on an edge. By the edges above it, in thirds of a
    /// step.
    fn has_centroid(&self, triangle: &Triangle) -> Option<bool> {
        let p = [0, 1].map(|i| triangle.iter().map(|corner| corner[i]).sum());
        let mut inside = false;
        for [a, b] in self.edges.iter().map(|edge| edge.map(|[x, y]| [3 * x, 3 * y])) {
            if on_segment(a, b, p) {
                return None;
            }
            let (left, right) = if a[0] < b[0] { (a, b) } else { (b, a) };
            inside ^= left[0] <= p[0] && p[0] < right[0] && turn(left, right, p) < 0;
        }
        Some(inside)
    }
}

/// Returns all triangles of the plain closure, those outside among them.
fn plain_closure(case: &Case, outline: &Outline, lattice: &Lattice) -> Vec<Triangle> {
    let cells = lattice.cells().map(i64::from);
    let cell = i64::from(lattice.cell_steps());
    let bounds = case.domain.bounds;
    let step = bounds.size() / dvec2(cells[0] as f64, cells[1] as f64) / cell as f64;
    let side = (step * cell as f64).max_element();
    let world = |[x, y]: Point| {
        let along = |k: i64, extent: i64, min: f64, max: f64, step: f64| {
            if k == extent { max } else { min + k as f64 * step }
        };
        dvec2(
            along(x, cells[0] * cell, bounds.min.x, bounds.max.x, step.x),
            along(y, cells[1] * cell, bounds.min.y, bounds.max.y, step.y),
        )
    };
    // The closure asks again in every round.
    let known = RefCell::new(HashMap::new());
    let exceeds = |t: &Triangle| {
        let level = closure::level(cell, t) as i32;
        let diameter = side * 2f64.powi(-(level / 2)) * if level % 2 == 0 { SQRT_2 } else { 1.0 };
        let by_boundary = || diameter > case.diameter && outline.cuts(t);
        let by_field = || case.exceeds(diameter, t.map(world)) && !outline.misses(t);
        *known.borrow_mut().entry(*t).or_insert_with(|| by_boundary() || by_field())
    };
    closure::refine(closure::coarse(cells[0], cells[1], cell, |_, _| true), exceeds)
}

fn point([x, y]: [u32; 2]) -> Point {
    [i64::from(x), i64::from(y)]
}

fn corners_of(mesh: &Mesh) -> Vec<Triangle> {
    mesh.raw_triangles().iter().map(|t| t.vertices.map(|v| mesh.node(v)).map(|p| point([p.x, p.y]))).collect()
}

#[test]
fn every_fitted_mesh_is_the_one_that_brute_force_finds() {
    let (mut kept, mut left_out, mut on_edge, mut cut) = (0, 0, 0, 0);
    for seed in 0..150 {
        let case = Case::random(seed);
        let mesh = case.mesh();
        let outline = Outline::new(&case.domain, mesh.lattice());
        let expected = closure::set_of(plain_closure(&case, &outline, mesh.lattice()));
        let found = corners_of(&mesh);
        assert!(closure::set_of(found.iter().copied()) == expected, "seed {seed}");
        for (triangle, corners) in mesh.raw_triangles().iter().zip(&found) {
            let inside = outline.has_centroid(corners);
            assert!(inside.is_none_or(|inside| inside != triangle.is_outside()), "seed {seed}: {corners:?}");
            on_edge += usize::from(inside.is_none());
            cut += usize::from(outline.cuts(corners));
        }
        kept += mesh.triangle_count();
        left_out += mesh.outside_count();
    }
    // The generator does its work.
    assert!(kept > 50_000 && left_out > 30_000 && cut > 20_000, "{kept} {left_out} {cut}");
    assert!(on_edge < 2000, "{on_edge} centroids on an edge are not judged");
}

/// Returns an edge as a pair of nodes in ascending order.
fn undirected((a, b): (NodeId, NodeId)) -> [NodeId; 2] {
    [a.min(b), a.max(b)]
}

#[test]
fn default_accessors_show_the_domain_only() {
    let mut left_out = 0;
    for seed in 700..740 {
        let mesh = Case::random(seed).mesh();
        let kept: Vec<usize> =
            (0..mesh.raw_triangle_count()).filter(|&n| !mesh.raw_triangles()[n].is_outside()).collect();
        left_out += mesh.raw_triangle_count() - kept.len();
        assert!(mesh.triangles().map(|(id, _)| id.index()).eq(kept.iter().copied()), "seed {seed}");
        assert_eq!(mesh.triangle_count(), kept.len(), "seed {seed}");
        assert_eq!(mesh.level_counts().iter().sum::<usize>(), kept.len(), "seed {seed}");

        let (mut owners, mut around) = (HashMap::<[NodeId; 2], Vec<TriangleId>>::new(), HashMap::new());
        for id in kept.into_iter().map(TriangleId::from_index) {
            for edge in mesh.triangle(id).edge_nodes() {
                owners.entry(undirected(edge)).or_default().push(id);
            }
            for node in mesh.triangle(id).vertices {
                around.entry(node).or_insert_with(HashSet::new).insert(id);
            }
        }
        let edges: Vec<_> = mesh.edges().map(undirected).collect();
        assert_eq!(edges.len(), owners.len(), "seed {seed}: every edge once");
        assert!(edges.iter().all(|edge| owners.contains_key(edge)), "seed {seed}");
        assert_eq!(mesh.nodes().count(), around.len(), "seed {seed}");
        assert!(
            mesh.nodes().all(|(id, place)| around.contains_key(&id) && mesh.node(id) == place),
            "seed {seed}"
        );

        let rows = mesh.adjacency();
        assert_eq!(rows.edge_count(), owners.len(), "seed {seed}");
        for node in (0..mesh.raw_nodes().len()).map(NodeId::from_index) {
            let joined = |&other: &NodeId| owners.contains_key(&undirected((node, other)));
            assert!(rows.of(node).iter().all(joined), "seed {seed}: {node:?}");
            let found: HashSet<_> = mesh.triangles_around(node).collect();
            assert_eq!(found, around.remove(&node).unwrap_or_default(), "seed {seed}: {node:?}");
        }
        for (id, triangle) in mesh.triangles() {
            let edges = triangle.edge_nodes().map(|edge| &owners[&undirected(edge)]);
            let expected = edges.map(|both| both.iter().copied().find(|&other| other != id));
            assert_eq!(mesh.neighbours(id).map(|across| across.triangle()), expected, "seed {seed}: {id:?}");
        }
    }
    assert!(left_out > 10_000, "{left_out}");
}

/// Returns the coordinates in 2⁻⁶⁰ of a lattice step, where that is exact.
fn fine(p: DVec2) -> Option<[i128; 2]> {
    let scaled = p * 2f64.powi(60);
    (scaled == scaled.floor() && scaled.abs().max_element() < 1e28)
        .then_some([scaled.x as i128, scaled.y as i128])
}

/// Which edges of a triangle the point lies on; `None` where it lies outside.
fn edges_under(corners: &[Point; 3], p: [i128; 2]) -> Option<Vec<usize>> {
    let mut on = Vec::new();
    for j in 0..3 {
        let ([ax, ay], [bx, by]) = (corners[j].map(i128::from), corners[(j + 1) % 3].map(i128::from));
        let side = (bx - ax) * (p[1] - (ay << 60)) - (by - ay) * (p[0] - (ax << 60));
        if side < 0 {
            return None;
        }
        on.extend((side == 0).then_some(j));
    }
    Some(on)
}

/// Returns points on nodes, edges, and a hair beside them, in triangles kept and left out, and beyond the
/// rim.
fn queries(mesh: &Mesh, random: &mut Rng) -> Vec<DVec2> {
    let lattice = mesh.lattice();
    let mut queries = vec![dvec2(f64::NAN, 0.0), lattice.bounds().min, lattice.bounds().max];
    for _ in 0..400 {
        let triangle = &mesh.raw_triangles()[random.usize(..mesh.raw_triangle_count())];
        let [a, b, c] = triangle.vertices.map(|v| mesh.world(v));
        let inner = a.lerp(b, random.f64()).lerp(c, random.f64());
        for p in [a, a.midpoint(b), b.midpoint(c), (a + b + c) / 3.0, inner] {
            let x = [p.x.next_down(), p.x, p.x.next_up()][random.usize(..3)];
            queries.extend([p, dvec2(x, p.y)]);
        }
        let beyond = lattice.bounds().size() * (3.0 * place(random) - DVec2::ONE);
        queries.push(lattice.bounds().min + beyond);
    }
    queries
}

#[test]
fn points_are_found_among_the_triangles_that_files_have() {
    let mut counts = [0; 5];
    for seed in 500..540 {
        let mesh = Case::random(seed).mesh();
        let extract = mesh.extract();
        let corners: Vec<[Point; 3]> = extract
            .triangles()
            .iter()
            .map(|t| t.edge_nodes().map(|(from, _)| extract.node(from)).map(|p| point([p.x, p.y])))
            .collect();
        let locator = Locator::new(&mesh);
        for query in queries(&mesh, &mut Rng::with_seed(seed)) {
            let found = mesh.locate(query);
            assert_eq!(locator.locate(query), found, "seed {seed}: {query}");
            let p = mesh.lattice().lattice_from_world(query);
            let Some(fine) = fine(p) else {
                assert!(!query.is_nan() || found == Location::Invalid);
                continue;
            };
            let first = corners.iter().zip(0..).find_map(|(c, n)| Some((n, edges_under(c, fine)?)));
            let place = found.triangle().map(|id| extract.place_of(id).expect("it is in the domain").index());
            assert_eq!(place, first.as_ref().map(|(n, _)| *n), "seed {seed}: {query}");
            let kind = match (found, first) {
                (Location::Inside { .. }, Some((_, on))) if on.is_empty() => 0,
                (Location::OnEdge { edge, .. }, Some((_, on))) if on == [edge] => 1,
                (Location::OnVertex { node, .. }, Some((_, on))) if on.len() == 2 => {
                    assert_eq!(mesh.node(node).as_dvec2(), p);
                    2
                }
                (Location::OutsideDomain, None) if mesh.lattice().bounds().contains(query) => 3,
                (Location::OutsideBounds, None) if !mesh.lattice().bounds().contains(query) => 4,
                other => panic!("seed {seed}: {query}: {other:?}"),
            };
            counts[kind] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 2000), "{counts:?}");
}

/// Sets of triangles that shared edges join, by filling from one to the next; the edges are given twice where
/// two share them.
fn pieces(triangles: &[[LatticePoint; 3]]) -> Vec<Vec<usize>> {
    let key = |t: &[LatticePoint; 3], j: usize| {
        let (a, b) = (t[j], t[(j + 1) % 3]);
        [a.min(b), a.max(b)]
    };
    let mut owners: HashMap<_, Vec<usize>> = HashMap::new();
    for (n, t) in triangles.iter().enumerate() {
        (0..3).for_each(|j| owners.entry(key(t, j)).or_default().push(n));
    }
    let mut reached = vec![false; triangles.len()];
    let mut pieces = Vec::new();
    for start in 0..triangles.len() {
        let (mut piece, mut open) = (Vec::new(), vec![start]);
        while let Some(n) = open.pop() {
            if !std::mem::replace(&mut reached[n], true) {
                piece.push(n);
                open.extend((0..3).flat_map(|j| &owners[&key(&triangles[n], j)]));
            }
        }
        if !piece.is_empty() {
            pieces.push(piece);
        }
    }
    pieces
}

/// Returns the parts of the mesh; and holes, as pieces of what is left out that reach no side of the
/// rectangle.
fn parts_and_holes(mesh: &Mesh) -> (usize, usize) {
    let of_class = |outside: bool| -> Vec<[LatticePoint; 3]> {
        let class = mesh.raw_triangles().iter().filter(|t| t.is_outside() == outside);
        class.map(|t| t.vertices.map(|v| mesh.node(v))).collect()
    };
    let extent = mesh.lattice().extent();
    let on_rim = |t: &[LatticePoint; 3]| {
        (0..3).any(|j| {
            let (a, b) = (t[j], t[(j + 1) % 3]);
            (a.x == b.x && (a.x == 0 || a.x == extent.x)) || (a.y == b.y && (a.y == 0 || a.y == extent.y))
        })
    };
    let outside = of_class(true);
    let closed = |piece: &&Vec<usize>| !piece.iter().any(|&n| on_rim(&outside[n]));
    (pieces(&of_class(false)).len(), pieces(&outside).iter().filter(closed).count())
}

#[test]
fn files_get_a_mesh_without_gaps_orphans_or_one_sided_neighbours() {
    let (mut most_parts, mut most_holes) = (0, 0);
    for seed in 0..150 {
        let mesh = Case::random(seed).mesh();
        let extract = mesh.extract();
        assert_eq!(extract.triangles().len(), mesh.triangle_count(), "seed {seed}");
        let used: HashSet<usize> = extract.cells().flat_map(|cell| cell.corners).collect();
        assert_eq!(used.len(), extract.nodes().len(), "seed {seed}: every node is used");
        assert_eq!(extract.nodes().iter().collect::<HashSet<_>>().len(), used.len(), "seed {seed}");
        assert!(used.iter().all(|&node| node < used.len()), "seed {seed}");
        let mut owner = HashMap::new();
        let mut area = 0.0;
        let nodes: Vec<DVec2> = extract.world_nodes().collect();
        for (n, cell) in extract.cells().enumerate() {
            let [a, b, c] = cell.corners;
            area += 0.5 * (nodes[b] - nodes[a]).perp_dot(nodes[c] - nodes[a]);
            for edge in [[a, b], [b, c], [c, a]] {
                assert_eq!(owner.insert(edge, n), None, "seed {seed}");
            }
        }
        for cell in extract.cells() {
            let [a, b, c] = cell.corners;
            let across = [[c, b], [a, c], [b, a]].map(|edge| owner.get(&edge).copied());
            assert_eq!(cell.opposite, across, "seed {seed}");
        }
        assert!((area / mesh.area() - 1.0).abs() < 1e-9, "seed {seed}: {area} and {}", mesh.area());
        let Topology { nodes, parts, holes } = mesh.extract().topology();
        assert_eq!((nodes, (parts, holes)), (used.len(), parts_and_holes(&mesh)), "seed {seed}");
        most_parts = most_parts.max(parts);
        most_holes = most_holes.max(holes);
    }
    assert!(most_parts > 3 && most_holes > 3, "{most_parts} parts, {most_holes} holes");
}

#[test]
fn the_aegean_sea_keeps_its_islands() {
    let polygons = geojson::read(Path::new("../../assets/aegean_sea.geojson")).unwrap();
    let domain = Domain::of_polygons(&polygons).unwrap();
    let region = domain.region().unwrap();
    assert_eq!(region.hole_count(), 65);
    let mesh = fitted(&domain, 0.5, 0.02, "100");
    let centroid =
        |t: &meshbrush_mesh::mesh::Triangle| t.vertices.map(|v| mesh.world(v)).iter().sum::<DVec2>() / 3.0;
    let left_out: Vec<DVec2> = mesh.raw_triangles().iter().filter(|t| t.is_outside()).map(centroid).collect();
    let encloses = |ring: &Ring, p: DVec2| {
        let ends = ring.iter().zip(ring.iter().skip(1).chain(ring.first()));
        let above = |a: DVec2, b: DVec2| {
            (a.x <= p.x) != (b.x <= p.x) && ((b - a).perp_dot(p - a) < 0.0) == (a.x < b.x)
        };
        ends.filter(|&(&a, &b)| above(a, b)).count() % 2 == 1
    };
    let islands = region.polygons().iter().flat_map(|rings| &rings[1..]);
    let lost: Vec<f64> = islands
        .filter(|ring| !left_out.iter().any(|&p| encloses(ring, p)))
        .map(|ring| signed_area(ring).abs())
        .collect();
    // The one that falls between the centroids is smaller than the triangles there.
    let deepest = mesh.level_counts().len() as u32 - 1;
    assert!(lost.len() == 1 && lost[0] < 0.25 * mesh.diameter(deepest).powi(2), "{lost:?}");
    assert_eq!((mesh.extract().topology().parts, mesh.extract().topology().holes), parts_and_holes(&mesh));
    assert!((mesh.area() / region.area() - 1.0).abs() < 0.002);
}

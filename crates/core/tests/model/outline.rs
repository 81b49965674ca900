//! Meshes with the nodes of their boundary on the outline, against a referee that knows only nodes,
//! triangles and polygons.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::path::Path;

use crate::formula_mesh::formula_mesh;
use crate::random_coast::{place, random_coast};
use crate::runs::runs;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::build::BuiltMesh;
use meshbrush_core::domain::{BoundaryTreatment, Domain, Ring};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_io::io::geojson;
use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect};
use meshbrush_mesh::mesh::{
    Changes, Cleaning, Extract, Limits, Location, Mesh, NodeId, PatchPieces, PatchedLocator, Progress,
    TriangleId, Updater,
};

fn built(domain: &Domain, spacing: f64, diameter: f64, target: &str) -> BuiltMesh {
    formula_mesh(domain, spacing, BoundaryTreatment::OnOutline { diameter }, target)
}

fn derived(mesh: &Mesh, built: &BuiltMesh) -> DerivedMesh {
    DerivedMesh::new(mesh, &built.domain, None, &Cleaning::NONE)
}

/// The measurements of the referee.
#[derive(Clone, Copy, Debug, Default)]
struct Figures {
    triangles: usize,
    boundary_nodes: usize,
    on_outline: usize,
    /// Largest distance of a boundary node from the polygons, in boundary diameters.
    farthest: f64,
    /// In degrees.
    smallest_angle: f64,
    largest_angle: f64,
    area: f64,
}

/// Checks that the triangles cover a domain whose boundary is a set of closed lines that do not touch, and
/// measures angles and distances.
fn judge(extract: &Extract, domain: &Domain, diameter: f64, name: &str) -> Figures {
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    let cells: Vec<[usize; 3]> = extract.cells().map(|cell| cell.corners).collect();
    let mut figures = Figures { triangles: cells.len(), smallest_angle: 180.0, ..Figures::default() };
    let mut owner = HashMap::new();
    for (n, &[a, b, c]) in cells.iter().enumerate() {
        let doubled = (nodes[b] - nodes[a]).perp_dot(nodes[c] - nodes[a]);
        assert!(doubled > 0.0, "{name}: triangle {n} has the area {doubled}");
        figures.area += 0.5 * doubled;
        for (at, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert_eq!(owner.insert([at, from], n), None, "{name}: two triangles on one side of an edge");
            let angle = (nodes[from] - nodes[at]).angle_to(nodes[to] - nodes[at]).to_degrees();
            figures.smallest_angle = figures.smallest_angle.min(angle);
            figures.largest_angle = figures.largest_angle.max(angle);
        }
    }
    for cell in extract.cells() {
        let [a, b, c] = cell.corners;
        let across = [[c, b], [a, c], [b, a]].map(|edge| owner.get(&edge).copied());
        assert_eq!(cell.opposite, across, "{name}: neighbours");
    }
    let used: HashSet<usize> = cells.iter().flatten().copied().collect();
    assert_eq!(used.len(), nodes.len(), "{name}: every node is used");

    let boundary: Vec<[usize; 2]> =
        owner.keys().filter(|&&[a, b]| !owner.contains_key(&[b, a])).copied().collect();
    let mut ends: HashMap<usize, [usize; 2]> = HashMap::new();
    for &[a, b] in &boundary {
        ends.entry(a).or_default()[0] += 1;
        ends.entry(b).or_default()[1] += 1;
    }
    assert!(ends.values().all(|&count| count == [1, 1]), "{name}: the domain touches itself in a node");
    no_edges_meet(&boundary, &nodes, name);

    let outline = Finder::new(domain.region().unwrap().edges().collect(), diameter);
    let precision = 2.0 * extract.lattice().step().max_element();
    figures.boundary_nodes = ends.len();
    for &node in ends.keys() {
        let distance = outline.distance(nodes[node], diameter);
        figures.on_outline += usize::from(distance <= precision);
        figures.farthest = figures.farthest.max(distance / diameter);
    }
    figures
}

/// Segments in the squares of a grid that they touch.
struct Finder {
    segments: Vec<[DVec2; 2]>,
    side: f64,
    squares: HashMap<[i64; 2], Vec<usize>>,
}

impl Finder {
    fn new(segments: Vec<[DVec2; 2]>, side: f64) -> Self {
        let mut squares: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
        for (n, [a, b]) in segments.iter().enumerate() {
            let pieces = ((b.distance(*a) / side).ceil() as usize).max(1);
            let mut places = HashSet::new();
            for k in 0..=2 * pieces {
                let p = (a.lerp(*b, k as f64 / (2 * pieces) as f64) / side).floor();
                for dx in -1..=1 {
                    for dy in -1..=1 {
                        places.insert([p.x as i64 + dx, p.y as i64 + dy]);
                    }
                }
            }
            places.into_iter().for_each(|place| squares.entry(place).or_default().push(n));
        }
        Self { segments, side, squares }
    }

    fn near(&self, p: DVec2) -> &[usize] {
        let square = (p / self.side).floor();
        self.squares.get(&[square.x as i64, square.y as i64]).map_or(&[], Vec::as_slice)
    }

    /// Returns the distance of a point from the nearest segment, or twice `reach` if there is none within
    /// `reach`.
    fn distance(&self, p: DVec2, reach: f64) -> f64 {
        let distance = |&n: &usize| {
            let [a, b] = self.segments[n];
            let along = (p - a).dot(b - a) / (b - a).length_squared();
            p.distance(a + along.clamp(0.0, 1.0) * (b - a))
        };
        self.near(p).iter().map(distance).filter(|&d| d <= reach).fold(2.0 * reach, f64::min)
    }
}

/// Checks that no two edges without a common node meet.
fn no_edges_meet(edges: &[[usize; 2]], nodes: &[DVec2], name: &str) {
    let segments: Vec<[DVec2; 2]> = edges.iter().map(|edge| edge.map(|v| nodes[v])).collect();
    let longest = segments.iter().map(|[a, b]| a.distance(*b)).fold(0.0, f64::max);
    let finder = Finder::new(segments.clone(), longest);
    let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    for (n, &[a, b]) in segments.iter().enumerate() {
        for &m in finder.near(a) {
            let [c, d] = segments[m];
            if m <= n || edges[n].iter().any(|v| edges[m].contains(v)) {
                continue;
            }
            let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
            let meet = turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0 && !apart;
            assert!(!meet, "{name}: the boundary crosses itself near {a}");
        }
    }
}

/// Returns the smallest angle that may occur, in degrees: arctan of a third of the ratio of a cell's sides,
/// or 18.4°; and beside sharp corners 12°, or 0.8 times the angle of the corner.
fn bound(domain: &Domain, lattice: &Lattice, corners: usize) -> f64 {
    let step = lattice.step();
    let ratio = step.min_element() / step.max_element();
    let bound = (ratio / 3.0).atan().to_degrees().min(18.4);
    if corners == 0 {
        return bound;
    }
    let rings = domain.region().unwrap().rings();
    let angles = rings.flat_map(|ring| {
        (0..ring.len()).map(|k| {
            let [before, at, after] = [ring.len() - 1, 0, 1].map(|n| ring[(k + n) % ring.len()]);
            let angle = (after - at).angle_to(before - at).to_degrees();
            if angle < 0.0 { angle + 360.0 } else { angle }
        })
    });
    bound.min(12.0).min(0.8 * angles.fold(360.0, f64::min))
}

/// Returns the triangles by their corners, in an order of their own.
pub fn shape(extract: &Extract) -> Vec<[[u32; 2]; 3]> {
    let corners = |cell: meshbrush_mesh::mesh::Cell| {
        let corners = cell.corners.map(|node| extract.nodes()[node]).map(|p| [p.x, p.y]);
        let lowest = (0..3).min_by_key(|&i| corners[i]).unwrap();
        [0, 1, 2].map(|i| corners[(lowest + i) % 3])
    };
    let mut shape: Vec<_> = extract.cells().map(corners).collect();
    shape.sort_unstable();
    shape
}

fn disc(corners: u32) -> Domain {
    let ring = (0..corners).map(|k| DVec2::from_angle(TAU * f64::from(k) / f64::from(corners))).collect();
    Domain::of_polygons(&[vec![ring]]).unwrap()
}

/// Returns a case of the random coasts: the domain, its mesh and the boundary diameter.
fn case(seed: u64) -> (Domain, BuiltMesh, f64) {
    let mut random = Rng::with_seed(seed);
    let domain = Domain::of_polygons(&random_coast(&mut random)).unwrap();
    let spacing = domain.bounds.size().max_element() / (2.0 + 6.0 * random.f64());
    let diameter = spacing * 0.04 * 12f64.powf(random.f64());
    let target = format!("{}", spacing * (0.1 + random.f64()));
    let built = built(&domain, spacing, diameter, &target);
    (domain, built, diameter)
}

#[test]
fn random_coasts_are_valid_domains() {
    // The environment can ask for more.
    let count = runs(150);
    let (mut all, mut on, mut pinned) = (0, 0, 0);
    let (mut smallest, mut largest, mut farthest) = (180.0f64, 0.0f64, 0.0f64);
    for seed in 0..count {
        let (domain, built, diameter) = case(seed);
        let outline = derived(&built.mesh, &built);
        let extract = outline.extract(&built.mesh);
        let figures = judge(&extract, &domain, diameter, &format!("seed {seed}"));
        assert_eq!(outline.violations(&extract), [], "seed {seed}");
        let bound = bound(&domain, extract.lattice(), outline.fit().unwrap().corners) - 1e-6;
        assert!(figures.smallest_angle >= bound, "seed {seed}: {figures:?}");
        assert!(figures.largest_angle <= 180.0 - 2.0 * bound, "seed {seed}: {figures:?}");
        assert!(figures.farthest <= 1.0, "seed {seed}: {figures:?}");
        let triangles: usize = extract.level_counts().iter().sum();
        assert_eq!((triangles, extract.topology().nodes), (figures.triangles, extract.nodes().len()));
        assert!((extract.area() / figures.area - 1.0).abs() < 1e-6, "seed {seed}");
        all += figures.boundary_nodes;
        on += figures.on_outline;
        pinned += outline.fit().unwrap().corners;
        smallest = smallest.min(figures.smallest_angle);
        largest = largest.max(figures.largest_angle);
        farthest = farthest.max(figures.farthest);
    }
    let share = on as f64 / all as f64;
    eprintln!(
        "{count} coasts: {smallest:.2}° to {largest:.2}°, {:.2} % of {all} nodes on the outline, the others at most \
         {farthest:.3} diameters off, {pinned} corners",
        100.0 * share
    );
    assert!(share > 0.97 && pinned > 0, "{share} {pinned}");
}

/// Returns the parts that edges join, each with its triangles.
fn parts(extract: &Extract) -> Vec<Vec<[[u32; 2]; 3]>> {
    let all = shape(extract);
    let mut by_edge: HashMap<[[u32; 2]; 2], usize> = HashMap::new();
    let edges = |&[a, b, c]: &[[u32; 2]; 3]| [[a, b], [b, c], [c, a]];
    for (n, triangle) in all.iter().enumerate() {
        by_edge.extend(edges(triangle).map(|edge| (edge, n)));
    }
    let (mut seen, mut parts) = (vec![false; all.len()], Vec::new());
    for start in 0..all.len() {
        let (mut part, mut waiting) = (Vec::new(), vec![start]);
        while let Some(n) = waiting.pop() {
            if !std::mem::replace(&mut seen[n], true) {
                part.push(all[n]);
                waiting.extend(edges(&all[n]).iter().filter_map(|&[a, b]| by_edge.get(&[b, a])));
            }
        }
        if !part.is_empty() {
            parts.push(part);
        }
    }
    parts
}

#[test]
fn the_largest_part_stays_as_it_is_and_the_others_go() {
    let mut several = 0;
    for seed in 0..60 {
        let (_, built, _) = case(seed);
        let before = parts(&derived(&built.mesh, &built).extract(&built.mesh));
        let doubled = |triangle: &[[u32; 2]; 3]| {
            let [a, b, c] = triangle.map(|p| p.map(i128::from));
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let area = |part: &[[[u32; 2]; 3]]| part.iter().map(doubled).sum::<i128>();
        let outline = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::FOR_SOLVERS);
        let removed = outline.removed();
        let extract = outline.extract(&built.mesh);
        let after = parts(&extract);
        assert_eq!((after.len(), removed.parts.len()), (1, before.len() - 1), "seed {seed}");
        assert!(before.contains(&after[0]), "seed {seed}");
        assert!(before.iter().all(|part| area(part) <= area(&after[0])), "seed {seed}");
        assert_eq!(removed.triangles, before.iter().map(Vec::len).sum::<usize>() - after[0].len());
        assert_eq!(outline.violations(&extract), [], "seed {seed}");
        several += usize::from(before.len() > 1);
    }
    assert!(several > 10, "{several} of 60 had several parts");
}

#[test]
fn all_nodes_of_a_smooth_boundary_are_on_the_outline() {
    for (corners, diameter) in [(400, 0.1), (2000, 0.03), (1000, 0.2), (5000, 0.013)] {
        let domain = disc(corners);
        let built = built(&domain, 0.5, diameter, "10");
        let outline = derived(&built.mesh, &built);
        let extract = outline.extract(&built.mesh);
        let figures = judge(&extract, &domain, diameter, "disc");
        assert_eq!(figures.on_outline, figures.boundary_nodes, "{diameter}");
        assert_eq!(outline.fit().unwrap().on_outline, outline.fit().unwrap().nodes, "{diameter}");
        assert!(figures.smallest_angle > 29.0, "{diameter}: {figures:?}");
        let polygon = domain.region().unwrap().area();
        assert!((figures.area / polygon - 1.0).abs() < diameter * diameter, "{diameter}: {figures:?}");
        // Every corner of the polygon has the boundary of the mesh near it.
        let nodes: Vec<DVec2> = extract.world_nodes().collect();
        let edges = extract.boundary_edges().map(|edge| edge.ends.map(|v| nodes[v])).collect();
        let boundary = Finder::new(edges, diameter);
        for p in domain.region().unwrap().rings().flatten() {
            assert!(boundary.distance(*p, diameter) < diameter * diameter, "{diameter}: {p}");
        }
    }
}

#[test]
fn sharp_corners_are_nodes() {
    // An L whose inner side is curved, turned a little; and islands that keep the frame away from it.
    let arc = (1..40).map(|k| TAU * f64::from(k) / 160.0).map(|a| dvec2(2.0 - a.sin(), 2.0 - a.cos()));
    let mut ring = vec![dvec2(0.0, 0.0), dvec2(2.0, 0.0), dvec2(2.0, 1.0)];
    ring.extend(arc);
    ring.extend([dvec2(1.0, 2.0), dvec2(0.0, 2.0)]);
    let turned: Ring = ring.iter().map(|p| DVec2::from_angle(0.2).rotate(*p)).collect();
    let island = |at: f64| vec![vec![dvec2(at, at), dvec2(at + 0.5, at), dvec2(at + 0.2, at + 0.5)]];
    let (mut kept, mut all) = (0, 0);
    for diameter in [0.2, 0.1, 0.07, 0.05, 0.03] {
        let domain = Domain::of_polygons(&[vec![turned.clone()], island(-1.0), island(3.0)]).unwrap();
        let built = built(&domain, 0.5, diameter, "10");
        let outline = derived(&built.mesh, &built);
        let extract = outline.extract(&built.mesh);
        let figures = judge(&extract, &domain, diameter, "L");
        assert!(figures.on_outline * 100 > figures.boundary_nodes * 97, "{figures:?}");
        let nodes: Vec<DVec2> = extract.world_nodes().collect();
        for corner in [ring[0], ring[1], ring[2], ring[42], ring[43]] {
            let corner = DVec2::from_angle(0.2).rotate(corner);
            kept += usize::from(nodes.iter().any(|p| p.distance(corner) < 1e-7));
            all += 1;
        }
        assert!(figures.smallest_angle > 18.0, "{figures:?}");
    }
    assert!(kept * 10 >= all * 9, "{kept} of {all} corners are nodes");
}

#[test]
fn the_result_does_not_depend_on_the_order_of_edits() {
    let mut permuted = 0;
    for seed in 1000..1030 {
        let (_, built, _) = case(seed);
        let expected = derived(&built.mesh, &built);
        // There and back: coarse everywhere, then fine again in one place after the other.
        let (mut mesh, mut random) = (built.mesh.clone(), Rng::with_seed(seed));
        let extent = mesh.lattice().extent();
        let all = LatticeRect { min: LatticePoint::new(0, 0), max: extent };
        let mut updater = Updater::new(Limits::default());
        let mut fine: Vec<LatticeRect> = Vec::new();
        for step in 0..6 {
            let mut coordinate = |side: u32| (f64::from(side) * random.f64()) as u32;
            let (a, b) =
                ([coordinate(extent.x), coordinate(extent.y)], [coordinate(extent.x), coordinate(extent.y)]);
            let area = LatticeRect {
                min: LatticePoint::new(a[0].min(b[0]), a[1].min(b[1])),
                max: LatticePoint::new(a[0].max(b[0]), a[1].max(b[1])),
            };
            updater.add(if step == 0 || step == 5 { all } else { area });
            fine.extend((step > 0).then_some(if step == 5 { all } else { area }));
            let criterion = built.criterion(None);
            let exceeds = |corners: [LatticePoint; 3], level: u32| {
                let is_fine = fine.iter().any(|area| area.touches(corners));
                (is_fine || level < 5) && criterion.exceeds_at(corners, level)
            };
            while updater.advance(&mut mesh, &|| exceeds, 1000).unwrap() == Progress::More {}
        }
        mesh.classify(0..mesh.raw_triangle_count(), |element| built.domain.excludes(element));
        assert_eq!(mesh.fingerprint(), built.mesh.fingerprint(), "seed {seed}");
        let found = derived(&mesh, &built);
        assert_eq!(found.fit(), expected.fit(), "seed {seed}");
        assert!(shape(&found.extract(&mesh)) == shape(&expected.extract(&built.mesh)), "seed {seed}");
        permuted += usize::from(mesh.raw_nodes() != built.mesh.raw_nodes());
    }
    assert!(permuted > 20, "{permuted} meshes have their entries in another order");
}

#[test]
fn the_aegean_sea_is_a_valid_domain() {
    let polygons = geojson::read(Path::new("../../assets/aegean_sea.geojson")).unwrap();
    let domain = Domain::of_polygons(&polygons).unwrap();
    let built = built(&domain, 0.5, 0.02, "100");
    let outline = derived(&built.mesh, &built);
    let extract = outline.extract(&built.mesh);
    let figures = judge(&extract, &domain, 0.02, "Aegean Sea");
    eprintln!("{figures:?} {:?} {:?}", outline.fit(), extract.topology());
    assert_eq!(outline.violations(&extract), []);
    assert!(figures.smallest_angle > 12.0 && figures.largest_angle < 143.2, "{figures:?}");
    assert!(figures.on_outline * 100 > figures.boundary_nodes * 97, "{figures:?}");
    assert!((figures.area / domain.region().unwrap().area() - 1.0).abs() < 0.001, "{figures:?}");
}

/// Returns the coordinates in 2⁻⁶⁰ of a lattice step, where that is exact.
fn fine(p: DVec2) -> Option<[i128; 2]> {
    let scaled = p * 2f64.powi(60);
    (scaled == scaled.floor() && scaled.abs().max_element() < 1e28)
        .then_some([scaled.x as i128, scaled.y as i128])
}

/// On how many edges of a triangle a point lies; `None` where it lies outside.
fn edges_under(corners: &[[i128; 2]; 3], p: [i128; 2]) -> Option<usize> {
    let mut count = 0;
    for j in 0..3 {
        let ([ax, ay], [bx, by]) = (corners[j], corners[(j + 1) % 3]);
        let side = (bx - ax) * (p[1] - (ay << 60)) - (by - ay) * (p[0] - (ax << 60));
        if side < 0 {
            return None;
        }
        count += usize::from(side == 0);
    }
    Some(count)
}

#[test]
fn points_are_found_in_the_triangles_that_files_have() {
    let mut counts = [0; 4];
    for seed in 2000..2012 {
        let (_, built, _) = case(seed);
        let outline = derived(&built.mesh, &built);
        let extract = outline.extract(&built.mesh);
        let locator = PatchedLocator::new(&built.mesh, outline.patch(), &extract);
        let nodes: Vec<DVec2> = extract.world_nodes().collect();
        let whole = |n: usize| [i128::from(extract.nodes()[n].x), i128::from(extract.nodes()[n].y)];
        let triangles: Vec<[[i128; 2]; 3]> = extract.cells().map(|cell| cell.corners.map(whole)).collect();
        let mut random = Rng::with_seed(seed);
        let on_boundary: Vec<usize> =
            extract.on_boundary().iter().zip(0..).filter(|(on, _)| **on).map(|(_, n)| n).collect();
        let mut queries = Vec::new();
        for _ in 0..300 {
            let cell = extract.cells().nth(random.usize(..triangles.len())).unwrap();
            let [a, b, c] = cell.corners.map(|n| nodes[n]);
            queries.extend([a, a.midpoint(b), b.midpoint(c), (a + b + c) / 3.0]);
            let near = nodes[on_boundary[random.usize(..on_boundary.len())]];
            queries.extend([near, near + (place(&mut random) - 0.5) * a.distance(b)]);
        }
        for query in queries {
            let found = locator.locate(&extract, query, built.mesh.locate(query));
            let Some(p) = fine(built.mesh.lattice().lattice_from_world(query)) else { continue };
            let first = triangles.iter().zip(0..).find_map(|(t, n)| Some((n, edges_under(t, p)?)));
            assert_eq!(found.triangle().map(|id| id.index()), first.map(|(n, _)| n), "seed {seed}: {query}");
            let kind = match (found, first.map(|(_, edges)| edges)) {
                (Location::Inside { .. }, Some(0)) => 0,
                (Location::OnEdge { .. }, Some(1)) => 1,
                (Location::OnVertex { node, .. }, Some(2)) => {
                    assert!(
                        nodes[node.index()].distance(query) < 1e-9 * query.length(),
                        "seed {seed}: {query}"
                    );
                    2
                }
                (Location::OutsideDomain | Location::OutsideBounds, None) => 3,
                other => panic!("seed {seed}: {query}: {other:?}"),
            };
            counts[kind] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

#[test]
fn pieces_and_the_triangles_that_they_do_not_replace_are_the_mesh() {
    for seed in 3000..3010 {
        let (_, built, _) = case(seed);
        let outline = DerivedMesh::new(&built.mesh, &built.domain, None, &Cleaning::FOR_SOLVERS);
        let extract = outline.extract(&built.mesh);
        let mut pieces = PatchPieces::new(&built.mesh, outline.patch(), &extract);
        let drawn = |pieces: &PatchPieces| {
            let replaced: HashSet<TriangleId> = pieces.replaced().collect();
            let kept = built.mesh.triangles().filter(|(id, _)| !replaced.contains(id));
            let corners = |points: [LatticePoint; 3]| {
                let mut corners = points.map(|p| [p.x, p.y]);
                corners.sort_unstable();
                corners
            };
            let mut all: Vec<_> = kept.map(|(id, _)| corners(built.mesh.corners(id))).collect();
            let shown = pieces.triangles().iter().filter(|piece| !piece.is_outside());
            all.extend(shown.map(|piece| corners(piece.vertices.map(|v| pieces.nodes()[v.index()]))));
            all.sort_unstable();
            all
        };
        let mut expected: Vec<_> = shape(&extract).into_iter().collect();
        expected.iter_mut().for_each(|corners| corners.sort_unstable());
        expected.sort_unstable();
        assert!(drawn(&pieces) == expected, "seed {seed}");
        // Retired everywhere: the mesh as it is, with the moved nodes where the patch has them.
        let all = Changes {
            nodes: Vec::new(),
            triangles: std::iter::once(0..built.mesh.raw_triangle_count()).collect(),
            ..Changes::default()
        };
        assert!(!pieces.retire(&built.mesh, &all).is_empty());
        let moved: HashMap<NodeId, LatticePoint> = outline.patch().moved.iter().copied().collect();
        let shown = |id: TriangleId| {
            let nodes = built.mesh.triangle(id).vertices;
            let mut corners = nodes.map(|node| moved.get(&node).copied().unwrap_or(built.mesh.node(node)));
            corners.sort_unstable_by_key(|p| [p.x, p.y]);
            corners.map(|p| [p.x, p.y])
        };
        let mut whole: Vec<_> = built.mesh.triangles().map(|(id, _)| shown(id)).collect();
        whole.sort_unstable();
        assert!(drawn(&pieces) == whole, "seed {seed}");
    }
}

//! Meshes with the nodes of their boundary on the outline, against a referee that knows only nodes, triangles and
//! polygons.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;
use std::path::Path;

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush::internals::build::{BuiltMesh, FieldSampling, MeshBuilder, MeshSpec};
use meshbrush::internals::domain::{BoundaryTreatment, Domain, Polygon, Ring};
use meshbrush::internals::field::{Formula, RefinementRule, Source, TargetFieldSpec, Transfer};
use meshbrush::internals::geometry::Lattice;
use meshbrush::internals::io::geojson;
use meshbrush::internals::mesh::{Extract, Limits, Progress};
use meshbrush::internals::outline::OutlineMesh;

/// The mesh as the program makes it, for a formula of the target diameter under the vertex rule.
fn built(domain: &Domain, spacing: f64, boundary_diameter: f64, target: &str) -> BuiltMesh {
    let limits = Limits::default();
    let mut builder = MeshBuilder::new(MeshSpec {
        lattice: Lattice::covering(domain.bounds, spacing, limits.max_triangles).unwrap(),
        domain: domain.clone(),
        boundary: BoundaryTreatment::OnOutline { diameter: boundary_diameter },
        field: TargetFieldSpec {
            sources: vec![Source::TargetFormula(Formula::parse(target).unwrap())],
            transfer: Transfer { h_min: f64::MIN_POSITIVE, h_max: f64::MAX, shape: 1.0 },
            unasked: f64::MAX,
            size: [2; 2],
        },
        rule: RefinementRule::Vertex,
        sampling: FieldSampling::AsNeeded,
        limits,
    });
    while builder.advance(None, 1000).unwrap() == Progress::More {}
    builder.finish()
}

/// What the referee measures.
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

    /// The distance of a point from the nearest segment, or twice `reach` if there is none within `reach`.
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

fn place(random: &mut Rng) -> DVec2 {
    dvec2(random.f64(), random.f64())
}

/// A closed line with bays and capes of all sizes.
fn coast(random: &mut Rng, centre: DVec2, radius: f64, corners: usize, roughness: f64) -> Ring {
    let waves: Vec<(f64, f64)> = (0..9).map(|_| (random.f64() - 0.5, random.f64() * TAU)).collect();
    (0..corners)
        .map(|k| {
            let angle = TAU * k as f64 / corners as f64;
            let wave = |(n, &(size, phase)): (usize, &(f64, f64))| {
                let frequency = (1 << n) as f64;
                size / frequency.powf(0.8) * (frequency * angle + phase).sin()
            };
            let waves: f64 = waves.iter().enumerate().map(wave).sum();
            let noise = 0.02 * (random.f64() - 0.5);
            centre + radius * (1.0 + roughness * (waves + noise)).max(0.1) * DVec2::from_angle(angle)
        })
        .collect()
}

/// A triangle with its tip at `from` when it is a needle, or a bar between two points.
fn spit(random: &mut Rng, from: DVec2, to: DVec2) -> Ring {
    let width = 0.06 * 0.02f64.powf(random.f64());
    let across = width * (to - from).normalize().perp();
    if random.bool() { vec![from, to - across, to + across] } else { vec![from - across, to - across, to + across, from + across] }
}

/// Land with bays, spits, inlets, islands, rings that touch and needles; and the sea around it or the land.
fn random_coast(random: &mut Rng) -> Vec<Polygon> {
    let middle = DVec2::splat(0.5);
    let corners = random.usize(8..400);
    let roughness = random.f64();
    let mut polygons = vec![vec![coast(random, middle, 0.45, corners, roughness)]];
    for _ in 0..random.usize(0..6) {
        let (centre, radius) = (place(random), 0.2 * 0.02f64.powf(random.f64()));
        let corners = random.usize(3..40);
        let ring = coast(random, centre, radius, corners, 0.5);
        if random.bool() { polygons[0].push(ring) } else { polygons.push(vec![ring]) }
    }
    for _ in 0..random.usize(0..4) {
        let (from, to) = (place(random), middle + 0.3 * (place(random) - 0.5));
        let ring = spit(random, from, to);
        // Overlaps are inlets in a polygon of several rings, and spits in one of its own.
        if random.bool() { polygons[0].push(ring) } else { polygons.push(vec![ring]) }
    }
    if random.bool() {
        let at = polygons[0][0][random.usize(..8)];
        polygons[0].push(vec![at, at.lerp(middle, 0.3), at.lerp(middle, 0.3) + 0.1 * place(random)]);
    }
    let scale = dvec2(1.0 + random.f64(), 1.0 + random.f64()) * 10f64.powi(random.i32(-2..4));
    let shift = scale * 100.0 * (place(random) - 0.5) * f64::from(random.u8(0..2));
    for p in polygons.iter_mut().flatten().flatten() {
        *p = *p * scale + shift;
    }
    polygons
}

#[test]
fn random_coasts_are_valid_domains() {
    let count = std::env::var("OUTLINE_COASTS").map_or(120, |count| count.parse().unwrap());
    let (mut all, mut off, mut smallest, mut largest, mut farthest) = (0, 0, 180.0f64, 0.0f64, 0.0f64);
    for seed in 0..count {
        let mut random = Rng::with_seed(seed);
        let domain = Domain::of_polygons(&random_coast(&mut random)).unwrap();
        let spacing = domain.bounds.size().max_element() / (2.0 + 6.0 * random.f64());
        let diameter = spacing * 0.04 * 12f64.powf(random.f64());
        let built = built(&domain, spacing, diameter, &format!("{}", spacing * (0.1 + random.f64())));
        let outline = OutlineMesh::new(&built.mesh, &built.domain).unwrap();
        let figures = judge(&outline.extract(&built.mesh), &domain, diameter, &format!("seed {seed}"));
        if std::env::var("OUTLINE_PRINT").is_ok() {
            println!("{seed} {figures:?} {:?}", outline.fit());
        }
        if figures.smallest_angle < 18.4 { println!("small {seed} {figures:?} {:?}", outline.fit()); }
        all += figures.boundary_nodes;
        off += figures.boundary_nodes - figures.on_outline;
        smallest = smallest.min(figures.smallest_angle);
        largest = largest.max(figures.largest_angle);
        farthest = farthest.max(figures.farthest);
    }
    println!("{count} coasts: angles {smallest:.2} to {largest:.2}, {off} of {all} nodes off, at most {farthest:.3} h");
}

#[test]
fn smooth_outlines_have_all_nodes_on_them() {
    for (radius, corners, diameter) in [(1.0, 400, 0.1), (1.0, 2000, 0.03), (1.0, 1000, 0.2)] {
        let ring: Ring = (0..corners).map(|k| radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(corners))).collect();
        let domain = Domain::of_polygons(&[vec![ring]]).unwrap();
        let built = built(&domain, 0.5, diameter, "10");
        let outline = OutlineMesh::new(&built.mesh, &built.domain).unwrap();
        let figures = judge(&outline.extract(&built.mesh), &domain, diameter, "disc");
        println!("{figures:?} {:?}", outline.fit());
        let finder = Finder::new(domain.region().unwrap().edges().collect(), diameter); let extract = outline.extract(&built.mesh);
        for (n, on) in extract.on_boundary().into_iter().enumerate() { let p = extract.world_nodes().nth(n).unwrap(); if on && finder.distance(p, diameter) > 1e-8 { println!("off {p}"); } }
    }
}

#[test]
fn the_aegean_sea() {
    let polygons = geojson::read(Path::new("assets/aegean_sea.geojson")).unwrap();
    let domain = Domain::of_polygons(&polygons).unwrap();
    let built = built(&domain, 0.5, 0.02, "100");
    let start = std::time::Instant::now();
    let outline = OutlineMesh::new(&built.mesh, &built.domain).unwrap();
    println!("{:?}", start.elapsed());
    let figures = judge(&outline.extract(&built.mesh), &domain, 0.02, "Aegean Sea");
    println!("{figures:?} {:?} {}", outline.fit(), domain.region().unwrap().area());
}

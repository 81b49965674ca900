//! No edge of a finished mesh is longer than its target, by a checker that reads triangles and knows the
//! target as a formula, and nothing of how the mesh was made.

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_core::document::{Document, Follower, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain};
use meshbrush_core::earth::{EarthPlane, Projection};
use meshbrush_core::field::{Formula, Transfer};
use meshbrush_core::layers::{Layer, LayerKind};
use meshbrush_core::outline::{DerivedMesh, OutlineFit};
use meshbrush_mesh::mesh::{Cleaning, Extract};

use crate::random_coast::{place, random_coast};
use crate::runs::{prints_table, seeds};

/// A target that grows with the distance from a point, or is the same everywhere.
#[derive(Clone, Copy, Debug)]
struct RadialTarget {
    at: DVec2,
    least: f64,
    slope: f64,
}

impl RadialTarget {
    fn layer(&self) -> LayerKind {
        let Self { at, least, slope } = self;
        let text = format!("{least:?} + {slope:?} * hypot(x - ({:?}), y - ({:?}))", at.x, at.y);
        if *slope == 0.0 {
            LayerKind::constant(*least)
        } else {
            LayerKind::target(Formula::parse(&text).unwrap())
        }
    }

    /// Returns the least target in a closed triangle.
    fn least_in(&self, corners: [DVec2; 3]) -> f64 {
        self.least + self.slope * distance(self.at, corners)
    }
}

/// Returns the distance of a point from a closed triangle.
fn distance(p: DVec2, corners: [DVec2; 3]) -> f64 {
    let edges = [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]);
    if edges.iter().all(|[a, b]| (*b - *a).perp_dot(p - *a) >= 0.0) {
        return 0.0;
    }
    let to_edge = edges.map(|[a, b]| {
        let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, share))
    });
    to_edge.into_iter().fold(f64::INFINITY, f64::min)
}

/// A coast with a target, in the plane or on the Earth.
pub struct Coast {
    pub settings: Settings,
    target: RadialTarget,
}

/// Planes whose scale differs from place to place, each with the middle and the width of a coast.
const PLANES: [(&str, DVec2, f64); 3] = [
    ("+proj=merc +lat_ts=0 +ellps=WGS84 +units=m", dvec2(2e6, 8.4e6), 2e6),
    ("+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m", dvec2(2e5, 5e6), 4e5),
    ("+proj=stere +lat_0=90 +lat_ts=70 +lon_0=0 +ellps=WGS84 +units=m", dvec2(-1e6, 2e6), 3e6),
];

impl Coast {
    pub fn new(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let mut polygons = random_coast(&mut random);
        let mut domain = Domain::of_polygons(&polygons).unwrap();
        if seed % 3 == 2 {
            let (projection, middle, width) = PLANES[random.usize(..PLANES.len())];
            let (center, scale) = (domain.bounds.center(), width / domain.bounds.size().max_element());
            let moved = |p: DVec2| middle + scale * (p - center);
            polygons.iter_mut().flatten().flatten().for_each(|p| *p = moved(*p));
            domain = Domain::of_polygons(&polygons).unwrap();
            domain.projection = Some(projection.parse::<Projection>().unwrap());
        }
        let size = domain.bounds.size().max_element();
        let least = size * 0.008 * 3f64.powf(random.f64());
        let slope = if random.bool() { 0.3 * random.f64() } else { 0.0 };
        let at = domain.bounds.min + place(&mut random) * domain.bounds.size();
        let target = RadialTarget { at, least, slope };
        // Finer along the outline than elsewhere, or no finer.
        let diameter = least * 0.5 * 4f64.powf(random.f64());
        let mut settings = Settings::for_domain("coast".into(), domain);
        settings.spacing = size / f64::from(random.u32(4..20));
        settings.boundary = BoundaryTreatment::OnOutline { diameter };
        settings.transfer = Transfer::between(0.1 * diameter.min(least), 10.0 * size);
        settings.layers = Layer::default_stack(target.layer());
        Self { settings, target }
    }
}

/// What a checker finds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found {
    pub triangles: usize,
    /// Triangles with an edge that is longer than the least target in them.
    pub over: usize,
    /// The greatest ratio of an edge to the least target in its triangle.
    worst: f64,
    pub smallest_angle: f64,
    pub most_at_node: usize,
    pub boundary_nodes: usize,
    pub on_outline: usize,
    /// The largest distance of the other nodes of the boundary from the outline, in world units.
    farthest: f64,
}

impl Found {
    /// Returns what was found in both meshes. There may be none in the first.
    pub fn and(self, other: Self) -> Self {
        let angle = if self.triangles == 0 { 180.0 } else { self.smallest_angle };
        Self {
            triangles: self.triangles + other.triangles,
            over: self.over + other.over,
            worst: self.worst.max(other.worst),
            smallest_angle: angle.min(other.smallest_angle),
            most_at_node: self.most_at_node.max(other.most_at_node),
            boundary_nodes: self.boundary_nodes + other.boundary_nodes,
            on_outline: self.on_outline + other.on_outline,
            farthest: self.farthest.max(other.farthest),
        }
    }
}

pub fn check(extract: &Extract, fit: OutlineFit, coast: &Coast) -> Found {
    let nodes: Vec<DVec2> = extract.world_nodes().collect();
    let plane = coast.settings.domain.projection.map(EarthPlane::Projected);
    let length = |a: DVec2, b: DVec2| plane.map_or(a.distance(b), |plane| plane.length(&[a, b]));
    // A formula has one value in a cell of the lattice, that at its middle.
    let cell = coast.target.slope * extract.lattice().step().length();
    let OutlineFit { nodes: boundary_nodes, on_outline, farthest, .. } = fit;
    let mut found = Found { smallest_angle: 180.0, boundary_nodes, on_outline, farthest, ..Found::default() };
    let mut at_node = vec![0; nodes.len()];
    for triangle in extract.cells() {
        let corners = triangle.corners.map(|node| nodes[node]);
        triangle.corners.iter().for_each(|&node| at_node[node] += 1);
        let [a, b, c] = corners;
        let longest = length(a, b).max(length(b, c)).max(length(c, a));
        let target = coast.target.least_in(corners);
        found.triangles += 1;
        found.over += usize::from(longest > (target + cell) * (1.0 + 1e-9));
        found.worst = found.worst.max(longest / target);
        for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
            found.smallest_angle = found.smallest_angle.min((q - p).angle_to(r - p).to_degrees());
        }
    }
    found.most_at_node = at_node.into_iter().max().unwrap_or(0);
    found
}

/// The mesh of a coast with its nodes on the outline, as files have it, and without regard to lengths.
fn judged(coast: &Coast) -> [Found; 2] {
    let mut document = Document::new(coast.settings.clone(), None).unwrap();
    let follower = Follower::new(&mut document).unwrap();
    let (mesh, domain) = (follower.mesh(), follower.domain());
    let targets = follower.edge_targets(document.paint());
    assert!(targets.is_some());
    [targets, None].map(|targets| {
        let derived = DerivedMesh::new(mesh, domain, targets, &Cleaning::NONE);
        let extract = derived.extract(mesh);
        assert_eq!(derived.violations(&extract), []);
        check(&extract, derived.fit().unwrap(), coast)
    })
}

#[test]
fn no_edge_is_longer_than_its_target() {
    let mut sums = [Found::default(); 2];
    for seed in seeds(6) {
        let found = judged(&Coast::new(seed));
        if prints_table() {
            eprintln!("{seed}: {:?}\n  with edges of any length: {:?}", found[0], found[1]);
        }
        assert_eq!(found[0].over, 0, "seed {seed}: {:?}", found[0]);
        sums.iter_mut().zip(found).for_each(|(sum, found)| *sum = sum.and(found));
    }
    let [kept, any] = sums;
    if prints_table() {
        eprintln!("{kept:?}\nwith edges of any length: {any:?}");
    }
    // The checker would find them.
    assert!(any.over > 0 && any.worst > 1.1, "{any:?}");
    assert!(100 * kept.triangles <= 105 * any.triangles, "{kept:?} for {any:?}");
    let share = |found: Found| found.on_outline as f64 / found.boundary_nodes as f64;
    assert!(share(kept) > share(any) - 0.01, "{kept:?} for {any:?}");
}

/// A disc of 10 km at 60° N, with triangles of 1 km at the outline and elsewhere.
#[test]
fn no_edge_of_a_disc_on_the_earth_is_longer_than_its_target() {
    let projection: Projection = "+proj=merc +lat_ts=0 +lon_0=5 +ellps=WGS84 +units=m".parse().unwrap();
    let middle = projection.plane_from_geographic(dvec2(5.0, 60.0));
    let radius = 10e3 * projection.scale_in_plane(middle);
    let ring =
        (0..90).map(|n| middle + radius * DVec2::from_angle(f64::from(n) * std::f64::consts::TAU / 90.0));
    let mut domain = Domain::of_polygons(&[vec![ring.collect()]]).unwrap();
    domain.projection = Some(projection);
    let mut settings = Settings::for_domain("disc".into(), domain);
    settings.spacing = 4e3;
    settings.boundary = BoundaryTreatment::OnOutline { diameter: 1e3 };
    settings.transfer = Transfer::between(10.0, 1e5);
    let target = RadialTarget { at: middle, least: 1e3, slope: 0.0 };
    settings.layers = Layer::default_stack(target.layer());
    let [kept, any] = judged(&Coast { settings, target });
    assert!(kept.over == 0 && kept.worst > 0.9, "{kept:?}");
    assert!(any.over > 0 && any.worst > 1.05, "{any:?}");
    assert!(kept.on_outline >= any.on_outline && kept.farthest <= any.farthest, "{kept:?} and {any:?}");
}

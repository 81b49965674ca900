//! Location, barycentric coordinates and adjacency against brute force with arithmetic of its own.
//!
//! The contract of location, in world coordinates: a point with exactly the coordinates of a node is on that
//! vertex, and a point one ulp to the right of a node is to its right. In between, the point's place is its
//! lattice coordinates
//! ([`Lattice::lattice_from_world`](meshbrush_mesh::geometry::Lattice::lattice_from_world)), and the
//! answer is exact for those.

use std::cmp::Ordering;
use std::collections::{BTreeSet, HashMap};

use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{
    Limits, Location, Locator, Mesh, NodeId, TriangleId, barycentric, bisection_edge_length, interpolate,
};

const QUERIES_PER_MESH: usize = 170_000;

/// The result of brute force: every closed triangle that contains the point, and the number of its edges that
/// contain the point.
type Containing = Vec<(usize, usize)>;

/// All triangles by size class and place: a triangle is listed under every cell of its own size that it
/// touches.
struct BruteForce {
    corners: Vec<[[i64; 2]; 3]>,
    candidates: HashMap<(u32, i64, i64), Vec<usize>>,
    sizes: BTreeSet<u32>,
}

impl BruteForce {
    fn new(mesh: &Mesh) -> Self {
        let corner = |v: NodeId| [i64::from(mesh.node(v).x), i64::from(mesh.node(v).y)];
        let corners: Vec<_> = mesh.raw_triangles().iter().map(|t| t.vertices.map(corner)).collect();
        let (mut candidates, mut sizes) = (HashMap::<_, Vec<usize>>::new(), BTreeSet::new());
        for (index, c) in corners.iter().enumerate() {
            let range = |axis: usize| {
                let along = c.map(|c| c[axis]);
                (along.into_iter().min().unwrap(), along.into_iter().max().unwrap())
            };
            let (x, y) = (range(0), range(1));
            let size = ((x.1 - x.0).max(y.1 - y.0)).ilog2();
            sizes.insert(size);
            for column in x.0 >> size..=x.1 >> size {
                for row in y.0 >> size..=y.1 >> size {
                    candidates.entry((size, column, row)).or_default().push(index);
                }
            }
        }
        Self { corners, candidates, sizes }
    }

    fn containing(&self, p: DVec2) -> Containing {
        let (x, y) = (p.x.floor() as i64, p.y.floor() as i64);
        let listed = self.sizes.iter().filter_map(|&s| self.candidates.get(&(s, x >> s, y >> s)));
        let mut found: Containing =
            listed.flatten().filter_map(|&i| edges_under(self.corners[i], p).map(|on| (i, on))).collect();
        found.sort_unstable();
        found
    }

    /// Returns the triangles that contain a point, found by testing all of them without the lists.
    fn containing_of_all(&self, p: DVec2) -> Containing {
        let all = self.corners.iter().enumerate();
        all.filter_map(|(i, &corners)| edges_under(corners, p).map(|on| (i, on))).collect()
    }
}

/// On how many edges of a triangle the point lies; `None` when it is strictly outside.
fn edges_under(corners: [[i64; 2]; 3], p: DVec2) -> Option<usize> {
    let mut on = 0;
    for j in 0..3 {
        let (from, to, opposite) = (corners[j], corners[(j + 1) % 3], corners[(j + 2) % 3]);
        let inner = side(from, to, dvec2(opposite[0] as f64, opposite[1] as f64));
        match side(from, to, p) {
            Ordering::Equal => on += 1,
            side if side != inner => return None,
            _ => {}
        }
    }
    Some(on)
}

/// Greater: left of the line from `from` to `to`, which runs along an axis or a diagonal. Exact.
fn side(from: [i64; 2], to: [i64; 2], p: DVec2) -> Ordering {
    let whole = |n: i64| n as f64; // below 2^53
    let step = [(to[0] - from[0]).signum(), (to[1] - from[1]).signum()];
    let flip = |order: Ordering, sign: i64| if sign < 0 { order.reverse() } else { order };
    match step {
        [sign, 0] => flip(p.y.compare(whole(from[1])), sign),
        [0, sign] => flip(p.x.compare(whole(from[0])), -sign),
        [sx, sy] if sx == sy => flip(compare_difference(p.y, p.x, from[1] - from[0]), sx),
        [sx, _] => flip(compare_sum(p.x, p.y, from[0] + from[1]), sx),
    }
}

trait Compare {
    fn compare(self, other: f64) -> Ordering;
}

impl Compare for f64 {
    /// Neither is NaN; −0 equals 0.
    fn compare(self, other: f64) -> Ordering {
        self.partial_cmp(&other).unwrap()
    }
}

/// Whole part and fraction of a number that is not negative: both exact.
fn split(x: f64) -> (i64, f64) {
    (x.floor() as i64, x - x.floor())
}

/// Compares a + b with c, exactly, for a and b not negative.
fn compare_sum(a: f64, b: f64, c: i64) -> Ordering {
    let ((a, a_fraction), (b, b_fraction)) = (split(a), split(b));
    let (less, more) = (a_fraction.min(b_fraction), a_fraction.max(b_fraction));
    // The fractions add up to less than 2.
    match c - a - b {
        ..0 => Ordering::Greater,
        0 => more.compare(0.0),
        1 if more < 0.5 => Ordering::Less,
        1 => less.compare(1.0 - more), // exact: 0.5 ≤ more < 1
        2.. => Ordering::Less,
    }
}

/// Compares a − b with c, exactly, for a and b not negative.
fn compare_difference(a: f64, b: f64, c: i64) -> Ordering {
    let ((a, a_fraction), (b, b_fraction)) = (split(a), split(b));
    match (a - b).cmp(&c) {
        Ordering::Equal => a_fraction.compare(b_fraction),
        unequal => unequal,
    }
}

/// A mesh to query. `exact` where the map to the lattice is a multiplication by a power of two, done here
/// independently.
struct Subject {
    mesh: Mesh,
    exact: bool,
}

impl Subject {
    fn lattice_from_world(&self, p: DVec2) -> DVec2 {
        let lattice = self.mesh.lattice();
        if self.exact {
            p * f64::from(lattice.cells()[0]) * f64::from(lattice.cell_steps())
        } else {
            lattice.lattice_from_world(p)
        }
    }
}

/// Refined to `level` towards each of the points given in parts of the domain.
fn refined(mut mesh: Mesh, level: u32, towards: &[DVec2]) -> Mesh {
    let extent = mesh.lattice().extent().as_dvec2();
    let width = mesh.lattice().spacing() / mesh.lattice().step().max_element();
    let limits = Limits { max_level: Some(level), ..Limits::default() };
    mesh.refine(&limits, |element| {
        let size = bisection_edge_length(width, element.triangle.level());
        let corners = element.corners.map(LatticePoint::as_dvec2);
        towards
            .iter()
            .any(|&t| corners.iter().any(|c| size > 0.3 * c.distance(t * extent).max(1e-30 * width)))
    })
    .unwrap();
    assert_eq!(mesh.level_counts().len(), level as usize + 1);
    mesh
}

fn subjects() -> Vec<(&'static str, Subject)> {
    let grid = |bounds, spacing, contains: &dyn Fn(DVec2) -> bool| {
        Mesh::coarse_grid(
            &Lattice::covering(bounds, spacing, 1_000_000).unwrap(),
            contains,
            &Limits::default(),
        )
        .unwrap()
    };
    let everywhere = |_: DVec2| true;
    let not = |removed: &'static [(u32, u32)], cells: f64| {
        move |p: DVec2| !removed.contains(&((p.x * cells) as u32, (p.y * cells) as u32))
    };
    let mut random = Rng::with_seed(7);
    let mut scattered = |n: usize| -> Vec<DVec2> {
        std::iter::repeat_with(|| dvec2(random.f64(), random.f64())).take(n).collect()
    };
    let holes = not(&[(3, 3), (5, 3), (4, 9), (0, 0), (16, 16), (10, 12), (11, 14), (7, 0), (16, 5)], 16.0);
    let far = Rect::new(dvec2(4.0e6 + 0.1, -7.7e6), dvec2(4.0e6 + 531.3, -7.7e6 + 218.7));
    let tall = Rect::new(dvec2(-1e-7, 3e-7), dvec2(1e-7, 9.1e-7));
    let subject = |mesh, exact| Subject { mesh, exact };
    vec![
        ("square", subject(refined(grid(Rect::UNIT, 0.125, &everywhere), 12, &scattered(12)), true)),
        ("deep", subject(refined(grid(Rect::UNIT, 1.0, &everywhere), 50, &[dvec2(1.0 / 3.0, 0.7)]), true)),
        ("holes", subject(refined(grid(Rect::UNIT, 0.0625, &holes), 16, &scattered(9)), true)),
        ("one", subject(grid(Rect::UNIT, 1.0, &not(&[(0, 0)], 1.0)), true)),
        ("far", subject(refined(grid(far, 40.0, &everywhere), 14, &scattered(10)), false)),
        ("tall", subject(refined(grid(tall, 1e-7, &everywhere), 30, &scattered(3)), false)),
    ]
}

fn nudged(x: f64, random: &mut Rng) -> f64 {
    match random.u32(0..3) {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    }
}

/// Returns a point chosen to do harm.
fn hostile(mesh: &Mesh, random: &mut Rng) -> DVec2 {
    let lattice = mesh.lattice();
    let bounds = lattice.bounds();
    let id = TriangleId::from_index(random.usize(..mesh.raw_triangle_count()));
    let corners = mesh.world_corners(id);
    let (a, b) = (corners[random.usize(..3)], corners[random.usize(..3)]);
    let p = match random.u32(0..16) {
        0..3 => a,
        3..6 => (a + b) / 2.0,
        6..8 => a + (b - a) * random.f64(),
        8 => dvec2(a.x, b.y),
        9..11 => (a + corners[0] + corners[1]) / 3.0,
        11 => bounds.min + bounds.size() * (1.4 * dvec2(random.f64(), random.f64()) - 0.2),
        12 => dvec2(bounds.min.x, a.y),
        13 => dvec2(a.x, bounds.max.y),
        14 => {
            let odd = [f64::NAN, f64::INFINITY, -f64::INFINITY, -0.0, 0.0, 5e-324, -5e-324, 1e-310, 1e300];
            let mut any = |x: f64| if random.bool() { odd[random.usize(..odd.len())] } else { x };
            dvec2(any(a.x), any(b.y))
        }
        _ => return bounds.min + bounds.size() * dvec2(random.f64(), random.f64()),
    };
    if random.bool() { p } else { dvec2(nudged(p.x, random), nudged(p.y, random)) }
}

/// Checks one answer. Returns which kind it was.
fn check(
    subject: &Subject,
    brute: &BruteForce,
    everything: bool,
    world: DVec2,
    answer: Location,
) -> &'static str {
    let mesh = &subject.mesh;
    let p = subject.lattice_from_world(world);
    let extent = mesh.lattice().extent().as_dvec2();
    if world.x.is_nan() || world.y.is_nan() {
        assert_eq!(answer, Location::Invalid);
        return "invalid";
    }
    if p.x < 0.0 || p.y < 0.0 || p.x > extent.x || p.y > extent.y {
        assert_eq!(answer, Location::OutsideBounds);
        return "outside";
    }
    let containing = brute.containing(p);
    if everything {
        assert_eq!(containing, brute.containing_of_all(p), "the referee itself");
    }
    let Some(&(lowest, on)) = containing.first() else {
        assert_eq!(answer, Location::OutsideDomain);
        return "hole";
    };
    let lowest = TriangleId::from_index(lowest);
    assert_eq!(answer.triangle(), Some(lowest), "{containing:?}");
    match (on, answer) {
        (0, Location::Inside { .. }) => "inside",
        (1, Location::OnEdge { edge, .. }) => {
            let (from, to) = mesh.triangle(lowest).edge_nodes()[edge];
            let ends = [from, to].map(|v| [i64::from(mesh.node(v).x), i64::from(mesh.node(v).y)]);
            assert_eq!(side(ends[0], ends[1], p), Ordering::Equal);
            "edge"
        }
        (2, Location::OnVertex { node, .. }) => {
            assert_eq!(mesh.node(node).as_dvec2(), p);
            assert!(mesh.triangle(lowest).vertices.contains(&node));
            "vertex"
        }
        _ => panic!("on {on} edges, and the answer is {answer:?}"),
    }
}

#[test]
fn a_million_hostile_points_are_found_where_brute_force_finds_them() {
    let mut kinds: HashMap<&str, usize> = HashMap::new();
    for (seed, (name, subject)) in subjects().into_iter().enumerate() {
        let mesh = &subject.mesh;
        let brute = BruteForce::new(mesh);
        let locator = Locator::new(mesh);
        let mut random = Rng::with_seed(seed as u64);
        for query in 0..QUERIES_PER_MESH {
            let world = hostile(mesh, &mut random);
            let answer = mesh.locate(world);
            assert_eq!(locator.locate(world), answer, "{name}: {world:?}");
            let everything = query % (1 + mesh.raw_triangle_count() / 10) == 0;
            let kind = std::panic::catch_unwind(|| check(&subject, &brute, everything, world, answer));
            let kind = kind.unwrap_or_else(|_| panic!("{name}: {world:?}: {answer:?}"));
            *kinds.entry(kind).or_default() += 1;
        }
    }
    assert!(kinds.values().sum::<usize>() >= 1_000_000);
    for kind in ["invalid", "outside", "hole", "inside", "edge", "vertex"] {
        assert!(kinds.get(kind).is_some_and(|&n| n > 5_000), "{kinds:?}");
    }
}

#[test]
fn a_walk_leads_from_the_bucket_to_the_answer_through_neighbours() {
    for (seed, (name, subject)) in subjects().into_iter().enumerate() {
        let mesh = &subject.mesh;
        let mut random = Rng::with_seed(100 + seed as u64);
        let (mut longest, mut found) = (0, 0);
        for _ in 0..20_000 {
            let world = hostile(mesh, &mut random);
            let path = mesh.walk_path(world);
            assert_eq!(path.last().copied(), mesh.locate(world).triangle(), "{name}: {world:?}");
            let across = |pair: &[TriangleId]| {
                mesh.neighbours(pair[0]).iter().any(|next| next.triangle() == Some(pair[1]))
            };
            assert!(path.windows(2).all(across), "{name}: {path:?} to {world:?}");
            let distinct: BTreeSet<_> = path.iter().collect();
            assert_eq!(distinct.len(), path.len(), "{name}: {path:?} to {world:?}");
            longest = longest.max(path.len().saturating_sub(1));
            found += usize::from(!path.is_empty());
        }
        assert!(found > 1000 && longest as f64 <= mesh.walk_bound(), "{name}: {longest} steps");
    }
}

#[test]
fn the_mean_walk_is_that_of_random_points() {
    let subjects = subjects();
    let [square, one] =
        ["square", "one"].map(|name| &subjects.iter().find(|(n, _)| *n == name).unwrap().1.mesh);
    assert_eq!((one.mean_walk_steps(100), one.walk_bound()), (0.0, 1.0));
    let mut random = Rng::with_seed(5);
    let steps = |_| square.walk_path(dvec2(random.f64(), random.f64())).len() - 1;
    let mean = (0..20_000).map(steps).sum::<usize>() as f64 / 20_000.0;
    let sampled = square.mean_walk_steps(1000);
    assert!((sampled / mean - 1.0).abs() < 0.1 && mean > 1.0, "{sampled} of {mean}");
    assert_eq!(square.walk_bound(), 4096.0);
}

#[test]
fn a_point_with_a_nodes_coordinates_is_on_that_vertex_and_one_ulp_off_is_not() {
    for (name, subject) in subjects() {
        let mesh = &subject.mesh;
        let locator = Locator::new(mesh);
        for index in 0..mesh.raw_nodes().len() {
            let node = NodeId::from_index(index);
            let world = mesh.world(node);
            for answer in [mesh.locate(world), locator.locate(world)] {
                assert!(
                    matches!(answer, Location::OnVertex { node: n, .. } if n == node),
                    "{name}: {answer:?}"
                );
            }
            for off in [dvec2(world.x.next_up(), world.y), dvec2(world.x, world.y.next_down())] {
                assert!(!matches!(mesh.locate(off), Location::OnVertex { .. }), "{name}: {off}");
            }
        }
    }
}

#[test]
fn the_triangle_found_contains_the_point_in_the_world_as_well() {
    for (name, subject) in subjects() {
        let mesh = &subject.mesh;
        let bounds = mesh.lattice().bounds();
        let rounding = 4.0 * f64::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element();
        let mut random = Rng::with_seed(3);
        for _ in 0..20_000 {
            let world = hostile(mesh, &mut random);
            let Some(id) = mesh.locate(world).triangle() else { continue };
            let c = mesh.world_corners(id);
            let turn = (c[1] - c[0]).perp_dot(c[2] - c[0]).signum();
            for j in 0..3 {
                let edge = c[(j + 1) % 3] - c[j];
                let beyond = -turn * edge.perp_dot(world - c[j]) / edge.length();
                assert!(beyond <= rounding, "{name}: {world:?} is {beyond:e} beyond edge {j} of {id:?}");
            }
        }
    }
}

/// What docs/locate.md says: in world coordinates only edges along a diagonal have a band of rounding.
#[test]
fn in_the_coordinates_given_edges_along_an_axis_are_exact() {
    let (mut beside, mut on) = (0, 0);
    for (name, subject) in subjects() {
        let mesh = &subject.mesh;
        let bounds = mesh.lattice().bounds();
        let rounding = 4.0 * f64::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element();
        let locator = Locator::new(mesh);
        let mut random = Rng::with_seed(31);
        for _ in 0..20_000 {
            let world = hostile(mesh, &mut random);
            let found = locator.locate(world);
            let Some(id) = found.triangle() else { continue };
            let c = mesh.triangle(id).edge_nodes().map(|(from, _)| mesh.world(from));
            for j in 0..3 {
                let (from, to, opposite) = (c[j], c[(j + 1) % 3], c[(j + 2) % 3]);
                let is_on = matches!(found, Location::OnEdge { edge, .. } if edge == j);
                let [way, inner] = match (from.x == to.x, from.y == to.y) {
                    (true, false) => [world.x, opposite.x].map(|x| x.compare(from.x)),
                    (false, true) => [world.y, opposite.y].map(|y| y.compare(from.y)),
                    _ => {
                        let edge = to - from;
                        let distance = edge.perp_dot(world - from).abs() / edge.length();
                        assert!(
                            !is_on || distance <= rounding,
                            "{name}: {world} is {distance:e} from edge {j}"
                        );
                        continue;
                    }
                };
                let is_corner = matches!(found, Location::OnVertex { .. });
                let expected = if is_on { way.is_eq() } else { way == inner || (is_corner && way.is_eq()) };
                assert!(expected, "{name}: {world:?} is {found:?}, and {way:?} of edge {j}");
                (beside, on) = (beside + usize::from(way == inner), on + usize::from(is_on));
            }
        }
    }
    assert!(beside > 50_000 && on > 2_000, "{beside} {on}");
}

#[test]
fn barycentric_coordinates_sum_to_one_and_reproduce_linear_functions() {
    for (name, subject) in subjects() {
        let mesh = &subject.mesh;
        let mut random = Rng::with_seed(11);
        let extent = mesh.lattice().extent().as_dvec2().max_element();
        for _ in 0..50_000 {
            let world = hostile(mesh, &mut random);
            let Some(id) = mesh.locate(world).triangle() else { continue };
            let (corners, p) = (mesh.corners(id), mesh.lattice().lattice_from_world(world));
            let zeta = barycentric(corners, p);
            assert!((zeta.iter().sum::<f64>() - 1.0).abs() <= 4.0 * f64::EPSILON, "{name}: {zeta:?}");
            assert!(zeta.iter().all(|z| (-1e-15..=1.0 + 1e-15).contains(z)), "{name}: {zeta:?}");
            let linear = |p: DVec2| (3.0 - 2.0 * p.x + 5.0 * p.y) / extent;
            let value = interpolate(zeta, corners.map(|c| linear(c.as_dvec2())));
            assert!((value - linear(p)).abs() <= 64.0 * f64::EPSILON, "{name}: {value} at {world}");
        }
    }
}

#[test]
fn the_adjacency_rows_are_the_sets_of_algorithm_13() {
    for (name, subject) in subjects() {
        let mesh = &subject.mesh;
        let mut rows = vec![BTreeSet::new(); mesh.raw_nodes().len()];
        for t in mesh.raw_triangles() {
            for (n, m) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)] {
                rows[t.vertices[n].index()].insert(t.vertices[m]);
            }
        }
        let adjacency = mesh.adjacency();
        assert_eq!(adjacency.len(), rows.len());
        assert_eq!(2 * adjacency.edge_count(), rows.iter().map(BTreeSet::len).sum::<usize>());
        for (index, row) in rows.iter().enumerate() {
            let ours = adjacency.of(NodeId::from_index(index));
            assert_eq!(ours.len(), row.len(), "{name}: node {index} without duplicates");
            assert_eq!(ours.iter().copied().collect::<BTreeSet<_>>(), *row, "{name}: node {index}");
        }
    }
}

#[test]
fn a_large_locator_is_the_same_for_any_number_of_threads() {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 1_000_000).unwrap();
    let limits = Limits::default();
    for has_hole in [false, true] {
        let contains = |p: DVec2| !has_hole || p.distance(dvec2(0.5, 0.5)) > 0.2;
        let mut mesh = Mesh::coarse_grid(&lattice, contains, &limits).unwrap();
        let target = |p: DVec2| 2e-4 + 0.008 * p.distance(dvec2(0.4, 0.3));
        mesh.refine(&limits, |e| e.world_corners().iter().any(|&p| e.diameter() > target(p))).unwrap();
        assert!(mesh.raw_triangle_count() > 150_000, "{}", mesh.raw_triangle_count());
        for threads in [1, 2, 3, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let locator = pool.install(|| Locator::new(&mesh));
            let mut random = Rng::with_seed(12);
            for _ in 0..20_000 {
                let point = 1.1 * dvec2(random.f64(), random.f64());
                assert_eq!(locator.locate(point), mesh.locate(point), "{point}, {threads} threads");
            }
        }
    }
}

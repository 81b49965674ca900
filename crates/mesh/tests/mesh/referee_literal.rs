//! The core against the report's algorithms as they stand, routine by routine.
//!
//! Both are driven with the same calls in the same order; their arrays must be the same entry by entry.

use std::collections::{BTreeMap, BTreeSet};

use crate::literal::{BETA, Node, Report};
use glam::dvec2;
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Location, Mesh, NodeId, Orientation, TriangleId};

/// Returns a coarse mesh twice, by the program and by the report: grid nodes (column, row) of an N_e × N_e
/// grid on the unit square without `removed`.
fn coarse_pair(n_e: i64, removed: &[(i64, i64)]) -> (Mesh, Report) {
    let whole = |x: f64| (x * n_e as f64).round() as i64;
    let contains = |p: glam::DVec2| !removed.contains(&(whole(p.x), whole(p.y)));
    let mesh = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 1.0 / n_e as f64, 1_000_000).unwrap(),
        contains,
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(mesh.lattice().cells(), [n_e as u32; 2]);
    let delta = i64::from(mesh.lattice().cell_steps());
    let mut report = Report::initialise_mesh(n_e, delta, |[x, y]| !removed.contains(&(x / delta, y / delta)));
    report.remove_orphans();
    (mesh, report)
}

fn assert_same(mesh: &Mesh, report: &Report) {
    assert_eq!(mesh.raw_nodes().len(), report.n.len() - 1);
    assert_eq!(mesh.raw_triangle_count(), report.t.len() - 1);
    for (ours, theirs) in mesh.raw_nodes().iter().zip(&report.n[1..]) {
        assert_eq!([i64::from(ours.x), i64::from(ours.y)], *theirs);
    }
    for (i, (ours, theirs)) in mesh.raw_triangles().iter().zip(&report.t[1..]).enumerate() {
        let v = ours.vertices.map(|v| v.index() as i64 + 1);
        let n = ours.raw_neighbours.map(|n| n.triangle().map_or(BETA, |id| id.index() as i64 + 1));
        let o = i64::from(ours.orientation() == Orientation::Anticlockwise);
        assert_eq!([v[0], v[1], v[2], n[0], n[1], n[2], o, i64::from(ours.level())], *theirs, "entry {i}");
    }
}

/// Squares, and domains in which the diagonal of a cell is on the boundary, so that boundary triangles of
/// even level are bisected.
fn domains() -> Vec<(i64, Vec<(i64, i64)>)> {
    vec![
        (1, vec![]),
        (2, vec![]),
        (5, vec![]),
        (1, vec![(0, 0)]),         // one triangle, its bisection edge on the boundary
        (1, vec![(1, 1)]),         // the other one
        (4, vec![(0, 0), (4, 4)]), // two corners cut off
        (5, vec![(2, 2)]),         // a hexagonal hole
        (6, vec![(1, 1), (3, 2), (5, 5), (0, 4)]), // holes, some that open to the outside
        (7, vec![(2, 2), (3, 4), (4, 2), (5, 5), (1, 5)]),
        (3, vec![(1, 0), (2, 2)]), // leaves nodes that no triangle uses
    ]
}

/// Returns some triangle, half the time one of the youngest: meshes grow deep as well as wide.
fn any_triangle(mesh: &Mesh, random: &mut fastrand::Rng) -> TriangleId {
    let count = mesh.raw_triangle_count();
    let first = if random.bool() { count.saturating_sub(6) } else { 0 };
    TriangleId::from_index(random.usize(first..count))
}

#[test]
fn the_same_calls_give_the_same_arrays() {
    let mut branches: BTreeMap<(u32, i64, i64, Option<i64>), usize> = BTreeMap::new();
    let mut routines: BTreeMap<&str, usize> = BTreeMap::new();
    let mut calls = 0;
    for (seed, (n_e, removed)) in domains().into_iter().enumerate() {
        let mut random = fastrand::Rng::with_seed(seed as u64);
        let (mut mesh, mut report) = coarse_pair(n_e, &removed);
        assert_same(&mesh, &report);
        for call in 0..2600 {
            let id = any_triangle(&mesh, &mut random);
            if mesh.triangle(id).level() >= 40 {
                continue;
            }
            mesh.refine_triangle(id);
            report.refine_triangle(id.index() + 1);
            calls += 1;
            assert_eq!(mesh.raw_triangle_count(), report.t.len() - 1, "call {call}");
            if call % 100 == 0 {
                assert_same(&mesh, &report);
            }
        }
        assert_same(&mesh, &report);
        report.branches.iter().for_each(|(&key, count)| *branches.entry(key).or_default() += count);
        report.routines.iter().for_each(|(&key, count)| *routines.entry(key).or_default() += count);
    }
    assert!(calls >= 25_000, "{calls} calls");
    assert_eq!(routines.len(), 6, "Algorithms 9, 21 to 25 all ran: {routines:?}");
    for (k, o) in [(1, 0), (1, 1), (2, 0), (2, 1)] {
        assert!(branches.contains_key(&(19, k, o, None)), "Algorithm 19 with k = {k}, O = {o}: {branches:?}");
        for o_b in [0, 1] {
            // Two clockwise triangles never share their bisection edge: Algorithm 8 has two cases, (1, 0, 0)
            // and (2, 0, 0), that no mesh refined from the coarse grid reaches.
            let reachable = o == 1 || o_b == 1;
            let key = (8, k, o, Some(o_b));
            assert_eq!(branches.contains_key(&key), reachable, "Algorithm 8, {k}, {o}, {o_b}: {branches:?}");
        }
    }
}

/// A triangle, independent of its number and the order of its vertices.
type Corners = [Node; 3];

fn set_of(corners: impl Iterator<Item = Corners>) -> BTreeSet<Corners> {
    corners
        .map(|mut c| {
            c.sort_unstable();
            c
        })
        .collect()
}

fn corners_of(mesh: &Mesh) -> BTreeSet<Corners> {
    let node = |v: NodeId| [i64::from(mesh.node(v).x), i64::from(mesh.node(v).y)];
    set_of(mesh.raw_triangles().iter().map(|t| t.vertices.map(node)))
}

/// Eq. (13) with the vertex rule: levels near two nodes of a fine grid, at the right rim, and on a thin
/// strip.
fn vertex_rule(extent: i64, random: &mut fastrand::Rng) -> impl Fn(i64, Corners) -> bool {
    let place = |random: &mut fastrand::Rng| random.i64(0..=64) * (extent / 64);
    let centres = [(); 2].map(|()| [place(random), place(random)]);
    let (strip, half_width) = (2 * place(random), random.i64(0..extent / 16));
    let wanted = move |[x, y]: Node| {
        let near = |c: Node| ((x - c[0]).abs() + (y - c[1]).abs()) < extent / 20;
        if centres.iter().any(|&c| near(c)) {
            13
        } else if x == extent {
            8
        } else if (x + y - strip).abs() < half_width {
            10
        } else {
            2
        }
    };
    move |level, corners| corners.iter().any(|&c| level < wanted(c))
}

#[test]
fn refine_mesh_in_index_order_gives_the_same_set_of_triangles() {
    let mut left_unsatisfied = 0;
    for seed in 0..60 {
        let (n_e, removed) = &domains()[seed % domains().len()];
        let mut random = fastrand::Rng::with_seed(100 + seed as u64);
        let (mut mesh, mut report) = coarse_pair(*n_e, removed);
        let exceeds = vertex_rule(n_e * report.delta, &mut random);
        mesh.refine(&Limits::default(), |element| {
            let corners = element.corners.map(|c| [i64::from(c.x), i64::from(c.y)]);
            exceeds(i64::from(element.triangle.level()), corners)
        })
        .unwrap();
        // One run of Algorithm 12 can leave triangles that break Eq. (14): it never comes back to an entry
        // that compatibility bisects later. Each further run starts over, until one has nothing to do.
        report.refine_mesh(&exceeds);
        let after_one_run = report.t.len();
        let mut before = 0;
        while before < report.t.len() {
            before = report.t.len();
            report.refine_mesh(&exceeds);
        }
        left_unsatisfied += usize::from(report.t.len() > after_one_run);
        let theirs = set_of((1..report.t.len()).map(|i| report.corners(i)));
        assert!(theirs.len() > 4 * report.n_e as usize);
        assert!(corners_of(&mesh) == theirs, "seed {seed}");
    }
    assert!(left_unsatisfied > 0, "a rule was met that Algorithm 12 does not satisfy in one run");
}

#[test]
fn adjacency_and_location_agree_with_algorithms_13_to_15() {
    for (seed, (n_e, removed)) in domains().into_iter().enumerate() {
        let mut random = fastrand::Rng::with_seed(200 + seed as u64);
        let (mut mesh, mut report) = coarse_pair(n_e, &removed);
        for _ in 0..400 {
            let id = any_triangle(&mesh, &mut random);
            if mesh.triangle(id).level() < 12 {
                mesh.refine_triangle(id);
                report.refine_triangle(id.index() + 1);
            }
        }
        assert_same(&mesh, &report);
        let rows = mesh.adjacency();
        for (n, row) in report.adjacency_list().iter().enumerate().skip(1) {
            let mut ours: Vec<i64> =
                rows.of(NodeId::from_index(n - 1)).iter().map(|m| m.index() as i64 + 1).collect();
            ours.sort_unstable();
            assert_eq!(ours, *row, "node {n}");
        }
        let mut found = 0;
        for _ in 0..500 {
            // Whole lattice points: the report's orientation test is exact there.
            let extent = mesh.lattice().extent();
            let p = meshbrush_mesh::geometry::LatticePoint::new(
                random.u32(0..=extent.x),
                random.u32(0..=extent.y),
            );
            let theirs = report.point_location([f64::from(p.x), f64::from(p.y)], &mut random);
            match mesh.locate(mesh.lattice().world_from_lattice(p)) {
                Location::Inside { triangle } => {
                    assert_eq!(theirs, Some(triangle.index() + 1));
                    found += 1;
                }
                Location::OutsideDomain => assert_eq!(theirs, None),
                // Several triangles are right; the report gives one at random, or none beside a removed one.
                Location::OnEdge { .. } | Location::OnVertex { .. } => {}
                other => panic!("{p:?}: {other:?}"),
            }
        }
        assert!(found > 50);
    }
    let (mesh, _) = coarse_pair(2, &[]);
    assert_eq!(mesh.locate(dvec2(1.5, 0.5)), Location::OutsideBounds);
}

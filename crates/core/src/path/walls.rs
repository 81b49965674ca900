//! Walls, which paths may not cross: the edges at which the open triangles end.

use std::ops::ControlFlow;

use glam::DVec2;

use super::Passage;
use super::path_mesh::{NONE, PathMesh, contains};
use crate::geometry::{BoxTree, Rect, Side, side_of_points};

/// The edges at which the open triangles of a mesh end, to test segments.
///
/// All tests are exact for the coordinates as they are: a segment along a wall is admitted, and one that
/// leaves the open triangles by the smallest number of f64 is not.
#[derive(Clone)]
pub struct Walls {
    walls: Vec<Wall>,
    tree: BoxTree,
    /// The distance of neighbouring numbers at the largest coordinate.
    ulp: f64,
}

/// An edge from a to b with the open triangles to the left, and the end of the next edge along them.
///
/// ```text
///      next
///        \   open
///         b------a
/// ```
#[derive(Clone, Copy, Debug)]
struct Wall {
    a: DVec2,
    b: DVec2,
    next: DVec2,
    /// The number of b.
    node: u32,
}

/// A corner of the walls on a segment, and whether the segment leaves it into open triangles on each side.
struct Touch {
    node: u32,
    is_open: [bool; 2],
}

/// A point that rounding put outside is moved by this many ulps at most.
const MOST_ULPS: f64 = 4096.0;

impl Walls {
    /// Returns the walls of a mesh.
    pub fn new(mesh: &PathMesh) -> Self {
        let mut walls = Vec::new();
        for t in 0..mesh.triangles.len() as u32 {
            if mesh.passage(t) == Passage::Open {
                (0..3)
                    .filter(|&edge| is_wall(mesh, t, edge))
                    .for_each(|edge| walls.push(wall(mesh, t, edge)));
            }
        }
        let boxes: Vec<Rect> = walls.iter().map(|wall| Rect::spanning(wall.a, wall.b)).collect();
        let tree = BoxTree::new(&boxes);
        let largest = tree.bounds().map_or(0.0, |all| all.min.abs().max(all.max.abs()).max_element());
        Self { walls, tree, ulp: largest.next_up() - largest }
    }

    /// Returns whether a segment stays in the open triangles, their rims included. Its first end must lie in
    /// them.
    ///
    /// A segment can leave them only where it crosses a wall, at an end on a wall, or at a corner of the
    /// walls. At each of these it is known on which side it continues.
    pub fn admit(&self, p: DVec2, q: DVec2) -> bool {
        if p == q {
            return true;
        }
        let mut touched: Vec<Touch> = Vec::new();
        let blocked = self.tree.visit_meeting(&Rect::spanning(p, q), |number| {
            match is_blocked_by(&self.walls[number as usize], p, q, &mut touched) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        blocked.is_continue() && touched.iter().all(|touch| touch.is_open == [true; 2])
    }

    /// Returns whether all pieces of a polyline stay in the open triangles. Its first point must lie in them.
    pub fn admit_all(&self, points: &[DVec2]) -> bool {
        points.windows(2).all(|pair| self.admit(pair[0], pair[1]))
    }

    /// Returns a point between the ends of a segment that is admitted, such that both parts are admitted,
    /// too.
    ///
    /// Rounding puts most points beside an oblique segment, and where the segment follows a wall, perhaps
    /// beyond it: then it is a point a few ulps beside the segment. `None` where none of those tried will do.
    pub(super) fn between(&self, p: DVec2, q: DVec2, share: f64) -> Option<DVec2> {
        let at = p.lerp_monotonic(q, share);
        let admits = |at: &DVec2| self.admit(p, *at) && self.admit(*at, q);
        if admits(&at) {
            return Some(at);
        }
        let across = self.ulp * (q - p).perp().normalize_or_zero();
        let ulps =
            std::iter::successors(Some(1.0), |ulps| Some(2.0 * ulps).filter(|&ulps| ulps <= MOST_ULPS));
        ulps.flat_map(|ulps| [at + ulps * across, at - ulps * across]).find(admits)
    }

    /// The nodes at which a shortest way can bend: where the open triangles have an angle of more than 180°,
    /// or meet in the node alone.
    pub(super) fn bends(&self) -> Vec<u32> {
        let mut nodes: Vec<u32> = self.walls.iter().map(|wall| wall.node).collect();
        nodes.sort_unstable();
        let pinched = nodes.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
        let is_reflex = |wall: &&Wall| side_of_points(wall.a, wall.b, wall.next) == Side::Right;
        pinched.chain(self.walls.iter().filter(is_reflex).map(|wall| wall.node)).collect()
    }

    /// The corners of the walls within a triangle, but for two of its own.
    pub(super) fn corners_within(&self, p: DVec2, q: DVec2, apex: DVec2) -> Vec<DVec2> {
        let corners = if (q - p).perp_dot(apex - p) > 0.0 { [p, q, apex] } else { [q, p, apex] };
        let around = Rect::new(p.min(q).min(apex), p.max(q).max(apex));
        let mut found = Vec::new();
        let _ = self.tree.visit_meeting(&around, |number| {
            let corner = self.walls[number as usize].b;
            if corner != p && corner != q && contains(&corners, corner) {
                found.push(corner);
            }
            ControlFlow::<()>::Continue(())
        });
        found
    }

    /// The corner of the walls within a triangle that is farthest from the line through its first two
    /// points.
    pub fn corner_within(&self, p: DVec2, q: DVec2, apex: DVec2) -> Option<DVec2> {
        let height = |corner: &DVec2| (q - p).perp_dot(*corner - p).abs();
        let farther = |best: DVec2, corner| if height(&corner) > height(&best) { corner } else { best };
        self.corners_within(p, q, apex).into_iter().reduce(farther)
    }
}

impl std::fmt::Debug for Walls {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Walls").field("count", &self.walls.len()).finish_non_exhaustive()
    }
}

fn is_blocked_by(wall: &Wall, p: DVec2, q: DVec2, touched: &mut Vec<Touch>) -> bool {
    let [of_p, of_q] = [p, q].map(|end| side_of_points(wall.a, wall.b, end));
    let [of_a, of_b] = [wall.a, wall.b].map(|end| side_of_points(p, q, end));
    let are_apart = |one: Side, other: Side| one != other && one != Side::On && other != Side::On;
    if are_apart(of_p, of_q) && are_apart(of_a, of_b) {
        return true;
    }
    // An end on the wall, between its ends: the segment must not leave to the right.
    if (of_p == Side::On && of_q == Side::Right && is_between(wall, p))
        || (of_q == Side::On && of_p == Side::Right && is_between(wall, q))
    {
        return true;
    }
    if of_b == Side::On && Rect::spanning(p, q).contains(wall.b) {
        touch(wall, p, q, touched);
    }
    false
}

/// Returns whether a point of the line through a wall lies between its ends, and is neither of them.
fn is_between(wall: &Wall, point: DVec2) -> bool {
    point != wall.a && point != wall.b && Rect::spanning(wall.a, wall.b).contains(point)
}

/// Notes whether a segment through the end of a wall has open triangles on both sides of it.
fn touch(wall: &Wall, p: DVec2, q: DVec2, touched: &mut Vec<Touch>) {
    // A corner at an end of the segment has only one side.
    let is_open = [p, q].map(|end| end == wall.b || leads_inside(wall, end));
    match touched.iter_mut().find(|touch| touch.node == wall.node) {
        // Several wedges meet in the node: one of them is enough.
        Some(touch) => (0..2).for_each(|side| touch.is_open[side] |= is_open[side]),
        None => touched.push(Touch { node: wall.node, is_open }),
    }
}

/// Returns whether the way from b to a point begins in the wedge of open triangles at b.
fn leads_inside(wall: &Wall, to: DVec2) -> bool {
    let is_left = |from, to, point| side_of_points(from, to, point) != Side::Right;
    let left = [is_left(wall.a, wall.b, to), is_left(wall.b, wall.next, to)];
    let is_convex = is_left(wall.a, wall.b, wall.next);
    if is_convex { left[0] && left[1] } else { left[0] || left[1] }
}

fn is_wall(mesh: &PathMesh, t: u32, edge: usize) -> bool {
    let across = mesh.across[t as usize][edge];
    across == NONE || mesh.passage(across) != Passage::Open
}

fn wall(mesh: &PathMesh, t: u32, edge: usize) -> Wall {
    let corners = mesh.triangles[t as usize].corners;
    let (a, node) = (corners[edge], corners[(edge + 1) % 3]);
    // Around b through the open triangles, up to the next wall.
    let (mut t, mut edge) = (t, (edge + 1) % 3);
    while !is_wall(mesh, t, edge) {
        t = mesh.across[t as usize][edge];
        edge = (0..3).find(|&k| mesh.triangles[t as usize].corners[k] == node).expect("it shares the node");
    }
    let next = mesh.triangles[t as usize].corners[(edge + 1) % 3];
    let [a, b, next] = [a, node, next].map(|node| mesh.nodes[node as usize]);
    Wall { a, b, next, node }
}

#[cfg(test)]
pub(super) mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::Lattice;
    use crate::layers::Mask;
    use crate::mesh::{Limits, Mesh};

    /// Returns the unit square in 8 × 8 cells without the cells that a square touches: those from 0.375 to
    /// 0.625.
    pub(in crate::path) fn with_hole() -> PathMesh {
        let lattice = Lattice::covering(Rect::UNIT, 0.125, 10_000).unwrap();
        let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
        let ring = [(0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)].map(|(x, y)| dvec2(x, y));
        PathMesh::with_keep_out(mesh.view(), &[Mask::new(&[vec![ring.to_vec()]]).unwrap()])
    }

    #[test]
    fn segments_are_admitted_that_stay_in_open_triangles() {
        // The hole is the square from 0.375 to 0.625.
        let walls = Walls::new(&with_hole());
        let (low, high) = (0.375, 0.625);
        let admitted = [
            // Along the hole, around its corners, along the rim, from corner to corner of the square.
            (dvec2(0.0, low), dvec2(1.0, low)),
            (dvec2(low, 0.1), dvec2(low, 0.9)),
            (dvec2(low, low), dvec2(high, low)),
            (dvec2(0.25, 0.5), dvec2(low, high)),
            (dvec2(0.0, 0.0), dvec2(0.0, 1.0)),
            (dvec2(0.0, 0.75), dvec2(0.75, 0.0)),
            (dvec2(0.0, 0.0), dvec2(low, low)),
            (dvec2(0.3, 0.45), dvec2(0.45, 0.3)),
        ];
        let refused = [
            (dvec2(0.0, 0.0), dvec2(1.0, 1.0)),
            (dvec2(low, low), dvec2(high, high)),
            (dvec2(low, 0.5), dvec2(high, 0.5)),
            (dvec2(low, low), dvec2(0.5, 0.5)),
            (dvec2(low, 0.5), dvec2(0.5, 0.5)),
            (dvec2(0.5, 0.5), dvec2(0.1, 0.5)),
            (dvec2(0.9, 0.5), dvec2(1.1, 0.5)),
            (dvec2(0.3, 0.5), dvec2(0.5, 0.3)),
        ];
        for (p, q) in admitted {
            assert!(walls.admit(p, q) && walls.admit(q, p), "{p} {q}");
        }
        for (p, q) in refused {
            assert!(!walls.admit(p, q), "{p} {q}");
        }
    }

    #[test]
    fn random_segments_are_admitted_as_their_points_are() {
        let mesh = with_hole();
        let walls = Walls::new(&mesh);
        let mut random = fastrand::Rng::with_seed(1404);
        let mut admitted = 0;
        for _ in 0..4000 {
            let [p, q] = [(); 2].map(|()| match random.bool() {
                true => dvec2(random.f64(), random.f64()),
                false => dvec2(f64::from(random.u32(0..17)), f64::from(random.u32(0..17))) / 16.0,
            });
            if mesh.locate(p, Passage::Open).is_none() {
                continue;
            }
            let inside = |n: u32| mesh.locate(p.lerp(q, f64::from(n) / 200.0), Passage::Open).is_some();
            let expected = (0..=200).all(inside);
            // A segment that crosses a corner between two of the points is rare.
            if walls.admit(p, q) != expected {
                assert!(expected, "{p} {q}");
                let finely = (0..=20_000)
                    .all(|n| mesh.locate(p.lerp(q, f64::from(n) / 20_000.0), Passage::Open).is_some());
                assert!(!finely, "{p} {q}");
            }
            admitted += u32::from(expected);
        }
        assert!(admitted > 1000, "{admitted}");
    }
}

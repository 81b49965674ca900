//! Where paths may not go: the edges at which the open triangles end.

use std::ops::ControlFlow;

use glam::DVec2;

use super::Passage;
use super::path_mesh::{NONE, PathMesh, contains};
use crate::geometry::{BoxTree, Rect};

/// The edges at which the open triangles of a mesh end, to test segments.
#[derive(Clone, Debug)]
pub struct Walls {
    walls: Vec<Wall>,
    tree: BoxTree,
    /// Coordinates are exact to about this length.
    margin: f64,
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

/// Lengths below this share of the coordinates count as rounding.
const ROUNDING: f64 = 1e-13;

impl Walls {
    /// The walls of a mesh.
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
        Self { walls, tree, margin: ROUNDING * largest }
    }

    /// Whether a segment stays in the open triangles, their rims included. Its first end must lie in them.
    pub fn admit(&self, p: DVec2, q: DVec2) -> bool {
        if p == q {
            return true;
        }
        let mut touched: Vec<Touch> = Vec::new();
        let around = Rect::spanning(p, q).expanded(self.margin);
        let blocked = self.tree.visit_meeting(&around, |number| {
            let wall = &self.walls[number as usize];
            match self.is_blocked_by(wall, p, q, &mut touched) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        blocked.is_continue() && touched.iter().all(|touch| touch.is_open == [true; 2])
    }

    /// The corner of the walls within a triangle that is farthest from the line through its first two points.
    pub fn corner_within(&self, p: DVec2, q: DVec2, apex: DVec2) -> Option<DVec2> {
        let corners = if (q - p).perp_dot(apex - p) > 0.0 { [p, q, apex] } else { [q, p, apex] };
        let around = Rect::new(p.min(q).min(apex), p.max(q).max(apex));
        let height = |corner: DVec2| (q - p).perp_dot(corner - p).abs();
        let mut best: Option<DVec2> = None;
        let _ = self.tree.visit_meeting(&around, |number| {
            let corner = self.walls[number as usize].b;
            let is_better = best.is_none_or(|best| height(corner) > height(best));
            if is_better && corner != p && corner != q && contains(&corners, corner) {
                best = Some(corner);
            }
            ControlFlow::<()>::Continue(())
        });
        best
    }

    fn is_blocked_by(&self, wall: &Wall, p: DVec2, q: DVec2, touched: &mut Vec<Touch>) -> bool {
        let [of_p, of_q] = [p, q].map(|end| self.side([wall.a, wall.b], end));
        let [of_a, of_b] = [wall.a, wall.b].map(|end| self.side([p, q], end));
        if of_p * of_q < 0 && of_a * of_b < 0 {
            return true;
        }
        // An end on the wall, between its ends: the segment must not leave to the right.
        let along = |end: DVec2| (end - wall.a).dot(wall.b - wall.a);
        let is_between = |end: DVec2| along(end) > 0.0 && along(end) < (wall.b - wall.a).length_squared();
        if (of_p == 0 && is_between(p) && of_q < 0) || (of_q == 0 && is_between(q) && of_p < 0) {
            return true;
        }
        if of_b == 0 {
            self.touch(wall, p, q, touched);
        }
        false
    }

    /// Notes whether a segment through the end of a wall has open triangles on both sides of it.
    fn touch(&self, wall: &Wall, p: DVec2, q: DVec2, touched: &mut Vec<Touch>) {
        let place = (wall.b - p).dot(q - p) / (q - p).length_squared();
        if !(0.0..=1.0).contains(&place) && wall.b.distance(p).min(wall.b.distance(q)) > self.margin {
            return;
        }
        // A corner at an end of the segment has only one side.
        let is_open = [p, q].map(|end| end.distance(wall.b) <= self.margin || self.leads_inside(wall, end));
        match touched.iter_mut().find(|touch| touch.node == wall.node) {
            // Several wedges meet in the node: one of them is enough.
            Some(touch) => (0..2).for_each(|side| touch.is_open[side] |= is_open[side]),
            None => touched.push(Touch { node: wall.node, is_open }),
        }
    }

    /// Whether the way from b to a point begins in the wedge of open triangles at b.
    fn leads_inside(&self, wall: &Wall, to: DVec2) -> bool {
        let left = [[wall.a, wall.b], [wall.b, wall.next]].map(|edge| self.side(edge, to) >= 0);
        let is_convex = self.side([wall.a, wall.b], wall.next) >= 0;
        if is_convex { left[0] && left[1] } else { left[0] || left[1] }
    }

    /// 1 if a point lies to the left of a line, −1 to the right, 0 on it but for rounding.
    fn side(&self, [from, to]: [DVec2; 2], point: DVec2) -> i32 {
        let (line, arm) = (to - from, point - from);
        let area = line.perp_dot(arm);
        let margin = 4.0 * self.margin * (line.length() + arm.length());
        i32::from(area > margin) - i32::from(area < -margin)
    }
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
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geometry::Lattice;
    use crate::layers::Mask;
    use crate::mesh::{Limits, Mesh};

    /// The unit square in 8 × 8 cells without the cells that a square touches.
    fn with_hole() -> PathMesh {
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

//! The shortest way through triangles of one cost, exactly. In a plane on the Earth it is the shortest in the
//! plane, which is nearly the shortest on the ellipsoid.
//!
//! It is straight but for bends at corners of the walls. The search looks from the start, and from each
//! corner that it sees, through the triangles: what is seen through an edge is an interval of it.
//!
//! ```text
//!            c
//!          ╱   ╲          from the root, the interval l–r of the edge pq is seen, and through it parts of
//!        ╱       ╲        the edges pc and cq, and c itself if it lies between the rays
//!      p──l─────r──q
//!          ╲   ╱
//!           root
//! ```
//!
//! Intervals and corners wait in the order of the least length of a way to the goal by them (A*, as
//! \[CuiHaraborGrastien2017\]), so that the first way that is complete is the shortest.

use glam::DVec2;

use super::Passage;
use super::path_mesh::{NONE, PathMesh};
use super::place::MeshPlace;
use super::walls::Walls;
use crate::geometry::{BestFirst, Side, side_of_points};
use crate::mesh::Progress;

/// The most intervals that a search looks at.
const MOST_INTERVALS: usize = 200_000;
/// A way is shorter than a known one by this share at least.
const LEAST_GAIN: f64 = 1e-9;

/// Where a shortest way is sought: through the open triangles with the cost of the first one.
pub(super) struct Shortest<'a> {
    pub mesh: &'a PathMesh,
    /// Returns whether a triangle has that cost.
    pub has_cost: &'a dyn Fn(u32) -> bool,
}

/// The point that a part of the way begins with: the start, or a corner by the number of its node.
#[derive(Clone, Copy, Debug)]
struct Root {
    at: DVec2,
    /// [`NONE`] for the start.
    node: u32,
    /// The length of the way to it.
    length: f64,
}

/// A part of an edge through which a triangle is seen: on the left and on the right, seen from the root.
#[derive(Clone, Copy, Debug)]
struct Interval {
    triangle: u32,
    /// The place of the edge's first end among the corners of the triangle: its left end from outside.
    edge: usize,
    left: DVec2,
    right: DVec2,
}

impl Shortest<'_> {
    fn is_open(&self, triangle: u32) -> bool {
        triangle != NONE && self.mesh.passage(triangle) == Passage::Open && (self.has_cost)(triangle)
    }
}

/// The state of a corner of the walls during a search.
#[derive(Clone, Copy, Debug)]
struct WallCorner {
    /// Whether a shortest way can bend there.
    bends: bool,
    /// The length of the shortest known way to it.
    length: f64,
    /// The corner before it on that way.
    before: u32,
}

/// The search for a shortest way between two places, in steps.
#[derive(Clone, Debug)]
pub(super) struct CornerSearch {
    start: DVec2,
    goal: DVec2,
    /// The triangles that hold the goal.
    at_goal: Vec<u32>,
    /// By node.
    corners: Vec<WallCorner>,
    /// Roots with the interval through which each looks, `None` for all around. The bound is the least length
    /// of a way to the goal by them.
    waiting: BestFirst<(Root, Option<Interval>)>,
    /// The length of the shortest known way to the goal.
    shortest: f64,
    /// The last corner on it.
    last: Option<u32>,
    /// How many intervals it has looked at; `None` before the first one.
    looked_at: Option<usize>,
}

impl CornerSearch {
    /// Begins to look for a way that is shorter than `known`.
    pub fn new(mesh: &PathMesh, walls: &Walls, [start, goal]: [MeshPlace; 2], known: f64) -> Self {
        let blank = WallCorner { bends: false, length: f64::INFINITY, before: NONE };
        let mut corners = vec![blank; mesh.node_count()];
        walls.bends().into_iter().for_each(|node| corners[node as usize].bends = true);
        let [start, goal] = [start.point, goal.point];
        let at_goal = mesh.open_triangles_at(goal);
        let shortest = known * (1.0 - LEAST_GAIN);
        let (waiting, last, looked_at) = (BestFirst::default(), None, None);
        Self { start, goal, at_goal, corners, waiting, shortest, last, looked_at }
    }

    /// Looks at the next intervals, at most `most` of them. Returns whether there is more to do.
    pub fn advance(&mut self, over: &Shortest, most: usize) -> Progress {
        if self.looked_at.is_none() {
            self.see_around(over, Root { at: self.start, node: NONE, length: 0.0 });
        }
        let mut looked_at = self.looked_at.unwrap_or(0);
        for _ in 0..most {
            let Some((least, (root, seen))) = self.waiting.pop() else { return Progress::Done };
            if least >= self.shortest {
                return Progress::Done;
            }
            // Meanwhile a shorter way to the root may be known.
            if root.node != NONE && root.length > self.corners[root.node as usize].length {
                continue;
            }
            match seen {
                None => self.see_around(over, root),
                Some(interval) => self.see_through(over, root, interval),
            }
            looked_at += 1;
            if looked_at > MOST_INTERVALS {
                // Another way may be shorter.
                self.last = None;
                return Progress::Done;
            }
        }
        self.looked_at = Some(looked_at);
        Progress::More
    }

    /// Returns the shortest way, as a polyline that the walls admit. `None` where none is shorter than the
    /// one that was known, or the search was too long.
    pub fn way(&self, mesh: &PathMesh, walls: &Walls) -> Option<Vec<DVec2>> {
        let mut way = vec![self.goal];
        let mut node = self.last?;
        // Ends: each corner has a longer way than the one before it.
        while node != NONE {
            way.push(mesh.nodes[node as usize]);
            node = self.corners[node as usize].before;
        }
        way.push(self.start);
        way.dedup();
        way.reverse();
        (way.len() > 1 && walls.admit_all(&way)).then_some(way)
    }

    /// Looks from a root into the triangles around it.
    fn see_around(&mut self, over: &Shortest, root: Root) {
        let mesh = over.mesh;
        let around = match root.node {
            NONE => mesh.open_triangles_at(root.at),
            node => mesh.around(node).to_vec(),
        };
        for triangle in around.into_iter().filter(|&triangle| over.is_open(triangle)) {
            if self.at_goal.contains(&triangle) {
                self.reach_goal(root);
            }
            let corners = mesh.triangles[triangle as usize].corners;
            corners.iter().for_each(|&node| self.reach(mesh, node, root));
            for edge in 0..3 {
                let [a, b] = [corners[edge], corners[(edge + 1) % 3]].map(|node| mesh.nodes[node as usize]);
                // From inside, the first end of an edge is on the right.
                if side_of_points(a, b, root.at) == Side::Left {
                    self.put(over, root, mesh.across[triangle as usize][edge], [b, a], triangle);
                }
            }
        }
    }

    /// Looks from a root through an interval into a triangle.
    fn see_through(&mut self, over: &Shortest, root: Root, seen: Interval) {
        let Interval { triangle, edge, left, right } = seen;
        let mesh = over.mesh;
        let corners = mesh.triangles[triangle as usize].corners;
        let [p, q, c] = [0, 1, 2].map(|step| mesh.nodes[corners[(edge + step) % 3] as usize]);
        let sides = |at| [side_of_points(root.at, left, at), side_of_points(root.at, right, at)];
        if self.at_goal.contains(&triangle) {
            let [of_left, of_right] = sides(self.goal);
            if of_left != Side::Left && of_right != Side::Right {
                self.reach_goal(root);
            }
        }
        let [of_left, of_right] = sides(c);
        if of_left != Side::Left && of_right != Side::Right {
            self.reach(mesh, corners[(edge + 2) % 3], root);
        }
        let across = |step: usize| mesh.across[triangle as usize][(edge + step) % 3];
        if of_left == Side::Right {
            let from = crossing([root.at, left], [p, c]);
            let to = if of_right == Side::Right { crossing([root.at, right], [p, c]) } else { c };
            self.put(over, root, across(2), [from, to], triangle);
        }
        if of_right == Side::Left {
            let from = if of_left == Side::Left { crossing([root.at, left], [c, q]) } else { c };
            self.put(over, root, across(1), [from, crossing([root.at, right], [c, q])], triangle);
        }
    }

    /// Puts what is seen from a root through an interval into the queue.
    fn put(&mut self, over: &Shortest, root: Root, triangle: u32, [left, right]: [DVec2; 2], from: u32) {
        if left == right || !over.is_open(triangle) {
            return;
        }
        let across = over.mesh.across[triangle as usize];
        let Some(edge) = (0..3).find(|&edge| across[edge] == from) else { return };
        let least = root.length + least_by(root.at, [left, right], self.goal);
        if least < self.shortest {
            self.waiting.push(least, (root, Some(Interval { triangle, edge, left, right })));
        }
    }

    /// A node is seen from a root.
    fn reach(&mut self, mesh: &PathMesh, node: u32, root: Root) {
        let at = mesh.nodes[node as usize];
        let corner = &mut self.corners[node as usize];
        let length = root.length + root.at.distance(at);
        let least = length + at.distance(self.goal);
        if corner.bends && length < corner.length && node != root.node && least < self.shortest {
            (corner.length, corner.before) = (length, root.node);
            self.waiting.push(least, (Root { at, node, length }, None));
        }
    }

    /// The goal is seen from a root.
    fn reach_goal(&mut self, root: Root) {
        let length = root.length + root.at.distance(self.goal);
        if length < self.shortest {
            (self.shortest, self.last) = (length, Some(root.node));
        }
    }
}

/// Where the line through two points crosses a segment, or its nearer end where rounding leads beyond it.
fn crossing([from, to]: [DVec2; 2], [a, b]: [DVec2; 2]) -> DVec2 {
    let way = to - from;
    let [of_a, of_b] = [a, b].map(|end| way.perp_dot(end - from));
    let share = of_a / (of_a - of_b);
    if share.is_finite() { a.lerp_monotonic(b, share.clamp(0.0, 1.0)) } else { a }
}

/// The least length of a way between two points by a point of a segment.
fn least_by(from: DVec2, [a, b]: [DVec2; 2], to: DVec2) -> f64 {
    let edge = b - a;
    let squared = edge.length_squared();
    let [along_from, along_to] = [from, to].map(|point| (point - a).dot(edge) / squared);
    let [off_from, off_to] = [from, to].map(|point| (point - a).perp_dot(edge).abs());
    let both = off_from + off_to;
    let share = if both > 0.0 { (along_from * off_to + along_to * off_from) / both } else { along_from };
    let at = a.lerp(b, share.clamp(0.0, 1.0));
    from.distance(at) + at.distance(to)
}

//! From the distance function to a path: descent through the triangles.

use glam::DVec2;

use super::Passage;
use super::march::March;
use super::path_mesh::{NONE, PathMesh};
use super::place::Place;

/// Where the descent stands.
#[derive(Clone, Copy)]
enum Stand {
    Within(u32),
    /// On an edge, between its ends: the triangle and the place of the first end among its corners.
    OnEdge(u32, usize),
    OnNode(u32),
}

/// A step of the descent, and the distance that it leads to.
struct Step {
    /// The distance at its end and its own cost.
    total: f64,
    /// The distance at its end.
    value: f64,
    to: DVec2,
    /// `None` at the start of the path.
    stand: Option<Stand>,
}

/// A foot this near to the end of an edge, as a share of the edge, is the end.
const NEAR_END: f64 = 1e-9;

/// The path from the start of a march to the goal, as a polyline from the start: each piece lies in one
/// triangle. `None` where the march did not reach the goal.
///
/// It goes down from the goal: from a point of a triangle to the point x of the other edges with the least
/// u(x) + F |x − p|, where u is linear on the edges. Where that does not lead down, it goes to the lowest
/// node nearby, and from there by way of the nodes that gave the values.
pub(super) fn trace(
    mesh: &PathMesh,
    costs: &[f64],
    march: &March,
    start: Place,
    goal: Place,
) -> Option<Vec<DVec2>> {
    // A march may have paused at the goal: what lies beyond does not count.
    let corners = goal.corner_nodes(mesh);
    let farthest = corners.iter().map(|&node| march.value(node)).fold(0.0, f64::max);
    let descent = Descent { mesh, costs, march, start, farthest };
    let (mut stand, mut at, mut value) = (descent.stand_at(goal), goal.point, f64::INFINITY);
    let mut points = vec![goal.point];
    // Ends: each step leads to a lower value, except from an edge to an end of equal value.
    for _ in 0..8 * mesh.triangles.len() + 8 {
        let mut step = descent.best(stand, at)?;
        if step.value >= value && step.stand.is_some() {
            step = descent.to_lowest_node(stand, at).filter(|step| step.value <= value)?;
        }
        if step.to != at {
            points.push(step.to);
        }
        let Some(next) = step.stand else {
            points.reverse();
            return Some(points);
        };
        (stand, at, value) = (next, step.to, step.value);
    }
    None
}

struct Descent<'a> {
    mesh: &'a PathMesh,
    costs: &'a [f64],
    march: &'a March,
    start: Place,
    /// Values above this one count as infinite.
    farthest: f64,
}

impl Descent<'_> {
    fn value(&self, node: u32) -> f64 {
        let value = self.march.value(node);
        if value <= self.farthest { value } else { f64::INFINITY }
    }

    /// Where a place stands: on a node or an edge of its triangle, or within.
    fn stand_at(&self, place: Place) -> Stand {
        let corners = self.mesh.triangles[place.triangle as usize].corners;
        let shares = place.shares(self.mesh);
        let is_off = shares.map(|share| share.abs() < NEAR_END);
        match is_off {
            [false, true, true] => Stand::OnNode(corners[0]),
            [true, false, true] => Stand::OnNode(corners[1]),
            [true, true, false] => Stand::OnNode(corners[2]),
            [false, false, true] => Stand::OnEdge(place.triangle, 0),
            [true, false, false] => Stand::OnEdge(place.triangle, 1),
            [false, true, false] => Stand::OnEdge(place.triangle, 2),
            _ => Stand::Within(place.triangle),
        }
    }

    /// The triangles at a place that paths go through.
    fn triangles(&self, stand: Stand) -> Vec<u32> {
        let mut found = match stand {
            Stand::Within(t) => vec![t],
            Stand::OnEdge(t, edge) => vec![t, self.mesh.across[t as usize][edge]],
            Stand::OnNode(node) => self.mesh.around(node).to_vec(),
        };
        found.retain(|&t| t != NONE && self.mesh.passage(t) == Passage::Open);
        found
    }

    /// The best step; `None` where no node nearby has a distance.
    fn best(&self, stand: Stand, at: DVec2) -> Option<Step> {
        let steps = self.triangles(stand).into_iter().flat_map(|t| self.steps(t, stand, at));
        steps.reduce(|best, step| if step.total < best.total { step } else { best })
    }

    /// The best steps to the start and to each edge of a triangle that holds a point, but for edges that the
    /// point is on: rounding would lead along them by tiny steps.
    fn steps(&self, t: u32, stand: Stand, at: DVec2) -> impl Iterator<Item = Step> {
        let cost = self.costs[t as usize];
        let corners = self.mesh.triangles[t as usize].corners;
        let to_start = (t == self.start.triangle).then(|| {
            let to = self.start.point;
            Step { total: cost * at.distance(to), value: 0.0, to, stand: None }
        });
        let to_edges = (0..3).filter_map(move |k| {
            let ends = [corners[k], corners[(k + 1) % 3]];
            if self.is_on(stand, ends) {
                return None;
            }
            let foot = self.foot(ends, at, cost)?;
            let [a, b] = ends.map(|node| self.mesh.nodes[node as usize]);
            let (to, stand) = if foot < NEAR_END {
                (a, Stand::OnNode(ends[0]))
            } else if foot > 1.0 - NEAR_END {
                (b, Stand::OnNode(ends[1]))
            } else {
                (a.lerp(b, foot), Stand::OnEdge(t, k))
            };
            let [at_a, at_b] = ends.map(|node| self.value(node));
            let value = match stand {
                Stand::OnNode(node) => self.value(node),
                _ => at_a + foot * (at_b - at_a),
            };
            (to != at).then_some(Step {
                total: value + cost * at.distance(to),
                value,
                to,
                stand: Some(stand),
            })
        });
        to_start.into_iter().chain(to_edges)
    }

    fn is_on(&self, stand: Stand, ends: [u32; 2]) -> bool {
        match stand {
            Stand::Within(_) => false,
            Stand::OnNode(node) => ends.contains(&node),
            Stand::OnEdge(t, k) => {
                let corners = self.mesh.triangles[t as usize].corners;
                ends.contains(&corners[k]) && ends.contains(&corners[(k + 1) % 3])
            }
        }
    }

    /// Where on an edge u(x) + F |x − p| is least, as a share of the edge.
    fn foot(&self, ends: [u32; 2], p: DVec2, cost: f64) -> Option<f64> {
        let [at_a, at_b] = ends.map(|node| self.value(node));
        match [at_a.is_finite(), at_b.is_finite()] {
            [true, true] => {}
            [true, false] => return Some(0.0),
            [false, true] => return Some(1.0),
            [false, false] => return None,
        }
        let [a, b] = ends.map(|node| self.mesh.nodes[node as usize]);
        let (edge, arm, rise) = (b - a, p - a, at_b - at_a);
        let squared = edge.length_squared();
        let rest = cost * cost * squared - rise * rise;
        if rest <= 0.0 {
            return Some(if rise > 0.0 { 0.0 } else { 1.0 });
        }
        let foot = (arm.dot(edge) - edge.perp_dot(arm).abs() * rise / rest.sqrt()) / squared;
        Some(foot.clamp(0.0, 1.0))
    }

    /// A step to the node with the least distance among those of the triangles here.
    fn to_lowest_node(&self, stand: Stand, at: DVec2) -> Option<Step> {
        let here = if let Stand::OnNode(node) = stand { Some(node) } else { None };
        let triangles = self.triangles(stand).into_iter();
        let nodes = triangles.flat_map(|t| self.mesh.triangles[t as usize].corners.map(|node| (node, t)));
        let (node, t) = nodes
            .filter(|&(node, _)| Some(node) != here && self.value(node).is_finite())
            .min_by(|a, b| self.value(a.0).total_cmp(&self.value(b.0)))?;
        let (to, value) = (self.mesh.nodes[node as usize], self.value(node));
        let total = value + self.costs[t as usize] * at.distance(to);
        Some(Step { total, value, to, stand: Some(Stand::OnNode(node)) })
    }
}

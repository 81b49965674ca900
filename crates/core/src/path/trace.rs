//! Traces a path from the distance function: descent through the triangles.

use glam::DVec2;

use super::Passage;
use super::march::March;
use super::path_mesh::{NONE, PathMesh};
use super::place::MeshPlace;

/// The current position of the descent.
#[derive(Clone, Copy)]
enum Stand {
    Within(u32),
    /// On an edge, between its ends: the triangle and the place of the first end among its corners.
    OnEdge(u32, usize),
    OnNode(u32),
}

/// A step of the descent, and the distance that it leads to.
struct DescentStep {
    /// The distance at its end and its own cost.
    total: f64,
    /// The distance at its end.
    value: f64,
    to: DVec2,
    /// `None` at the start of the path.
    stand: Option<Stand>,
}

impl DescentStep {
    /// Returns the value and the number of its node: what falls from step to step.
    fn height(&self) -> (f64, u32) {
        (self.value, if let Some(Stand::OnNode(node)) = self.stand { node } else { NONE })
    }
}

/// A foot this near to the end of an edge, as a share of the edge, is the end.
const NEAR_END: f64 = 1e-9;

/// Returns the path from the start of a march to the goal, as a polyline from the start: each piece lies in
/// one triangle, but for rounding. `None` where the march did not reach the goal.
///
/// It goes down from the goal: from a point of a triangle to the point x of the other edges with the least
/// u(x) + F |x − p|, where u is linear on the edges. Where that does not lead down, it goes to a node that
/// does ([`PathDescent::down_to_node`]).
pub(super) fn trace(
    mesh: &PathMesh,
    costs: &[f64],
    march: &March,
    [start, goal]: [MeshPlace; 2],
) -> Option<Vec<DVec2>> {
    let descent = PathDescent::new(mesh, costs, march, [start, goal])?;
    let (mut stand, mut at, mut height) = (descent.stand_at(goal), goal.point, (f64::INFINITY, NONE));
    let mut points = vec![goal.point];
    // Each step leads to a lower value, or to a node of equal value and lower number. Their number is limited
    // nevertheless, since values on edges can be arbitrarily close: beyond the limit, the path descends along
    // nodes alone.
    for _ in 0..8 * mesh.triangles.len() + 8 {
        let step = descent.best(stand, at).filter(|step| step.stand.is_none() || step.height() < height);
        let step = step.or_else(|| descent.down_to_node(stand, at))?;
        height = step.height();
        match take(step, &mut points) {
            Some(next) => (stand, at) = next,
            None => return Some(points),
        }
    }
    trace_by_nodes(mesh, costs, march, [start, goal])
}

/// Returns the path that [`trace`] looks for, through nodes only. Each piece lies in one triangle, without an
/// exception for rounding.
pub(super) fn trace_by_nodes(
    mesh: &PathMesh,
    costs: &[f64],
    march: &March,
    [start, goal]: [MeshPlace; 2],
) -> Option<Vec<DVec2>> {
    let descent = PathDescent::new(mesh, costs, march, [start, goal])?;
    let (mut stand, mut at) = (Stand::Within(goal.triangle), goal.point);
    let mut points = vec![goal.point];
    // Ends: the nodes have lower and lower values, or equal ones and lower numbers.
    loop {
        match take(descent.down_to_node(stand, at)?, &mut points) {
            Some(next) => (stand, at) = next,
            None => return Some(points),
        }
    }
}

/// Adds the end of a step to the points from the goal on, and returns where the descent stands then. `None`
/// at the start: then the points are those of the path, from the start on.
fn take(step: DescentStep, points: &mut Vec<DVec2>) -> Option<(Stand, DVec2)> {
    let stays = points.last() == Some(&step.to);
    if !stays || step.stand.is_none() && points.len() == 1 {
        points.push(step.to);
    }
    let next = step.stand.map(|stand| (stand, step.to));
    if next.is_none() {
        points.reverse();
    }
    next
}

struct PathDescent<'a> {
    mesh: &'a PathMesh,
    costs: &'a [f64],
    march: &'a March,
    start: MeshPlace,
    /// Values above this one count as infinite.
    farthest: f64,
}

impl<'a> PathDescent<'a> {
    /// `None` where the march did not reach the goal.
    fn new(
        mesh: &'a PathMesh,
        costs: &'a [f64],
        march: &'a March,
        [start, goal]: [MeshPlace; 2],
    ) -> Option<Self> {
        // A march may have paused at the goal: what lies beyond does not count.
        let values = goal.corner_nodes(mesh).map(|node| march.value(node));
        let farthest = values.into_iter().fold(0.0, f64::max);
        farthest.is_finite().then_some(Self { mesh, costs, march, start, farthest })
    }

    fn value(&self, node: u32) -> f64 {
        let value = self.march.value(node);
        if value <= self.farthest { value } else { f64::INFINITY }
    }

    /// Returns where a place is: at a node, on an edge of its triangle, or inside.
    fn stand_at(&self, place: MeshPlace) -> Stand {
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

    /// Returns the triangles at a place that paths go through.
    fn triangles(&self, stand: Stand) -> Vec<u32> {
        let mut found = match stand {
            Stand::Within(t) => vec![t],
            Stand::OnEdge(t, edge) => vec![t, self.mesh.across[t as usize][edge]],
            Stand::OnNode(node) => self.mesh.around(node).to_vec(),
        };
        found.retain(|&t| t != NONE && self.mesh.passage(t) == Passage::Open);
        found
    }

    /// Returns the best step; `None` where no node nearby has a distance.
    fn best(&self, stand: Stand, at: DVec2) -> Option<DescentStep> {
        let steps = self.triangles(stand).into_iter().flat_map(|t| self.steps(t, stand, at));
        steps.reduce(|best, step| if step.total < best.total { step } else { best })
    }

    /// Returns the best steps to the start and to each edge of a triangle that holds a point, but for edges
    /// that the point is on: rounding would lead along them by tiny steps.
    fn steps(&self, t: u32, stand: Stand, at: DVec2) -> impl Iterator<Item = DescentStep> {
        let cost = self.costs[t as usize];
        let corners = self.mesh.triangles[t as usize].corners;
        let to_start = (t == self.start.triangle).then(|| {
            let to = self.start.point;
            DescentStep { total: cost * at.distance(to), value: 0.0, to, stand: None }
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
                // Rounding must not put a point of a wall outside.
                (self.mesh.moved_into(t, a.lerp_monotonic(b, foot)), Stand::OnEdge(t, k))
            };
            let [at_a, at_b] = ends.map(|node| self.value(node));
            let value = match stand {
                Stand::OnNode(node) => self.value(node),
                _ => at_a + foot * (at_b - at_a),
            };
            (to != at).then_some(DescentStep {
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

    /// Returns the point of an edge at which u(x) + F |x − p| is least, as a share of the edge.
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

    /// Returns a step to a node that is lower: from a node to the lowest corner of the triangle that its
    /// value came from, or to the start if it has none; from elsewhere to the lowest corner of the triangles
    /// there.
    fn down_to_node(&self, stand: Stand, at: DVec2) -> Option<DescentStep> {
        let triangles = match stand {
            Stand::OnNode(node) => match self.march.nodes[node as usize].from {
                NONE => {
                    let to = self.start.point;
                    let total = self.costs[self.start.triangle as usize] * at.distance(to);
                    return Some(DescentStep { total, value: 0.0, to, stand: None });
                }
                from => vec![from],
            },
            _ => self.triangles(stand),
        };
        let nodes =
            triangles.iter().flat_map(|&t| self.mesh.triangles[t as usize].corners.map(|node| (node, t)));
        let (node, t) = nodes
            .filter(|&(node, _)| self.value(node).is_finite())
            .min_by(|a, b| self.value(a.0).total_cmp(&self.value(b.0)).then(a.0.cmp(&b.0)))?;
        let (to, value) = (self.mesh.nodes[node as usize], self.value(node));
        let total = value + self.costs[t as usize] * at.distance(to);
        Some(DescentStep { total, value, to, stand: Some(Stand::OnNode(node)) })
    }
}

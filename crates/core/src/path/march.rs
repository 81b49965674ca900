//! Fast marching on triangles: the least cost from seeds to each node.

use glam::DVec2;

use super::Passage;
use super::path_mesh::{NONE, PathMesh};
use super::queue::Queue;
use crate::mesh::Progress;

/// Solves the eikonal equation |∇u| = F, whose solution u is the least cost from the seeds, to first order
/// for a cost F that is constant on each triangle: fast marching on triangles \[KimmelSethian1998\].
///
/// A node takes the least over its triangles of
///
/// ```text
///          c           u(c) = min over x on the edge ab of u(x) + F · |x − c|
///         /|\          with u(x) linear between a and b, and F the cost of the triangle,
///        / | \         if the result is not below u(a) or u(b)
///       /  |  \
///      a---x---b
/// ```
///
/// and of F · |a − c| from each accepted corner a; from the one accepted last only where no x between the
/// corners is better. Where the angle at c is at most 90°, the condition holds but for rounding. It makes the
/// result independent of the order of the work: nodes are accepted by value, then by number, and the value of
/// each follows from those accepted before. An obtuse angle at c is divided by the node d beyond the edge ab:
/// c takes values from the edges ad and db as well.
///
/// The arrays are reused from run to run.
#[derive(Clone, Debug, Default)]
pub struct March {
    pub(super) nodes: Vec<NodeState>,
    pub(super) queue: Queue,
    /// How many nodes the last run accepted.
    pub(super) accepted_count: usize,
}

/// The state of a node in a march.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeState {
    pub at: DVec2,
    /// The least cost from a seed; infinite if no seed reaches the node.
    pub value: f64,
    /// The triangle that the value comes from; [`NONE`] for a seed.
    pub from: u32,
    pub is_accepted: bool,
}

/// A node with a value to begin with.
pub type Seed = (u32, f64);

impl March {
    /// Marches from the seeds through all triangles with at least this passage. `costs` has one number for
    /// each triangle. With `until`, the march pauses when these nodes are accepted; values of others may then
    /// be missing or too large.
    pub fn run(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        least: Passage,
        seeds: &[Seed],
        until: Option<[u32; 3]>,
    ) {
        self.begin(mesh, seeds);
        self.go_on(mesh, costs, least, until);
    }

    /// Begins to march from seeds.
    pub(super) fn begin(&mut self, mesh: &PathMesh, seeds: &[Seed]) {
        self.nodes.clear();
        let fresh = |&at: &DVec2| NodeState { at, value: f64::INFINITY, from: NONE, is_accepted: false };
        self.nodes.extend(mesh.nodes.iter().map(fresh));
        self.queue.clear();
        self.accepted_count = 0;
        for &(node, value) in seeds {
            self.offer(node, value, NONE);
        }
    }

    /// Continues a paused march, with the same costs, until these nodes are accepted; without any, to the
    /// end.
    pub fn go_on(&mut self, mesh: &PathMesh, costs: &[f64], least: Passage, until: Option<[u32; 3]>) {
        _ = self.go_on_for(mesh, costs, least, until, usize::MAX);
    }

    /// [`Self::go_on`], for a limited number of nodes. Returns whether more are left.
    pub(super) fn go_on_for(
        &mut self,
        mesh: &PathMesh,
        costs: &[f64],
        least: Passage,
        until: Option<[u32; 3]>,
        most: usize,
    ) -> Progress {
        let has_more = |march: &Self| {
            until.is_none_or(|nodes| nodes.iter().any(|&node| !march.nodes[node as usize].is_accepted))
        };
        let last = self.accepted_count.saturating_add(most);
        let mut goes_on = has_more(self);
        while goes_on && self.accepted_count < last {
            let Some(node) = self.next() else { return Progress::Done };
            self.spread(mesh, costs, least, node);
            goes_on = until.is_none_or(|nodes| !nodes.contains(&node)) || has_more(self);
        }
        if goes_on { Progress::More } else { Progress::Done }
    }

    /// Returns whether every node that can be reached was accepted.
    pub(super) fn is_complete(&self) -> bool {
        self.queue.is_empty()
    }

    /// Returns the value of a node: infinite where no seed leads.
    pub fn value(&self, node: u32) -> f64 {
        self.nodes[node as usize].value
    }

    /// Returns the values of all nodes, in their order.
    pub fn values(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.nodes.iter().map(|node| node.value)
    }

    /// Returns how many nodes the last run accepted.
    pub fn accepted_count(&self) -> usize {
        self.accepted_count
    }

    /// Returns whether there are values for this mesh.
    pub fn is_for(&self, mesh: &PathMesh) -> bool {
        self.nodes.len() == mesh.nodes.len()
    }

    /// Accepts the next node.
    #[inline]
    pub(super) fn next(&mut self) -> Option<u32> {
        loop {
            let nodes = &self.nodes;
            let is_wanted = |value: f64, number: u32| {
                let node = &nodes[number as usize];
                !node.is_accepted && value == node.value
            };
            let (value, number) = self.queue.take(is_wanted)?;
            let node = &mut self.nodes[number as usize];
            if !node.is_accepted && value == node.value {
                node.is_accepted = true;
                self.accepted_count += 1;
                return Some(number);
            }
        }
    }

    #[inline]
    pub(super) fn offer(&mut self, number: u32, value: f64, from: u32) {
        let node = &mut self.nodes[number as usize];
        if value < node.value {
            (node.value, node.from, node.is_accepted) = (value, from, false);
            self.queue.put(value, number);
        }
    }

    /// Offers values to the nodes around an accepted one that are not accepted.
    #[inline]
    fn spread(&mut self, mesh: &PathMesh, costs: &[f64], least: Passage, number: u32) {
        let node = self.nodes[number as usize];
        for &t in mesh.around(number) {
            let triangle = &mesh.triangles[t as usize];
            if triangle.passage < least {
                continue;
            }
            let cost = costs[t as usize];
            let [a, b, c] = triangle.corners;
            // The other corners, anticlockwise.
            let [next, last] = if a == number {
                [b, c]
            } else if b == number {
                [c, a]
            } else {
                [a, b]
            };
            let (front_next, front_last) = (self.nodes[next as usize], self.nodes[last as usize]);
            if !front_next.is_accepted {
                let mut value = f64::INFINITY;
                if front_last.is_accepted {
                    value = through_edge(&front_last, &node, [last, number], &front_next, next, cost);
                }
                // By way of the edge it is less, but for rounding.
                if value == f64::INFINITY {
                    value = from_corner(&node, &front_next, cost);
                }
                self.offer_to(next, value, t, front_next.value);
            }
            if !front_last.is_accepted {
                let mut value = f64::INFINITY;
                if front_next.is_accepted {
                    value = through_edge(&node, &front_next, [number, next], &front_last, last, cost);
                }
                if value == f64::INFINITY {
                    value = from_corner(&node, &front_last, cost);
                }
                self.offer_to(last, value, t, front_last.value);
            }
        }
        if mesh.has_obtuse {
            self.spread_obtuse(mesh, costs, least, number);
        }
    }

    #[inline]
    fn offer_to(&mut self, number: u32, value: f64, from: u32, known: f64) {
        if value < known {
            self.offer(number, value, from);
        }
    }

    /// [`Self::spread`] across the edges opposite obtuse angles.
    #[cold]
    fn spread_obtuse(&mut self, mesh: &PathMesh, costs: &[f64], least: Passage, number: u32) {
        for &t in mesh.around(number) {
            let corners = mesh.triangles[t as usize].corners;
            let k = (0..3).find(|&k| corners[k] == number).expect("the row of a node has its triangles");
            // The node may be d of the triangle across, or a or b of this one.
            for obtuse in [mesh.across[t as usize][(k + 1) % 3], t] {
                let Some(kite) = Kite::new(mesh, obtuse, least) else { continue };
                let cost = costs[kite.triangles[0] as usize].max(costs[kite.triangles[1] as usize]);
                for [a, b] in kite.edges.into_iter().filter(|edge| edge.contains(&number)) {
                    let [from_a, from_b, to] = [a, b, kite.apex].map(|n| self.nodes[n as usize]);
                    if from_a.is_accepted && from_b.is_accepted && !to.is_accepted {
                        let value = through_edge(&from_a, &from_b, [a, b], &to, kite.apex, cost);
                        self.offer_to(kite.apex, value, obtuse, to.value);
                    }
                }
            }
        }
    }
}

/// A triangle with an obtuse angle at its apex c, and the one across the opposite edge.
///
/// ```text
///        c
///      / : \        the angle at c is divided by the line to d
///    a---:---b
///     \  :  /
///       \d/
/// ```
pub(super) struct Kite {
    /// c.
    pub apex: u32,
    /// ad and db.
    pub edges: [[u32; 2]; 2],
    /// abc and the one across.
    pub triangles: [u32; 2],
}

impl Kite {
    /// `None` where the triangle has no obtuse angle, or the one across does not divide it.
    pub fn new(mesh: &PathMesh, number: u32, least: Passage) -> Option<Self> {
        let triangle = mesh.triangles.get(number as usize)?;
        let c = usize::from(triangle.obtuse);
        if c == 3 || triangle.passage < least {
            return None;
        }
        let [apex, a, b] = [c, c + 1, c + 2].map(|k| triangle.corners[k % 3]);
        let across = mesh.across[number as usize][(c + 1) % 3];
        let other = mesh.triangles.get(across as usize).filter(|other| other.passage >= least)?;
        let d = *other.corners.iter().find(|&&d| d != a && d != b)?;
        let [pa, pb, pc, pd] = [a, b, apex, d].map(|n| mesh.nodes[n as usize]);
        let divides = (pa - pc).perp_dot(pd - pc) > 0.0 && (pd - pc).perp_dot(pb - pc) > 0.0;
        divides.then_some(Self { apex, edges: [[a, d], [d, b]], triangles: [number, across] })
    }
}

/// Returns the value at `to` along an edge from an accepted node. It is greater than the value there, even
/// where the cost of the edge is lost in rounding. So each value comes from smaller ones, or from equal ones
/// of nodes with smaller numbers, and a descent along them ends.
#[inline]
pub(super) fn from_corner(from: &NodeState, to: &NodeState, cost: f64) -> f64 {
    (from.value + cost * from.at.distance(to.at)).max(from.value.next_up())
}

/// Returns the least value at `to` by way of a point between two accepted nodes; infinite where that is at an
/// end, or would be below the value of an end.
#[inline]
pub(super) fn through_edge(
    a: &NodeState,
    b: &NodeState,
    [number_a, number_b]: [u32; 2],
    to: &NodeState,
    number: u32,
    cost: f64,
) -> f64 {
    let value = through_segment((a.at, a.value), (b.at, b.value), to.at, cost);
    let is_after = |end: f64, at: u32| value > end || (value == end && number > at);
    if is_after(a.value, number_a) && is_after(b.value, number_b) { value } else { f64::INFINITY }
}

/// min over x strictly between a and b of u(x) + F |x − c|, where u is linear on the segment; infinite if the
/// least value is at an end.
///
/// With d = u(b) − u(a), e = b − a and q = (c − a) · e, the least is at
/// x = a + e (q − A d / r) / |e|², where A = |e × (c − a)| and r = √(F² |e|² − d²).
#[inline]
pub(super) fn through_segment((a, at_a): (DVec2, f64), (b, at_b): (DVec2, f64), c: DVec2, cost: f64) -> f64 {
    let (edge, arm, rise) = (b - a, c - a, at_b - at_a);
    let squared = edge.length_squared();
    let rest = cost * cost * squared - rise * rise;
    if rest <= 0.0 {
        return f64::INFINITY;
    }
    let (along, area, root) = (arm.dot(edge), edge.perp_dot(arm).abs(), rest.sqrt());
    if along * root > area * rise && (squared - along) * root > -(area * rise) {
        at_a + (rise * along + area * root) / squared
    } else {
        f64::INFINITY
    }
}

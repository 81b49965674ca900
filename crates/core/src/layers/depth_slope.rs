//! Depths smoothed to a slope: the r-factor of ocean models.
//!
//! The r-factor of an edge is |h₁ − h₂| / (h₁ + h₂), with the depths h of its ends (Beckmann & Haidvogel,
//! J. Phys. Oceanogr. 23, 1993). Models with terrain-following coordinates have errors in their pressure
//! gradients where it is large.
//!
//! First, in rounds, each edge above the limit moves water from its deeper end to its shallower one until it
//! has the limit, as Mellor, Ezer & Oey do (J. Atmos. Ocean. Tech. 11, 1994): with the areas of the cells of
//! both nodes, so that the volume stays. Rounds converge; they end where no edge is above the limit by more
//! than a millionth of it, or after [`MOST_ROUNDS`]. Then what is left is deepened, as Martinho & Batteen do
//! (Ocean Modelling 13, 2006), from the deepest node on. That ends after one visit of each node, and the
//! bound holds for the numbers as files have them. The order is that of the nodes, so the result is one for
//! any number of threads. Depths stay between those of their neighbours, so a least depth is kept.
//!
//! A node is dry where its depth is 0 or less. Edges with a dry end have no r-factor, and do not count.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec2;

use super::node_depths::places;
use crate::mesh::MeshView;

/// Most rounds that move water. What is left then is deepened.
const MOST_ROUNDS: usize = 2000;
/// The share of the limit by which edges may be above it after these rounds.
const SLACK: f64 = 1e-6;

/// What smoothing changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthSlope {
    /// The largest r-factor that was asked for.
    pub limit: f64,
    /// The largest one of an edge before.
    pub before: f64,
    /// The largest one of an edge afterwards.
    pub after: f64,
    /// The nodes whose depth changed.
    pub changed: usize,
    /// The largest change, in metres: positive where the node is deeper now.
    pub largest: f64,
    /// The node of the largest change.
    pub at: DVec2,
    /// The water that there is more of, as a share of all of it.
    pub more_water: f64,
    /// The nodes that are dry.
    pub dry: usize,
}

impl DepthSlope {
    /// Changes depths in metres, positive downwards, so that no edge has an r-factor above the `limit`, which
    /// is between 0 and 1.
    pub fn smooth(mesh: MeshView, depths: &mut [f64], limit: f64) -> Self {
        let nodes = places(mesh);
        let neighbours = Neighbours::of(mesh);
        let areas = areas_of_cells(mesh, &nodes);
        let old = depths.to_vec();
        let mut smoothing = Smoothing { depths, neighbours: &neighbours, areas: &areas, limit };
        let before = smoothing.steepest();
        smoothing.move_water();
        smoothing.deepen();
        let after = smoothing.steepest();
        let mut found = Self { limit, before, after, ..Self::default() };
        let (mut water, mut more) = (0.0, 0.0);
        for (node, (&new, &old)) in depths.iter().zip(&old).enumerate() {
            found.dry += usize::from(old <= 0.0);
            water += areas[node] * old.max(0.0);
            if new == old {
                continue;
            }
            found.changed += 1;
            more += areas[node] * (new - old);
            if (new - old).abs() > found.largest.abs() {
                (found.largest, found.at) = (new - old, nodes[node]);
            }
        }
        found.more_water = if water > 0.0 { more / water } else { 0.0 };
        found
    }
}

/// Returns the r-factor of two depths; `None` where one is dry.
fn factor(a: f64, b: f64) -> Option<f64> {
    (a > 0.0 && b > 0.0).then(|| (a - b).abs() / (a + b))
}

/// The neighbours of each node, in ascending order, one node after the other.
struct Neighbours {
    starts: Vec<usize>,
    nodes: Vec<u32>,
}

impl Neighbours {
    fn of(mesh: MeshView) -> Self {
        let sides = |triangle: &crate::mesh::Triangle| {
            let [a, b, c] = triangle.vertices.map(|node| node.index() as u32);
            [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)]
        };
        // An edge inside is there from both of its triangles.
        let mut pairs: Vec<(u32, u32)> = mesh.triangles().iter().flat_map(sides).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; mesh.nodes().len() + 1];
        pairs.iter().for_each(|&(from, _)| starts[from as usize + 1] += 1);
        for node in 1..starts.len() {
            starts[node] += starts[node - 1];
        }
        Self { starts, nodes: pairs.into_iter().map(|(_, to)| to).collect() }
    }

    fn around(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        self.nodes[self.starts[node]..self.starts[node + 1]].iter().map(|&node| node as usize)
    }
}

/// Returns the area of the cell of each node: a third of its triangles.
fn areas_of_cells(mesh: MeshView, nodes: &[DVec2]) -> Vec<f64> {
    let mut areas = vec![0.0; nodes.len()];
    for triangle in mesh.triangles() {
        let corners = triangle.vertices.map(|node| node.index());
        let [a, b, c] = corners.map(|node| nodes[node]);
        let third = (b - a).perp_dot(c - a).abs() / 6.0;
        corners.into_iter().for_each(|node| areas[node] += third);
    }
    areas
}

/// Depths that are being smoothed.
struct Smoothing<'a> {
    depths: &'a mut [f64],
    neighbours: &'a Neighbours,
    areas: &'a [f64],
    limit: f64,
}

impl Smoothing<'_> {
    /// Returns the largest r-factor of an edge.
    fn steepest(&self) -> f64 {
        let of_node = |node: usize| {
            let around = self.neighbours.around(node);
            around.filter_map(move |other| factor(self.depths[node], self.depths[other]))
        };
        (0..self.depths.len()).flat_map(of_node).fold(0.0, f64::max)
    }

    /// Moves water over edges above the limit, in rounds over the nodes that changed in the round before.
    fn move_water(&mut self) {
        let mut active: Vec<usize> = (0..self.depths.len()).collect();
        let mut is_changed = vec![false; self.depths.len()];
        for _ in 0..MOST_ROUNDS {
            let mut changed = Vec::new();
            for &node in &active {
                for other in self.neighbours.around(node) {
                    if !self.level(node, other) {
                        continue;
                    }
                    for end in [node, other] {
                        if !std::mem::replace(&mut is_changed[end], true) {
                            changed.push(end);
                        }
                    }
                }
            }
            if changed.is_empty() {
                return;
            }
            changed.sort_unstable();
            changed.iter().for_each(|&node| is_changed[node] = false);
            active = changed;
        }
    }

    /// Moves water from the deeper of two nodes to the other one until their r-factor is the limit. Returns
    /// whether that was necessary.
    fn level(&mut self, a: usize, b: usize) -> bool {
        let (shallow, deep) = if self.depths[a] < self.depths[b] { (a, b) } else { (b, a) };
        let (low, high) = (self.depths[shallow], self.depths[deep]);
        if factor(low, high).is_none_or(|factor| factor <= self.limit * (1.0 + SLACK)) {
            return false;
        }
        let (less, more) = (1.0 - self.limit, 1.0 + self.limit);
        let water = (less * high - more * low) / (less / self.areas[deep] + more / self.areas[shallow]);
        self.depths[shallow] = low + water / self.areas[shallow];
        self.depths[deep] = high - water / self.areas[deep];
        true
    }

    /// Deepens nodes beside much deeper ones, from the deepest on. A node that is taken from the queue is
    /// as deep as it will be, since those after it are less deep, and nodes next to them end less deep still.
    fn deepen(&mut self) {
        let share = (1.0 - self.limit) / (1.0 + self.limit);
        let mut queue: BinaryHeap<Deep> =
            (0..self.depths.len()).map(|node| Deep { depth: self.depths[node], node }).collect();
        while let Some(Deep { depth, node }) = queue.pop() {
            if depth < self.depths[node] || depth <= 0.0 {
                continue; // it was deepened meanwhile, or is dry
            }
            for other in self.neighbours.around(node) {
                let old = self.depths[other];
                if old >= depth || factor(old, depth).is_none_or(|factor| factor <= self.limit) {
                    continue;
                }
                let mut new = (depth * share).max(old);
                // By rounding the next numbers may be needed; the depth of the neighbour is one that will do.
                while factor(new, depth).is_some_and(|factor| factor > self.limit) {
                    new = new.next_up();
                }
                self.depths[other] = new;
                queue.push(Deep { depth: new, node: other });
            }
        }
    }
}

/// A node in the queue: the deepest comes first, and of equally deep ones that with the lowest number.
#[derive(Clone, Copy, PartialEq)]
struct Deep {
    depth: f64,
    node: usize,
}

impl Eq for Deep {}

impl Ord for Deep {
    fn cmp(&self, other: &Self) -> Ordering {
        self.depth.total_cmp(&other.depth).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Deep {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

//! Other ways between two places than those that marches lead to first.
//!
//! A march is exact to first order. Of two ways that cost nearly the same it can prefer the more expensive
//! one. But the marches from both ends together know the other one: along a line of points that are equally
//! far along the way, each way between hills or walls is a valley of the sum of both distances.
//!
//! ```text
//!            ·  ╭── b ──╮           us + ug along the line:  ╲    ╱╲    ╱
//!   start  ─────┤ hill  ├─────  goal                           ╲a╱  ╲b╱
//!            ·  ╰── a ──╯
//!      the line us = ug passes a and b
//! ```

use std::collections::HashMap;

use glam::DVec2;

use super::Passage;
use super::disjoint_sets::DisjointSets;
use super::march::March;
use super::path_mesh::PathMesh;
use super::place::MeshPlace;
use super::trace::trace;
use super::walls::Walls;
use crate::geometry::nearest_on_segment;

/// Number of equal parts into which lines divide the way; valleys are sought on these lines.
const PARTS: u32 = 32;
/// A way counts if marches promise that it costs at most this share more than the best.
const MOST_EXCESS: f64 = 0.05;
/// A valley is at least this deep, as a share of the cost: anything less is noise of the marches.
const LEAST_DEPTH: f64 = 2e-4;
/// The most ways that are tried.
const MOST_WAYS: usize = 12;
/// A valley this near to a known way, in diameters of a triangle there, is that way's own.
const NEAR: f64 = 0.5;

/// Two places, and marches through open triangles from each of them to the other.
pub(super) struct Ways<'a> {
    pub mesh: &'a PathMesh,
    pub costs: &'a [f64],
    pub walls: &'a Walls,
    pub ends: [MeshPlace; 2],
    pub marches: [&'a March; 2],
}

/// The distances of a node from the start and from the goal.
type Distances = [f64; 2];

/// Where a line crosses an edge: between two nodes, in a triangle.
#[derive(Clone, Copy)]
struct Crossing {
    at: DVec2,
    triangle: u32,
    /// The sum of both distances there.
    sum: f64,
}

/// Where a line crosses edges.
#[derive(Default)]
struct CrossLine {
    crossings: Vec<Crossing>,
    /// Crossings of one triangle.
    links: Vec<[usize; 2]>,
    /// The crossing of an edge, from the node before the line to the one beyond.
    numbers: HashMap<[u32; 2], usize>,
}

impl CrossLine {
    /// The number of the crossing of an edge.
    fn add(&mut self, edge: [u32; 2], crossing: Crossing) -> usize {
        *self.numbers.entry(edge).or_insert_with(|| {
            self.crossings.push(crossing);
            self.crossings.len() - 1
        })
    }

    /// The lowest places of its valleys, the deepest first.
    fn valleys(&self) -> Vec<Crossing> {
        let mut order: Vec<usize> = (0..self.crossings.len()).collect();
        let sum = |number: usize| self.crossings[number].sum;
        order.sort_by(|&a, &b| sum(a).total_cmp(&sum(b)).then(a.cmp(&b)));
        let mut ranks = vec![0; order.len()];
        order.iter().enumerate().for_each(|(rank, &crossing)| ranks[crossing] = rank);
        let mut lower_beside: Vec<Vec<usize>> = vec![Vec::new(); order.len()];
        for [a, b] in self.links.iter().map(|link| link.map(|crossing| ranks[crossing])) {
            lower_beside[a.max(b)].push(a.min(b));
        }
        // The level rises from crossing to crossing. A valley ends where it meets a deeper one, and the root
        // of each part is its lowest crossing.
        let mut parts = DisjointSets::new(order.len());
        let mut is_shallow = vec![false; order.len()];
        for (rank, lower) in lower_beside.iter().enumerate() {
            for &other in lower {
                let [own, other] = [parts.root(rank), parts.root(other)];
                let ended = own.max(other);
                let [level, lowest] = [rank, ended].map(|rank| sum(order[rank]));
                is_shallow[ended] |= own != other && level - lowest < LEAST_DEPTH * lowest;
                parts.join(own, other);
            }
        }
        let is_valley = |&rank: &usize| lower_beside[rank].is_empty() && !is_shallow[rank];
        (0..order.len()).filter(is_valley).map(|rank| self.crossings[order[rank]]).collect()
    }
}

impl Ways<'_> {
    /// Ways that the walls admit, by other valleys than those of the known ways.
    pub fn others(&self, known: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
        let near = self.triangles_near_the_best();
        let mut found: Vec<Vec<DVec2>> = Vec::new();
        for line in self.lines(&near) {
            for crossing in line.valleys() {
                let is_known = known.iter().chain(&found).any(|way| self.is_beside(way, crossing));
                if found.len() < MOST_WAYS && !is_known {
                    found.extend(self.way_by(crossing));
                }
            }
        }
        found
    }

    /// The distances that each march reached at least: those of the corners around the other place.
    fn farthest(&self) -> Distances {
        let [start, goal] = self.ends;
        [(self.marches[0], goal), (self.marches[1], start)].map(|(march, to)| {
            to.corner_nodes(self.mesh).into_iter().map(|node| march.value(node)).fold(0.0, f64::max)
        })
    }

    /// The distances of a node; `None` where a march did not come.
    fn distances(&self, node: u32, farthest: Distances) -> Option<Distances> {
        let [us, ug] = self.marches.map(|march| march.value(node));
        (us < farthest[0] && ug < farthest[1]).then_some([us, ug])
    }

    /// The triangles around the nodes on ways that cost little more than the best one, in their order, with
    /// the distances of their corners.
    fn triangles_near_the_best(&self) -> Vec<(u32, [Distances; 3])> {
        let farthest = self.farthest();
        let sum = |node: u32| self.distances(node, farthest).map_or(f64::INFINITY, |[us, ug]| us + ug);
        let nodes = 0..self.mesh.node_count() as u32;
        let best = nodes.clone().map(sum).fold(f64::INFINITY, f64::min);
        let most = best * (1.0 + MOST_EXCESS);
        let near = nodes.filter(|&node| sum(node) <= most);
        let mut triangles: Vec<u32> = near.flat_map(|node| self.mesh.around(node).to_vec()).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let with_distances = |triangle: u32| {
            let corners = self.mesh.triangles[triangle as usize].corners;
            let [a, b, c] = corners.map(|node| self.distances(node, farthest));
            Some((triangle, [a?, b?, c?]))
        };
        let open = triangles.into_iter().filter(|&triangle| self.mesh.passage(triangle) == Passage::Open);
        open.filter_map(with_distances).collect()
    }

    /// Where the lines cross edges.
    fn lines(&self, near: &[(u32, [Distances; 3])]) -> Vec<CrossLine> {
        let mut lines: Vec<CrossLine> = (1..PARTS).map(|_| CrossLine::default()).collect();
        for &(triangle, distances) in near {
            let parts = distances.map(|[us, ug]| f64::from(PARTS) * us / (us + ug));
            let [first, last] = [f64::min, f64::max].map(|of| parts.into_iter().reduce(of).unwrap_or(0.0));
            for number in (first.floor() as u32 + 1).max(1)..=(last.floor() as u32).min(PARTS - 1) {
                self.cross(&mut lines[number as usize - 1], number, triangle, distances);
            }
        }
        lines
    }

    /// Adds where a line crosses the edges of a triangle.
    fn cross(&self, line: &mut CrossLine, number: u32, triangle: u32, distances: [Distances; 3]) {
        let share = f64::from(number) / f64::from(PARTS);
        let heights = distances.map(|[us, ug]| (1.0 - share) * us - share * ug);
        let corners = self.mesh.triangles[triangle as usize].corners;
        let mut own = Vec::with_capacity(2);
        for [i, j] in crossed_edges(heights) {
            let part = heights[i] / (heights[i] - heights[j]);
            let [from, to] = [i, j].map(|k| self.mesh.nodes[corners[k] as usize]);
            let [at_from, at_to] = [i, j].map(|k| distances[k][0] + distances[k][1]);
            let sum = at_from + part * (at_to - at_from);
            let crossing = Crossing { at: from.lerp(to, part), triangle, sum };
            own.push(line.add([corners[i], corners[j]], crossing));
        }
        if let [a, b] = own[..] {
            line.links.push([a, b]);
        }
    }

    /// Whether a way passes a crossing so near that it is in the same valley.
    fn is_beside(&self, way: &[DVec2], crossing: Crossing) -> bool {
        let reach = NEAR * self.mesh.diameter(crossing.triangle);
        way.windows(2).any(|pair| {
            let nearest = nearest_on_segment(crossing.at, [pair[0], pair[1]]);
            nearest.distance(crossing.at) <= reach && self.walls.admit(crossing.at, nearest)
        })
    }

    /// The way that both marches lead by a crossing.
    fn way_by(&self, crossing: Crossing) -> Option<Vec<DVec2>> {
        let point = self.mesh.moved_into(crossing.triangle, crossing.at);
        let via = MeshPlace { point, triangle: crossing.triangle };
        let [start, goal] = self.ends;
        let mut way = trace(self.mesh, self.costs, self.marches[0], [start, via])?;
        let mut rest = trace(self.mesh, self.costs, self.marches[1], [goal, via])?;
        rest.reverse();
        way.extend(&rest[1..]);
        self.walls.admit_all(&way).then_some(way)
    }
}

/// The edges of a triangle from a corner below zero to one that is not.
fn crossed_edges(heights: [f64; 3]) -> impl Iterator<Item = [usize; 2]> {
    let edges = [[0, 1], [1, 2], [2, 0], [1, 0], [2, 1], [0, 2]];
    edges.into_iter().filter(move |&[i, j]| heights[i] < 0.0 && heights[j] >= 0.0)
}

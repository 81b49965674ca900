use std::f64::consts::TAU;

use super::Extract;
use crate::geometry::NumberMap;
use crate::mesh::kernel::NodeId;

impl Extract<'_> {
    /// Returns the boundary as closed loops that contain each boundary edge once. A loop is a list of nodes;
    /// each edge runs from a node to the next, the last one back to the first, with the domain on its left.
    /// Where the boundary touches itself in a node, a loop stays at the same piece of the outside.
    pub fn boundary_loops(&self) -> Vec<Vec<usize>> {
        let starts: Vec<usize> = self.boundary_edges().map(|edge| edge.ends[0]).collect();
        let nodes = |edges: Vec<usize>| edges.into_iter().map(|edge| starts[edge]).collect();
        self.boundary_edge_loops().into_iter().map(nodes).collect()
    }

    /// Returns the loops of [`Self::boundary_loops`] with the numbers of the edges in
    /// [`Self::boundary_edges`] in place of their first nodes.
    pub fn boundary_edge_loops(&self) -> Vec<Vec<usize>> {
        let edges: Vec<[usize; 2]> = self.boundary_edges().map(|edge| edge.ends).collect();
        let mut leaving: NumberMap<usize, Vec<usize>> = NumberMap::default();
        for (index, [from, _]) in edges.iter().enumerate() {
            leaving.entry(*from).or_default().push(index);
        }
        let next = |edge: usize| {
            let [from, to] = edges[edge];
            let turn = |&onward: &usize| outer_angle(self, [from, to, edges[onward][1]]);
            leaving.get(&to)?.iter().copied().min_by(|a, b| turn(a).total_cmp(&turn(b)))
        };
        let mut drawn = vec![false; edges.len()];
        let mut loops = Vec::new();
        for start in 0..edges.len() {
            let mut loop_edges = Vec::new();
            let mut edge = Some(start);
            // Ends: each iteration takes an edge that was not taken before.
            while let Some(now) = edge.filter(|&now| !std::mem::replace(&mut drawn[now], true)) {
                loop_edges.push(now);
                edge = next(now);
            }
            if !loop_edges.is_empty() {
                loops.push(loop_edges);
            }
        }
        loops
    }
}

/// Returns the angle of the outside at the middle one of three nodes: on the right of the path from the first
/// to the last.
fn outer_angle(mesh: &Extract, nodes: [usize; 3]) -> f64 {
    let [from, at, to] = nodes.map(|node| mesh.node(NodeId::from_index(node)).as_dvec2());
    let (back, onward) = (from - at, to - at);
    (onward.to_angle() - back.to_angle()).rem_euclid(TAU)
}

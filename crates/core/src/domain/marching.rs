//! Marching squares: rings through the edges of a grid whose ends lie on different sides.
//!
//! ```text
//!   3 ──2── 2      edges of a square between four nodes, and its corners; segments lead from an edge
//!   3       1      at which the way around the square leaves the inside to one at which it enters it,
//!   0 ──0── 1      so that the inside is on their left
//! ```

use std::collections::HashMap;

/// A node by column and row.
pub(super) type GridNode = [i64; 2];

/// An edge from a node to the next one along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct GridEdge {
    pub node: GridNode,
    pub axis: usize,
}

impl GridEdge {
    pub(super) fn ends(self) -> [GridNode; 2] {
        let mut end = self.node;
        end[self.axis] += 1;
        [self.node, end]
    }
}

/// A grid of nodes that are inside or outside.
pub(super) trait MarchingGrid {
    /// Returns whether a node is inside.
    fn is_inside(&self, node: GridNode) -> bool;

    /// Returns whether the inside of opposite corners of a square is joined in its middle.
    fn is_joined(&self, corners: [GridNode; 4]) -> bool;
}

/// Returns the rings through some squares, each given by its lower left node, with the inside on their left:
/// the edges that each ring crosses. No ring may leave these squares. Rings are sorted by their lowest edges
/// along x.
pub(super) fn rings(grid: &impl MarchingGrid, squares: impl Iterator<Item = GridNode>) -> Vec<Vec<GridEdge>> {
    let mut next: HashMap<GridEdge, GridEdge> = HashMap::new();
    squares.for_each(|square| add_segments(grid, square, &mut next));
    // Each ring crosses an edge along x.
    let mut starts: Vec<GridEdge> = next.keys().copied().filter(|edge| edge.axis == 0).collect();
    starts.sort_unstable_by_key(|edge| [edge.node[1], edge.node[0]]);
    let ring = |start: GridEdge| {
        let (mut ring, mut edge) = (Vec::new(), start);
        while let Some(following) = next.remove(&edge) {
            ring.push(edge);
            edge = following;
        }
        ring
    };
    starts.into_iter().map(ring).filter(|ring| !ring.is_empty()).collect()
}

/// Adds the segments in the square above and to the right of a node, each from an edge to another one.
fn add_segments(grid: &impl MarchingGrid, [x, y]: GridNode, next: &mut HashMap<GridEdge, GridEdge>) {
    let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
    let inside = corners.map(|node| grid.is_inside(node));
    if inside == [inside[0]; 4] {
        return;
    }
    let edges = [([x, y], 0), ([x + 1, y], 1), ([x, y + 1], 0), ([x, y], 1)];
    let edges = edges.map(|(node, axis)| GridEdge { node, axis });
    let leaves = |n: usize| inside[n] && !inside[(n + 1) % 4];
    let enters = |n: usize| !inside[n] && inside[(n + 1) % 4];
    let is_saddle = inside[0] == inside[2] && inside[1] == inside[3];
    let is_joined = is_saddle && grid.is_joined(corners);
    for from in (0..4).filter(|&n| leaves(n)) {
        // Around the corners outside that follow, or, where the inside meets at a corner only, around the one
        // inside.
        let step = if is_saddle && !is_joined { 3 } else { 1 };
        let ways = (1..4).map(|count| (from + step * count) % 4);
        if let Some(to) = ways.into_iter().find(|&n| enters(n)) {
            next.insert(edges[from], edges[to]);
        }
    }
}

//! The edges between two cells.

/// An edge between two cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct InnerEdge {
    /// Its nodes, the smaller number first.
    pub(super) ends: [usize; 2],
    /// The numbers of the cells on both sides, the smaller one first.
    pub(super) cells: [usize; 2],
}

/// Returns the edges that two cells have in common, in ascending order of their nodes. `sides` are the edges
/// of all cells, each with its cell.
pub(super) fn inner_edges(sides: impl Iterator<Item = (usize, [usize; 2])>) -> Vec<InnerEdge> {
    let mut sides: Vec<([usize; 2], usize)> =
        sides.map(|(cell, [from, to])| ([from.min(to), from.max(to)], cell)).collect();
    sides.sort_unstable();
    let pairs = sides.chunk_by(|a, b| a.0 == b.0).filter_map(|group| match group {
        [(ends, first), (_, second)] => Some(InnerEdge { ends: *ends, cells: [*first, *second] }),
        _ => None,
    });
    pairs.collect()
}

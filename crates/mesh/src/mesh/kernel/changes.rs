use std::ops::Range;

use super::{Bitset, Mesh, NodeId, TriangleId};
use crate::geometry::LatticeRect;

/// Which entries of a mesh's two arrays have changed since the last time this was asked.
///
/// Ranges count entries of the arrays as they are now; they ascend and do not touch. Entries that are new are
/// among them; an array may also have become shorter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Changed ranges of [`Mesh::nodes`](crate::mesh::Mesh::nodes).
    pub nodes: Vec<Range<usize>>,
    /// Changed ranges of [`Mesh::triangles`](crate::mesh::Mesh::triangles).
    pub triangles: Vec<Range<usize>>,
    /// Rectangles in which target diameters may have changed: where nodes are moved to an outline, or edges
    /// made along lines, the lengths of edges depend on them. Empty without either.
    pub retargeted: Vec<LatticeRect>,
}

/// Most rectangles with changed targets; more are joined.
const MOST_RETARGETED: usize = 32;

impl Changes {
    /// Takes in what changed after this, in `mesh` as it is now.
    pub fn extend(&mut self, later: &Self, mesh: &Mesh) {
        join(&mut self.nodes, &later.nodes, mesh.raw_nodes().len());
        join(&mut self.triangles, &later.triangles, mesh.raw_triangle_count());
        let new = later.retargeted.iter().filter(|area| !self.retargeted.contains(area));
        self.retargeted.extend(new.copied().collect::<Vec<_>>());
        if self.retargeted.len() > MOST_RETARGETED {
            self.retargeted = self.retargeted.drain(..).reduce(|a, b| a.union(&b)).into_iter().collect();
        }
    }
}

/// Merges both lists of ranges into one that ascends, in which no two ranges touch, up to `end`.
fn join(ranges: &mut Vec<Range<usize>>, later: &[Range<usize>], end: usize) {
    ranges.extend_from_slice(later);
    ranges.sort_unstable_by_key(|range| range.start);
    let mut joined: Vec<Range<usize>> = Vec::with_capacity(ranges.len());
    for range in
        ranges.drain(..).map(|range| range.start..range.end.min(end)).filter(|range| !range.is_empty())
    {
        match joined.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => joined.push(range),
        }
    }
    *ranges = joined;
}

/// [`Changes`] as they come about.
#[derive(Clone, Debug, Default)]
pub(super) struct ChangeLog {
    pub(super) nodes: Bitset,
    pub(super) triangles: Bitset,
    /// How many times something changed.
    steps: u64,
    steps_taken: u64,
}

impl ChangeLog {
    #[inline]
    pub(super) fn node(&mut self, id: NodeId) {
        self.nodes.insert(id.index());
    }

    #[inline]
    pub(super) fn triangle(&mut self, id: TriangleId) {
        self.triangles.insert(id.index());
    }

    /// Must be called for every change, even if an array only became shorter.
    #[inline]
    pub(super) fn step(&mut self) {
        self.steps += 1;
    }

    /// Returns the changes since the last call, or `None` if there are none.
    pub(super) fn take(&mut self) -> Option<Changes> {
        let (nodes, triangles) = (self.nodes.take_ranges(), self.triangles.take_ranges());
        let taken = std::mem::replace(&mut self.steps_taken, self.steps);
        (taken != self.steps).then_some(Changes { nodes, triangles, retargeted: Vec::new() })
    }
}

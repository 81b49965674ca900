use std::ops::Range;

use super::marks::Marks;
use super::{NodeId, TriangleId};

/// Which entries of a mesh's two arrays differ from what they were when this was last asked.
///
/// Ranges count entries of the arrays as they are now; they ascend and do not touch. Entries that are new are among them; an
/// array may also have become shorter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Of [`Mesh::nodes`](super::Mesh::nodes).
    pub nodes: Vec<Range<usize>>,
    /// Of [`Mesh::triangles`](super::Mesh::triangles).
    pub triangles: Vec<Range<usize>>,
}

/// [`Changes`] as they come about.
#[derive(Clone, Debug, Default)]
pub(super) struct ChangeLog {
    pub(super) nodes: Marks,
    pub(super) triangles: Marks,
    /// How many times nodes were created or removed.
    steps: u64,
    steps_told: u64,
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

    /// To be called for every change: it may be that an array became shorter, and nothing else.
    #[inline]
    pub(super) fn step(&mut self) {
        self.steps += 1;
    }

    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    /// What changed since this was last asked, `None` if nothing did.
    pub(super) fn take(&mut self) -> Option<Changes> {
        let (nodes, triangles) = (self.nodes.take_ranges(), self.triangles.take_ranges());
        let told = std::mem::replace(&mut self.steps_told, self.steps);
        (told != self.steps).then_some(Changes { nodes, triangles })
    }
}

//! What is wrong with triangles along a boundary.

use crate::geometry::LatticePoint;
use crate::mesh::{NodeId, TriangleId};
use crate::outline::angles::{Angles, COT_25};
use crate::outline::local::PatchedMesh;

/// Most triangles at a node.
pub(super) const MOST_AT_A_NODE: usize = 8;

/// For each node, the triangles at it, and whether it is on the boundary.
///
/// The latter is known by the nodes around it. Going around an inner node, each of these is entered as often
/// as it is left, so the sum of all differences is 0; at a node on the boundary, the ends of its fans are
/// left over.
#[derive(Default)]
pub(in crate::outline) struct BoundaryCensus {
    counts: Vec<u32>,
    sums: Vec<u64>,
}

impl BoundaryCensus {
    /// Counts in one pass over all triangles.
    pub(super) fn of_all(whole: &PatchedMesh) -> Self {
        let mut census = Self::default();
        census.grow(whole.points.len());
        for owner in (0..whole.mesh.raw_triangle_count()).map(TriangleId::from_index) {
            whole.pieces_of(owner).for_each(|t| census.add(t.corners.map(|v| v.index())));
        }
        census
    }

    /// Counts a triangle.
    pub(in crate::outline) fn add(&mut self, corners: [usize; 3]) {
        self.grow(corners.into_iter().fold(0, |most, v| most.max(v + 1)));
        for i in 0..3 {
            let [at, next, last] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
            self.counts[at] += 1;
            self.sums[at] = self.sums[at].wrapping_add(mixed(next)).wrapping_sub(mixed(last));
        }
    }

    fn grow(&mut self, nodes: usize) {
        if nodes > self.counts.len() {
            self.counts.resize(nodes, 0);
            self.sums.resize(nodes, 0);
        }
    }

    pub(super) fn count(&self, node: usize) -> usize {
        self.counts[node] as usize
    }

    pub(super) fn is_on_boundary(&self, node: usize) -> bool {
        self.sums[node] != 0
    }

    /// Returns whether a triangle is a defect, or beside a node that is one.
    pub(super) fn has_defect(&self, nodes: [NodeId; 3], corners: [LatticePoint; 3], angles: &Angles) -> bool {
        let nodes = nodes.map(|v| v.index());
        nodes.iter().all(|&v| self.is_on_boundary(v))
            || nodes.iter().any(|&v| self.count(v) > MOST_AT_A_NODE)
            || angles.worst(corners) > COT_25
    }
}

/// Returns a number without a pattern for each node, so that the sums of different nodes differ (SplitMix64).
fn mixed(node: usize) -> u64 {
    let mut x = (node as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

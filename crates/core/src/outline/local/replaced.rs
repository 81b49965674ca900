//! Writes local triangles into a patch.

use super::{LocalMesh, PatchedMesh, PatchedTriangle};
use crate::geometry::{LatticePoint, NumberMap};
use crate::mesh::{MeshPatch, NodeId, PatchTriangle, TriangleId};
use crate::outline::angles::Angles;
use crate::outline::triangulation::NONE;

impl LocalMesh {
    /// Writes the triangles into a patch in place of those that they were made from.
    pub(in crate::outline) fn write(
        &self,
        whole: &PatchedMesh,
        start: &Self,
        angles: &Angles,
        to: &mut Replaced,
    ) {
        let mut used = vec![false; self.points.len()];
        self.triangles
            .corners
            .iter()
            .flatten()
            .filter(|&&v| v != NONE)
            .for_each(|&v| used[v as usize] = true);
        let mut ids = self.ids.clone();
        for (&at, &is_used) in self.points.iter().zip(&used).skip(self.ids.len()) {
            // The number of one without triangles is never read.
            ids.push(NodeId::from_index(whole.points.len() + to.added.len()));
            to.added.extend(is_used.then_some(at));
        }
        let is_moved = |v: u32| start.points.get(v as usize).is_some_and(|&at| at != self.points[v as usize]);
        let changed = (0..self.ids.len()).filter(|&v| used[v] && is_moved(v as u32));
        to.moved.extend(changed.map(|v| (self.ids[v], self.points[v])));
        // Triangles keep their numbers while they change.
        for (t, &owner) in self.owners.iter().enumerate() {
            let former = start.owners.get(t).copied().flatten();
            let (is, was) = (self.triangles.corners[t], start.triangles.corners.get(t));
            let stays = was.is_some_and(|&was| owner.is_some() && (0..3).any(|i| is == turned(was, i)));
            if let Some(owner) = former.filter(|_| !stays) {
                let corners = start.triangles.corners[t].map(|v| ids[v as usize]);
                to.gone.push(PatchedTriangle { owner, corners });
            }
            if let Some(owner) = owner.filter(|_| !stays || is.iter().any(|&v| is_moved(v))) {
                let corners =
                    turned(is, longest_edge(self.corners(t as u32), angles)).map(|v| ids[v as usize]);
                if stays {
                    to.gone.push(PatchedTriangle { owner, corners });
                }
                to.pieces.push(PatchedTriangle { owner, corners });
            }
        }
        to.edges.extend(self.fixed.iter().map(|(ends, &segment)| (segment, ends.map(|v| ids[v as usize]))));
    }
}

/// What takes the place of some triangles of a mesh with a patch.
#[derive(Default)]
pub(in crate::outline) struct Replaced {
    pub(in crate::outline) added: Vec<LatticePoint>,
    pub(in crate::outline) moved: Vec<(NodeId, LatticePoint)>,
    pub(in crate::outline) gone: Vec<PatchedTriangle>,
    pub(in crate::outline) pieces: Vec<PatchedTriangle>,
    /// The edges on segments.
    pub(in crate::outline) edges: Vec<(u32, [NodeId; 2])>,
}

impl Replaced {
    /// Returns the patch with the changes.
    pub(in crate::outline) fn into_patch(mut self, whole: &PatchedMesh) -> MeshPatch {
        let sorted = |mut corners: [NodeId; 3]| {
            corners.sort_unstable();
            corners
        };
        let former = &whole.patch;
        let raw = whole.mesh.raw_nodes().len();
        let mut patch = MeshPatch { added: former.added.clone(), ..MeshPatch::default() };
        patch.added.append(&mut self.added);
        let mut moved: NumberMap<u32, LatticePoint> =
            former.moved.iter().map(|&(id, at)| (id.index() as u32, at)).collect();
        for (id, at) in self.moved {
            match id.index().checked_sub(raw) {
                Some(added) => patch.added[added] = at,
                None => {
                    moved.insert(id.index() as u32, at);
                }
            }
        }
        let is_moved = |(id, at): &(NodeId, LatticePoint)| whole.mesh.node(*id) != *at;
        let moved = moved.into_iter().map(|(id, at)| (NodeId::from_index(id as usize), at));
        patch.moved = moved.filter(is_moved).collect();
        patch.moved.sort_unstable_by_key(|(id, _)| *id);
        let mut gone: Vec<(TriangleId, [NodeId; 3])> =
            self.gone.iter().map(|t| (t.owner, sorted(t.corners))).collect();
        gone.sort_unstable();
        self.pieces.sort_by_key(|t| t.owner);
        let mut owners: Vec<TriangleId> = self.gone.iter().chain(&self.pieces).map(|t| t.owner).collect();
        owners.extend(former.changed.iter().map(|(id, _)| *id));
        owners.sort_unstable();
        owners.dedup();
        let mut pieces = self.pieces.into_iter().peekable();
        for owner in owners {
            let first = patch.pieces.len();
            let level = whole.mesh.triangle(owner).level();
            let stays = |t: &PatchedTriangle| gone.binary_search(&(t.owner, sorted(t.corners))).is_err();
            let staying = whole.pieces_of(owner).filter(stays);
            patch.pieces.extend(staying.map(|t| PatchTriangle { corners: t.corners, level }));
            while let Some(piece) = pieces.next_if(|piece| piece.owner == owner) {
                patch.pieces.push(PatchTriangle { corners: piece.corners, level });
            }
            patch.changed.push((owner, first..patch.pieces.len()));
        }
        patch
    }
}

fn turned([a, b, c]: [u32; 3], i: usize) -> [u32; 3] {
    [[a, b, c], [b, c, a], [c, a, b]][i]
}

/// Returns the place of the corner at which the longest edge begins.
fn longest_edge(corners: [LatticePoint; 3], angles: &Angles) -> usize {
    let length = |i: usize| angles.vector(corners[i], corners[(i + 1) % 3]).length_squared();
    (1..3).fold(0, |best, i| if length(i) > length(best) { i } else { best })
}

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
        let used = self.used();
        let mut ids = self.ids.clone();
        for (&at, &is_used) in self.points.iter().zip(&used).skip(self.ids.len()) {
            // The number of one without triangles is never read.
            ids.push(NodeId::from_index(whole.points.len() + to.added.len()));
            to.added.extend(is_used.then_some(at));
        }
        let changed = (0..self.ids.len()).filter(|&v| used[v] && self.is_moved(start, v as u32));
        to.moved.extend(changed.map(|v| (self.ids[v], self.points[v])));
        let numbered = |LocalTriangle { owner, corners, .. }: LocalTriangle| PatchedTriangle {
            owner,
            corners: corners.map(|v| ids[v as usize]),
        };
        for change in self.changed(start, angles) {
            to.gone.extend(change.gone.map(numbered));
            to.pieces.extend(change.piece.map(numbered));
        }
        to.edges.extend(self.fixed.iter().map(|(ends, &segment)| (segment, ends.map(|v| ids[v as usize]))));
    }
}

/// A local triangle, by its number there and those of its corners.
#[derive(Clone, Copy)]
pub(in crate::outline) struct LocalTriangle {
    pub(in crate::outline) number: u32,
    /// The triangle of the mesh whose place it takes.
    pub(in crate::outline) owner: TriangleId,
    pub(in crate::outline) corners: [u32; 3],
}

/// What became of a local triangle that is not as it was.
pub(in crate::outline) struct ChangedTriangle {
    /// As it was.
    pub(in crate::outline) gone: Option<LocalTriangle>,
    /// As it is, beginning with the ends of its longest edge.
    pub(in crate::outline) piece: Option<LocalTriangle>,
}

impl LocalMesh {
    /// Returns for each node whether a triangle has it.
    pub(in crate::outline) fn used(&self) -> Vec<bool> {
        let mut used = vec![false; self.points.len()];
        let corners = self.triangles.corners.iter().flatten().filter(|&&v| v != NONE);
        corners.for_each(|&v| used[v as usize] = true);
        used
    }

    /// Returns whether a node of the start is elsewhere.
    pub(in crate::outline) fn is_moved(&self, start: &Self, v: u32) -> bool {
        start.points.get(v as usize).is_some_and(|&at| at != self.points[v as usize])
    }

    /// Returns the triangles that are not as they were at the start.
    pub(in crate::outline) fn changed<'a>(
        &'a self,
        start: &'a Self,
        angles: &'a Angles,
    ) -> impl Iterator<Item = ChangedTriangle> + 'a {
        // Triangles keep their numbers while they change.
        let of_number = |(t, &owner): (usize, &Option<TriangleId>)| {
            let number = t as u32;
            let former = start.owners.get(t).copied().flatten();
            let (is, was) = (self.triangles.corners[t], start.triangles.corners.get(t));
            let stays = was.is_some_and(|&was| owner.is_some() && (0..3).any(|i| is == turned(was, i)));
            let is_same = stays && !is.iter().any(|&v| self.is_moved(start, v));
            let before = |owner| LocalTriangle { number, owner, corners: start.triangles.corners[t] };
            let now = |owner| {
                let corners = turned(is, longest_edge(self.corners(number), angles));
                LocalTriangle { number, owner, corners }
            };
            (!is_same).then(|| ChangedTriangle { gone: former.map(before), piece: owner.map(now) })
        };
        self.owners.iter().enumerate().filter_map(of_number)
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

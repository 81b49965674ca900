//! The stages in which a mesh becomes the derived one, for whoever wants to watch.

use super::DerivedMesh;
use super::lengths::EdgeTargets;
use crate::domain::DomainOnLattice;
use crate::geometry::LatticePoint;
use crate::mesh::{Cleaning, Mesh, MeshPatch, NodeId, PatchTriangle, TriangleId};

/// What a stage does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DerivationAction {
    /// Removes triangles whose centroid is not in the domain.
    RemoveByCentroid,
    /// Removes triangles without a corner in the domain.
    RemoveByCorners,
    /// Moves nodes to the nearest point where the outline crosses an edge of theirs.
    MoveToOutline,
    /// Cuts edges that the outline still crosses, and removes what lies outside.
    CutEdges,
    /// Moves nodes to sharp corners of the outline.
    MoveToCorners,
    /// Moves nodes back towards home where an angle is too small, or an edge too long.
    Retreat,
    /// Halves edges that are longer than their target.
    HalveEdges,
    /// Flips edges for larger angles.
    FlipEdges,
    /// Shifts nodes for larger angles.
    ShiftNodes,
    /// Moves nodes of the boundary that are off the outline onto it.
    PullToOutline,
    /// Removes parts and nodes where the domain touches itself.
    Clean,
}

/// A stage, with the differences from the mesh after it.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivationStage {
    /// What it does.
    pub action: DerivationAction,
    /// The differences from the mesh of right-angled triangles.
    pub patch: MeshPatch,
}

/// Is notified of each stage, with a function that returns the differences from the mesh after it.
pub(super) type Watch<'a> = &'a mut dyn FnMut(DerivationAction, &dyn Fn() -> MeshPatch);

/// Returns the stages of [`DerivedMesh::new`] that change anything. After the last one, the mesh is the
/// derived one.
pub fn derivation_stages(
    mesh: &Mesh,
    domain: &DomainOnLattice,
    targets: Option<EdgeTargets>,
    cleaning: &Cleaning,
) -> Vec<DerivationStage> {
    let mut stages: Vec<DerivationStage> = Vec::new();
    DerivedMesh::watched(mesh, domain, targets, cleaning, &mut |action, patch| {
        let patch = patch();
        let has_changed = match stages.last() {
            Some(former) => former.patch != patch,
            None => !patch.is_empty() || mesh.outside_count() > 0,
        };
        if has_changed {
            stages.push(DerivationStage { action, patch });
        }
    });
    stages
}

/// Returns the mesh without the triangles that have no corner in the domain. `signs` says of each node
/// whether it is in the domain, and `moved` which nodes lie elsewhere, in ascending order.
pub(super) fn without_outside(mesh: &Mesh, signs: &[bool], moved: Vec<(NodeId, LatticePoint)>) -> MeshPatch {
    let mut patch = MeshPatch { moved, ..MeshPatch::default() };
    for (index, triangle) in mesh.raw_triangles().iter().enumerate() {
        let stays = triangle.vertices.iter().any(|node| signs[node.index()]);
        if stays != triangle.is_outside() {
            continue;
        }
        let (first, level) = (patch.pieces.len(), triangle.level());
        let corners = triangle.edge_nodes().map(|(from, _)| from);
        patch.pieces.extend(stays.then_some(PatchTriangle { corners, level }));
        patch.changed.push((TriangleId::from_index(index), first..patch.pieces.len()));
    }
    patch
}

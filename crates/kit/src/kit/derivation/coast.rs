//! The derived mesh on the screen: nodes on the outline, triangles along it and edges along lines that are
//! kept in step with the follower's mesh.
//!
//! A job derives them once. From then on they follow each change of the mesh, before it is drawn, so that the
//! screen shows the derived mesh also while a stroke is drawn.

use std::collections::HashSet;

use crate::kit::platform::IS_PAGE;
use meshbrush_core::document::{Follower, MeshChange};
use meshbrush_core::layers::PaintLayers;
use meshbrush_core::outline::{DerivedFollower, DerivedMesh};
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{Changes, Mesh, Replacement, TriangleId};

/// Most triangles that come near the outline in one frame while it is kept in step, and most that are changed
/// again along lines or for a better boundary. With more, the mesh is derived from scratch by a job: on
/// another thread that takes as long as a few frames. A page has one thread.
const MOST_AT_ONCE: usize = if IS_PAGE { 32 } else { 4096 };

/// The triangles that cleaning removed from a derived mesh, by their corners in ascending order.
#[derive(Debug, Default)]
pub(super) struct RemovedTriangles(HashSet<[LatticePoint; 3]>);

impl RemovedTriangles {
    pub(super) fn of(derived: &DerivedMesh) -> Self {
        Self(derived.removed_triangles().iter().copied().map(sorted).collect())
    }

    fn contains(&self, corners: [LatticePoint; 3]) -> bool {
        self.0.contains(&sorted(corners))
    }
}

fn sorted(mut corners: [LatticePoint; 3]) -> [LatticePoint; 3] {
    corners.sort_unstable();
    corners
}

/// What is kept in step, once a job has derived it.
#[derive(Default)]
pub(super) struct Coast {
    derived: Option<DerivedFollower>,
    /// A former one, which another thread is to drop.
    useless: Option<DerivedFollower>,
    /// What the last derived mesh is without. Which parts of a mesh are too small is known for the whole mesh
    /// only, so edits do not change it: what was removed stays removed until the next mesh is derived, and
    /// triangles that come meanwhile are drawn, also where they join or divide removed ones.
    removed: RemovedTriangles,
}

impl Coast {
    /// Returns whether it belongs to the domain of the follower. It is then in step with the mesh.
    pub(super) fn is_of(&self, follower: &Follower) -> bool {
        let cleaning = follower.settings().derived_cleaning();
        self.derived.as_ref().is_some_and(|derived| derived.is_of(follower.domain(), &cleaning))
    }

    /// Returns whether nothing was removed.
    #[cfg(any(test, feature = "hooks"))]
    pub(super) fn is_whole(&self) -> bool {
        self.removed.0.is_empty()
    }

    /// Takes in a change of the mesh and of the targets of edges, and returns the triangles whose pieces may
    /// be others than before; `None` if it is no longer in step.
    pub(super) fn follow(
        &mut self,
        follower: &Follower,
        paint: &PaintLayers,
        changes: &Changes,
    ) -> Option<Vec<TriangleId>> {
        let is_of_domain = self.is_of(follower);
        let derived = self.derived.as_mut()?;
        let targets = follower.edge_targets(paint);
        let update = || derived.update(follower.mesh(), targets, changes, MOST_AT_ONCE);
        let replaced = is_of_domain.then(update).flatten();
        if replaced.is_none() {
            self.forget();
        }
        replaced
    }

    /// Begins with what was derived before a change of the mesh. Returns what [`Self::follow`] returns.
    pub(super) fn begin(
        &mut self,
        derived: DerivedFollower,
        follower: &Follower,
        paint: &PaintLayers,
        since: Option<&MeshChange>,
    ) -> Option<Vec<TriangleId>> {
        self.forget();
        self.derived = Some(derived);
        let unchanged = Changes::default();
        match since {
            None => self.follow(follower, paint, &unchanged),
            Some(MeshChange::Within(changes)) => self.follow(follower, paint, changes),
            Some(MeshChange::Replaced) => {
                self.forget();
                None
            }
        }
    }

    /// Notes what a derived mesh is without. One of another domain ends the coast.
    pub(super) fn remove(&mut self, removed: RemovedTriangles, follower: &Follower) {
        self.removed = removed;
        if !self.is_of(follower) {
            self.forget();
        }
    }

    /// Stops keeping anything in step.
    pub(super) fn forget(&mut self) {
        self.useless = self.derived.take().or(self.useless.take());
    }

    /// Returns what was kept in step before, to be dropped.
    pub(super) fn take_useless(&mut self) -> Option<DerivedFollower> {
        self.useless.take()
    }

    /// Returns what is drawn in place of triangles of the mesh, which the coast must be in step with.
    pub(super) fn replacements(&self, mesh: &Mesh, ids: &[TriangleId]) -> impl Iterator<Item = Replacement> {
        let derived = self.derived.iter();
        derived.flat_map(|derived| {
            ids.iter().map(|&id| self.without_removed(mesh, derived.replacement(mesh, id)))
        })
    }

    fn without_removed(&self, mesh: &Mesh, mut replacement: Replacement) -> Replacement {
        match &mut replacement.pieces {
            Some(pieces) => pieces.retain(|piece| !self.removed.contains(piece.corners)),
            None if mesh.is_in_domain(replacement.id) && self.removed.contains(replacement.nodes) => {
                replacement.pieces = Some(Vec::new());
            }
            None => {}
        }
        replacement
    }
}

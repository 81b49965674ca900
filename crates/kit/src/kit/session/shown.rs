//! What is shown and queried: the mesh, and what is derived from it.

use glam::DVec2;

use super::Session;
use crate::kit::derivation::{Derivation, Derived, ShownChange};
use crate::kit::heights::Heights;
use crate::kit::jobs::Jobs;
use crate::kit::readout::{Quantity, Readout};
use meshbrush_core::domain::BoundaryPieces;
use meshbrush_core::explain::AgesNow;
use meshbrush_core::layers::Decision;
use meshbrush_mesh::mesh::{Location, MeshView, TriangleId};

impl Session {
    /// Returns the mesh that is derived along the outline of the domain; `None` without an outline, and until
    /// it is derived.
    pub fn derived(&self) -> Option<&Derived> {
        self.derived.mesh.current(&self.live.follower)
    }

    /// Returns the mesh that is shown and queried: the derived one, or else the follower's.
    pub fn view(&self) -> MeshView<'_> {
        self.derived().map_or_else(|| self.mesh().view(), Derived::view)
    }

    /// Finds a point in world units in [`Self::view`].
    pub fn locate(&self, point: DVec2) -> Location {
        let in_mesh = self.mesh().locate(point);
        self.derived().map_or(in_mesh, |derived| derived.locate(point, in_mesh))
    }

    /// Returns h̄ at a point in world units and the layer that decides it, for the mesh that is shown.
    pub fn decision_at(&self, point: DVec2) -> Decision {
        self.live.readings.borrow_mut().decision_at(&self.live.document, &self.live.follower, point)
    }

    /// Returns whether ids of [`Self::view`] are the numbers in files.
    pub fn has_file_numbers(&self) -> bool {
        self.derived().is_some() || !self.live.follower.settings().is_derived()
    }

    /// Returns how many triangles the domain has.
    pub fn triangle_count(&self) -> usize {
        let counts = self.derived().map(|derived| derived.level_counts.iter().sum());
        counts.unwrap_or_else(|| self.mesh().triangle_count())
    }

    /// Returns the triangles per level.
    pub fn level_counts(&self) -> Vec<usize> {
        self.derived().map_or_else(|| self.mesh().level_counts(), |derived| derived.level_counts.clone())
    }

    /// Returns the derived mesh that is drawn.
    pub fn derivation(&self) -> &Derivation {
        &self.derived.mesh
    }

    /// Takes and starts work on the derived mesh, waiting for it as long as the frame may. Returns whether
    /// some is left.
    pub fn advance_derivation(&mut self, jobs: &Jobs) -> bool {
        let in_gesture = self.live.document.is_in_gesture() || self.is_cutting();
        self.derived.mesh.advance(&self.live.follower, self.live.document.paint(), in_gesture, jobs)
    }

    /// Returns the pieces of the boundary; `None` until [`Self::find_boundary`] has found them.
    pub fn boundary_pieces(&self) -> Option<&BoundaryPieces> {
        self.derived.boundary.pieces(&self.live.document)
    }

    /// Returns the numbers of the pieces of which the mesh has no edge; `None` until they are found.
    pub fn lost_boundary_pieces(&self) -> Option<&[usize]> {
        self.derived.boundary.lost(&self.live.document, self.derived()?)
    }

    /// Finds the pieces of the boundary, waiting for them as long as the frame may. Returns whether some are
    /// being found.
    pub fn find_boundary(&mut self, jobs: &Jobs) -> bool {
        let derived = self.derived.mesh.current(&self.live.follower);
        self.derived.boundary.advance(&self.live.document, &self.live.follower, derived, jobs)
    }

    /// Returns how many edits ago each triangle of the follower's mesh came.
    pub fn ages(&self) -> AgesNow {
        self.derived.ages.snapshot()
    }

    /// Returns the heights of the mesh on the screen; [`Self::find_heights`] finds them.
    pub fn heights(&self) -> Heights<'_> {
        self.derived.heights.heights(&self.live.document, &self.live.follower, self.derivation())
    }

    /// Returns whether the heights of the mesh on the screen are still being found.
    pub fn seeks_heights(&self) -> bool {
        match self.heights() {
            Heights::Known(surface) => !surface.is_current(),
            Heights::Sought => true,
            Heights::Missing => false,
        }
    }

    /// Finds the heights of the mesh while they are `wanted`, waiting for them as long as the frame may.
    /// Returns whether they are being found.
    pub fn find_heights(&mut self, wanted: bool, jobs: &Jobs) -> bool {
        if wanted {
            return self.derived.heights.advance(
                &self.live.document,
                &self.live.follower,
                &self.derived.mesh,
                jobs,
            );
        }
        self.derived.heights.stop(jobs);
        false
    }

    /// Returns the changes on the screen since the last call.
    pub fn take_shown_change(&mut self) -> ShownChange {
        ShownChange { mesh: self.derived.mesh_change.take(), pieces: self.derived.mesh.take_pieces_change() }
    }

    /// Queries a point in world units, or none. The trail to the former one ends.
    pub fn query(&mut self, point: Option<DVec2>) {
        self.query.point = point;
        self.query.trail.clear();
    }

    /// Queries the middle of a triangle after that of another one, which the trail keeps.
    pub fn query_next(&mut self, from: DVec2, to: DVec2) {
        if self.query.trail.is_empty() {
            self.query.trail.push(from);
        }
        self.query.trail.push(to);
        self.query.point = Some(to);
    }

    /// The middles of the triangles on the way to the queried one, in world units.
    pub fn trail(&self) -> &[DVec2] {
        &self.query.trail
    }

    /// Returns the queried point, in world units.
    pub fn queried(&self) -> Option<DVec2> {
        self.query.point
    }

    /// Returns the triangle around the queried point.
    pub fn queried_triangle(&self) -> Option<TriangleId> {
        self.query.point.and_then(|point| self.locate(point).triangle())
    }

    /// Returns the queried point and the triangle around it in the mesh on the screen.
    pub fn readout(&self, quantity: Quantity) -> Option<Readout> {
        self.query.point.map(|point| Readout::at(point, self, quantity))
    }
}

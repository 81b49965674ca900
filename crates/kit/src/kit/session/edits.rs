//! Edits of the document, what is drawn and on its way to it, and what is taken back.

use super::Session;
use crate::kit::jobs::Jobs;
use crate::kit::notices;
use meshbrush_core::build::BuildError;
use meshbrush_core::document::{DrawnPart, DrawnShape, Setting};
use meshbrush_core::domain::{BoundaryMarks, BoundaryPieces, CutShape};
use meshbrush_mesh::geometry::Rect;

impl Session {
    /// Changes a setting. What cannot be met is reported, and the document stays as it was.
    pub fn set(&mut self, setting: Setting) {
        self.guards.size.note(&setting, &self.live.document, &self.live.follower);
        match self.live.document.set(setting) {
            Ok(()) => self.notices.dismiss(),
            Err(error) => self.report_edit(error),
        }
    }

    /// Adds a shape to the domain (`true`) or removes it.
    pub fn reshape(&mut self, cut_shape: CutShape, adds: bool) {
        if self.live.document.settings().domain.formula().is_some() {
            self.report_edit(
                "The domain is given by a formula, and a formula has no outline to cut. Empty the row \"Domain where\" to \
                 start from the whole rectangle.",
            );
        } else {
            self.draw(DrawnPart::Domain, DrawnShape::Area(cut_shape), adds);
        }
    }

    /// Adds a shape to a part of the document (`true`) or cuts it away. Further shapes join the gesture.
    pub fn draw(&mut self, part: DrawnPart, shape: DrawnShape, adds: bool) {
        self.live.cuts.draw(part, shape, adds);
    }

    /// Gives the domain other bounds, in world units, as a gesture of its own.
    pub fn set_bounds(&mut self, bounds: Rect) {
        if self.live.document.settings().domain.region().is_some() {
            self.live.cuts.set_bounds(bounds);
        } else {
            self.set(Setting::Bounds(bounds));
        }
        self.end_gesture();
    }

    /// Ends a gesture with a setting, after the cuts that belong to it.
    pub fn end_gesture(&mut self) {
        self.live.cuts.end_gesture(&mut self.live.document);
    }

    /// Returns whether something that was drawn has not reached the document yet.
    pub fn is_cutting(&self) -> bool {
        !self.live.cuts.is_idle()
    }

    /// Returns the areas that have not reached the parts of the document that `counts` accepts.
    pub fn pending_cuts(&self, counts: impl Fn(DrawnPart) -> bool) -> impl Iterator<Item = &CutShape> {
        self.live.cuts.areas(counts)
    }

    /// Takes finished cuts into the document, waiting for them as long as the frame may. Returns whether any
    /// are left.
    pub fn advance_cuts(&mut self, jobs: &Jobs) -> bool {
        match self.live.cuts.advance(&mut self.live.document, jobs) {
            Ok(left) => left,
            Err(error) => {
                self.report_edit(error);
                self.is_cutting()
            }
        }
    }

    /// Drops the cut in progress: all of it, where the brush is still down.
    pub fn drop_cut(&mut self) {
        let begun = self.live.document.is_in_gesture();
        self.live.cuts.discard(&mut self.live.document);
        if begun {
            self.live.document.undo();
        }
    }

    /// Returns whether there is a gesture to take back, including one in progress.
    pub fn can_undo(&self) -> bool {
        let document = &self.live.document;
        document.history().undo_title().is_some() || document.stroke().is_some() || self.is_cutting()
    }

    /// Takes back the last gesture. One that has not reached the document is dropped.
    pub fn undo(&mut self) {
        if !self.live.cuts.discard(&mut self.live.document) {
            self.live.document.undo();
        }
    }

    /// Does the last undone gesture again.
    pub fn redo(&mut self) {
        self.live.cuts.discard(&mut self.live.document);
        self.live.document.redo();
    }

    /// What a change makes of the names and splits of the boundary.
    pub fn changed_marks(
        &self,
        change: impl FnOnce(&BoundaryPieces, &BoundaryMarks) -> Option<BoundaryMarks>,
    ) -> Option<BoundaryMarks> {
        change(self.boundary_pieces()?, &self.live.document.settings().boundary_marks)
    }

    /// Names and splits the boundary, as a gesture of its own.
    pub fn set_marks(&mut self, marks: Option<BoundaryMarks>) {
        if let Some(marks) = marks {
            self.set(Setting::BoundaryMarks(marks));
            self.end_gesture();
        }
    }

    /// Takes back the setting that made a mesh impossible. If paint did, the mesh stops, and a message says
    /// so.
    pub(super) fn take_back(&mut self, error: &BuildError) {
        let revision = self.live.document.revision();
        let is_other = self.live.document.settings() != self.live.follower.settings();
        if is_other || self.live.document.is_followed_in_place() {
            self.live.document.reject_last();
        }
        if self.live.document.revision() != revision {
            self.report_edit(format!("{error}{}", notices::advice(error)));
        } else {
            let is_other = self.live.document.settings() != self.live.follower.settings();
            let shows_former = is_other && !self.awaits_mesh();
            self.notices.stand(error, shows_former);
        }
    }
}

//! The mesh follows the document: as far as was agreed, and after a question further.

use super::{LiveDocument, Session};
use crate::kit::brake::Need;
use crate::kit::clock::{Duration, Instant};
use crate::kit::slices::{Followed, draw_stroke, follow_document};
use crate::kit::threads::Threads;
use meshbrush_core::document::{MeshChange, Stage};

impl Session {
    /// Draws the current stroke, and brings field and mesh closer to the document, on `threads` and until
    /// `deadline`. Returns whether work is left.
    ///
    /// Reports what turns out to be impossible. A setting that caused it is taken back; paint stays, for the
    /// user to undo or erase.
    pub fn follow(&mut self, threads: &Threads, deadline: Instant) -> bool {
        let began = self.clock.began.unwrap_or_else(Instant::now);
        self.derived.ages.look_at(&self.live.document);
        let revision = self.live.follower.revision();
        let left = self.follow_as_agreed(threads, deadline);
        if self.live.follower.stopped().is_none() && self.stage() != Stage::GaveUp(None) {
            self.notices.end_standing();
        }
        self.notices.forget_failed_edit(self.live.document.version());
        if !self.guards.brake.holds() {
            self.notices.end_question();
        }
        let left = left || !self.live.document.is_stroke_drawn();
        let changed = self.live.follower.revision() != revision;
        let was_in_progress = self.clock.began.is_some();
        self.clock.began = left.then_some(began);
        if !left && (was_in_progress || changed) {
            self.clock.last = Some(began.elapsed());
        }
        if let Some(change) = self.live.follower.take_change() {
            let (follower, paint) = (&self.live.follower, self.live.document.paint());
            self.derived.mesh.note_change(&change, follower, paint);
            self.derived.ages.note(&change, self.live.follower.mesh());
            MeshChange::join(&mut self.derived.mesh_change, change, self.live.follower.mesh());
        }
        let estimates = self.guards.brake.advance_stopped(&self.live.document, &self.live.follower, deadline);
        left | estimates | self.derived.ages.advance(self.live.follower.mesh(), deadline)
    }

    /// Brings the mesh closer to the document, up to the number of triangles for which a question is asked.
    /// Returns whether work is left that can be done now.
    pub(super) fn follow_as_agreed(&mut self, threads: &Threads, deadline: Instant) -> bool {
        let LiveDocument { document, follower, pace, .. } = &mut self.live;
        let brake = &mut self.guards.brake;
        if brake.holds_other(document.settings()) {
            // Or the follower would complete the mesh that is held, before that of the document.
            follower.drop_update();
        }
        let Some(most) = brake.most(document, follower) else {
            draw_stroke(document, deadline);
            let estimates = threads.run(|| brake.advance(document, follower, deadline));
            self.ask_first();
            return estimates || !self.guards.brake.holds();
        };
        match threads.run(|| follow_document(document, follower, pace, most, deadline)) {
            Ok(Followed::Wholly) => false,
            Ok(Followed::Partly) => true,
            Ok(Followed::TooFar) => {
                if let Stage::Refining { triangles } = follower.stage() {
                    brake.stop(document, follower, triangles);
                }
                true
            }
            Err(error) => {
                self.take_back(&error);
                true
            }
        }
    }

    /// Asks whether the mesh is to have very many triangles, while that is open.
    fn ask_first(&mut self) {
        let budget = self.live.document.settings().limits().most_triangles() as u64;
        // While a newer value is estimated, the question about the last one stays in its place.
        if let Some(need) = self.guards.brake.question() {
            self.notices.ask(need, self.guards.brake.triangles_before(), budget);
        }
    }

    /// Returns what the settings of the document need, while that is asked before the mesh follows them.
    pub fn question(&self) -> Option<Need> {
        self.guards.brake.question()
    }

    /// Returns what the document needs, where its mesh has less: it waits for an answer, or a budget stopped
    /// it.
    pub fn need(&self) -> Option<Need> {
        self.guards.brake.need()
    }

    /// Returns whether the mesh waits for an estimate or for an answer.
    pub fn is_held(&self) -> bool {
        self.guards.brake.holds()
    }

    /// Keeps the mesh, where a question is open: returns to the settings that it was made from. Returns
    /// whether there was a question.
    pub fn keep_mesh(&mut self) -> bool {
        let asks = self.guards.brake.holds();
        if let Some(settings) = self.guards.brake.kept_settings().filter(|_| asks) {
            let settings = settings.clone();
            self.live.document.return_to(&settings);
        }
        asks
    }

    /// Lets the mesh have the triangles that were asked for.
    pub fn apply_anyway(&mut self) {
        self.guards.brake.agree();
    }

    /// Stops the cuts in progress, or else the update of the mesh. The document keeps the edits that reached
    /// it; the notice says that the mesh lags behind.
    pub fn cancel_update(&mut self) {
        if self.is_cutting() {
            self.live.cuts.discard(&mut self.live.document);
            return;
        }
        self.live.follower.cancel(&self.live.document);
        self.notices.stand_cancelled(self.awaits_mesh());
    }

    /// Returns the time on the clock of the last complete update, from the edit to the mesh, with the frames
    /// drawn meanwhile.
    pub fn last_update(&self) -> Option<Duration> {
        self.clock.last
    }

    /// Returns the time on the clock since the update in progress began.
    pub fn update_so_far(&self) -> Option<Duration> {
        self.clock.began.map(|began| began.elapsed())
    }

    /// Returns the present stage of the update.
    pub fn stage(&self) -> Stage {
        self.live.follower.stage()
    }
}

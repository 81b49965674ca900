//! The document, the mesh that follows it, edits on their way to the document, and the queried point.

use crate::kit::clock::{Duration, Instant};
use std::cell::RefCell;

use glam::DVec2;

use super::ages::AgeKeeper;
use super::boundary::BoundaryFinder;
use super::brake::GrowthGuard;
use super::cuts::PolygonEditQueue;
use super::derivation::{Derivation, Derived, ShownChange};
use super::document_id::DocumentId;
use super::heights::HeightFinder;
use super::jobs::Jobs;
use super::notices::{self, Notices};
use super::readout::{Quantity, Readout};
use super::size_change::SizeChange;
use super::slices::SLICE;
use super::threads::Threads;
use meshbrush_core::build::BuildError;
use meshbrush_core::document::{
    Document, DrawnPart, DrawnShape, Follower, MeshChange, Pace, Pricer, Readings, Setting, Stage,
};
use meshbrush_core::domain::{BoundaryMarks, BoundaryPieces, CutShape};
use meshbrush_core::explain::AgesNow;
use meshbrush_core::layers::Decision;
use meshbrush_core::paint::StrokePlan;
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Location, Mesh, MeshView, Progress, TriangleId};

/// A document and its mesh in the window.
pub struct Session {
    pub(super) document: Document,
    pub(super) document_id: DocumentId,
    pub(super) follower: Follower,
    /// The size of the slices in which the follower works.
    pub(super) pace: Pace,
    /// A cache of values at points. It changes no result.
    readings: RefCell<Readings>,
    pricer: Pricer,
    /// The effect of the last edit of the size, and the price of the next.
    pub(super) size_change: SizeChange,
    /// Holds updates that need very many triangles.
    pub(super) brake: GrowthGuard,
    pub(super) cuts: PolygonEditQueue,
    queried: Option<DVec2>,
    /// The middles of the triangles on the way to the queried one, in world units.
    trail: Vec<DVec2>,
    pub(super) notices: Notices,
    /// When the update in progress began.
    update_began: Option<Instant>,
    last_update: Option<Duration>,
    pub(super) derivation: Derivation,
    boundary: BoundaryFinder,
    ages: AgeKeeper,
    pub(super) heights: HeightFinder,
    /// The change of the follower's mesh since the canvas last took it.
    mesh_change: Option<MeshChange>,
    /// The revision of the follower's mesh that stands for that of the document until that is made.
    pub(super) bare_revision: Option<u64>,
}

impl Session {
    /// Opens a document and builds its mesh in one step.
    ///
    /// # Errors
    /// Fails when no mesh can be built for it.
    pub fn new(mut document: Document) -> Result<Self, BuildError> {
        let began = Instant::now();
        document.record();
        let follower = Follower::new(&mut document)?;
        Ok(Self {
            document,
            document_id: DocumentId::default(),
            follower,
            pace: Pace::default(),
            readings: RefCell::default(),
            pricer: Pricer::default(),
            size_change: SizeChange::default(),
            brake: GrowthGuard::default(),
            cuts: PolygonEditQueue::default(),
            queried: None,
            trail: Vec::new(),
            notices: Notices::default(),
            update_began: None,
            last_update: Some(began.elapsed()),
            derivation: Derivation::default(),
            boundary: BoundaryFinder::default(),
            ages: AgeKeeper::default(),
            heights: HeightFinder::default(),
            mesh_change: None,
            bare_revision: None,
        })
    }

    /// Returns the document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Which document is open.
    pub fn document_id(&self) -> DocumentId {
        self.document_id
    }

    /// Returns the document, to be edited.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// Returns field and mesh as far as they are up to date.
    pub fn follower(&self) -> &Follower {
        &self.follower
    }

    /// Returns the mesh of the follower, which the derived mesh differs from along an outline.
    pub fn mesh(&self) -> &Mesh {
        self.follower.mesh()
    }

    /// Returns the mesh that is derived along the outline of the domain; `None` without an outline, and until
    /// it is derived.
    pub fn derived(&self) -> Option<&Derived> {
        self.derivation.current(&self.follower)
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
        self.readings.borrow_mut().decision_at(&self.document, &self.follower, point)
    }

    /// Returns whether ids of [`Self::view`] are the numbers in files.
    pub fn has_file_numbers(&self) -> bool {
        self.derived().is_some() || self.document.settings().domain.region().is_none()
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
        &self.derivation
    }

    /// Takes and starts work on the derived mesh, waiting for it as long as the frame may. Returns whether
    /// some is left.
    pub fn advance_derivation(&mut self, jobs: &Jobs) -> bool {
        let in_gesture = self.document.is_in_gesture() || self.is_cutting();
        self.derivation.advance(&self.follower, in_gesture, jobs)
    }

    /// Returns the pieces of the boundary; `None` until [`Self::find_boundary`] has found them.
    pub fn boundary_pieces(&self) -> Option<&BoundaryPieces> {
        self.boundary.pieces(&self.document)
    }

    /// Returns the numbers of the pieces of which the mesh has no edge; `None` until they are found.
    pub fn lost_boundary_pieces(&self) -> Option<&[usize]> {
        self.boundary.lost(&self.document, self.derived()?)
    }

    /// Finds the pieces of the boundary, waiting for them as long as the frame may. Returns whether some are
    /// being found.
    pub fn find_boundary(&mut self, jobs: &Jobs) -> bool {
        let derived = self.derivation.current(&self.follower);
        self.boundary.advance(&self.document, &self.follower, derived, jobs)
    }

    /// What a change makes of the names and splits of the boundary.
    pub fn changed_marks(
        &self,
        change: impl FnOnce(&BoundaryPieces, &BoundaryMarks) -> Option<BoundaryMarks>,
    ) -> Option<BoundaryMarks> {
        change(self.boundary_pieces()?, &self.document.settings().boundary_marks)
    }

    /// Names and splits the boundary, as a gesture of its own.
    pub fn set_marks(&mut self, marks: Option<BoundaryMarks>) {
        if let Some(marks) = marks {
            self.set(Setting::BoundaryMarks(marks));
            self.end_gesture();
        }
    }

    /// Returns the time on the clock of the last complete update, from the edit to the mesh, with the frames
    /// drawn meanwhile.
    pub fn last_update(&self) -> Option<Duration> {
        self.last_update
    }

    /// Returns the time on the clock since the update in progress began.
    pub fn update_so_far(&self) -> Option<Duration> {
        self.update_began.map(|began| began.elapsed())
    }

    /// Returns the present stage of the update.
    pub fn stage(&self) -> Stage {
        self.follower.stage()
    }

    /// Returns the messages on the canvas.
    pub fn notices(&self) -> &Notices {
        &self.notices
    }

    /// Returns the messages on the canvas, to dismiss them.
    pub fn notices_mut(&mut self) -> &mut Notices {
        &mut self.notices
    }

    /// Shows news.
    pub fn tell(&mut self, text: String) {
        self.notices.tell(text);
    }

    /// Shows a failure.
    pub fn report(&mut self, failure: impl std::fmt::Display) {
        self.notices.report(failure);
    }

    /// Shows that an edit failed. The next edit dismisses the message.
    pub(super) fn report_edit(&mut self, failure: impl std::fmt::Display) {
        self.notices.report_edit(self.document.version(), failure);
    }

    /// Changes a setting. What cannot be met is reported, and the document stays as it was.
    pub fn set(&mut self, setting: Setting) {
        self.size_change.note(&setting, &self.document, &self.follower);
        match self.document.set(setting) {
            Ok(()) => self.notices.dismiss(),
            Err(error) => self.report_edit(error),
        }
    }

    /// Adds a shape to the domain (`true`) or removes it.
    pub fn reshape(&mut self, cut_shape: CutShape, adds: bool) {
        if self.document.settings().domain.formula().is_some() {
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
        self.cuts.draw(part, shape, adds);
    }

    /// Gives the domain other bounds, in world units, as a gesture of its own.
    pub fn set_bounds(&mut self, bounds: Rect) {
        if self.document.settings().domain.region().is_some() {
            self.cuts.set_bounds(bounds);
        } else {
            self.set(Setting::Bounds(bounds));
        }
        self.end_gesture();
    }

    /// Ends a gesture with a setting, after the cuts that belong to it.
    pub fn end_gesture(&mut self) {
        self.cuts.end_gesture(&mut self.document);
    }

    /// Returns whether something that was drawn has not reached the document yet.
    pub fn is_cutting(&self) -> bool {
        !self.cuts.is_idle()
    }

    /// Returns the areas that have not reached the parts of the document that `counts` accepts.
    pub fn pending_cuts(&self, counts: impl Fn(DrawnPart) -> bool) -> impl Iterator<Item = &CutShape> {
        self.cuts.areas(counts)
    }

    /// Returns whether there is a gesture to take back, including one in progress.
    pub fn can_undo(&self) -> bool {
        let document = &self.document;
        document.history().undo_title().is_some() || document.stroke().is_some() || self.is_cutting()
    }

    /// Takes back the last gesture. One that has not reached the document is dropped.
    pub fn undo(&mut self) {
        if !self.cuts.discard(&mut self.document) {
            self.document.undo();
        }
    }

    /// Returns the triangle around the queried point.
    pub fn queried_triangle(&self) -> Option<TriangleId> {
        self.queried.and_then(|point| self.locate(point).triangle())
    }

    /// Does the last undone gesture again.
    pub fn redo(&mut self) {
        self.cuts.discard(&mut self.document);
        self.document.redo();
    }

    /// Stops the cuts in progress, or else the update of the mesh. The document keeps the edits that reached
    /// it; the notice says that the mesh lags behind.
    pub fn cancel_update(&mut self) {
        if self.is_cutting() {
            self.cuts.discard(&mut self.document);
            return;
        }
        self.follower.cancel(&self.document);
        self.notices.stand_cancelled(self.awaits_mesh());
    }

    /// Queries a point in world units, or none. The trail to the former one ends.
    pub fn query(&mut self, point: Option<DVec2>) {
        self.queried = point;
        self.trail.clear();
    }

    /// Queries the middle of a triangle after that of another one, which the trail keeps.
    pub fn query_next(&mut self, from: DVec2, to: DVec2) {
        if self.trail.is_empty() {
            self.trail.push(from);
        }
        self.trail.push(to);
        self.queried = Some(to);
    }

    /// The middles of the triangles on the way to the queried one, in world units.
    pub fn trail(&self) -> &[DVec2] {
        &self.trail
    }

    /// Returns the queried point, in world units.
    pub fn queried(&self) -> Option<DVec2> {
        self.queried
    }

    /// Returns the queried point and the triangle around it in the mesh on the screen.
    pub fn readout(&self, quantity: Quantity) -> Option<Readout> {
        self.queried.map(|point| Readout::at(point, self, quantity))
    }

    /// Draws the current stroke, and brings field and mesh closer to the document, on `threads` and until
    /// `deadline`. Returns whether work is left.
    ///
    /// Reports what turns out to be impossible. A setting that caused it is taken back; paint stays, for the
    /// user to undo or erase.
    pub fn follow(&mut self, threads: &Threads, deadline: Instant) -> bool {
        let began = self.update_began.unwrap_or_else(Instant::now);
        self.ages.look_at(&self.document);
        let revision = self.follower.revision();
        let left = self.follow_as_agreed(threads, deadline);
        if self.follower.stopped().is_none() && self.stage() != Stage::GaveUp(None) {
            self.notices.end_standing();
        }
        self.notices.forget_failed_edit(self.document.version());
        if !self.brake.holds() {
            self.notices.end_question();
        }
        let left = left || !self.document.is_stroke_drawn();
        let changed = self.follower.revision() != revision;
        let was_in_progress = self.update_began.is_some();
        self.update_began = left.then_some(began);
        if !left && (was_in_progress || changed) {
            self.last_update = Some(began.elapsed());
        }
        if let Some(change) = self.follower.take_change() {
            self.derivation.note_change(&change, &self.follower);
            self.ages.note(&change, self.follower.mesh());
            MeshChange::join(&mut self.mesh_change, change, self.follower.mesh());
        }
        let estimates = self.brake.advance_stopped(&self.document, &self.follower, deadline);
        left | estimates | self.ages.advance(self.follower.mesh(), deadline)
    }

    /// Returns how many edits ago each triangle of the follower's mesh came.
    pub fn ages(&self) -> AgesNow {
        self.ages.snapshot()
    }

    /// Computes the price of a stroke until `deadline`. Returns whether work is left. `None` cancels.
    pub fn price_stroke(&mut self, plan: Option<StrokePlan>, deadline: Instant) -> bool {
        self.pricer.ask(plan, &self.document, &self.follower);
        while self.pricer.progress() == Progress::More && Instant::now() < deadline {
            self.pricer.advance(&self.document, &self.follower, SLICE);
        }
        self.pricer.progress() == Progress::More
    }

    /// Returns the price of the stroke that a click would paint.
    pub fn pricer(&self) -> &Pricer {
        &self.pricer
    }

    /// Returns the changes on the screen since the last call.
    pub fn take_shown_change(&mut self) -> ShownChange {
        ShownChange { mesh: self.mesh_change.take(), pieces: self.derivation.take_pieces_change() }
    }

    /// Takes back the setting that made a mesh impossible. If paint did, the mesh stops, and a message says
    /// so.
    pub(super) fn take_back(&mut self, error: &BuildError) {
        let revision = self.document.revision();
        let is_other = self.document.settings() != self.follower.settings();
        if is_other || self.document.is_followed_in_place() {
            self.document.reject_last();
        }
        if self.document.revision() != revision {
            self.report_edit(format!("{error}{}", notices::advice(error)));
        } else {
            let is_other = self.document.settings() != self.follower.settings();
            let shows_former = is_other && !self.awaits_mesh();
            self.notices.stand(error, shows_former);
        }
    }
}

//! Edits of the domain's outline on their way to the document. They are computed on another thread: cutting
//! an outline of many corners takes longer than a frame.

use std::collections::VecDeque;

use super::jobs::{Job, Jobs, Kind, Taken};
use meshbrush_core::document::{Document, Setting, SettingsError};
use meshbrush_core::domain::{CutShape, Domain};
use meshbrush_mesh::geometry::Rect;

/// One edit of the outline.
#[derive(Clone, Debug, PartialEq)]
enum OutlineEdit {
    /// Adds a shape (`true`) or removes it.
    Reshape(CutShape, bool),
    /// Another rectangle for the coarse grid, in world units.
    Bounds(Rect),
}

impl OutlineEdit {
    /// Returns the edited domain; `None` where the edit changes nothing.
    fn apply(&self, domain: &Domain) -> Option<Domain> {
        match self {
            Self::Reshape(cut_shape, adds) => domain.reshaped(cut_shape, *adds),
            Self::Bounds(bounds) => Some(domain.with_bounds(*bounds)),
        }
    }

    /// Appends the next edit, where both belong to one stroke of the brush.
    fn join(&mut self, next: &Self) -> bool {
        let (Self::Reshape(cut_shape, adds), Self::Reshape(next, next_adds)) = (self, next) else {
            return false;
        };
        *adds == *next_adds && cut_shape.join(next)
    }
}

/// The changes of the domain, in order.
#[derive(Debug)]
enum Step {
    Edit(OutlineEdit),
    /// The gesture ends: what follows is an undo step of its own.
    EndGesture,
}

/// An edit on the other thread.
struct Running {
    edit: OutlineEdit,
    /// The domain that is edited.
    domain: Domain,
    job: Job<Option<Domain>>,
}

/// Edits of the outline that have not reached the document.
#[derive(Default)]
pub struct CutQueue {
    waiting: VecDeque<Step>,
    running: Option<Running>,
}

impl CutQueue {
    /// Returns whether all edits have reached the document.
    pub fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.running.is_none()
    }

    /// Returns the shapes that are not cut yet.
    pub fn shapes(&self) -> impl Iterator<Item = &CutShape> {
        let waiting = self.waiting.iter().filter_map(|step| match step {
            Step::Edit(edit) => Some(edit),
            Step::EndGesture => None,
        });
        self.running.iter().map(|running| &running.edit).chain(waiting).filter_map(|edit| match edit {
            OutlineEdit::Reshape(cut_shape, _) => Some(cut_shape),
            OutlineEdit::Bounds(_) => None,
        })
    }

    /// Adds a shape to the domain (`true`) or removes it.
    pub fn reshape(&mut self, cut_shape: CutShape, adds: bool) {
        self.push(OutlineEdit::Reshape(cut_shape, adds));
    }

    /// Gives the coarse grid another rectangle, in world units.
    pub fn set_bounds(&mut self, bounds: Rect) {
        self.push(OutlineEdit::Bounds(bounds));
    }

    fn push(&mut self, edit: OutlineEdit) {
        if let Some(Step::Edit(last)) = self.waiting.back_mut()
            && last.join(&edit)
        {
            return;
        }
        self.waiting.push_back(Step::Edit(edit));
    }

    /// Ends a gesture of the document, after the edits that belong to it.
    pub fn end_gesture(&mut self, document: &mut Document) {
        if self.is_idle() {
            document.end_gesture();
        } else {
            self.waiting.push_back(Step::EndGesture);
        }
    }

    /// Drops the edits that have not reached the document. Returns whether the current gesture consists of
    /// nothing else.
    pub fn discard(&mut self, document: &mut Document) -> bool {
        let nothing_else = !self.is_idle() && !document.is_in_gesture();
        let dropped = std::mem::take(self);
        if dropped.waiting.iter().any(|step| matches!(step, Step::EndGesture)) {
            // The brush was lifted: what is cut already is an undo step of its own.
            document.end_gesture();
        }
        nothing_else
    }

    /// Hands finished edits to the document and starts those that wait. Returns whether one is left.
    ///
    /// # Errors
    /// Fails when the document refuses an edit; the others are dropped.
    pub fn advance(&mut self, document: &mut Document, jobs: &Jobs) -> Result<bool, SettingsError> {
        loop {
            if let Some(running) = &self.running {
                match running.job.take(jobs) {
                    Taken::Working => return Ok(true),
                    Taken::Value(domain) => self.finish(document, domain)?,
                    Taken::Ended => self.finish(document, None)?,
                }
            }
            match self.waiting.pop_front() {
                None => return Ok(false),
                Some(Step::EndGesture) => document.end_gesture(),
                Some(Step::Edit(edit)) => self.start(edit, &document.settings().domain, jobs),
            }
        }
    }

    fn start(&mut self, edit: OutlineEdit, domain: &Domain, jobs: &Jobs) {
        let (edit_there, before) = (edit.clone(), domain.clone());
        let job = jobs.start(Kind::Compute, move |output| {
            output.send(edit_there.apply(&before));
        });
        self.running = Some(Running { edit, domain: domain.clone(), job });
    }

    /// Replaces the domain by the edited one. If it is no longer the one that was edited, all edits are
    /// dropped.
    fn finish(&mut self, document: &mut Document, edited: Option<Domain>) -> Result<(), SettingsError> {
        let Some(running) = self.running.take() else { return Ok(()) };
        match edited {
            Some(domain) if document.settings().domain == running.domain => {
                document.set(Setting::Domain(domain))
            }
            _ => {
                self.discard(document);
                Ok(())
            }
        }
    }
}

//! What is drawn by hand on its way to the document: edits of the domain's outline, of masks, of keep-out
//! regions and of shapes. They are computed on another thread: an outline of many corners takes longer than a
//! frame.

use std::collections::VecDeque;

use super::jobs::{Job, JobKind, Jobs, Taken};
use meshbrush_core::document::{Document, Drawing, DrawingError, DrawnPart, DrawnShape, Setting};
use meshbrush_core::domain::CutShape;
use meshbrush_mesh::geometry::Rect;

/// One edit.
#[derive(Clone, Debug, PartialEq)]
enum DrawnEdit {
    /// Adds a shape to a part (`true`) or cuts it away.
    Draw(DrawnPart, DrawnShape, bool),
    /// Another rectangle for the coarse grid, in world units.
    Bounds(Rect),
}

impl DrawnEdit {
    /// The part of the document that is edited.
    fn part(&self) -> DrawnPart {
        match self {
            Self::Draw(part, ..) => *part,
            Self::Bounds(_) => DrawnPart::Domain,
        }
    }

    /// Returns the edited drawing; `None` where the edit changes nothing.
    fn apply(&self, drawing: &Drawing) -> Result<Option<Drawing>, DrawingError> {
        match (self, drawing) {
            (Self::Draw(_, shape, adds), drawing) => drawing.edited(shape, *adds),
            (Self::Bounds(bounds), Drawing::Domain(domain)) => {
                Ok(Some(Drawing::Domain(domain.with_bounds(*bounds))))
            }
            (Self::Bounds(_), _) => Ok(None),
        }
    }

    /// Appends the next edit, where both belong to one stroke of the brush.
    fn join(&mut self, next: &Self) -> bool {
        match (self, next) {
            (Self::Draw(part, shape, adds), Self::Draw(next_part, next, next_adds)) => {
                part == next_part && adds == next_adds && shape.join(next)
            }
            _ => false,
        }
    }
}

/// The edits, in order.
#[derive(Debug)]
enum QueuedEdit {
    Edit(DrawnEdit),
    /// The gesture ends: what follows is an undo step of its own.
    EndGesture,
}

/// An edit on the other thread.
struct RunningEdit {
    edit: DrawnEdit,
    /// What is edited.
    before: Drawing,
    job: Job<Result<Option<Drawing>, DrawingError>>,
}

/// Edits that have not reached the document.
#[derive(Default)]
pub struct PolygonEditQueue {
    waiting: VecDeque<QueuedEdit>,
    running: Option<RunningEdit>,
}

impl PolygonEditQueue {
    /// Returns whether all edits have reached the document.
    pub fn is_idle(&self) -> bool {
        self.waiting.is_empty() && self.running.is_none()
    }

    /// Returns the areas that have not reached the parts that `counts` accepts.
    pub fn areas(&self, counts: impl Fn(DrawnPart) -> bool) -> impl Iterator<Item = &CutShape> {
        let waiting = self.waiting.iter().filter_map(|step| match step {
            QueuedEdit::Edit(edit) => Some(edit),
            QueuedEdit::EndGesture => None,
        });
        let edits = self.running.iter().map(|running| &running.edit).chain(waiting);
        edits.filter_map(move |edit| match edit {
            DrawnEdit::Draw(part, DrawnShape::Area(area), _) if counts(*part) => Some(area),
            DrawnEdit::Draw(..) | DrawnEdit::Bounds(_) => None,
        })
    }

    /// Adds a shape to a part of the document (`true`) or cuts it away.
    pub fn draw(&mut self, part: DrawnPart, shape: DrawnShape, adds: bool) {
        self.push(DrawnEdit::Draw(part, shape, adds));
    }

    /// Gives the coarse grid another rectangle, in world units.
    pub fn set_bounds(&mut self, bounds: Rect) {
        self.push(DrawnEdit::Bounds(bounds));
    }

    fn push(&mut self, edit: DrawnEdit) {
        if let Some(QueuedEdit::Edit(last)) = self.waiting.back_mut()
            && last.join(&edit)
        {
            return;
        }
        self.waiting.push_back(QueuedEdit::Edit(edit));
    }

    /// Ends a gesture of the document, after the edits that belong to it.
    pub fn end_gesture(&mut self, document: &mut Document) {
        if self.is_idle() {
            document.end_gesture();
        } else {
            self.waiting.push_back(QueuedEdit::EndGesture);
        }
    }

    /// Drops the edits that have not reached the document. Returns whether the current gesture consists of
    /// nothing else.
    pub fn discard(&mut self, document: &mut Document) -> bool {
        let nothing_else = !self.is_idle() && !document.is_in_gesture();
        let dropped = std::mem::take(self);
        if dropped.waiting.iter().any(|step| matches!(step, QueuedEdit::EndGesture)) {
            // The brush was lifted: what is cut already is an undo step of its own.
            document.end_gesture();
        }
        nothing_else
    }

    /// Hands finished edits to the document and starts those that wait. Returns whether one is left.
    ///
    /// # Errors
    /// Fails with a sentence when an edit is not possible or the document refuses it; the others are
    /// dropped.
    pub fn advance(&mut self, document: &mut Document, jobs: &Jobs) -> Result<bool, String> {
        loop {
            if let Some(running) = &self.running {
                match running.job.take(jobs) {
                    Taken::Working => return Ok(true),
                    Taken::Value(Ok(drawing)) => self.finish(document, drawing)?,
                    Taken::Value(Err(error)) => {
                        self.discard(document);
                        return Err(error.to_string());
                    }
                    Taken::Ended => self.finish(document, None)?,
                }
            }
            match self.waiting.pop_front() {
                None => return Ok(false),
                Some(QueuedEdit::EndGesture) => document.end_gesture(),
                Some(QueuedEdit::Edit(edit)) => match edit.part().drawing(document.settings()) {
                    Some(before) => self.start(edit, before, jobs),
                    None => _ = self.discard(document),
                },
            }
        }
    }

    fn start(&mut self, edit: DrawnEdit, before: Drawing, jobs: &Jobs) {
        let (edit_there, before_there) = (edit.clone(), before.clone());
        let job = jobs.start(JobKind::Compute, move |output| {
            output.send(edit_there.apply(&before_there));
        });
        self.running = Some(RunningEdit { edit, before, job });
    }

    /// Replaces what was edited. If it is no longer what it was, all edits are dropped.
    fn finish(&mut self, document: &mut Document, edited: Option<Drawing>) -> Result<(), String> {
        let Some(RunningEdit { edit, before, .. }) = self.running.take() else { return Ok(()) };
        let (part, settings) = (edit.part(), document.settings());
        let is_as_before = part.drawing(settings).as_ref() == Some(&before);
        let edited = edited.filter(|_| is_as_before);
        let setting: Option<Setting> = edited.and_then(|edited| part.setting(settings, edited));
        match setting {
            Some(setting) => document.set(setting).map_err(|error| {
                self.discard(document);
                error.to_string()
            }),
            None => {
                self.discard(document);
                Ok(())
            }
        }
    }
}

//! A job, seen from the window and from its thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, TryRecvError, channel};

use eframe::egui::Context;

use super::Jobs;
use crate::app::document_id::DocumentId;

/// Whether the values of a job are still wanted. Clones know the same.
#[derive(Clone, Debug)]
pub struct Wanted(Arc<AtomicBool>);

impl Wanted {
    /// Whether they are. Long work checks this between its steps, and ends where they are not.
    pub fn goes_on(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A job in the window. Dropped, it tells the thread to end.
pub struct Job<T> {
    values: Receiver<T>,
    wanted: Wanted,
    document: DocumentId,
}

/// What a job has to give.
#[derive(Debug)]
pub enum Taken<T> {
    /// The next value.
    Value(T),
    /// None yet.
    Working,
    /// No more: the work is done, was cancelled, or panicked.
    Ended,
}

impl<T> Job<T> {
    pub(super) fn new(ctx: &Context, document: DocumentId) -> (Self, Output<T>) {
        let (sender, values) = channel();
        let wanted = Wanted(Arc::new(AtomicBool::new(true)));
        let output = Output { sender, wanted: wanted.clone(), ctx: ctx.clone() };
        (Self { values, wanted, document }, output)
    }

    /// The document that was open when it began.
    pub fn document(&self) -> DocumentId {
        self.document
    }

    /// Takes the next value, and waits for it as long as the frame may still wait.
    pub fn take(&self, jobs: &Jobs) -> Taken<T> {
        match jobs.receive(&self.values) {
            Ok(value) => Taken::Value(value),
            Err(RecvTimeoutError::Timeout) => Taken::Working,
            Err(RecvTimeoutError::Disconnected) => Taken::Ended,
        }
    }

    /// Takes the next value if it is there.
    pub fn take_ready(&self) -> Taken<T> {
        match self.values.try_recv() {
            Ok(value) => Taken::Value(value),
            Err(TryRecvError::Empty) => Taken::Working,
            Err(TryRecvError::Disconnected) => Taken::Ended,
        }
    }

    /// Tells the thread to end.
    pub fn cancel(&self) {
        self.wanted.0.store(false, Ordering::Relaxed);
    }

    /// Whether the thread was told to end.
    pub fn is_cancelled(&self) -> bool {
        !self.wanted.goes_on()
    }

    /// Waits until the work has ended, however long it takes: for a window that is being closed.
    pub fn wait_for_end(self) {
        while self.values.recv().is_ok() {}
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// A job on its thread.
pub struct Output<T> {
    sender: Sender<T>,
    wanted: Wanted,
    ctx: Context,
}

impl<T> Output<T> {
    /// Whether more values are wanted.
    pub fn is_wanted(&self) -> bool {
        self.wanted.goes_on()
    }

    /// The same question, to hand on.
    pub fn wanted(&self) -> &Wanted {
        &self.wanted
    }

    /// Sends a value. Returns whether more are wanted.
    pub fn send(&self, value: T) -> bool {
        let is_heard = self.sender.send(value).is_ok();
        self.ctx.request_repaint();
        is_heard && self.is_wanted()
    }

    /// Wakes the window without a value.
    pub fn wake(&self) {
        self.ctx.request_repaint();
    }

    /// The end: the window finds that there are no more values.
    pub(super) fn end(self) {
        let Self { sender, wanted: _, ctx } = self;
        drop(sender);
        ctx.request_repaint();
    }
}

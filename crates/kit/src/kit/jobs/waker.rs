//! Waking the window from the threads of its jobs.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use egui::Context;

/// Wakes a window until it is closed. Clones wake the same window.
///
/// The context of a window owns its graphics device. A thread that owned a context could be the last to drop
/// it, and would unload the graphics driver while the main thread runs the driver's exit handlers: a crash.
/// So threads hold this, and the context ends on the thread of the window.
#[derive(Clone)]
pub struct Waker(Arc<Mutex<Option<Context>>>);

impl Waker {
    /// Wakes the window of `ctx`.
    pub fn new(ctx: &Context) -> Self {
        Self(Arc::new(Mutex::new(Some(ctx.clone()))))
    }

    /// Makes another frame follow, if the window is open.
    pub fn wake(&self) {
        if let Some(ctx) = &*self.lock() {
            ctx.request_repaint();
        }
    }

    /// Drops the context: no thread has it after this.
    pub fn close(&self) {
        let ctx = self.lock().take();
        drop(ctx); // outside the lock
    }

    fn lock(&self) -> MutexGuard<'_, Option<Context>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

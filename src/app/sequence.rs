//! Values that a thread computes one after the other, until it ends or nobody wants more.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use eframe::egui::Context;

use super::failures::caught;

/// The values of a thread. Dropped, it tells the thread to end.
pub struct Sequence<T> {
    /// The values that were computed; disconnected when there are no more.
    pub values: Receiver<T>,
    is_cancelled: Arc<AtomicBool>,
}

/// Where the thread sends its values.
pub struct Output<T> {
    sender: Sender<T>,
    is_cancelled: Arc<AtomicBool>,
    ctx: Context,
}

impl<T: Send + 'static> Sequence<T> {
    /// Starts the work on a thread. Each value, and the end, wakes the window.
    pub fn start(work: impl FnOnce(&Output<T>) + Send + 'static, ctx: &Context) -> Self {
        let (sender, values) = channel();
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let output = Output { sender, is_cancelled: is_cancelled.clone(), ctx: ctx.clone() };
        thread::spawn(move || {
            caught(&output.ctx, || work(&output));
            let ctx = output.ctx.clone();
            // The window then finds that there are no more values.
            drop(output);
            ctx.request_repaint();
        });
        Self { values, is_cancelled }
    }
}

impl<T> Drop for Sequence<T> {
    fn drop(&mut self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }
}

impl<T> Output<T> {
    /// Whether more values are wanted.
    pub fn goes_on(&self) -> bool {
        !self.is_cancelled.load(Ordering::Relaxed)
    }

    /// Sends a value. Returns whether more are wanted.
    pub fn send(&self, value: T) -> bool {
        let is_heard = self.sender.send(value).is_ok();
        self.ctx.request_repaint();
        is_heard && self.goes_on()
    }
}

//! A value that takes longer than a frame: it is computed on another thread, and the last one is kept.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use eframe::egui::Context;

/// The value for a key that was computed last, and the one that is being computed. The key holds everything
/// that the value depends on.
pub struct Latest<K, T> {
    found: Option<(K, T)>,
    running: Option<(K, Receiver<T>)>,
}

impl<K, T> Default for Latest<K, T> {
    fn default() -> Self {
        Self { found: None, running: None }
    }
}

impl<K: PartialEq, T: Send + 'static> Latest<K, T> {
    /// The last value with its key, which may be that of an earlier state.
    pub fn last(&self) -> Option<(&K, &T)> {
        self.found.as_ref().map(|(key, value)| (key, value))
    }

    /// Takes the last value with its key out.
    pub fn take_last(&mut self) -> Option<(K, T)> {
        self.found.take()
    }

    /// Drops the last value unless its key may stay.
    pub fn keep_if(&mut self, may_stay: impl FnOnce(&K) -> bool) {
        self.found.take_if(|(key, _)| !may_stay(key));
    }

    /// Whether a value is being computed.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Whether the value for a key is known or being computed.
    pub fn has(&self, key: &K) -> bool {
        self.found.as_ref().is_some_and(|(found, _)| found == key)
            || self.running.as_ref().is_some_and(|(running, _)| running == key)
    }

    /// Computes the value for a key. Nothing happens while another one is being computed.
    pub fn start(&mut self, key: K, compute: impl FnOnce() -> T + Send + 'static, ctx: &Context) {
        if self.running.is_some() {
            return;
        }
        let (sender, value) = channel();
        let ctx = ctx.clone();
        thread::spawn(move || {
            // The receiver is gone when the window is closed.
            let _ = sender.send(compute());
            ctx.request_repaint();
        });
        self.running = Some((key, value));
    }

    /// Takes the value that was computed, waiting for it up to `patience`. Returns whether one is being
    /// computed.
    pub fn take(&mut self, patience: Duration) -> bool {
        let Some((_, value)) = &self.running else { return false };
        let received = value.recv_timeout(patience);
        if matches!(received, Err(RecvTimeoutError::Timeout)) {
            return true;
        }
        let key = self.running.take().map(|(key, _)| key);
        if let Some(found) = key.zip(received.ok()) {
            self.found = Some(found);
        }
        false
    }
}

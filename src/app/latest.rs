//! A value that takes longer than a frame: it is computed on another thread, and the last one is kept.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use eframe::egui::Context;

use super::failures::caught;

/// The value for a key that was computed last, and the one that is being computed. The key holds everything
/// that the value depends on.
pub struct Latest<K, T> {
    found: Option<(K, T)>,
    running: Option<Running<K, T>>,
    /// The key whose value could not be computed: it is not tried again.
    failed: Option<K>,
}

struct Running<K, T> {
    key: K,
    value: Receiver<T>,
    ends: EndsWork,
}

/// Dropped, it tells the thread to end.
struct EndsWork(Wanted);

impl Drop for EndsWork {
    fn drop(&mut self) {
        self.0.end();
    }
}

/// Whether a value that is being computed is still wanted. Clones know the same.
#[derive(Clone, Debug)]
pub struct Wanted(Arc<AtomicBool>);

impl Wanted {
    fn new() -> Self {
        Self(Arc::new(AtomicBool::new(true)))
    }

    fn end(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// Ask this between the steps of long work, and end the work if not.
    pub fn goes_on(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl<K, T> Default for Latest<K, T> {
    fn default() -> Self {
        Self { found: None, running: None, failed: None }
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

    /// Drops the last value and tells the thread to end. Until it has ended, no other one starts.
    pub fn stop(&mut self) {
        self.found = None;
        if let Some(running) = &self.running {
            running.ends.0.end();
        }
        self.take(Duration::ZERO);
    }

    /// Whether a value is being computed.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Whether the value for a key is known, being computed, or cannot be computed.
    pub fn has(&self, key: &K) -> bool {
        self.found.as_ref().is_some_and(|(found, _)| found == key)
            || self.running.as_ref().is_some_and(|running| running.key == *key && running.ends.0.goes_on())
            || self.failed.as_ref() == Some(key)
    }

    /// Computes the value for a key. Nothing happens while another one is being computed, and for a key whose
    /// value could not be computed.
    pub fn start(&mut self, key: K, compute: impl FnOnce() -> T + Send + 'static, ctx: &Context) {
        self.start_wanted(key, |_| Some(compute()), ctx);
    }

    /// As [`Self::start`], with work that ends without a value once it is no longer wanted: after
    /// [`Self::stop`], and when this is dropped.
    pub fn start_wanted(
        &mut self,
        key: K,
        compute: impl FnOnce(&Wanted) -> Option<T> + Send + 'static,
        ctx: &Context,
    ) {
        if self.running.is_some() || self.failed.as_ref() == Some(&key) {
            return;
        }
        let (sender, value) = channel();
        let (ctx, wanted) = (ctx.clone(), Wanted::new());
        let wanted_there = wanted.clone();
        thread::spawn(move || {
            if let Some(value) = caught(&ctx, || compute(&wanted_there)).flatten() {
                // The receiver is gone when the window is closed.
                let _ = sender.send(value);
            }
            // The window then finds that there is no value.
            drop(sender);
            ctx.request_repaint();
        });
        self.running = Some(Running { key, value, ends: EndsWork(wanted) });
    }

    /// Takes the value that was computed, waiting for it up to `patience`. Returns whether one is being
    /// computed.
    pub fn take(&mut self, patience: Duration) -> bool {
        let Some(running) = &self.running else { return false };
        let received = running.value.recv_timeout(patience);
        if matches!(received, Err(RecvTimeoutError::Timeout)) {
            return true;
        }
        let Some(Running { key, ends, .. }) = self.running.take() else { return false };
        if ends.0.goes_on() {
            match received {
                Ok(value) => self.found = Some((key, value)),
                Err(_) => self.failed = Some(key),
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;

    use super::*;

    const LONG: Duration = Duration::from_secs(30);

    #[test]
    fn what_panics_is_computed_once_and_told_once() {
        let (ctx, runs) = (Context::default(), Arc::new(AtomicUsize::new(0)));
        let mut latest: Latest<u32, u32> = Latest::default();
        for _ in 0..5 {
            let runs = runs.clone();
            latest.start(
                7,
                move || {
                    runs.fetch_add(1, Ordering::Relaxed);
                    panic!("no value for seven")
                },
                &ctx,
            );
            assert!(!latest.take(LONG) && latest.has(&7) && latest.last().is_none());
        }
        assert_eq!(runs.load(Ordering::Relaxed), 1);
        let told = crate::app::failures::take(&ctx);
        assert!(told.len() == 1 && told[0].contains("(no value for seven)"), "{told:?}");
        latest.start(8, || 80, &ctx);
        assert!(!latest.take(LONG) && latest.last() == Some((&8, &80)));
    }

    #[test]
    fn what_is_stopped_ends_before_anything_else_starts() {
        let ctx = Context::default();
        let mut latest: Latest<u32, u32> = Latest::default();
        let (running, most) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        for key in 0..50 {
            let (running, most) = (running.clone(), most.clone());
            let work = move |wanted: &Wanted| {
                most.fetch_max(running.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                while wanted.goes_on() {
                    thread::yield_now();
                }
                running.fetch_sub(1, Ordering::SeqCst);
                None
            };
            latest.start_wanted(key, work, &ctx);
            latest.stop();
            assert!(!latest.has(&key));
        }
        assert!(!latest.take(LONG));
        assert_eq!((running.load(Ordering::SeqCst), most.load(Ordering::SeqCst)), (0, 1));
    }
}

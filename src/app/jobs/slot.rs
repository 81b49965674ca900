//! The last value for a key that changes, computed by jobs.

use super::{Job, Jobs, Kind, Taken, Wanted};

/// The value for a key that was computed last, and the one that is being computed. The key holds everything
/// that the value depends on.
pub struct Slot<K, T> {
    found: Option<(K, T)>,
    running: Option<(K, Job<T>)>,
    /// The key whose value could not be computed: it is not tried again.
    failed: Option<K>,
}

impl<K, T> Default for Slot<K, T> {
    fn default() -> Self {
        Self { found: None, running: None, failed: None }
    }
}

impl<K: PartialEq, T: Send + 'static> Slot<K, T> {
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

    /// Drops the last value and ends the job. Until it has ended, no other one starts.
    pub fn stop(&mut self, jobs: &Jobs) {
        self.found = None;
        if let Some((_, job)) = &self.running {
            job.cancel();
        }
        self.take_ready(jobs);
    }

    /// Whether a value is being computed.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Whether the value for a key is known, being computed, or cannot be computed.
    pub fn has(&self, key: &K) -> bool {
        self.found.as_ref().is_some_and(|(found, _)| found == key)
            || self.running.as_ref().is_some_and(|(running, job)| running == key && !job.is_cancelled())
            || self.failed.as_ref() == Some(key)
    }

    /// Computes the value for a key. Nothing happens while another one is being computed, which is shown
    /// until then, and for a key whose value could not be computed.
    pub fn start(&mut self, key: K, compute: impl FnOnce() -> T + Send + 'static, jobs: &Jobs) {
        self.start_wanted(key, |_| Some(compute()), jobs);
    }

    /// As [`Self::start`], with work that ends without a value once it is no longer wanted: after
    /// [`Self::stop`], and when this is dropped.
    pub fn start_wanted(
        &mut self,
        key: K,
        compute: impl FnOnce(&Wanted) -> Option<T> + Send + 'static,
        jobs: &Jobs,
    ) {
        if self.running.is_some() || self.failed.as_ref() == Some(&key) {
            return;
        }
        let job = jobs.start(Kind::Compute, |output| {
            if let Some(value) = compute(output.wanted()) {
                output.send(value);
            }
        });
        self.running = Some((key, job));
    }

    /// Takes the value that was computed, and waits for it as long as the frame may still wait. Returns
    /// whether one is being computed.
    pub fn take(&mut self, jobs: &Jobs) -> bool {
        let taken = self.running.as_ref().map(|(_, job)| job.take(jobs));
        self.took(taken, jobs)
    }

    /// As [`Self::take`], without waiting.
    pub fn take_ready(&mut self, jobs: &Jobs) -> bool {
        let taken = self.running.as_ref().map(|(_, job)| job.take_ready());
        self.took(taken, jobs)
    }

    /// What a job found for an earlier document is dropped.
    fn took(&mut self, taken: Option<Taken<T>>, jobs: &Jobs) -> bool {
        let Some(taken) = taken else { return false };
        if matches!(taken, Taken::Working) {
            return true;
        }
        let Some((key, job)) = self.running.take() else { return false };
        if !job.is_cancelled() && job.document() == jobs.document() {
            match taken {
                Taken::Value(value) => self.found = Some((key, value)),
                _ => self.failed = Some(key),
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use eframe::egui::Context;

    use super::*;
    use crate::app::document_id::DocumentId;

    fn patient_jobs() -> Jobs {
        let jobs = Jobs::new(&Context::default());
        jobs.wait_for_all();
        jobs
    }

    #[test]
    fn what_panics_is_computed_once_and_gives_one_message() {
        let (jobs, runs) = (patient_jobs(), Arc::new(AtomicUsize::new(0)));
        let mut slot: Slot<u32, u32> = Slot::default();
        for _ in 0..5 {
            let runs = runs.clone();
            slot.start(
                7,
                move || {
                    runs.fetch_add(1, Ordering::Relaxed);
                    panic!("no value for seven")
                },
                &jobs,
            );
            assert!(!slot.take(&jobs) && slot.has(&7) && slot.last().is_none());
        }
        assert_eq!(runs.load(Ordering::Relaxed), 1);
        let problems = jobs.take_problems();
        assert!(problems.len() == 1 && problems[0].contains("(no value for seven)"), "{problems:?}");
        slot.start(8, || 80, &jobs);
        assert!(!slot.take(&jobs) && slot.last() == Some((&8, &80)));
    }

    #[test]
    fn what_is_stopped_ends_before_anything_else_starts() {
        let jobs = patient_jobs();
        let mut slot: Slot<u32, u32> = Slot::default();
        let (running, most) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        for key in 0..50 {
            let (running, most) = (running.clone(), most.clone());
            let work = move |wanted: &Wanted| {
                most.fetch_max(running.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                while wanted.goes_on() {
                    std::thread::yield_now();
                }
                running.fetch_sub(1, Ordering::SeqCst);
                None
            };
            slot.start_wanted(key, work, &jobs);
            slot.stop(&jobs);
            assert!(!slot.has(&key));
        }
        assert!(!slot.take(&jobs));
        assert!(running.load(Ordering::SeqCst) == 0 && most.load(Ordering::SeqCst) <= 1);
    }

    #[test]
    fn what_was_computed_for_an_earlier_document_is_dropped() {
        let jobs = patient_jobs();
        let mut slot: Slot<u32, u32> = Slot::default();
        slot.start(1, || 10, &jobs);
        jobs.work_for(DocumentId::default().next());
        assert!(!slot.take(&jobs) && slot.last().is_none() && !slot.has(&1));
    }
}

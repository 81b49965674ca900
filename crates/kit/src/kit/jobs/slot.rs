//! The last value for a key that changes, computed by jobs.

use super::succession::Succession;
use super::{Job, JobKind, Jobs, Output, Taken, Wanted};
use meshbrush_mesh::mesh::Progress;

/// Memoizes the last value computed for a key, and keeps the one that is being computed. The key holds
/// everything that the value depends on. Keys that change quickly are debounced ([`Succession`]).
pub struct Slot<K, T> {
    found: Option<(K, T)>,
    running: Option<RunningJob<K, T>>,
    /// The key whose value could not be computed: it is not tried again.
    failed: Option<K>,
    succession: Succession<K>,
}

/// What a slice of work for a value has come to.
pub enum Slice<T> {
    /// There is more to do.
    More,
    /// The value.
    Found(T),
}

struct RunningJob<K, T> {
    key: K,
    job: Job<T>,
    /// Whether its value is of no use any more.
    is_forgotten: bool,
}

impl<K, T> Default for Slot<K, T> {
    fn default() -> Self {
        Self { found: None, running: None, failed: None, succession: Succession::default() }
    }
}

impl<K: Clone + PartialEq, T: Send + 'static> Slot<K, T> {
    /// Returns the last value with its key, which may be that of an earlier state.
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
        if let Some(running) = &mut self.running {
            running.job.cancel();
            running.is_forgotten = true;
        }
        self.take_ready(jobs);
    }

    /// Returns whether a value is being computed.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Returns whether the value for a key is known, being computed, or cannot be computed.
    pub fn has(&self, key: &K) -> bool {
        let is_coming = |running: &RunningJob<K, T>| running.key == *key && !running.job.is_cancelled();
        self.found.as_ref().is_some_and(|(found, _)| found == key)
            || self.running.as_ref().is_some_and(is_coming)
            || self.failed.as_ref() == Some(key)
    }

    /// Returns whether the job was told to end, and has not ended yet.
    #[cfg(any(test, feature = "hooks"))]
    pub fn is_ending(&self) -> bool {
        self.running.as_ref().is_some_and(|running| running.job.is_cancelled())
    }

    /// Says which key is wanted now, in every frame: a job for another one may have to give way, by the rule
    /// of [`super`].
    pub fn want(&mut self, key: &K, jobs: &Jobs) {
        if let Some(running) = &self.running
            && self.succession.gives_way(&running.key, key, jobs)
        {
            running.job.cancel();
        }
    }

    /// Computes the value for a key. Nothing happens while another one is being computed, which is shown
    /// until then, and for a key whose value could not be computed.
    #[track_caller]
    pub fn start(&mut self, key: K, compute: impl FnOnce() -> T + Send + 'static, jobs: &Jobs) {
        self.start_wanted(key, |_| Some(compute()), jobs);
    }

    /// Starts work as [`Self::start`] does. The work may end without a value once it is no longer wanted:
    /// after [`Self::stop`], for a newer key, and when the slot is dropped.
    #[track_caller]
    pub fn start_wanted(
        &mut self,
        key: K,
        compute: impl FnOnce(&Wanted) -> Option<T> + Send + 'static,
        jobs: &Jobs,
    ) {
        if self.running.is_some() || self.failed.as_ref() == Some(&key) {
            return;
        }
        let job = jobs.start(JobKind::Compute, |output| {
            if let Some(value) = compute(output.wanted()) {
                output.send(value);
            }
        });
        self.running = Some(RunningJob { key, job, is_forgotten: false });
    }

    /// Starts work as [`Self::start`] does, in slices: `begin` makes a state, or `None` where there is no
    /// value, and `slice` is called until it has found the value, or until nobody wants it any more. So the
    /// work needs not look whether it is wanted.
    #[track_caller]
    pub fn start_in_slices<S: Send + 'static>(
        &mut self,
        key: K,
        begin: impl FnOnce() -> Option<S> + Send + 'static,
        mut slice: impl FnMut(&mut S) -> Slice<T> + Send + 'static,
        jobs: &Jobs,
    ) {
        if self.running.is_some() || self.failed.as_ref() == Some(&key) {
            return;
        }
        let slice = move |state: &mut S, output: &Output<T>| match slice(state) {
            Slice::More => Progress::More,
            Slice::Found(value) => {
                output.send(value);
                Progress::Done
            }
        };
        let job = jobs.start_in_slices(JobKind::Compute, begin, slice);
        self.running = Some(RunningJob { key, job, is_forgotten: false });
    }

    /// Takes the value that was computed, and waits for it as long as the frame may still wait. Returns
    /// whether one is being computed.
    pub fn take(&mut self, jobs: &Jobs) -> bool {
        let taken = self.running.as_ref().map(|running| running.job.take(jobs));
        self.took(taken, jobs)
    }

    /// Takes a value as [`Self::take`] does, but waits only where frames wait for all jobs.
    pub fn poll(&mut self, jobs: &Jobs) -> bool {
        let taken = self.running.as_ref().map(|running| running.job.poll(jobs));
        self.took(taken, jobs)
    }

    /// Takes a value as [`Self::take`] does, without waiting.
    pub fn take_ready(&mut self, jobs: &Jobs) -> bool {
        let taken = self.running.as_ref().map(|running| running.job.take_ready());
        self.took(taken, jobs)
    }

    /// Stores a value that was taken, unless it belongs to an earlier document. A value that came although
    /// its job was to give way is newer than what is shown. Returns whether the job still runs.
    fn took(&mut self, taken: Option<Taken<T>>, jobs: &Jobs) -> bool {
        let Some(taken) = taken else { return false };
        if matches!(taken, Taken::Working) {
            return true;
        }
        let Some(RunningJob { key, job, is_forgotten }) = self.running.take() else { return false };
        let is_wanted = !is_forgotten && job.document() == jobs.document();
        match taken {
            Taken::Value(value) if is_wanted => {
                self.succession.ended(true);
                self.found = Some((key, value));
            }
            Taken::Ended if is_wanted && job.is_cancelled() => self.succession.ended(false),
            Taken::Ended if is_wanted => self.failed = Some(key),
            _ => {}
        }
        false
    }
}

//! When a job for an older key gives way to one for a newer key: keys that change quickly are debounced.

use super::Jobs;

/// How long a newer key has to stay the same before the job for an older one is told to end, in seconds: in
/// a stroke, where it changes with every frame, the values on the way are shown.
pub const STILL: f64 = 0.1;

/// The keys that follow each other in one place, by the rule of [`super`].
pub struct Succession<K> {
    /// The newer key, and since when it has been wanted, in seconds.
    newer: Option<(K, f64)>,
    /// Whether the last job was told to end and gave nothing: the running one may finish.
    is_overdue: bool,
}

impl<K> Default for Succession<K> {
    fn default() -> Self {
        Self { newer: None, is_overdue: false }
    }
}

impl<K: Clone + PartialEq> Succession<K> {
    /// Returns whether the job for `running` is to end, as `wanted` is wanted now.
    pub fn gives_way(&mut self, running: &K, wanted: &K, jobs: &Jobs) -> bool {
        if running == wanted {
            self.newer = None;
            return false;
        }
        match &self.newer {
            Some((newer, since)) if newer == wanted => !self.is_overdue && jobs.time() - since >= STILL,
            _ => {
                self.newer = Some((wanted.clone(), jobs.time()));
                jobs.wake_after(STILL);
                false
            }
        }
    }

    /// Notes that the job has ended, with a value or because it gave way.
    pub fn ended(&mut self, with_value: bool) {
        (self.newer, self.is_overdue) = (None, !with_value);
    }
}

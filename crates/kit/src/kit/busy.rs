//! When work is long enough to be shown.

use crate::kit::clock::{Duration, Instant};

/// Work shorter than this shows no progress: it would only flicker.
pub const MOMENT: Duration = Duration::from_millis(250);

/// Tells long work from work of a moment.
#[derive(Clone, Copy, Debug, Default)]
pub struct Busy {
    since: Option<Instant>,
}

impl Busy {
    /// Work that begins now.
    pub fn now() -> Self {
        Self { since: Some(Instant::now()) }
    }

    /// Notes whether there is work. Call it every frame.
    pub fn note(&mut self, working: bool) {
        self.since = working.then(|| self.since.unwrap_or_else(Instant::now));
    }

    /// Returns whether the work has taken longer than a moment.
    pub fn is_long(&self) -> bool {
        self.since.is_some_and(|since| since.elapsed() > MOMENT)
    }
}

//! How long a frame still waits for other threads.

use std::time::{Duration, Instant};

/// A time that all waits of one frame share: several receivers together hold the frame up no longer than one.
pub struct Patience {
    end: Instant,
}

impl Patience {
    /// From now on.
    pub fn new(time: Duration) -> Self {
        Self { end: Instant::now() + time }
    }

    /// What is left of it.
    pub fn left(&self) -> Duration {
        self.end.saturating_duration_since(Instant::now())
    }
}

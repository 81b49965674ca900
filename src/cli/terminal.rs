//! What a person reads while and after the work: standard error.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Work shorter than this shows no progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two lines of progress.
const PACE: Duration = Duration::from_millis(100);

/// Messages and progress on standard error. Nothing that goes wrong here stops the work.
pub struct Terminal {
    show_progress: bool,
    last_shown: Option<Instant>,
}

impl Terminal {
    /// Standard error; progress is shown if a person is watching.
    pub fn new() -> Self {
        Self { show_progress: io::stderr().is_terminal(), last_shown: None }
    }

    /// One line.
    pub fn say(&mut self, line: &str) {
        self.clear();
        let _ = writeln!(io::stderr(), "{line}");
    }

    /// What has been done so far, in work that began at `start`; shown a few times a second, on one line.
    pub fn progress(&mut self, start: Instant, done: impl FnOnce() -> String) {
        let due = start.elapsed() > PATIENCE && self.last_shown.is_none_or(|last| last.elapsed() > PACE);
        if self.show_progress && due {
            let _ = write!(io::stderr(), "\r\x1b[K{} …", done());
            self.last_shown = Some(Instant::now());
        }
    }

    /// Takes the line of progress away.
    pub fn clear(&mut self) {
        if self.last_shown.take().is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

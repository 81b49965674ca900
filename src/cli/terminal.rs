//! What a person reads while and after the work: standard error.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::io::Meter;
use crate::text::Bytes;

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

    /// A sentence that the user should know, though the work goes well.
    pub fn note(&mut self, sentence: &str) {
        self.say(&format!("meshbrush: note: {sentence}"));
    }

    /// What has been done so far, in work that began at `start`; shown a few times a second, on one line.
    pub fn progress(&mut self, start: Instant, done: impl FnOnce() -> String) {
        let due = start.elapsed() > PATIENCE && self.last_shown.is_none_or(|last| last.elapsed() > PACE);
        if self.show_progress && due {
            let _ = write!(io::stderr(), "\r\x1b[K{} …", done());
            self.last_shown = Some(Instant::now());
        }
    }

    /// Does work on a file while another thread shows the progress of its meter.
    pub fn while_metered<T>(&mut self, what: &str, meter: &Meter, work: impl FnOnce() -> T) -> T {
        let (start, done) = (Instant::now(), AtomicBool::new(false));
        thread::scope(|scope| {
            // Where memory is so short that there is no thread, nothing is shown.
            let watcher = thread::Builder::new().spawn_scoped(scope, || {
                while !done.load(Ordering::Relaxed) {
                    self.progress(start, || format!("{what}, {}", share(meter)));
                    thread::park_timeout(PACE);
                }
                self.clear();
            });
            let result = work();
            done.store(true, Ordering::Relaxed);
            if let Ok(watcher) = watcher {
                watcher.thread().unpark();
            }
            result
        })
    }

    /// Takes the line of progress away.
    pub fn clear(&mut self) {
        if self.last_shown.take().is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

/// How much of a file is done: percent, or bytes where the number in all is not known.
fn share(meter: &Meter) -> String {
    let done = meter.done();
    match meter.total() {
        Some(total) => format!("{:.0} %", (100.0 * done as f64 / total as f64).min(100.0)),
        None => Bytes(done as usize).to_string(),
    }
}

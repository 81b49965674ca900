//! The messages for a person during and after the work, on standard error.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::failure::Failure;
use meshbrush_io::io::{Interruption, Meter};
use meshbrush_mesh::text::{Bytes, printable};

/// Work shorter than this shows no progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two lines of progress.
const PACE: Duration = Duration::from_millis(100);

/// Goes to the start of the line, and erases it.
const ERASE: &str = "\r\x1b[K";
/// Most characters of a line of progress.
const LONGEST_LINE: usize = 78;

/// Messages and progress on standard error. Nothing that goes wrong here stops the work.
pub struct Terminal {
    show_progress: bool,
    turns: Turns,
}

/// When lines of progress were shown.
#[derive(Default)]
struct Turns {
    /// Of the line that is there.
    last: Option<Instant>,
}

impl Turns {
    /// Returns whether a line of progress of work that began at `start` is to be shown now, and counts it as
    /// shown.
    fn take(&mut self, start: Instant, now: Instant) -> bool {
        let is_due = now - start > PATIENCE && self.last.is_none_or(|last| now - last > PACE);
        if is_due {
            self.last = Some(now);
        }
        is_due
    }
}

impl Terminal {
    /// Standard error; progress is shown if a person is watching.
    pub fn new() -> Self {
        Self { show_progress: io::stderr().is_terminal(), turns: Turns::default() }
    }

    /// One line. It may repeat what a file or a person wrote.
    pub fn say(&mut self, line: &str) {
        self.clear();
        let _ = writeln!(io::stderr(), "{}", printable(line));
    }

    /// A sentence that the user should know, though the work goes well.
    pub fn note(&mut self, sentence: &str) {
        self.say(&format!("meshbrush: note: {sentence}"));
    }

    /// Shows the progress of work that began at `start` on one line, a few times a second.
    pub fn progress(&mut self, start: Instant, done: impl FnOnce() -> String) {
        if self.show_progress && self.turns.take(start, Instant::now()) {
            let _ = write!(io::stderr(), "{ERASE}{}", progress_line(&done()));
        }
    }

    /// Does work on a file, or on parts of a whole that a meter counts, while another thread shows the
    /// progress of the meter.
    pub fn while_metered<T>(&mut self, what: &str, meter: &Meter, work: impl FnOnce() -> T) -> T {
        self.while_shown(|_| format!("{what}, {}", share(meter)), work)
    }

    /// Writes a file while another thread shows how far that is. A signal leaves nothing of it, and ends the
    /// program.
    ///
    /// # Errors
    /// Fails when the file cannot be written.
    pub fn while_writing<T>(
        &mut self,
        file: &Path,
        write: impl FnOnce(&Meter) -> io::Result<T>,
    ) -> Result<T, Failure> {
        let interruption = Interruption::listen().map_err(|error| Failure::Work(format!("{error}.")))?;
        let meter = interruption.meter();
        let written = self.while_metered(&format!("writing {}", file.display()), &meter, || write(&meter));
        interruption.end_program();
        written.map_err(|error| Failure::Write { file: file.to_owned(), problem: error.to_string() })
    }

    /// Does work of which nobody knows how far it is, while another thread shows how long it has taken.
    pub fn while_working<T>(&mut self, what: &str, work: impl FnOnce() -> T) -> T {
        self.while_shown(|elapsed| format!("{what}, {} s", elapsed.as_secs()), work)
    }

    /// Does work while another thread shows a line about it, made from the time that it has taken.
    pub fn while_shown<T>(
        &mut self,
        line: impl Fn(Duration) -> String + Sync,
        work: impl FnOnce() -> T,
    ) -> T {
        let (start, done) = (Instant::now(), AtomicBool::new(false));
        thread::scope(|scope| {
            // Where memory is so short that there is no thread, nothing is shown.
            let watcher = thread::Builder::new().spawn_scoped(scope, || {
                while !done.load(Ordering::Relaxed) {
                    self.progress(start, || line(start.elapsed()));
                    thread::park_timeout(PACE);
                }
                self.clear();
            });
            // The watcher ends with the work, also where that panics: the scope waits for it.
            let ends = Ends { done: &done, watcher: watcher.as_ref().ok().map(|watcher| watcher.thread()) };
            let result = work();
            drop(ends);
            result
        })
    }

    /// Takes the line of progress away.
    pub fn clear(&mut self) {
        if self.turns.last.take().is_some() {
            let _ = write!(io::stderr(), "{ERASE}");
        }
    }
}

/// Ends the thread that shows progress.
struct Ends<'a> {
    done: &'a AtomicBool,
    watcher: Option<&'a thread::Thread>,
}

impl Drop for Ends<'_> {
    fn drop(&mut self) {
        self.done.store(true, Ordering::Relaxed);
        self.watcher.inspect(|watcher| watcher.unpark());
    }
}

/// Shortens a line of progress so that no terminal breaks it. A broken line could not be erased.
fn progress_line(text: &str) -> String {
    let text = &printable(text);
    // The end says how far the work is: it stays.
    let (count, most) = (text.chars().count(), LONGEST_LINE - 2);
    if count <= most {
        return format!("{text} …");
    }
    let start: String = text.chars().take(most / 2 - 1).collect();
    let end: String = text.chars().skip(count - most / 2).collect();
    format!("{start}…{end} …")
}

/// Returns how much of a file is done: percent, or bytes where the number in all is not known.
fn share(meter: &Meter) -> String {
    let done = meter.done();
    match meter.total() {
        Some(total) => format!("{:.0} %", (100.0 * done as f64 / total as f64).min(100.0)),
        None => Bytes(done as usize).to_string(),
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    #[test]
    fn a_panic_in_shown_work_does_not_wait_for_ever() {
        let mut terminal = Terminal { show_progress: false, turns: Turns::default() };
        let work = AssertUnwindSafe(|| terminal.while_working("failing", || panic!("on purpose")));
        assert!(catch_unwind(work).is_err());
    }

    #[test]
    fn progress_is_shown_after_a_second_and_then_ten_times_a_second_at_most() {
        let (mut turns, start) = (Turns::default(), Instant::now());
        let times: Vec<u64> =
            (0..2000).filter(|&ms| turns.take(start, start + Duration::from_millis(ms))).collect();
        let expected: Vec<u64> = (0..10).map(|turn| 1001 + 101 * turn).collect();
        assert_eq!(times, expected, "milliseconds after the start");
        assert!(turns.last.is_some(), "there is a line to be erased");
    }

    #[test]
    fn a_line_of_progress_fits_on_a_line_and_keeps_its_end() {
        assert_eq!(progress_line("writing a.vtu, 12 %"), "writing a.vtu, 12 % …");
        let file = "ä".repeat(200);
        let line = progress_line(&format!("writing {file}.vtu, 12 %"));
        assert!(line.chars().count() <= LONGEST_LINE, "{line}");
        assert!(line.starts_with("writing ää") && line.ends_with("ä.vtu, 12 % …"), "{line}");
    }

    #[test]
    fn work_gives_its_result_and_a_meter_its_share() {
        let mut terminal = Terminal { show_progress: false, turns: Turns::default() };
        let meter = Meter::default();
        assert_eq!(share(&meter), "0 MB");
        meter.expect(400);
        assert!(terminal.while_metered("reading", &meter, || meter.add(100).is_ok()));
        assert_eq!(share(&meter), "25 %");
        assert_eq!(terminal.while_working("checking", || 7), 7);
    }
}

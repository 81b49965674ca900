//! Work that takes longer than a frame. Only this module of the window starts threads, waits for them and
//! catches their panics.
//!
//! ```text
//!   Jobs::start ─→ queue ─→ thread ─→ values ─→ Job::take, in a frame     newer values, and the end
//!                              └───── panic ──→ Jobs::take_problems       one message
//! ```
//!
//! A [`Job`] belongs to the document that was open when it began, and to whoever holds it: dropped, it ends
//! the work. A [`Slot`] keeps the last value of jobs for a key that changes.

mod failure;
mod job;
mod queue;
mod slot;

use std::cell::Cell;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use eframe::egui::Context;

pub use job::{Job, Output, Taken, Wanted};
use queue::Queue;
pub use slot::Slot;

use super::document_id::DocumentId;

/// How long a frame waits for jobs, all of them together: what takes a moment is shown in the frame that
/// asked for it.
const PATIENCE: Duration = Duration::from_millis(3);

/// The purpose of a job. There are so many threads for each at most; more jobs wait their turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It computes what the window shows, or an edit of the document.
    Compute,
    /// It reads a file. Whoever started it says what a panic means.
    Read,
    /// It writes a file: a window that is being closed waits for it. Whoever started it says what a panic
    /// means.
    Write,
    /// It waits for a person or for the system.
    Ask,
    /// It keeps the journal, as long as the window is open.
    Journal,
}

impl Kind {
    const ALL: [Self; 5] = [Self::Compute, Self::Read, Self::Write, Self::Ask, Self::Journal];

    /// The most threads.
    fn most(self) -> usize {
        match self {
            Self::Compute => 6,
            Self::Read | Self::Write | Self::Ask => 4,
            Self::Journal => 3,
        }
    }
}

/// The jobs of a window. Clones are handles to the same jobs.
#[derive(Clone)]
pub struct Jobs(Rc<Shared>);

struct Shared {
    ctx: Context,
    queue: Queue,
    /// The document that is open.
    document: Cell<DocumentId>,
    /// How long this frame may still wait.
    patience: Cell<Duration>,
    /// Whether a frame waits as long as its jobs take: pictures must be the same every time.
    waits_for_all: Cell<bool>,
    problem_sender: Sender<String>,
    problems: Receiver<String>,
}

impl Jobs {
    /// None yet, in the window of `ctx`.
    pub fn new(ctx: &Context) -> Self {
        let (problem_sender, problems) = channel();
        Self(Rc::new(Shared {
            ctx: ctx.clone(),
            queue: Queue::default(),
            document: Cell::default(),
            patience: Cell::new(PATIENCE),
            waits_for_all: Cell::new(false),
            problem_sender,
            problems,
        }))
    }

    /// From now on every frame waits until its jobs have ended.
    pub fn wait_for_all(&self) {
        self.0.waits_for_all.set(true);
    }

    /// Whether every frame waits until its jobs have ended.
    pub fn waits_for_all(&self) -> bool {
        self.0.waits_for_all.get()
    }

    /// Begins a frame: it may wait again.
    pub fn begin_frame(&self) {
        self.0.patience.set(PATIENCE);
    }

    /// Another document was opened. What jobs still find for the one before is dropped.
    pub fn work_for(&self, document: DocumentId) {
        self.0.document.set(document);
    }

    /// The document that is open.
    pub fn document(&self) -> DocumentId {
        self.0.document.get()
    }

    /// Starts a job, or puts it into the queue. Each value that it sends, and its end, wakes the window.
    pub fn start<T: Send + 'static>(
        &self,
        kind: Kind,
        work: impl FnOnce(&Output<T>) + Send + 'static,
    ) -> Job<T> {
        let (job, output) = Job::new(&self.0.ctx, self.document());
        let problems = (!matches!(kind, Kind::Read | Kind::Write)).then(|| self.0.problem_sender.clone());
        self.0.queue.push(kind, move || {
            if output.is_wanted()
                && let Err(problem) = failure::caught(|| work(&output))
                && let Some(problems) = problems
            {
                // The receiver is gone when the window is closed.
                let _ = problems.send(problem);
            }
            output.end();
        });
        job
    }

    /// Messages about jobs that ended with a panic, since the last call.
    pub fn take_problems(&self) -> Vec<String> {
        self.0.problems.try_iter().collect()
    }

    /// Waits until no file is being written, or the time is over: for a window that is being closed.
    pub fn wait_for_writing(&self, longest: Duration) {
        self.0.queue.wait(Kind::Write, longest);
    }

    /// Receives a value, and waits for it as long as the frame may still wait. No other code of the window
    /// waits for a thread while it is open.
    fn receive<T>(&self, values: &Receiver<T>) -> Result<T, RecvTimeoutError> {
        if self.waits_for_all() {
            return values.recv().map_err(|_| RecvTimeoutError::Disconnected);
        }
        let began = Instant::now();
        let received = values.recv_timeout(self.0.patience.get());
        self.0.patience.set(self.0.patience.get().saturating_sub(began.elapsed()));
        received
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Goes on until nobody wants it any more.
    fn endless(output: &Output<()>) {
        while output.is_wanted() {
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_frame_waits_for_all_its_jobs_together_no_longer_than_its_patience() {
        let jobs = Jobs::new(&Context::default());
        let running: Vec<Job<()>> =
            (0..Kind::Compute.most()).map(|_| jobs.start(Kind::Compute, endless)).collect();
        jobs.begin_frame();
        assert!(running.iter().all(|job| matches!(job.take(&jobs), Taken::Working)));
        assert_eq!(jobs.0.patience.get(), Duration::ZERO, "the jobs used up one patience together");
    }

    #[test]
    fn no_more_jobs_of_a_kind_run_at_once_than_it_has_threads() {
        let jobs = Jobs::new(&Context::default());
        jobs.wait_for_all();
        let (running, most) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let started: Vec<Job<usize>> = (0..100)
            .map(|number| {
                let (running, most) = (running.clone(), most.clone());
                jobs.start(Kind::Compute, move |output| {
                    most.fetch_max(running.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
                    std::thread::yield_now();
                    running.fetch_sub(1, Ordering::SeqCst);
                    output.send(number);
                })
            })
            .collect();
        for (number, job) in started.iter().enumerate() {
            assert!(matches!(job.take(&jobs), Taken::Value(value) if value == number));
            assert!(matches!(job.take(&jobs), Taken::Ended));
        }
        assert!((1..=Kind::Compute.most()).contains(&most.load(Ordering::SeqCst)));
    }

    #[test]
    fn a_job_that_nobody_wants_any_more_does_not_begin() {
        let jobs = Jobs::new(&Context::default());
        let holding: Vec<Job<()>> = (0..Kind::Ask.most()).map(|_| jobs.start(Kind::Ask, endless)).collect();
        let begun = Arc::new(AtomicUsize::new(0));
        let begins = begun.clone();
        drop(jobs.start(Kind::Ask, move |_: &Output<()>| {
            begins.fetch_add(1, Ordering::SeqCst);
        }));
        drop(holding);
        jobs.0.queue.wait(Kind::Ask, Duration::from_secs(30));
        assert_eq!(begun.load(Ordering::SeqCst), 0);
    }

    #[test]
    fn a_window_that_is_closed_waits_for_writing_and_not_for_reading() {
        let jobs = Jobs::new(&Context::default());
        let _reading = jobs.start(Kind::Read, endless);
        let writing = jobs.start(Kind::Write, |output: &Output<u32>| {
            output.send(7);
        });
        // The reading never ends by itself: waiting for it would take an hour.
        jobs.wait_for_writing(Duration::from_secs(3600));
        assert!(matches!(writing.take_ready(), Taken::Value(7)));
    }
}

//! Work that takes longer than a frame. Only this module of the window starts threads, waits for them and
//! catches their panics.
//!
//! ```text
//!   Jobs::start ─→ queue ─→ thread ─→ one channel ─→ Jobs::begin_frame ─→ Job::take_ready    values, the end
//!                              │           └───────→ Job::take, at most 3 ms a frame in total
//!                              └─ panic ─→ Jobs::take_problems     one message, and no second attempt
//! ```
//!
//! Where the system starts no threads, as in a browser, each frame does some of the work before it begins: at
//! least one slice, and for 8 ms at most where slices are short; for 14 ms where frames are slow and the hand
//! rests. While a button is held it pauses four times as long as it worked, so that painting stays fluent.
//! Work that had a slice of more than 30 ms is left until there was no input for 400 ms, each slice for 10 s
//! at most. Nothing waits then.
//!
//! A [`Job`] belongs to the document that was open when it began, and to whoever holds it: dropped, it ends
//! the work. So a window that is closed ends all work but the files that are being written.
//!
//! A [`Slot`] keeps the last value of jobs for a key that changes. It has one job at a time. A newer key ends
//! the job for an older one by this rule:
//!
//! ```text
//!   the newer key changes again within 100 ms   the job goes on: a stroke shows the values on the way
//!   the newer key stays the same for 100 ms     the job ends, and the one for the newer key begins
//!   the job before gave way and gave nothing    the job goes on, so that something is shown in the end
//! ```
//!
//! So while a key changes, a newer value comes at least every two computations. Once it rests, its value
//! comes after one computation and 100 ms where the work looks whether it is still wanted, and after two
//! computations at the latest.

mod failure;
mod inbox;
mod job;
mod queue;
mod slot;
#[cfg(test)]
mod slot_tests;
mod succession;
#[cfg(test)]
mod tests;
mod waker;

use std::cell::Cell;
use std::panic::Location;
use std::rc::Rc;

use egui::Context;

use inbox::Inbox;
pub use job::{Job, Output, Taken, Wanted};
use queue::{Allowed, Queue, Ran, Turn};
pub use slot::{Slice, Slot};
pub use succession::Succession;
use waker::Waker;

use super::document_id::DocumentId;
use crate::kit::clock::{Duration, Instant};
use meshbrush_mesh::mesh::Progress;

/// How long a frame works on jobs where there are no threads for them.
const SHARE: Duration = Duration::from_millis(8);
/// The same for a frame that comes late, while the hand rests: where drawing takes long, frames are few.
const SHARE_OF_SLOW_FRAMES: Duration = Duration::from_millis(14);
/// A frame that comes so many seconds after the one before is late.
const SLOW: f32 = 0.05;
/// How many times as long it then pauses while a button is held.
const PAUSE: u32 = 4;
/// How long after the last input the hand counts as resting.
const REST: Duration = Duration::from_millis(400);

/// The purpose of a job. There are so many threads for each at most; more jobs wait their turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobKind {
    /// Jobs that compute contents of the window, or an edit of the document.
    Compute,
    /// Jobs that read a file. The code that started a job reports a panic.
    Read,
    /// Jobs that write a file. A window that is being closed waits for them. The code that started a job
    /// reports a panic.
    Write,
    /// Jobs that wait for a person or for the system.
    Ask,
    /// The jobs that keep the journal, as long as the window is open.
    Journal,
}

impl JobKind {
    const ALL: [Self; 5] = [Self::Compute, Self::Read, Self::Write, Self::Ask, Self::Journal];
    /// Kinds of work that frames can do, those that a person waits for first. That of the journal waits for
    /// gestures, and would not return.
    const IN_FRAMES: [Self; 4] = [Self::Ask, Self::Read, Self::Write, Self::Compute];

    /// Returns the most threads.
    fn most(self) -> usize {
        match self {
            Self::Compute => 6,
            Self::Read | Self::Write | Self::Ask => 4,
            Self::Journal => 4,
        }
    }

    /// Returns whether the window says that a job ended with a panic. Whoever reads or writes a file says it
    /// with the name of the file.
    fn reports_panic(self) -> bool {
        !matches!(self, Self::Read | Self::Write)
    }
}

/// The jobs of a window. Clones are handles to the same jobs.
#[derive(Clone)]
pub struct Jobs(Rc<Shared>);

struct Shared {
    ctx: Context,
    /// The way from the threads to the window.
    waker: Waker,
    queue: Queue,
    inbox: Inbox,
    /// How many were started.
    started: Cell<u64>,
    /// The document that is open.
    document: Cell<DocumentId>,
    /// The number of this frame.
    frame: Cell<u64>,
    /// The time of the frame, in seconds.
    time: Cell<f64>,
    /// When frames may work on jobs again while a button is held.
    pause_ends: Cell<Option<Instant>>,
    /// When the last input came.
    last_input: Cell<Option<Instant>>,
}

/// Jobs may go on for a moment when their window is closed.
impl Drop for Shared {
    fn drop(&mut self) {
        self.waker.close();
    }
}

impl Jobs {
    /// None yet, in the window of `ctx`.
    pub fn new(ctx: &Context) -> Self {
        Self(Rc::new(Shared {
            ctx: ctx.clone(),
            waker: Waker::new(ctx),
            queue: Queue::default(),
            inbox: Inbox::default(),
            started: Cell::default(),
            document: Cell::default(),
            frame: Cell::default(),
            time: Cell::default(),
            pause_ends: Cell::default(),
            last_input: Cell::default(),
        }))
    }

    /// Makes every later frame wait until its jobs have ended.
    pub fn wait_for_all(&self) {
        self.0.inbox.wait_for_all();
    }

    /// Returns whether every frame waits until its jobs have ended.
    pub fn waits_for_all(&self) -> bool {
        self.0.inbox.waits_for_all()
    }

    /// Returns whether the system starts no threads, as in a browser: frames do the work of jobs.
    pub fn is_without_threads(&self) -> bool {
        self.0.queue.is_without_threads()
    }

    /// Begins a frame at a time in seconds: what jobs have sent is delivered, and the frame may wait again.
    pub fn begin_frame(&self, time: f64) {
        self.0.time.set(time);
        self.0.frame.set(self.0.frame.get() + 1);
        if self.is_without_threads() {
            self.work_in_frame();
        }
        if self.0.inbox.begin_frame() {
            self.wake();
        }
    }

    /// Does some of the work that waits, where there are no threads.
    fn work_in_frame(&self) {
        let began = Instant::now();
        let (draws, has_input, is_slow) = self.0.ctx.input(|input| {
            let is_slow = input.unstable_dt > SLOW;
            (input.pointer.any_down(), !input.events.is_empty(), is_slow)
        });
        if draws || has_input {
            self.0.last_input.set(Some(began));
        }
        if let Some(left) = self.0.pause_ends.get().and_then(|end| end.checked_duration_since(began))
            && draws
        {
            self.wake_after(left.as_secs_f64());
            return;
        }
        let rests_from = self.0.last_input.get().map(|last| last + REST).filter(|_| !self.waits_for_all());
        let is_busy = rests_from.is_some_and(|time| time > began);
        let allowed = if is_busy { Allowed::Short } else { Allowed::All };
        let mut ran = Ran::Slice;
        while ran == Ran::Slice && (began.elapsed() < SHARE || self.waits_for_all()) {
            ran = self.0.queue.run_slice(&JobKind::IN_FRAMES, allowed);
        }
        if ran == Ran::Slice && !is_busy && is_slow {
            self.work_on_until(began + SHARE_OF_SLOW_FRAMES);
        }
        self.0.pause_ends.set(Some(Instant::now() + PAUSE * began.elapsed()));
        match ran {
            Ran::Slice => self.wake(),
            Ran::Later => self.wake_after(REST.as_secs_f64()),
            Ran::Nothing => {}
        }
    }

    /// Does more slices, of work that is known to be done in time.
    fn work_on_until(&self, end: Instant) {
        let left = || end.saturating_duration_since(Instant::now());
        while self.0.queue.run_slice(&JobKind::IN_FRAMES, Allowed::Within(left())) == Ran::Slice {}
    }

    fn frame(&self) -> u64 {
        self.0.frame.get()
    }

    /// Returns whether this frame may still wait after it has spent some more time on the values of a job.
    fn has_time_left_after(&self, spent: Duration) -> bool {
        self.0.inbox.has_time_left_after(spent)
    }

    /// Makes another frame follow this one.
    pub fn wake(&self) {
        self.0.ctx.request_repaint();
    }

    /// Another document was opened. What jobs still find for the one before is dropped.
    pub fn work_for(&self, document: DocumentId) {
        self.0.document.set(document);
    }

    /// Returns the document that is open.
    pub fn document(&self) -> DocumentId {
        self.0.document.get()
    }

    /// Starts a job, or puts it into the queue. Each value that it sends, and its end, wakes the window.
    #[track_caller]
    pub fn start<T: Send + 'static>(
        &self,
        kind: JobKind,
        work: impl FnOnce(&Output<T>) + Send + 'static,
    ) -> Job<T> {
        let mut work = Some(work);
        self.start_slices(kind, move |output| {
            if let Some(work) = work.take() {
                work(output);
            }
            Progress::Done
        })
    }

    /// Starts a job as [`Self::start`] does, whose work is done in slices: the first one makes a state, and
    /// the others are called until they are done, or until no more values are wanted. On a thread that is one
    /// loop; without threads a frame takes as many slices as it has time for.
    #[track_caller]
    pub fn start_in_slices<T: Send + 'static, S: Send + 'static>(
        &self,
        kind: JobKind,
        begin: impl FnOnce() -> Option<S> + Send + 'static,
        mut slice: impl FnMut(&mut S, &Output<T>) -> Progress + Send + 'static,
    ) -> Job<T> {
        let (mut begin, mut state) = (Some(begin), None);
        self.start_slices(kind, move |output| {
            if let Some(begin) = begin.take() {
                state = begin();
            } else if let Some(state) = &mut state {
                return slice(state, output);
            }
            if state.is_some() { Progress::More } else { Progress::Done }
        })
    }

    #[track_caller]
    fn start_slices<T: Send + 'static>(
        &self,
        kind: JobKind,
        mut slice: impl FnMut(&Output<T>) -> Progress + Send + 'static,
    ) -> Job<T> {
        let (job, output) = self.expect();
        let mut output = Some(output);
        self.0.queue.push(kind, Location::caller(), move || {
            let Some(running) = &output else { return Turn::Done };
            let done =
                if running.is_wanted() { failure::caught(|| slice(running)) } else { Ok(Progress::Done) };
            if matches!(done, Ok(Progress::More)) {
                return Turn::More;
            }
            let is_wanted = running.is_wanted();
            if let Some(output) = output.take() {
                output.end(done.err().filter(|_| kind.reports_panic()));
            }
            if is_wanted { Turn::Done } else { Turn::GivenUp }
        });
        if self.is_without_threads() {
            self.wake(); // the next frame does it
        }
        job
    }

    /// Returns a job whose values come from elsewhere, and what sends them.
    pub fn expect<T: Send + 'static>(&self) -> (Job<T>, Output<T>) {
        let Shared { waker, inbox, started, .. } = &*self.0;
        started.set(started.get() + 1);
        Job::new(started.get(), self.document(), inbox.sender(), waker)
    }

    /// Messages about jobs that ended with a panic, since the last call.
    pub fn take_problems(&self) -> Vec<String> {
        self.0.inbox.take_problems()
    }

    /// Waits until no file is being written, or the time is over: for a window that is being closed.
    pub fn wait_for_writing(&self, longest: Duration) {
        self.0.queue.wait(JobKind::Write, longest);
        self.0.inbox.drain();
    }

    /// Waits until a job has ended, however long it takes: for a window that is being closed.
    pub fn wait_for_end<T: Send + 'static>(&self, job: &Job<T>) {
        while !matches!(job.take_ready(), Taken::Ended) {
            if !self.is_without_threads() {
                self.0.inbox.receive_within(Duration::MAX);
            } else if self.0.queue.run_slice(&JobKind::IN_FRAMES, Allowed::All) == Ran::Slice {
                self.0.inbox.drain();
            } else {
                return;
            }
        }
    }

    /// Waits for the next value of any job as long as the frame may still wait. Returns whether one came.
    fn receive(&self) -> bool {
        if self.is_without_threads() {
            // What was requested in this frame is done in the next one, except where frames wait.
            let worked = self.waits_for_all()
                && self.0.queue.run_slice(&JobKind::IN_FRAMES, Allowed::All) == Ran::Slice;
            self.0.inbox.drain();
            return worked;
        }
        self.0.inbox.receive()
    }

    /// Returns the time of the frame, in seconds.
    fn time(&self) -> f64 {
        self.0.time.get()
    }

    /// Wakes the window after so many seconds.
    pub fn wake_after(&self, seconds: f64) {
        self.0.ctx.request_repaint_after(Duration::from_secs_f64(seconds));
    }
}

/// Tests that decide when the window hears of its jobs, and that wait for them without a clock.
#[cfg(any(test, feature = "hooks"))]
impl Jobs {
    /// Starts no threads from now on, as in a browser.
    pub fn do_without_threads(&self) {
        self.0.queue.do_without_threads();
    }

    /// Holds back all later values of jobs until [`Self::release`] delivers them.
    pub fn hold(&self) {
        self.0.inbox.hold();
    }

    /// Delivers what one of the jobs sent next: `choose` picks its place among so many jobs. Returns whether
    /// there was anything.
    pub fn release(&self, choose: impl FnOnce(usize) -> usize) -> bool {
        self.0.inbox.release(choose)
    }

    /// Waits until the threads of all jobs but the journal have ended.
    pub fn wait_for_threads(&self) {
        for kind in JobKind::ALL.into_iter().filter(|&kind| kind != JobKind::Journal) {
            self.0.queue.wait(kind, Duration::from_secs(60));
            assert_eq!(self.threads(kind), 0, "{kind:?} does not end");
        }
    }

    /// Returns how many jobs were started.
    pub fn started(&self) -> u64 {
        self.0.started.get()
    }

    /// Returns how many threads a kind of jobs has now.
    pub fn threads(&self, kind: JobKind) -> usize {
        self.0.queue.running(kind)
    }

    /// Waits a moment for what jobs send next.
    pub fn wait_for_news(&self, longest: Duration) {
        self.0.inbox.receive_within(longest);
    }
}

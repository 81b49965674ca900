//! The threads of jobs, and what is done where the system gives none.

use std::collections::{HashMap, VecDeque};
use std::panic::Location;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::JobKind;
use crate::kit::clock::{Duration, Instant};

/// Runs work on threads: so many of each kind at once, the others in their order. A thread ends when no work
/// of its kind waits. Clones have the same threads.
///
/// Where the system starts no thread, as in a browser, work waits for [`Self::run_slice`].
#[derive(Clone, Default)]
pub struct Queue(Arc<JobThreads>);

/// A slice that takes longer is felt by a hand that moves.
const LONG: Duration = Duration::from_millis(30);
/// What is known of the longest slice of work from a source counts for so much less after each whole run.
const KEPT: f64 = 7.0 / 8.0;
/// The longest that work waits for the hand to rest.
const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// A place of the source code that starts jobs.
pub type Source = &'static Location<'static>;

/// Work that waits for its turn.
struct WaitingJob {
    /// One slice after the other, until it says that it is done.
    run: Box<dyn FnMut() -> Turn + Send>,
    /// Where it was started.
    source: Source,
    /// The longest slice so far.
    longest: Duration,
    since: Instant,
}

/// What became of work after a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// There are more slices.
    More,
    /// All slices are done.
    Done,
    /// Nobody wants the rest.
    GivenUp,
}

/// The work of which a slice may run.
#[derive(Clone, Copy, Debug)]
pub enum Allowed {
    All,
    /// What computes and writes only where no slice of work from the same source took long: which one will
    /// depends on how much there is to do before it.
    Short,
    /// Only where no slice of work from the same source took longer, and some were run.
    Within(Duration),
}

/// What became of a question for a slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ran {
    /// A slice was run.
    Slice,
    /// All that waits takes long, and is left until the hand rests.
    Later,
    /// Nothing waits.
    Nothing,
}

#[derive(Default)]
struct JobThreads {
    state: Mutex<QueueState>,
    /// A thread ended.
    ended: Condvar,
}

/// By kind.
#[derive(Default)]
struct QueueState {
    waiting: [VecDeque<WaitingJob>; JobKind::ALL.len()],
    running: [usize; JobKind::ALL.len()],
    /// No thread could be started.
    is_without_threads: bool,
    /// How long the longest slice of work from each source takes, where frames do the work.
    longest: HashMap<Source, Duration>,
}

impl QueueState {
    /// Takes the oldest work of a kind that is allowed.
    fn take(&mut self, kind: JobKind, allowed: Allowed) -> Option<WaitingJob> {
        let can_wait = matches!(kind, JobKind::Compute | JobKind::Write);
        let may_run = |work: &WaitingJob| {
            let longest = self.longest.get(work.source);
            match allowed {
                Allowed::All => true,
                Allowed::Short => {
                    !can_wait
                        || longest.is_none_or(|longest| *longest < LONG)
                        || work.since.elapsed() > LONGEST_WAIT
                }
                Allowed::Within(time) => longest.is_some_and(|longest| *longest <= time),
            }
        };
        let at = self.waiting[kind as usize].iter().position(may_run)?;
        self.waiting[kind as usize].remove(at)
    }

    /// Notes how long a slice took. A whole run can have been short by chance, as with nothing to prove; one
    /// that was given up says nothing.
    fn note(&mut self, work: &mut WaitingJob, took: Duration, turn: Turn) {
        work.longest = work.longest.max(took);
        let known = self.longest.entry(work.source).or_default();
        let kept = if turn == Turn::Done { known.mul_f64(KEPT) } else { *known };
        *known = work.longest.max(kept);
    }
}

impl Queue {
    /// Runs work, which does not panic, as soon as a thread is free.
    pub fn push(&self, kind: JobKind, source: Source, work: impl FnMut() -> Turn + Send + 'static) {
        let work = WaitingJob { run: Box::new(work), source, longest: Duration::ZERO, since: Instant::now() };
        let mut state = self.0.lock();
        state.waiting[kind as usize].push_back(work);
        if state.running[kind as usize] == kind.most() || state.is_without_threads {
            return;
        }
        state.running[kind as usize] += 1;
        drop(state);
        let threads = self.0.clone();
        if thread::Builder::new().spawn(move || threads.run(kind)).is_err() {
            let mut state = self.0.lock();
            state.running[kind as usize] -= 1;
            // A thread that runs takes the work later.
            state.is_without_threads = state.running.iter().all(|&running| running == 0);
        }
    }

    /// Starts no threads from now on.
    #[cfg(any(test, feature = "hooks"))]
    pub fn do_without_threads(&self) {
        self.0.lock().is_without_threads = true;
    }

    /// Returns whether work waits for [`Self::run_slice`].
    pub fn is_without_threads(&self) -> bool {
        self.0.lock().is_without_threads
    }

    /// Runs a slice of the oldest work of the first of these kinds that has some, on the calling thread. Work
    /// that is not done goes to the end of its row, so that others get their turn.
    pub fn run_slice(&self, kinds: &[JobKind], allowed: Allowed) -> Ran {
        let next = |kind: &JobKind| Some((*kind, self.0.lock().take(*kind, allowed)?));
        let Some((kind, mut work)) = kinds.iter().find_map(next) else {
            let state = self.0.lock();
            let is_left = kinds.iter().any(|&kind| !state.waiting[kind as usize].is_empty());
            return if is_left { Ran::Later } else { Ran::Nothing };
        };
        let began = Instant::now();
        let turn = (work.run)();
        let mut state = self.0.lock();
        state.note(&mut work, began.elapsed(), turn);
        if turn == Turn::More {
            state.waiting[kind as usize].push_back(WaitingJob { since: Instant::now(), ..work });
        }
        Ran::Slice
    }

    /// Waits until no work of a kind runs, or the time is over. Without threads it does the work.
    pub fn wait(&self, kind: JobKind, longest: Duration) {
        if self.is_without_threads() {
            while self.run_slice(&[kind], Allowed::All) == Ran::Slice {}
            return;
        }
        let deadline = Instant::now() + longest;
        let mut state = self.0.lock();
        while state.running[kind as usize] > 0 {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return;
            }
            state = self.0.ended.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Returns how many threads a kind of work has now.
    #[cfg(any(test, feature = "hooks"))]
    pub fn running(&self, kind: JobKind) -> usize {
        self.0.lock().running[kind as usize]
    }
}

impl JobThreads {
    /// Work runs outside the lock, so that no panic leaves the state half changed.
    fn lock(&self) -> MutexGuard<'_, QueueState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the oldest work of a kind; where there is none, the thread ends.
    fn next_or_end(&self, kind: JobKind) -> Option<WaitingJob> {
        let mut state = self.lock();
        let next = state.waiting[kind as usize].pop_front();
        if next.is_none() {
            state.running[kind as usize] -= 1;
            self.ended.notify_all();
        }
        next
    }

    fn run(&self, kind: JobKind) {
        while let Some(mut work) = self.next_or_end(kind) {
            while (work.run)() == Turn::More {}
        }
    }
}

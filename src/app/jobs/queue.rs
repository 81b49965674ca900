//! The threads of jobs, and what is done where the system gives none.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::Kind;
use crate::app::clock::{Duration, Instant};
use meshbrush_mesh::mesh::Progress;

/// Runs work on threads: so many of each kind at once, the others in their order. A thread ends when no work
/// of its kind waits. Clones have the same threads.
///
/// Where the system starts no thread, as in a browser, work waits for [`Self::run_slice`].
#[derive(Clone, Default)]
pub struct Queue(Arc<Threads>);

/// One slice of work after the other, until it says that it is done.
type Work = Box<dyn FnMut() -> Progress + Send>;

#[derive(Default)]
struct Threads {
    state: Mutex<State>,
    /// A thread ended.
    ended: Condvar,
}

/// By kind.
#[derive(Default)]
struct State {
    waiting: [VecDeque<Work>; Kind::ALL.len()],
    running: [usize; Kind::ALL.len()],
    /// No thread could be started.
    is_without_threads: bool,
}

impl Queue {
    /// Runs work, which does not panic, as soon as a thread is free.
    pub fn push(&self, kind: Kind, work: impl FnMut() -> Progress + Send + 'static) {
        let mut state = self.0.lock();
        state.waiting[kind as usize].push_back(Box::new(work));
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
    #[cfg(test)]
    pub fn do_without_threads(&self) {
        self.0.lock().is_without_threads = true;
    }

    /// Returns whether work waits for [`Self::run_slice`].
    pub fn is_without_threads(&self) -> bool {
        self.0.lock().is_without_threads
    }

    /// Runs a slice of the oldest work of the first of these kinds that has some, on the calling thread. Work
    /// that is not done goes to the end of its row, so that others get their turn. Returns whether there was
    /// any.
    pub fn run_slice(&self, kinds: &[Kind]) -> bool {
        let next = |kind: &Kind| Some((*kind, self.0.lock().waiting[*kind as usize].pop_front()?));
        let Some((kind, mut work)) = kinds.iter().find_map(next) else { return false };
        if work() == Progress::More {
            self.0.lock().waiting[kind as usize].push_back(work);
        }
        true
    }

    /// Waits until no work of a kind runs, or the time is over. Without threads it does the work.
    pub fn wait(&self, kind: Kind, longest: Duration) {
        if self.is_without_threads() {
            while self.run_slice(&[kind]) {}
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
    #[cfg(test)]
    pub fn running(&self, kind: Kind) -> usize {
        self.0.lock().running[kind as usize]
    }
}

impl Threads {
    /// Work runs outside the lock, so that no panic leaves the state half changed.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the oldest work of a kind; where there is none, the thread ends.
    fn next_or_end(&self, kind: Kind) -> Option<Work> {
        let mut state = self.lock();
        let next = state.waiting[kind as usize].pop_front();
        if next.is_none() {
            state.running[kind as usize] -= 1;
            self.ended.notify_all();
        }
        next
    }

    fn run(&self, kind: Kind) {
        while let Some(mut work) = self.next_or_end(kind) {
            while work() == Progress::More {}
        }
    }
}

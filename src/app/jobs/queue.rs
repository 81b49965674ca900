//! The threads of jobs.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::Kind;

/// Runs work on threads: so many of each kind at once, the others in their order. A thread ends when no work
/// of its kind waits. Clones have the same threads.
#[derive(Clone, Default)]
pub struct Queue(Arc<Threads>);

type Work = Box<dyn FnOnce() + Send>;

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
}

impl Queue {
    /// Runs work, which does not panic, as soon as a thread is free.
    pub fn push(&self, kind: Kind, work: impl FnOnce() + Send + 'static) {
        let mut state = self.0.lock();
        if state.running[kind as usize] == kind.most() {
            state.waiting[kind as usize].push_back(Box::new(work));
            return;
        }
        state.running[kind as usize] += 1;
        drop(state);
        let threads = self.0.clone();
        thread::spawn(move || threads.run(kind, Box::new(work)));
    }

    /// Waits until no work of a kind runs, or the time is over.
    pub fn wait(&self, kind: Kind, longest: Duration) {
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

    fn run(&self, kind: Kind, first: Work) {
        let mut next = Some(first);
        while let Some(work) = next {
            work();
            let mut state = self.lock();
            next = state.waiting[kind as usize].pop_front();
            if next.is_none() {
                state.running[kind as usize] -= 1;
                self.ended.notify_all();
            }
        }
    }
}

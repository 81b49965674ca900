//! The threads on which the window computes. It draws on others.

use std::num::NonZeroUsize;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// How many threads work may take, and the threads of work that goes on in every frame.
///
/// ```text
///   frame   ── slice ──┐        ┌── draw ──     The mesh has threads of its own, so that no frame waits for
///                      └ mesh ──┘               a file; so has each file that is read or written.
///   file    ─────────────────────────────
/// ```
pub struct Threads {
    count: NonZeroUsize,
    /// Absent where the system gives no threads: work is then done where it is asked for.
    pool: Option<ThreadPool>,
}

impl Default for Threads {
    fn default() -> Self {
        Self::new(Self::most())
    }
}

impl Threads {
    /// Uses `count` threads, or [`Self::most`] where that is less.
    pub fn new(count: NonZeroUsize) -> Self {
        let count = count.min(Self::most());
        Self { count, pool: ThreadPoolBuilder::new().num_threads(count.get()).build().ok() }
    }

    /// Returns the number of threads that the command line allows: one for each core without `--threads`.
    pub fn most() -> NonZeroUsize {
        NonZeroUsize::new(rayon::current_num_threads()).unwrap_or(NonZeroUsize::MIN)
    }

    /// Returns how many there are.
    pub fn count(&self) -> NonZeroUsize {
        self.count
    }

    /// Returns how many there are, where they are fewer than there may be.
    pub fn limit(&self) -> Option<NonZeroUsize> {
        Some(self.count).filter(|&count| count < Self::most())
    }

    /// Does work on these threads, and waits for it.
    pub fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_has_as_many_threads_as_were_asked_for_and_are_allowed() {
        let most = Threads::most();
        for (asked, got) in [(1, 1), (most.get(), most.get()), (most.get() + 1, most.get())] {
            let threads = Threads::new(NonZeroUsize::new(asked).unwrap());
            assert_eq!((threads.count().get(), threads.run(rayon::current_num_threads)), (got, got));
        }
    }
}

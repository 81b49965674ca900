//! The threads that refine meshes.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::thread;

use rayon::ThreadPoolBuilder;

/// The most threads, or as many as the machine has processors where it has more: threads that wait for a
/// processor only disturb each other.
const MOST: usize = 64;

fn processors() -> usize {
    thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// Returns the most threads that work at a time.
pub fn most() -> usize {
    processors().max(MOST)
}

/// Starts the threads for the whole process, as many as are wanted at most: as many as the system allows, or
/// none. Returns what the user should know.
pub fn start(wanted: Option<NonZeroUsize>) -> Option<String> {
    let (cores, most) = (processors(), most());
    let of_environment = || std::env::var("RAYON_NUM_THREADS").ok()?.parse().ok();
    let count = wanted.or_else(of_environment).map_or(cores, NonZeroUsize::get).min(most);
    let mut started = count;
    while started > 1 && !can_start(started) {
        started /= 2;
    }
    let mut pool = ThreadPoolBuilder::new().num_threads(started);
    if started == 1 && !can_start(1) {
        // The work is done by the thread that asks for it.
        pool = pool.use_current_thread();
    }
    // It fails where threads were started before: only tests run two commands in one process.
    let _ = pool.build_global();
    match wanted {
        Some(wanted) if wanted.get() > most => Some(format!(
            "--threads {wanted}: this machine has {cores} processors, and {most} threads are used."
        )),
        _ if started < count => {
            Some(format!("the system allows no {count} threads now; the work is done with {started}."))
        }
        _ => None,
    }
}

/// Returns whether the system allows `count` threads at a time.
fn can_start(count: usize) -> bool {
    let gate = Mutex::new(());
    let closed = gate.lock().unwrap_or_else(PoisonError::into_inner);
    thread::scope(|scope| {
        let wait = || drop(gate.lock().unwrap_or_else(PoisonError::into_inner));
        let started = (0..count).map_while(|_| thread::Builder::new().spawn_scoped(scope, wait).ok());
        let started = started.count();
        drop(closed);
        started == count
    })
}

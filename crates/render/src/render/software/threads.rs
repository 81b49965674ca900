//! The threads that draw.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Draws on threads of their own, one for each core: those of all other work can be busy for longer than a
/// frame, as when a file is written.
pub fn on_drawing_threads<R: Send>(draw: impl FnOnce() -> R + Send) -> R {
    static THREADS: OnceLock<Option<ThreadPool>> = OnceLock::new();
    let threads =
        THREADS.get_or_init(|| ThreadPoolBuilder::new().thread_name(|n| format!("draw {n}")).build().ok());
    match threads {
        Some(threads) => threads.install(draw),
        None => draw(),
    }
}

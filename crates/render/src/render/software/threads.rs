//! The threads for drawing.

use std::sync::OnceLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Runs `draw` on a pool of threads that is used for drawing only, one for each core. The threads of all
/// other work can be busy for longer than a frame, for example while a file is written.
pub fn on_drawing_threads<R: Send>(draw: impl FnOnce() -> R + Send) -> R {
    static THREADS: OnceLock<Option<ThreadPool>> = OnceLock::new();
    let threads =
        THREADS.get_or_init(|| ThreadPoolBuilder::new().thread_name(|n| format!("draw {n}")).build().ok());
    match threads {
        Some(threads) => threads.install(draw),
        None => draw(),
    }
}

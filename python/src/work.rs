//! Long work: on a thread of its own, with progress, until a signal ends it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use meshbrush_cli::cli::threads::most;
use meshbrush_io::io::Meter;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Time between two looks for signals.
const LOOK: Duration = Duration::from_millis(20);
/// Time between two calls of the function that is told the progress.
const TELL: Duration = Duration::from_millis(100);
/// As large as the stack of a main thread.
const STACK: usize = 8 << 20;

/// What work tells about itself, and whether it should go on.
#[derive(Clone, Default)]
pub struct Watch {
    /// Counts bytes of files, and is cancelled with the work.
    pub meter: Meter,
    stage: Arc<Mutex<(&'static str, u64)>>,
}

impl Watch {
    /// Notes what is being done, and how much of it is done.
    pub fn tell(&self, stage: &'static str, done: u64) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = (stage, done);
    }

    /// Returns whether nobody waits for the result any more.
    pub fn is_cancelled(&self) -> bool {
        self.meter.is_cancelled()
    }

    fn told(&self) -> (&'static str, u64) {
        let (stage, done) = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        (stage, if self.meter.total().is_some() { self.meter.done() } else { done })
    }
}

/// How work is watched.
#[derive(FromPyObject)]
pub struct Watching {
    /// A function of the stage and of what is done of it.
    #[pyo3(item)]
    pub progress: Option<Py<PyAny>>,
    /// The number of threads; by default all of the machine.
    #[pyo3(item)]
    pub threads: Option<usize>,
}

impl Watching {
    /// For work that tells nothing.
    pub const QUIET: Self = Self { progress: None, threads: None };
}

/// Does work on another thread, with no lock of Python held.
///
/// # Errors
/// Fails at once with the error of a signal's handler, such as `KeyboardInterrupt`, or of the function that
/// is told the progress. The work is then cancelled, and its result is dropped when it comes.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    Watching { progress, threads }: &Watching,
    work: impl FnOnce(&Watch) -> T + Send + 'static,
) -> PyResult<T> {
    let watch = Watch::default();
    let (own, pool) = (watch.clone(), own_pool(*threads)?);
    let (send, mut receive) = channel();
    let doing = move || {
        let work = || catch_unwind(AssertUnwindSafe(|| work(&own)));
        let result = match pool {
            Some(pool) => pool.install(work),
            None => work(),
        };
        // Nobody may be listening any more.
        let _ = send.send(result);
    };
    std::thread::Builder::new().stack_size(STACK).spawn(doing)?;
    let mut told = Instant::now();
    loop {
        // A receiver is for one thread at a time: it goes there and comes back.
        let answer;
        (receive, answer) = py.detach(move || {
            let answer = receive.recv_timeout(LOOK);
            (receive, answer)
        });
        match answer {
            Ok(Ok(result)) => return Ok(result),
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => {
                let message =
                    "Meshbrush has failed at a mistake of its own. Please report this, with the text above.";
                return Err(PyRuntimeError::new_err(message));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        let mut heard = py.check_signals();
        if let (Ok(()), Some(progress), true) = (&heard, progress, told.elapsed() > TELL) {
            heard = progress.call1(py, watch.told()).map(|_| ());
            told = Instant::now();
        }
        if let Err(error) = heard {
            watch.meter.cancel();
            return Err(error);
        }
    }
}

/// The process that imported the module.
static IMPORTED_BY: OnceLock<u32> = OnceLock::new();

/// Notes which process has the threads of rayon: one that was forked from it has none.
pub fn note_process() {
    IMPORTED_BY.get_or_init(std::process::id);
}

/// Returns threads for one piece of work alone, where the default ones are not wanted or not there.
///
/// The default ones are used from outside: within them, a thread that waits takes up any other work, which
/// could wait for a document that the first has locked.
fn own_pool(threads: Option<usize>) -> PyResult<Option<ThreadPool>> {
    let is_forked = IMPORTED_BY.get().is_some_and(|&process| process != std::process::id());
    let threads = match threads {
        Some(0) => return Err(crate::errors::mesh_error("threads = 0: there must be 1 thread at least.")),
        Some(threads) => threads.min(most()),
        None if is_forked => 0,
        None => return Ok(None),
    };
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map(Some).map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

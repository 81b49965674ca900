//! A job, seen from the window and from its thread.

use crate::kit::clock::Instant;
use std::cell::Cell;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use super::Jobs;
use super::inbox::Parcel;
use super::waker::Waker;
use crate::kit::document_id::DocumentId;

/// Whether the values of a job are still wanted. Clones know the same.
#[derive(Clone, Debug)]
pub struct Wanted(Arc<AtomicBool>);

impl Wanted {
    /// Returns whether they are. Long work checks this between its steps, and ends where they are not.
    pub fn goes_on(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A job in the window. Dropped, it tells the thread to end.
pub struct Job<T> {
    values: Arc<Values<T>>,
    wanted: Wanted,
    document: DocumentId,
    /// The frame that took the last value, and when.
    given: Cell<Option<(u64, Instant)>>,
}

/// The next result of a job.
#[derive(Debug)]
pub enum Taken<T> {
    /// The next value.
    Value(T),
    /// None yet.
    Working,
    /// No more: the work is done, was cancelled, or panicked.
    Ended,
}

/// The values of a job that were delivered. Only the window's thread uses them, but parcels carry them.
struct Values<T>(Mutex<Delivered<T>>);

struct Delivered<T> {
    waiting: VecDeque<T>,
    has_ended: bool,
}

impl<T> Values<T> {
    fn lock(&self) -> MutexGuard<'_, Delivered<T>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> Job<T> {
    /// Returns the document that was open when it began.
    pub fn document(&self) -> DocumentId {
        self.document
    }

    /// Takes the next value, and waits for it as long as the frame may still wait.
    ///
    /// A caller may ask again and again, until there is no value: what it does between two values of a frame
    /// counts as waiting, and once the frame may not wait any more, further values are left for the next one.
    pub fn take(&self, jobs: &Jobs) -> Taken<T> {
        if let Some((frame, at)) = self.given.get()
            && frame == jobs.frame()
            && !jobs.has_time_left_after(at.elapsed())
        {
            // The thread may have sent its last value already, and woken the window for the last time.
            jobs.wake();
            return Taken::Working;
        }
        loop {
            match self.take_ready() {
                Taken::Working if jobs.receive() => {}
                Taken::Value(value) => {
                    self.given.set(Some((jobs.frame(), Instant::now())));
                    return Taken::Value(value);
                }
                taken => return taken,
            }
        }
    }

    /// Takes the next value if it was delivered. Only where frames wait for all jobs does it wait.
    pub fn poll(&self, jobs: &Jobs) -> Taken<T> {
        if jobs.waits_for_all() { self.take(jobs) } else { self.take_ready() }
    }

    /// Takes the next value if it was delivered.
    pub fn take_ready(&self) -> Taken<T> {
        let mut delivered = self.values.lock();
        match delivered.waiting.pop_front() {
            Some(value) => Taken::Value(value),
            None if delivered.has_ended => Taken::Ended,
            None => Taken::Working,
        }
    }

    /// Tells the thread to end.
    pub fn cancel(&self) {
        self.wanted.0.store(false, Ordering::Relaxed);
    }

    /// Returns whether the thread was told to end.
    pub fn is_cancelled(&self) -> bool {
        !self.wanted.goes_on()
    }
}

impl<T: Send + 'static> Job<T> {
    /// A job with this number, and its side on the thread, which sends and wakes the window.
    pub(super) fn new(
        number: u64,
        document: DocumentId,
        sender: &Sender<Parcel>,
        waker: &Waker,
    ) -> (Self, Output<T>) {
        let values = Arc::new(Values(Mutex::new(Delivered { waiting: VecDeque::new(), has_ended: false })));
        let wanted = Wanted(Arc::new(AtomicBool::new(true)));
        let output = Output {
            number,
            values: Arc::downgrade(&values),
            sender: sender.clone(),
            wanted: wanted.clone(),
            waker: waker.clone(),
        };
        (Self { values, wanted, document, given: Cell::default() }, output)
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancel();
    }
}

/// A job on its thread.
pub struct Output<T> {
    number: u64,
    /// The destination of the values; gone once the job was dropped.
    values: Weak<Values<T>>,
    sender: Sender<Parcel>,
    wanted: Wanted,
    waker: Waker,
}

impl<T: Send + 'static> Output<T> {
    /// Returns whether more values are wanted.
    pub fn is_wanted(&self) -> bool {
        self.wanted.goes_on()
    }

    /// Returns the flag that says whether the values are still wanted, for functions that the job calls.
    pub fn wanted(&self) -> &Wanted {
        &self.wanted
    }

    /// Sends a value. Returns whether more are wanted.
    pub fn send(&self, value: T) -> bool {
        // Where nobody holds the job, its value ends here and not on the window's thread.
        if self.values.strong_count() > 0 {
            self.post(None, |delivered| delivered.waiting.push_back(value));
        }
        self.is_wanted()
    }

    /// Wakes the window without a value.
    pub fn wake(&self) {
        self.waker.wake();
    }

    /// Sends the end: the window finds that there are no more values, and the sentence about a panic.
    pub(super) fn end(self, problem: Option<String>) {
        self.post(problem, |delivered| delivered.has_ended = true);
    }

    fn post(&self, problem: Option<String>, deliver: impl FnOnce(&mut Delivered<T>) + Send + 'static) {
        let values = self.values.clone();
        let deliver = Box::new(move || {
            if let Some(values) = values.upgrade() {
                deliver(&mut values.lock());
            }
        });
        // The receiver is gone when the window is closed.
        let _ = self.sender.send(Parcel { job: self.number, deliver, problem });
        self.waker.wake();
    }
}

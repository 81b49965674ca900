//! The one channel on which all jobs of a window send, and the one place where the window waits for them.

use crate::kit::clock::{Duration, Instant};
use std::cell::{Cell, RefCell};
use std::sync::mpsc::{Receiver, Sender, channel};

/// How long a frame waits for jobs, all of them together: what takes a moment is shown in the frame that
/// asked for it.
const PATIENCE: Duration = Duration::from_millis(3);

/// A value of a job, or its end.
pub struct Parcel {
    /// The number of the job.
    #[cfg_attr(
        not(any(test, feature = "hooks")),
        expect(dead_code, reason = "only tests deliver in another order")
    )]
    pub job: u64,
    /// Puts it where whoever holds the job finds it.
    pub deliver: Box<dyn FnOnce() + Send>,
    /// A sentence about the panic that ended the job.
    pub problem: Option<String>,
}

/// The values that jobs have sent.
pub struct Inbox {
    sender: Sender<Parcel>,
    parcels: Receiver<Parcel>,
    /// How long this frame may still wait.
    patience: Cell<Duration>,
    waits_for_all: Cell<bool>,
    problems: RefCell<Vec<String>>,
    /// The values that a test holds back.
    #[cfg(any(test, feature = "hooks"))]
    held: RefCell<Option<Vec<Parcel>>>,
}

impl Default for Inbox {
    fn default() -> Self {
        let (sender, parcels) = channel();
        Self {
            sender,
            parcels,
            patience: Cell::new(PATIENCE),
            waits_for_all: Cell::new(false),
            problems: RefCell::default(),
            #[cfg(any(test, feature = "hooks"))]
            held: RefCell::default(),
        }
    }
}

impl Inbox {
    /// Returns the channel to which jobs send.
    pub fn sender(&self) -> &Sender<Parcel> {
        &self.sender
    }

    /// Makes every later frame wait as long as its jobs take.
    pub fn wait_for_all(&self) {
        self.waits_for_all.set(true);
    }

    /// Returns whether a frame waits as long as its jobs take.
    pub fn waits_for_all(&self) -> bool {
        self.waits_for_all.get()
    }

    /// Begins a frame: it may wait again, and what has come is delivered. Returns whether more has come than
    /// a frame has time for.
    pub fn begin_frame(&self) -> bool {
        self.patience.set(PATIENCE);
        let began = Instant::now();
        while let Some(parcel) = self.next_ready() {
            self.deliver(parcel);
            if began.elapsed() > PATIENCE && !self.waits_for_all() {
                return true;
            }
        }
        false
    }

    /// Delivers what has come.
    pub fn drain(&self) {
        while let Some(parcel) = self.next_ready() {
            self.deliver(parcel);
        }
    }

    /// Waits for the next parcel of any job as long as the frame may still wait, and delivers it. Returns
    /// whether one came. No other code of the window waits for a job while it is open.
    pub fn receive(&self) -> bool {
        let may_wait = self.waits_for_all() || !self.patience.get().is_zero();
        if self.is_held() || !may_wait {
            return false;
        }
        let parcel = if self.waits_for_all() {
            self.parcels.recv().ok()
        } else {
            let began = Instant::now();
            let parcel = self.parcels.recv_timeout(self.patience.get()).ok();
            self.patience.set(self.patience.get().saturating_sub(began.elapsed()));
            parcel
        };
        parcel.map(|parcel| self.deliver(parcel)).is_some()
    }

    /// Waits for the next parcel of any job, and delivers it: for a window that is being closed. Returns
    /// whether one came in time.
    pub fn receive_within(&self, longest: Duration) -> bool {
        self.parcels.recv_timeout(longest).map(|parcel| self.deliver(parcel)).is_ok()
    }

    /// Returns whether this frame may still wait after it has spent some more time on the values of a job.
    pub fn has_time_left_after(&self, spent: Duration) -> bool {
        self.patience.set(self.patience.get().saturating_sub(spent));
        self.waits_for_all() || !self.patience.get().is_zero()
    }

    /// Messages about jobs that ended with a panic, since the last call.
    pub fn take_problems(&self) -> Vec<String> {
        self.problems.take()
    }

    fn next_ready(&self) -> Option<Parcel> {
        if self.is_held() { None } else { self.parcels.try_recv().ok() }
    }

    fn deliver(&self, Parcel { job: _, deliver, problem }: Parcel) {
        self.problems.borrow_mut().extend(problem);
        deliver();
    }

    #[cfg(not(any(test, feature = "hooks")))]
    fn is_held(&self) -> bool {
        false
    }

    /// Returns how long this frame may still wait.
    #[cfg(test)]
    pub fn patience(&self) -> Duration {
        self.patience.get()
    }

    /// Uses up what this frame may wait.
    #[cfg(test)]
    pub fn use_up_patience(&self) {
        self.patience.set(Duration::ZERO);
    }
}

/// A test that decides when the window hears of its jobs.
#[cfg(any(test, feature = "hooks"))]
impl Inbox {
    /// Holds back all later values until [`Self::release`] delivers them.
    pub fn hold(&self) {
        self.held.replace(Some(Vec::new()));
    }

    fn is_held(&self) -> bool {
        self.held.borrow().is_some()
    }

    /// Delivers the oldest parcel of one of the jobs that have sent some: `choose` picks its place among so
    /// many jobs. Returns whether there was one.
    pub fn release(&self, choose: impl FnOnce(usize) -> usize) -> bool {
        let parcel = {
            let mut held = self.held.borrow_mut();
            let held = held.as_mut().expect("the test holds the jobs");
            held.extend(self.parcels.try_iter());
            let mut jobs: Vec<u64> = held.iter().map(|parcel| parcel.job).collect();
            jobs.sort_unstable();
            jobs.dedup();
            if jobs.is_empty() {
                return false;
            }
            let job = jobs[choose(jobs.len())];
            let oldest = held.iter().position(|parcel| parcel.job == job).expect("it is one of these");
            held.remove(oldest)
        };
        self.deliver(parcel);
        true
    }
}

//! The window's own values and its way of working in slices, and a field that its benches share.

use std::time::{Duration, Instant};

use meshbrush_core::document::{Document, Follower, Pace};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::LayerKind;
use meshbrush_core::paint::{Brush, Medium};

/// `FRAME_BUDGET` in `app/frame.rs`.
pub const FRAME_BUDGET: Duration = Duration::from_millis(7);
/// `SLICE` in `kit/slices.rs`.
pub const SLICE: usize = 2048;
/// The default brush on the unit square.
pub const BRUSH: Brush = Brush { medium: Medium::Risk(1.0), radius: 0.06, hardness: 0.35, strength: 0.8 };

/// On the unit square, a target diameter of `fine` below a wave at about `height`, and 0.2 above it: so a
/// stroke crosses fine and coarse parts.
pub fn wave(height: f64, fine: f64) -> LayerKind {
    let formula = format!("if(y < {height} + 0.1 * sin(7 * x), {fine}, 0.2)");
    LayerKind::target(Formula::parse(&formula).expect("a valid formula"))
}

/// Work in slices, as `kit/slices.rs` does it.
#[derive(Default)]
pub struct Slices {
    pace: Pace,
    /// The longest slice so far.
    pub longest: Duration,
}

impl Slices {
    /// Works until `slice` says that it is done, and returns the time. `slice` is given the number of
    /// triangles to look at.
    pub fn run(&mut self, mut slice: impl FnMut(usize) -> bool) -> Duration {
        let began = Instant::now();
        let mut is_done = false;
        while !is_done {
            is_done = self.one(&mut slice);
        }
        began.elapsed()
    }

    /// Does one slice, and returns whether the work is done.
    pub fn one(&mut self, slice: impl FnOnce(usize) -> bool) -> bool {
        let began = Instant::now();
        let is_done = slice(self.pace.visits());
        let time = began.elapsed();
        self.pace.took(time.as_secs_f64());
        self.longest = self.longest.max(time);
        is_done
    }

    /// Brings the mesh up to date, and returns the time.
    pub fn follow(&mut self, document: &mut Document, follower: &mut Follower) -> Duration {
        self.run(|visits| follower.advance(document, visits).expect("the budget is far").is_settled())
    }
}

/// A number of threads, and their pool.
pub struct Pool {
    pool: rayon::ThreadPool,
    pub threads: usize,
}

impl Pool {
    /// Returns the pool of so many threads.
    pub fn of(threads: usize) -> Self {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads");
        Self { pool, threads }
    }

    /// Works on one of the threads; the others help where the work can be divided.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }
}

/// Returns a pool of one thread, and one of all threads of the machine if it has more.
pub fn pools() -> Vec<Pool> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut pools = vec![Pool::of(1)];
    pools.extend((all > 1).then(|| Pool::of(all)));
    pools
}

/// Returns the median of some times, in milliseconds.
pub fn median_ms(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times.get(times.len() / 2).map_or(0.0, |time| 1e3 * time.as_secs_f64())
}

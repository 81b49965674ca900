//! The clock by which the runs of the experiment are timed.

use web_time::Instant;

use meshbrush_study::report::RunTime;

/// A clock of the thread that reads it.
#[derive(Clone, Copy, Debug)]
pub struct RunClock(Instant);

impl RunClock {
    /// Returns a clock whose wall time begins now.
    pub fn start() -> Self {
        Self(Instant::now())
    }

    /// Reads the clock. Two readings can be compared if the same thread takes them.
    pub fn now(&self) -> RunTime {
        RunTime { wall: self.0.elapsed().as_secs_f64(), processor: processor_time() }
    }
}

/// Returns how long the present thread has had a processor, in seconds.
#[cfg(unix)]
fn processor_time() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

#[cfg(not(unix))]
fn processor_time() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_thread_that_sleeps_takes_no_processor_time() {
        let clock = RunClock::start();
        let before = clock.now();
        std::thread::sleep(std::time::Duration::from_millis(30));
        let slept = clock.now().since(before);
        assert!(slept.wall >= 0.03 && slept.processor.unwrap() < 0.01, "{slept:?}");
        assert!(slept.is_interrupted());
    }
}

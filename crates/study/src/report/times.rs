//! How long runs take on one thread, and whether anything disturbed them.

use serde::Serialize;

/// A run whose thread had the processor for less than this share of the time was interrupted.
const LEAST_SHARE: f64 = 0.9;
/// Runs of one mesh whose median is larger than the least by this factor were disturbed.
const MOST_SPREAD: f64 = 1.25;

/// The time of a run, or the reading of a clock, in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunTime {
    /// By the clock on the wall.
    pub wall: f64,
    /// While the thread had a processor; `None` on platforms that do not count it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub processor: Option<f64>,
}

impl RunTime {
    /// Returns the time since an earlier reading of the same clock.
    pub fn since(self, earlier: Self) -> Self {
        let processor = self.processor.zip(earlier.processor).map(|(now, then)| now - then);
        Self { wall: self.wall - earlier.wall, processor }
    }

    /// Returns the processor time, or the wall time where the former is unknown.
    pub fn seconds(self) -> f64 {
        self.processor.unwrap_or(self.wall)
    }

    /// Returns whether other work had the processor for a part of the run.
    pub fn is_interrupted(self) -> bool {
        self.processor.is_some_and(|processor| processor < LEAST_SHARE * self.wall)
    }
}

/// Returns the minimum and the maximum time of some runs. A load only adds to a time, so that the minimum is
/// the best estimate. [`f64::INFINITY`] and 0 without runs.
pub(super) fn span(runs: &[RunTime]) -> [f64; 2] {
    let seconds = runs.iter().map(|run| run.seconds());
    seconds.fold([f64::INFINITY, 0.0], |[least, greatest], time| [least.min(time), greatest.max(time)])
}

/// Returns whether most of some runs took much longer than the least.
pub(super) fn is_spread(runs: &[RunTime]) -> bool {
    let mut seconds: Vec<f64> = runs.iter().map(|run| run.seconds()).collect();
    seconds.sort_by(f64::total_cmp);
    seconds.get(seconds.len() / 2).is_some_and(|median| *median > MOST_SPREAD * seconds[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times<const N: usize>(seconds: [f64; N]) -> [RunTime; N] {
        seconds.map(|wall| RunTime { wall, processor: None })
    }

    #[test]
    fn one_slow_run_neither_moves_the_least_nor_counts_as_spread() {
        let runs = times([2.0, 9.0, 2.1]);
        assert_eq!(span(&runs), [2.0, 9.0]);
        assert!(!is_spread(&runs));
        assert!(is_spread(&times([2.0, 9.0, 2.6])), "most runs were disturbed");
        assert!(!is_spread(&[]));
    }

    #[test]
    fn a_run_without_the_processor_is_interrupted() {
        let run = |wall, processor| RunTime { wall, processor };
        assert!(run(2.0, Some(1.0)).is_interrupted());
        assert!(!run(2.0, Some(1.95)).is_interrupted() && !run(2.0, None).is_interrupted());
        assert_eq!(run(3.0, Some(2.5)).since(run(1.0, Some(1.0))), run(2.0, Some(1.5)));
        assert_eq!([run(2.0, Some(1.0)).seconds(), run(2.0, None).seconds()], [1.0, 2.0]);
    }
}

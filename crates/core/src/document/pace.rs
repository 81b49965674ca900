//! How much work fits into a slice.

use crate::layers::SizeField;

/// Chooses the number of triangles of a slice by the time that the slices before took: between half a
/// millisecond and two.
///
/// A question to a stack of layers can take a thousand times as long as one to plain paint. Slices are long
/// enough to occupy all threads, and short enough for the time left in a frame. The mesh does not depend on
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pace {
    visits: usize,
}

impl Pace {
    /// Seconds.
    const SHORT: f64 = 0.5e-3;
    const LONG: f64 = 2e-3;
    /// No more: the next questions can be a hundred times as dear as the last ones.
    const VISITS: std::ops::RangeInclusive<usize> = 32..=2048;

    /// Returns how many triangles to look at in the next slice.
    pub fn visits(self) -> usize {
        self.visits
    }

    /// Notes how many seconds the last slice took.
    pub fn took(&mut self, seconds: f64) {
        if seconds < Self::SHORT {
            self.visits = (2 * self.visits).min(*Self::VISITS.end());
        } else if seconds > Self::LONG {
            // Straight to what would have taken a millisecond: the next slice can be as dear.
            let share = 1e-3 / seconds;
            self.visits = ((self.visits as f64 * share) as usize).max(*Self::VISITS.start());
        }
    }
}

/// Returns how many questions to a field are worth another thread, in a slice of `visits` triangles. In a
/// slice that the pace has shortened, an eighth of them is enough: they take an eighth of a millisecond.
pub(super) fn questions_per_thread(visits: usize, field: &SizeField) -> usize {
    let of_field = field.questions_per_thread();
    if visits < *Pace::VISITS.end() { of_field.min(visits / 8) } else { of_field }
}

impl Default for Pace {
    fn default() -> Self {
        Self { visits: 256 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_that_took_ten_times_as_long_as_it_may_is_followed_by_a_tenth() {
        let mut pace = Pace { visits: 2048 };
        pace.took(10e-3);
        assert_eq!(pace.visits(), 204);
        pace.took(1.0);
        assert_eq!(pace.visits(), *Pace::VISITS.start());
    }

    #[test]
    fn slices_grow_while_they_are_short_and_shrink_at_once_when_they_are_long() {
        let mut pace = Pace::default();
        let mut slice = |cost: f64| {
            let seconds = cost * pace.visits() as f64;
            pace.took(seconds);
            seconds
        };
        for cost in [20e-9, 20e-6, 0.5e-6, 60e-6, 1e-9] {
            let times: Vec<f64> = (0..20).map(|_| slice(cost)).collect();
            let settled = &times[10..];
            assert!(settled.windows(2).all(|pair| pair[0] == pair[1]), "{settled:?}");
            assert!(settled[0] <= Pace::LONG, "{settled:?}");
            let is_largest = settled[0] == cost * 2048.0;
            assert!(is_largest || settled[0] >= Pace::SHORT / 2.0, "{settled:?}");
        }
    }
}

//! A sum of numbers of very different sizes, which are also taken away again.

/// A sum with a rest: about twice the digits of one number \[Knuth1997\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TwoSum {
    sum: f64,
    rest: f64,
}

impl TwoSum {
    pub(super) fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        let of_term = sum - self.sum;
        let lost = (self.sum - (sum - of_term)) + (term - of_term);
        let rest = self.rest + lost;
        // The larger part stays in `sum`.
        self.sum = sum + rest;
        self.rest = rest - (self.sum - sum);
    }

    pub(super) fn value(self) -> f64 {
        self.sum + self.rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_terms_are_left_when_large_ones_are_taken_away() {
        let mut sum = TwoSum::default();
        let terms: Vec<f64> = (0..1000).map(|n| 1e9 / f64::from(n * n + 1)).collect();
        terms.iter().for_each(|term| sum.add(*term));
        sum.add(1e-12);
        terms.iter().for_each(|term| sum.add(-term));
        assert!((sum.value() - 1e-12).abs() < 1e-16, "{}", sum.value());
    }
}

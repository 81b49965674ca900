/// Returns the largest of 1, 2 and 5 times a power of ten that is at most `limit`, which is positive.
pub fn round_below(limit: f64) -> f64 {
    let decade = libm::exp10(libm::floor(libm::log10(limit)));
    // The logarithm may be rounded up to the next decade.
    let decade = if decade > limit { decade / 10.0 } else { decade };
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * decade <= limit * (1.0 + 1e-12));
    factor.unwrap_or(1.0) * decade
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_numbers_are_one_two_or_five() {
        let mut random = fastrand::Rng::with_seed(33);
        for _ in 0..2000 {
            let decade = 10_f64.powi(random.i32(-12..13));
            let limit = decade * (1.0 + 9.0 * random.f64());
            let round = round_below(limit);
            let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade);
            let place = steps.iter().position(|step| (round / step - 1.0).abs() < 1e-12);
            let place = place.unwrap_or_else(|| panic!("{round} of {limit} is not round"));
            assert!(round <= limit * (1.0 + 1e-9), "{round} is above {limit}");
            assert!(
                steps.get(place + 1).is_none_or(|next| *next > limit),
                "{round} is not the largest below {limit}"
            );
        }
        // A round number is its own, whichever way its logarithm is rounded.
        for decade in -12..13 {
            for factor in [1.0, 2.0, 5.0] {
                let round = factor * 10_f64.powi(decade);
                assert!((round_below(round) / round - 1.0).abs() < 1e-12, "{round}");
            }
        }
    }
}

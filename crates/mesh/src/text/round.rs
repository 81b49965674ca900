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
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..2_000 {
            let limit = libm::exp10(30.0 * random.f64() - 15.0);
            let round = round_below(limit);
            assert!(
                round <= limit * (1.0 + 1e-12) && limit < 2.5 * round * (1.0 + 1e-12),
                "{limit}: {round}"
            );
            // Written in the powers of ten, it has the one digit.
            let text = format!("{round:.11e}");
            assert!(["1.0", "2.0", "5.0"].contains(&&text[..3]), "{limit}: {text}");
            assert!((round_below(round) / round - 1.0).abs() < 1e-12, "{round} stays as it is");
        }
        assert_eq!([1.0, 2.0, 731.0].map(round_below), [1.0, 2.0, 500.0]);
    }
}

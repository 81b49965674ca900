/// Returns the largest of 1, 2 and 5 times a power of ten that is at most `limit`, which is positive.
pub fn round_below(limit: f64) -> f64 {
    let decade = libm::exp10(libm::floor(libm::log10(limit)));
    // The logarithm may be rounded up to the next decade.
    let decade = if decade > limit { decade / 10.0 } else { decade };
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * decade <= limit * (1.0 + 1e-12));
    factor.unwrap_or(1.0) * decade
}

/// Returns the step of ticks on an axis: the smallest of 1, 2 and 5 times a power of ten that is at least
/// `limit`, which is positive, and into how many parts smaller ticks divide it.
pub fn tick_step(limit: f64) -> (f64, u32) {
    let below = round_below(limit);
    let leading = below / libm::exp10(libm::floor(libm::log10(below) + 1e-9));
    let step = match leading.round() as u32 {
        _ if below >= limit * (1.0 - 1e-12) => below,
        2 => 2.5 * below,
        _ => 2.0 * below,
    };
    let leading = step / libm::exp10(libm::floor(libm::log10(step) + 1e-9));
    (step, if leading.round() as u32 == 2 { 4 } else { 5 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_no_closer_than_asked() {
        for (limit, step, parts) in [
            (1.0, 1.0, 5),
            (1.1, 2.0, 4),
            (2.1, 5.0, 5),
            (5.5, 10.0, 5),
            (0.03, 0.05, 5),
            (1000.0, 1000.0, 5),
        ] {
            let (found, divided) = tick_step(limit);
            assert!((found / step - 1.0).abs() < 1e-9, "{limit}: {found}");
            assert_eq!(divided, parts, "{limit}");
        }
    }

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

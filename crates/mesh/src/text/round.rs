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
        for (limit, length) in
            [(1.0, 1.0), (1.9, 1.0), (2.0, 2.0), (4.99, 2.0), (731.0, 500.0), (0.099, 0.05)]
        {
            assert!((round_below(limit) / length - 1.0).abs() < 1e-12, "{limit}");
        }
    }
}

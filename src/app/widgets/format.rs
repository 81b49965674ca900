//! Numbers as the window shows them.
//!
//! Digits are grouped by thousands with commas, the minus sign is `−`, and there are just enough digits.
//! Numbers that change while they are shown keep their number of decimals ([`fixed`], [`significant`]), so
//! nothing jumps.

use meshbrush_mesh::text::{LengthUnit, group_digits};
pub use meshbrush_mesh::text::{digits, fixed, percent_above, rounded, significant, with_unit};

/// Returns a count, grouped by thousands: `37,987`.
pub fn count(value: u64) -> String {
    group_digits(&value.to_string())
}

/// Returns a change of a count, with its sign: `+2,418`, `−12`, `0`.
pub fn change(value: i64) -> String {
    let sign = match value {
        0 => "",
        1.. => "+",
        _ => "−",
    };
    format!("{sign}{}", count(value.unsigned_abs()))
}

/// Returns an estimated count, with two digits: `620,000`, `1.2 million`, `20 million`.
pub fn about(value: u64) -> String {
    let rounded = rounded(value as f64, 2);
    match rounded {
        n if n < 1e6 => count(n as u64),
        n if n < 1e9 => format!("{} million", digits(n / 1e6, 2)),
        n => format!("{} billion", digits(n / 1e9, 2)),
    }
}

/// Returns an estimated change of a count, with its sign: `+20 million`, `−620,000`.
pub fn about_change(value: i64) -> String {
    format!("{}{}", if value < 0 { "−" } else { "+" }, about(value.unsigned_abs()))
}

/// Returns an interval with as many digits as tell its ends apart, the lower end rounded down and the upper
/// one up: `161.38 … 161.42`. Where that takes too many, it says how narrow it is: `161.4 (within 0.001 %)`.
pub fn interval(lower: f64, upper: f64) -> String {
    let digit = |digits: usize| 10_f64.powi(upper.abs().log10().floor() as i32 + 1 - digits as i32);
    let Some(digits) = INTERVAL_DIGITS.into_iter().find(|&digits| 2.0 * digit(digits) <= upper - lower)
    else {
        let gap = if upper > lower { (upper - lower) / upper } else { 0.0 };
        return format!("{} (within {})", significant(upper, 4), percent_above(gap));
    };
    let unit = digit(digits);
    let decimals = decimals_for(unit);
    // A quotient is off by a rounding error where the number has these digits only.
    let [lower, upper] = [(lower / unit + 1e-9).floor() * unit, (upper / unit - 1e-9).ceil() * unit];
    format!("{} … {}", fixed(lower, decimals), fixed(upper, decimals))
}

/// Digits of the ends of an interval.
const INTERVAL_DIGITS: [usize; 4] = [4, 5, 6, 7];

/// Returns all digits of `value`: exactly this number when it is read again. Without commas, for other
/// programs.
pub fn exact(value: f64) -> String {
    match value.abs() {
        size if value == 0.0 || (1e-5..1e16).contains(&size) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// Returns a length in world units, with three significant digits and the unit: `0.0061`, `0.2°`, `1,250 m`.
pub fn length(value: f64, unit: LengthUnit) -> String {
    unit.after(&digits(value, 3))
}

/// Returns a coordinate, with the unit and as many decimals as `step` (the size of a pixel, say) can tell
/// apart: `0.5813`, `23.58°`.
pub fn coordinate(value: f64, step: f64, unit: LengthUnit) -> String {
    unit.after(&fixed(value, decimals_for(step)))
}

/// Returns the number of decimals that tells apart values `step` from each other, at most 15.
pub fn decimals_for(step: f64) -> usize {
    if !(step.is_finite() && step > 0.0) {
        return 0;
    }
    (-step.log10() - 1e-9).ceil().clamp(0.0, 15.0) as usize
}

/// Returns a time in seconds, in a suitable unit: `0.4 ms`, `37 ms`, `1.24 s`, `2 min 05 s`.
pub fn time(seconds: f64) -> String {
    let ms = seconds * 1e3;
    match seconds {
        s if !s.is_finite() || s < 0.0 => "–".to_owned(),
        _ if ms < 0.05 => "<0.1 ms".to_owned(),
        _ if ms < 9.95 => format!("{ms:.1} ms"),
        _ if ms < 999.5 => format!("{ms:.0} ms"),
        s if s < 9.995 => format!("{s:.2} s"),
        s if s < 59.95 => format!("{s:.1} s"),
        s if s < 3599.5 => format!("{:.0} min {:02.0} s", (s.round() / 60.0).floor(), s.round() % 60.0),
        s => format!("{:.0} h {:02.0} min", (s / 3600.0).floor(), ((s % 3600.0) / 60.0).floor()),
    }
}

/// Returns the size of a file: `312 B`, `14 kB`, `1.2 MB`.
pub fn file_size(bytes: u64) -> String {
    let (value, unit) = match bytes as f64 {
        b if b < 999.5 => (b, "B"),
        b if b < 999.5e3 => (b / 1e3, "kB"),
        b if b < 999.5e6 => (b / 1e6, "MB"),
        b => (b / 1e9, "GB"),
    };
    let decimals = usize::from(value < 9.95 && unit != "B");
    format!("{} {unit}", fixed(value, decimals))
}

/// `text` with spaces before it, so that it takes at least `width` characters.
pub fn padded(text: &str, width: usize) -> String {
    format!("{text:>width$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped_by_thousands() {
        for (value, text) in [(0, "0"), (632, "632"), (1_000, "1,000"), (37_987, "37,987")] {
            assert_eq!(count(value), text);
        }
        assert_eq!(count(u64::MAX), "18,446,744,073,709,551,615");
    }

    #[test]
    fn changes_carry_their_sign() {
        assert_eq!(change(2_418), "+2,418");
        assert_eq!(change(-12), "−12");
        assert_eq!(change(0), "0");
        assert_eq!(change(i64::MIN), "−9,223,372,036,854,775,808");
    }

    #[test]
    fn the_ends_of_an_interval_differ() {
        assert_eq!(interval(155.123, 161.46), "155.1 … 161.5");
        assert_eq!(interval(161.381, 161.423), "161.38 … 161.43");
        assert_eq!(interval(0.0, 161.42), "0.0 … 161.5");
        assert_eq!(interval(0.001_234_1, 0.001_235_9), "0.0012341 … 0.0012359");
        assert_eq!(interval(161.423, 161.423_01), "161.4 (within 0.001 %)");
        assert_eq!(interval(161.423, 161.423), "161.4 (within 0 %)");
    }

    #[test]
    fn estimates_have_two_digits() {
        for (value, text) in [
            (0, "0"),
            (617_034, "620,000"),
            (1_234_567, "1.2 million"),
            (19_999_999, "20 million"),
            (996_000_000, "1 billion"),
            (7_560_000_000, "7.6 billion"),
        ] {
            assert_eq!(about(value), text);
        }
        assert_eq!([about_change(20_312_345), about_change(-617_034)], ["+20 million", "−620,000"]);
    }

    #[test]
    fn fixed_decimals_keep_their_width() {
        assert_eq!(fixed(1234.5, 2), "1,234.50");
        assert_eq!(fixed(-0.25, 1), "−0.2");
        assert_eq!(fixed(-0.0001, 2), "0.00");
        assert_eq!(fixed(f64::NAN, 2), "–");
        assert_eq!(fixed(f64::NEG_INFINITY, 2), "−∞");
    }

    #[test]
    fn significant_digits_are_just_enough() {
        assert_eq!(significant(0.064, 3), "0.0640");
        assert_eq!(significant(1234.0, 3), "1,230");
        assert_eq!(significant(9.999, 3), "10.0");
        assert_eq!(significant(1.2e-7, 3), "1.20e-7");
        assert_eq!(significant(-1.2e-7, 2), "−1.2e-7");
        assert_eq!(digits(0.064, 3), "0.064");
        assert_eq!(digits(2.0, 3), "2");
        assert_eq!(digits(100.0, 3), "100");
        assert_eq!(digits(1.2e-7, 5), "1.2e-7");
        assert_eq!(digits(0.0, 3), "0");
        assert_eq!(length(0.00610351, LengthUnit::None), "0.0061");
        assert_eq!(length(1250.0, LengthUnit::Metre), "1,250 m");
        assert_eq!(length(0.25, LengthUnit::Degree), "0.25°");
    }

    #[test]
    fn decimals_follow_the_step() {
        for (step, decimals) in [(1.0, 0), (0.5, 1), (0.01, 2), (0.001, 3), (25.0, 0), (0.0, 0), (1e-30, 15)]
        {
            assert_eq!(decimals_for(step), decimals, "{step}");
        }
        assert_eq!(coordinate(0.58134, 0.0004, LengthUnit::None), "0.5813");
        assert_eq!(coordinate(23.58134, 0.01, LengthUnit::Degree), "23.58°");
    }

    #[test]
    fn times_have_a_suitable_unit() {
        for (seconds, text) in [
            (4e-4, "0.4 ms"),
            (1e-6, "<0.1 ms"),
            (0.037, "37 ms"),
            (1.24, "1.24 s"),
            (12.0, "12.0 s"),
            (125.0, "2 min 05 s"),
            (119.7, "2 min 00 s"),
            (7260.0, "2 h 01 min"),
            (-1.0, "–"),
        ] {
            assert_eq!(time(seconds), text);
        }
    }

    #[test]
    fn file_sizes_have_a_suitable_unit() {
        for (bytes, text) in [
            (0, "0 B"),
            (999, "999 B"),
            (1_000, "1.0 kB"),
            (14_400, "14 kB"),
            (999_700, "1.0 MB"),
            (1_250_000, "1.2 MB"),
            (13_900_000, "14 MB"),
            (2_300_000_000, "2.3 GB"),
        ] {
            assert_eq!(file_size(bytes), text);
        }
    }

    #[test]
    fn padding_keeps_columns() {
        assert_eq!(padded("42", 6), "    42");
        assert_eq!(padded("−4", 3), " −4");
    }
}

//! Numbers as the window shows them.
//!
//! Digits are grouped by thousands with commas, the minus sign is `−`, and there are just enough digits.
//! Numbers that change while they are shown keep their number of decimals ([`fixed`], [`significant`]), so
//! nothing jumps.

use meshbrush_mesh::text::{LengthUnit, group_digits};
pub use meshbrush_mesh::text::{decimals_for, digits, fixed, percent_above, rounded, significant, with_unit};

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
    let Some(unit) = unit_of_interval(lower, upper) else {
        let gap = if upper > lower { (upper - lower) / upper } else { 0.0 };
        return format!("{} (within {})", significant(upper, 4), percent_above(gap));
    };
    // A quotient is off by a rounding error where the number has these digits only.
    let lower = (lower / unit + 1e-9).floor() * unit;
    format!("{} … {}", fixed(lower, decimals_for(unit)), rounded_up(upper, unit))
}

/// Returns a value with the digits of an [`interval`] beside it, rounded up as the upper end is. One that
/// these digits do not tell apart from that end is shown as it is.
pub fn beside_interval(value: f64, lower: f64, upper: f64) -> String {
    match unit_of_interval(lower, upper) {
        Some(unit) if (upper - value).abs() < unit => rounded_up(upper, unit),
        Some(unit) => rounded_up(value, unit),
        None => significant(value, 4),
    }
}

/// Returns the last digit of the ends of an interval; `None` where too many tell them apart.
fn unit_of_interval(lower: f64, upper: f64) -> Option<f64> {
    let digit = |digits: usize| 10_f64.powi(upper.abs().log10().floor() as i32 + 1 - digits as i32);
    INTERVAL_DIGITS.into_iter().map(digit).find(|unit| 2.0 * unit <= upper - lower)
}

fn rounded_up(value: f64, unit: f64) -> String {
    fixed((value / unit - 1e-9).ceil() * unit, decimals_for(unit))
}

/// Returns an area in square units, `12.5 km²`: from a square kilometre on, one in square metres is in
/// square kilometres.
pub fn area(value: f64, unit: LengthUnit, most_digits: usize) -> String {
    let (value, symbol) = match unit {
        LengthUnit::Metre if value >= 1e6 => (value / 1e6, LengthUnit::Kilometre.symbol()),
        _ => (value, unit.symbol()),
    };
    let square = if symbol.is_empty() { String::new() } else { format!("{symbol}²") };
    with_unit(&digits(value, most_digits), &square)
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

/// Returns the text of a number without the zeros after its last decimal.
pub fn without_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
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
        s => {
            let minutes = (s / 60.0).round();
            format!("{:.0} h {:02.0} min", (minutes / 60.0).floor(), minutes % 60.0)
        }
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

    /// Returns the number that a text begins with, and what follows it.
    fn read(text: &str) -> (f64, &str) {
        let end = text.find(|c: char| !(c.is_ascii_digit() || ",.−+".contains(c))).unwrap_or(text.len());
        let number = text[..end].replace(',', "").replace('−', "-");
        (number.parse().unwrap_or_else(|_| panic!("{text} begins with a number")), text[end..].trim())
    }

    /// Returns whole numbers of all lengths.
    fn random_counts() -> impl Iterator<Item = u64> {
        let mut random = fastrand::Rng::with_seed(35);
        (0..2_000).map(move |_| random.u64(..) >> random.u32(..64))
    }

    /// Fails unless a text says more for a larger number.
    #[track_caller]
    fn assert_in_order(mut numbers: Vec<f64>, said: impl Fn(f64) -> f64) {
        numbers.sort_by(f64::total_cmp);
        assert!(numbers.is_sorted_by_key(|&number| said(number)), "a larger number says less");
    }

    #[test]
    fn counts_are_grouped_by_thousands() {
        for value in random_counts().chain([0, 999, 1_000, u64::MAX]) {
            let text = count(value);
            assert_eq!(text.replace(',', ""), value.to_string());
            let mut groups = text.split(',').map(str::len);
            assert!(groups.next().is_some_and(|first| (1..=3).contains(&first)), "{text}");
            assert!(groups.all(|digits| digits == 3), "{text}");
        }
        assert_eq!(count(37_987), "37,987");
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
    fn random_intervals_hold_theirs_with_at_most_a_digit_more() {
        let mut random = fastrand::Rng::with_seed(36);
        let mut narrow = 0;
        for _ in 0..2_000 {
            let upper = 10_f64.powf(12.0 * random.f64() - 6.0);
            let lower = upper * (1.0 - 10_f64.powf(-7.0 * random.f64()));
            let text = interval(lower, upper);
            let Some((low, high)) = text.split_once(" … ") else {
                assert!(text.contains("within") && upper - lower < 1e-4 * upper, "{lower} {upper}: {text}");
                narrow += 1;
                continue;
            };
            let (low, high) = (read(low).0, read(high).0);
            let room = 1e-9 * upper;
            assert!(low <= lower + room && upper <= high + room, "{lower} {upper}: {text}");
            assert!(high - low < 2.0 * (upper - lower) + room, "{lower} {upper}: {text}");
        }
        assert!((20..1_000).contains(&narrow), "{narrow}");
    }

    #[test]
    fn estimates_have_two_digits() {
        let said = |value: u64| {
            let text = about(value);
            let (number, unit) = read(&text);
            number
                * [("", 1.0), ("million", 1e6), ("billion", 1e9)]
                    .iter()
                    .find(|(name, _)| *name == unit)
                    .unwrap()
                    .1
        };
        for value in random_counts().chain([0, 999_999, 19_999_999, 996_000_000]) {
            let off = (said(value) - value as f64).abs();
            assert!(off <= 0.05 * value as f64, "{value}: {}", about(value));
            let digits = about(value).chars().filter(char::is_ascii_digit).collect::<String>();
            assert!(digits.trim_matches('0').len() <= 2, "{value}: {digits}");
        }
        assert_in_order(random_counts().map(|value| value as f64).collect(), |value| said(value as u64));
        assert_eq!([about(617_034), about(996_000_000)], ["620,000", "1 billion"]);
        assert_eq!([about_change(20_312_345), about_change(-617_034)], ["+20 million", "−620,000"]);
    }

    #[test]
    fn fixed_decimals_keep_their_width() {
        let mut random = fastrand::Rng::with_seed(37);
        for _ in 0..2_000 {
            let (value, decimals) = (1e5 * (random.f64() - 0.5), random.usize(..6));
            let text = fixed(value, decimals);
            let (said, rest) = read(&text);
            assert!((said - value).abs() <= 0.500_001 * 0.1_f64.powi(decimals as i32), "{value}: {text}");
            let after = text.split_once('.').map_or(0, |(_, after)| after.len());
            assert!(after == decimals && rest.is_empty(), "{value}: {text}");
        }
        assert_eq!([fixed(1234.5, 2), fixed(-0.25, 1), fixed(-0.0001, 2)], ["1,234.50", "−0.2", "0.00"]);
        assert_eq!([fixed(f64::NAN, 2), fixed(f64::NEG_INFINITY, 2)], ["–", "−∞"]);
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
        let mut random = fastrand::Rng::with_seed(38);
        for _ in 0..2_000 {
            let step = 10_f64.powf(20.0 * random.f64() - 17.0);
            let decimals = decimals_for(step) as i32;
            let is_fine = |decimals: i32| 0.1_f64.powi(decimals) <= step * (1.0 + 1e-8);
            assert!(is_fine(decimals) || decimals == 15, "{step}");
            assert!(decimals == 0 || !is_fine(decimals - 1), "{step}");
        }
        assert_eq!([1.0, 0.5, 0.001, 25.0, 0.0, f64::NAN].map(decimals_for), [0, 1, 3, 0, 0, 0]);
        assert_eq!(coordinate(0.58134, 0.0004, LengthUnit::None), "0.5813");
        assert_eq!(coordinate(23.58134, 0.01, LengthUnit::Degree), "23.58°");
    }

    /// Returns the seconds that a time says, and those that one more in its last digit would be.
    fn read_time(text: &str) -> (f64, f64) {
        let (first, rest) = read(text.trim_start_matches('<'));
        let decimals = text.split_once('.').map_or(0, |(_, rest)| rest.find(' ').unwrap());
        let digit = 0.1_f64.powi(decimals as i32);
        match rest.split_once(' ') {
            None if rest == "ms" => (1e-3 * first, 1e-3 * digit),
            None => (first, digit),
            Some(("min", seconds)) => (60.0 * first + read(seconds).0, 1.0),
            Some((_, minutes)) => (3600.0 * first + 60.0 * read(minutes).0, 60.0),
        }
    }

    #[test]
    fn times_have_a_suitable_unit() {
        let mut random = fastrand::Rng::with_seed(39);
        let edges = [0.0095, 0.9995, 9.995, 59.95, 3599.5, 7199.5].map(|edge: f64| edge * (1.0 + 1e-9));
        let times: Vec<f64> =
            (0..4_000).map(|_| 10_f64.powf(9.5 * random.f64() - 4.2)).chain(edges).collect();
        for &seconds in &times {
            let text = time(seconds);
            let (said, digit) = read_time(&text);
            assert!((said - seconds).abs() <= 0.500_001 * digit, "{seconds}: {text}");
            // Two digits at least, from a millisecond on, and no more characters than fit a column.
            assert!(seconds < 1e-3 || digit <= 0.101 * seconds, "{seconds}: {text}");
            assert!(text.chars().count() <= 11, "{seconds}: {text}");
        }
        assert_in_order(times, |seconds| read_time(&time(seconds)).0);
        assert_eq!([4e-4, 1e-6, 125.0, -1.0].map(time), ["0.4 ms", "<0.1 ms", "2 min 05 s", "–"]);
    }

    #[test]
    fn file_sizes_have_a_suitable_unit() {
        let said = |bytes: u64| {
            let text = file_size(bytes);
            let (number, unit) = read(&text);
            let power = ["B", "kB", "MB", "GB"].iter().position(|name| *name == unit).unwrap();
            number * 1000_f64.powi(power as i32)
        };
        for bytes in random_counts().chain([0, 999, 1_000, 999_500, 999_700, 9_950_000]) {
            let off = (said(bytes) - bytes as f64).abs();
            assert!(off <= 0.05 * bytes as f64, "{bytes}: {}", file_size(bytes));
        }
        assert_in_order(random_counts().map(|bytes| bytes as f64).collect(), |bytes| said(bytes as u64));
        assert_eq!([14_400, 1_250_000].map(file_size), ["14 kB", "1.2 MB"]);
    }

    #[test]
    fn padding_keeps_columns() {
        assert_eq!(padded("42", 6), "    42");
        assert_eq!(padded("−4", 3), " −4");
    }

    #[test]
    fn a_cost_is_never_below_the_upper_end_of_the_interval_beside_it() {
        let (lower, upper) = (90_400.0, 92_083.0);
        assert_eq!(interval(lower, upper), "90,400 … 92,090");
        assert_eq!(beside_interval(92_083.0, lower, upper), "92,090");
        assert_eq!(beside_interval(92_079.0, lower, upper), "92,090");
        assert_eq!(beside_interval(92_083.0, 92_082.999, 92_083.0), "92,080", "as the interval");
        assert_eq!(interval(92_082.999, 92_083.0), "92,080 (within 0.001 %)");
        let mut value = 1.234_567;
        for _ in 0..200 {
            value *= 1.618_034;
            let (lower, upper) = (value * 0.99, value);
            let end = interval(lower, upper).split(" … ").nth(1).unwrap().to_owned();
            assert_eq!(beside_interval(value, lower, upper), end, "{value}");
        }
    }

    #[test]
    fn large_areas_in_square_metres_are_in_square_kilometres() {
        assert_eq!(area(2.662e9, LengthUnit::Metre, 6), "2,662 km²");
        assert_eq!(area(999_999.0, LengthUnit::Metre, 6), "999,999 m²");
        assert_eq!(area(2.5e6, LengthUnit::Kilometre, 6), "2,500,000 km²");
        assert_eq!(
            (area(3.25, LengthUnit::None, 6), area(3.25, LengthUnit::Degree, 2)),
            ("3.25".into(), "3.2 °²".into())
        );
    }
}

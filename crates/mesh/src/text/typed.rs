//! Numbers as users type them.

use super::decimal;

/// Units of length, as factors of a metre.
const LENGTHS: [(&str, f64, f64); 5] =
    [("mm", 1.0, 1000.0), ("cm", 1.0, 100.0), ("m", 1.0, 1.0), ("km", 1000.0, 1.0), ("nmi", 1852.0, 1.0)];
/// Units of memory, as factors of a byte.
const BYTES: [(&str, f64, f64); 4] =
    [("kB", 1e3, 1.0), ("MB", 1e6, 1.0), ("GB", 1e9, 1.0), ("TB", 1e12, 1.0)];
/// Letters after a number that multiply it.
const MULTIPLIERS: [(&str, f64); 4] = [("k", 1e3), ("K", 1e3), ("M", 1e6), ("G", 1e9)];

/// Returns the number that a user typed, in `unit`, which is a symbol such as `m`, `km`, `°` or `MB`, or
/// empty.
///
/// Takes `−` and `-`, spaces and commas that group thousands, one comma as decimal sign, `1e-4`, `100k`,
/// `2M`, and a unit at the end: `unit` itself, or one that can be converted to it (`1.5 km` in metres).
///
/// # Errors
/// Fails with a sentence that says what was not understood.
pub fn number(text: &str, unit: &str) -> Result<f64, String> {
    let text = text.trim();
    let (digits, suffix) = text.split_at(end_of_number(text));
    let suffix = suffix.trim();
    let Some(value) = plain_number(digits) else {
        return Err(not_a_number(text));
    };
    let Some((numerator, denominator)) = factor(suffix, unit.trim()) else {
        return Err(unknown_unit(suffix, unit.trim()));
    };
    Some(value * numerator / denominator).filter(|value| value.is_finite()).ok_or_else(|| not_a_number(text))
}

/// Returns the byte at which the unit begins.
fn end_of_number(text: &str) -> usize {
    let mut end = 0;
    let mut rest = text.char_indices().peekable();
    while let Some((at, c)) = rest.next() {
        let next = rest.peek().map(|(_, next)| *next);
        let is_exponent = matches!(c, 'e' | 'E') && next.is_some_and(|next| "0123456789+-−".contains(next));
        if !(c.is_ascii_digit() || c.is_whitespace() || "+-−.,".contains(c) || is_exponent) {
            break;
        }
        end = at + c.len_utf8();
    }
    end
}

fn plain_number(text: &str) -> Option<f64> {
    let plain: String =
        text.chars().filter(|c| !c.is_whitespace()).map(|c| if c == '−' { '-' } else { c }).collect();
    let plain = if groups_thousands(&plain) { plain.replace(',', "") } else { plain.replacen(',', ".", 1) };
    decimal::parse(&plain).filter(|value| value.is_finite())
}

/// Returns whether the commas of `text` stand where thousands are grouped: `1,234,567.8`, but not `0,123`.
fn groups_thousands(text: &str) -> bool {
    let whole = text.trim_start_matches(['-', '+']).split('.').next().unwrap_or_default();
    let mut groups = whole.split(',');
    let first = groups.next().unwrap_or_default();
    (1..=3).contains(&first.len()) && !first.starts_with('0') && groups.all(|group| group.len() == 3)
}

/// Returns the factors by which a number with `suffix` is multiplied and divided to be in `unit`.
fn factor(suffix: &str, unit: &str) -> Option<(f64, f64)> {
    if suffix.is_empty() || suffix == unit || (unit == "°" && suffix.starts_with("deg")) {
        return Some((1.0, 1.0));
    }
    let in_bytes = BYTES.iter().any(|(name, ..)| *name == unit);
    let own = if in_bytes { convert(&format!("{}B", suffix.replace('K', "k")), unit, &BYTES) } else { None };
    let multiplier = || MULTIPLIERS.iter().find(|(name, _)| *name == suffix).map(|(_, by)| (*by, 1.0));
    own.or_else(|| convert(suffix, unit, &BYTES))
        .or_else(|| convert(suffix, unit, &LENGTHS))
        .or_else(multiplier)
}

/// Returns the factor between two units of one table.
fn convert(from: &str, to: &str, table: &[(&str, f64, f64)]) -> Option<(f64, f64)> {
    let find = |unit: &str| table.iter().find(|(name, ..)| *name == unit);
    let ((_, up, down), (_, to_up, to_down)) = (find(from)?, find(to)?);
    Some((up * to_down, down * to_up))
}

fn not_a_number(text: &str) -> String {
    if text.is_empty() {
        return "Nothing was typed.".to_owned();
    }
    format!("“{text}” is not a number. Numbers can be typed as 0.25, 1e-4, 100k or 2M.")
}

fn unknown_unit(suffix: &str, unit: &str) -> String {
    let is_length = LENGTHS.iter().any(|(name, ..)| *name == suffix);
    match unit {
        "" if is_length => {
            format!("The unit “{suffix}” has no meaning here, because this value has no unit.")
        }
        "" => format!("“{suffix}” after the number is not understood. Type it without a unit."),
        "°" if is_length => format!(
            "“{suffix}” cannot be converted to degrees, because a degree has another length in each direction and at \
             each latitude."
        ),
        _ => format!("“{suffix}” cannot be converted to {unit}."),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{group_digits, rounded, significant};
    use super::*;

    #[test]
    fn typed_numbers_are_understood() {
        for (text, value) in [
            ("37,987", 37987.0),
            ("0,064", 0.064),
            ("1,234.5", 1234.5),
            ("−0.5", -0.5),
            (" 1e-3 ", 1e-3),
            ("1E−4", 1e-4),
            ("12 m", 12.0),
            ("1 000", 1000.0),
            (".5", 0.5),
            ("100k", 100_000.0),
            ("2 M", 2e6),
            ("1.5 km", 1500.0),
            ("25cm", 0.25),
            ("0.5 nmi", 926.0),
        ] {
            assert_eq!(number(text, "m"), Ok(value), "{text}");
        }
        for text in ["", "x", "1,2,3", "inf", "nan", "--1", "1e999", "e5"] {
            assert!(number(text, "").is_err(), "{text}");
        }
    }

    #[test]
    fn units_are_converted_or_refused_with_a_sentence() {
        assert_eq!(number("500 MB", "GB"), Ok(0.5));
        assert_eq!(number("2G", "GB"), Ok(2.0), "a letter before the byte is enough");
        assert_eq!(number("300 m", "km"), Ok(0.3));
        assert_eq!(number("12 deg", "°"), Ok(12.0));
        assert_eq!(number("512 px", "px"), Ok(512.0));
        let refused = |text, unit| number(text, unit).unwrap_err();
        assert!(refused("1 km", "").contains("no unit"), "{}", refused("1 km", ""));
        assert!(refused("2 km", "°").contains("another length in each direction"));
        assert!(refused("3 apples", "m").contains("cannot be converted to m"));
        assert!(refused("much", "m").contains("“much” is not a number"));
    }

    #[test]
    fn the_shown_number_is_the_rounded_value() {
        let mut random = fastrand::Rng::with_seed(35);
        for _ in 0..2_000 {
            let value = (2.0 * random.f64() - 1.0) * libm::exp10(24.0 * random.f64() - 12.0);
            let digits = random.usize(1..9);
            let text = significant(value, digits);
            assert_eq!(number(&text, ""), Ok(rounded(value, digits)), "{value} to {digits} digits: {text}");
        }
    }

    #[test]
    fn numbers_are_read_with_spaces_commas_signs_and_units_around_them() {
        let mut random = fastrand::Rng::with_seed(36);
        for _ in 0..2_000 {
            let value = f64::from(random.i32(-9_999_999..9_999_999)) / [1.0, 10.0, 1000.0][random.usize(..3)];
            let plain = value.abs().to_string();
            let (whole, decimals) = plain.split_at(plain.find('.').unwrap_or(plain.len()));
            let digits = if random.bool() { format!("{}{decimals}", group_digits(whole)) } else { plain };
            let text = format!("{}{digits}", if value < 0.0 { "-" } else { "" });
            let text = if random.bool() { text.replace('-', "−") } else { text };
            let (unit, factor) =
                [("", 1.0), (" m", 1.0), ("m", 1.0), (" km", 1e3), (" nmi", 1852.0), ("k", 1e3)]
                    [random.usize(..6)];
            let text =
                format!("{}{text}{unit}{}", " ".repeat(random.usize(..2)), " ".repeat(random.usize(..2)));
            let read = number(&text, "m").unwrap_or_else(|message| panic!("{text}: {message}"));
            assert!((read - factor * value).abs() <= 1e-12 * (factor * value).abs(), "{text}: {read}");
        }
    }
}

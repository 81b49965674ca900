use super::{decimal, group_digits};

/// `value` with exactly `decimals` digits after the point, grouped before it: `1,234.50`.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return not_finite(value);
    }
    let digits = format!("{:.decimals$}", value.abs());
    let negative = value < 0.0 && digits.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    let (whole, rest) = digits.split_at(digits.find('.').unwrap_or(digits.len()));
    format!("{}{}{rest}", if negative { "−" } else { "" }, group_digits(whole))
}

/// `value` with exactly `digits` significant digits, trailing zeros kept: `0.0640`, `1,230`, `1.20e-7`.
///
/// For values that are being dragged. Below 1e-4 and from 1e15 up the answer is in scientific notation.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return fixed(value, 0);
    }
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, value.abs());
    let exponent = exponent_of(&scientific);
    if (-4..15).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return fixed(rounded(value, digits), decimals);
    }
    format!("{}{scientific}", if value < 0.0 { "−" } else { "" })
}

/// `value` with at most `digits` significant digits and no trailing zeros: `0.064`, `2`, `1.2e-7`.
pub fn digits(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (mantissa, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
    if !mantissa.contains('.') {
        return text;
    }
    format!("{}{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
}

/// Returns the number of decimals that tells apart values `step` from each other, at most 15.
pub fn decimals_for(step: f64) -> usize {
    if !(step.is_finite() && step > 0.0) {
        return 0;
    }
    (-libm::log10(step) - 1e-9).ceil().clamp(0.0, 15.0) as usize
}

/// `value` rounded to `digits` significant digits: exactly what [`significant`] shows.
pub fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{:.*e}", digits.max(1) - 1, value);
    decimal::parse(&text).unwrap_or(value)
}

/// `number` with its unit, if there is one. Only the sign of degrees follows without a space.
pub fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" => number.to_owned(),
        "°" => format!("{number}°"),
        _ => format!("{number} {unit}"),
    }
}

/// Returns a share in percent, rounded up, so that an upper bound stays one. `1.24 %`, `0.004 %`.
pub fn percent_above(share: f64) -> String {
    let percent = 100.0 * share;
    let digits = if percent < 0.1 { 1000.0 } else { 100.0 };
    format!("{} %", (percent * digits).ceil() / digits)
}

fn not_finite(value: f64) -> String {
    match value {
        v if v.is_nan() => "–",
        v if v > 0.0 => "∞",
        _ => "−∞",
    }
    .to_owned()
}

fn exponent_of(scientific: &str) -> i32 {
    scientific.split('e').nth(1).and_then(|e| e.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_has_a_sign_of_its_own() {
        for (value, sign) in
            [(f64::INFINITY, "∞"), (f64::NEG_INFINITY, "−∞"), (f64::NAN, "–"), (-f64::NAN, "–")]
        {
            assert_eq!(digits(value, 4), sign);
            assert_eq!(fixed(value, 2), sign);
        }
    }
}

//! Decimal numbers as text. The parser of std adds 10 kB of tables, and every visitor of a page downloads the
//! module for JavaScript. This parser is short, returns the same values, and is fast for numbers of up to 15
//! digits.

use std::cmp::Ordering;

/// Significant digits that are looked at: no number halfway between two of f64 has more.
const DIGITS: usize = 800;
/// The powers of ten up to this one are exact in f64.
const EXACT_POWER: i32 = 22;
/// Bits of the fraction of an f64, with the one that is not stored.
const PRECISION: i32 = 53;
/// The exponent of the least normal f64.
const LEAST_EXPONENT: i32 = -1022;

/// Returns the f64 that is nearest to a decimal number such as `-12.5e-3`, the even one of two, as the parser
/// of std does. Returns `None` for a text without a digit or with anything else in it.
pub fn parse(text: &str) -> Option<f64> {
    let (is_negative, text) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    let (digits, exponent) = match text.find(['e', 'E']) {
        Some(at) => (&text[..at], exponent(&text[at + 1..])?),
        None => (text, 0),
    };
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let all = || whole.bytes().chain(fraction.bytes());
    if all().next().is_none() || !all().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    let value = nearest(all(), exponent.saturating_sub(i32::try_from(fraction.len()).ok()?));
    Some(if is_negative { -value } else { value })
}

/// Returns the exponent after the letter e, limited to what has no effect any more.
fn exponent(text: &str) -> Option<i32> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    let size = digits.bytes().fold(0, |sum: i32, digit| (10 * sum + i32::from(digit - b'0')).min(1 << 26));
    Some(if text.starts_with('-') { -size } else { size })
}

/// Returns the f64 nearest to the digits times a power of ten.
fn nearest(digits: impl Iterator<Item = u8>, mut power: i32) -> f64 {
    let mut significant: Vec<u8> = digits.map(|digit| digit - b'0').skip_while(|&digit| digit == 0).collect();
    while significant.last() == Some(&0) {
        significant.pop();
        power = power.saturating_add(1);
    }
    if significant.len() > DIGITS {
        power = power.saturating_add((significant.len() - DIGITS - 1) as i32);
        significant.truncate(DIGITS);
        // What follows is more than nothing.
        significant.push(1);
    }
    let magnitude = power.saturating_add(significant.len() as i32);
    if significant.is_empty() || magnitude < -330 {
        return 0.0;
    }
    if magnitude > 310 {
        return f64::INFINITY;
    }
    if significant.len() <= 15 && power.abs() <= EXACT_POWER {
        let number = significant.iter().fold(0, |sum: u64, &digit| 10 * sum + u64::from(digit)) as f64;
        let ten = (0..power.abs()).fold(1.0, |ten, _| 10.0 * ten);
        return if power < 0 { number / ten } else { number * ten };
    }
    let mut number = Natural::default();
    significant.iter().for_each(|&digit| number.multiply_add(10, u32::from(digit)));
    let mut divisor = Natural(vec![1]);
    let scaled = if power < 0 { &mut divisor } else { &mut number };
    (0..power.abs()).for_each(|_| scaled.multiply_add(10, 0));
    quotient(number, divisor)
}

/// Returns the f64 nearest to a fraction of positive numbers.
fn quotient(mut number: Natural, mut divisor: Natural) -> f64 {
    // So that the whole part of the quotient has 64 or 65 bits.
    let shift = 64 + divisor.bits() - number.bits();
    if shift > 0 {
        number.shift_left(shift)
    } else {
        divisor.shift_left(-shift)
    }
    divisor.shift_left(64);
    let mut whole = 0_u128;
    for _ in 0..=64 {
        whole <<= 1;
        if number.compare(&divisor) != Ordering::Less {
            number.subtract(&divisor);
            whole |= 1;
        }
        divisor.halve();
    }
    rounded(whole, -shift, !number.0.is_empty())
}

/// Returns the f64 nearest to `whole` times a power of two, or to a little more.
fn rounded(whole: u128, power: i32, has_more: bool) -> f64 {
    let bits = (u128::BITS - whole.leading_zeros()) as i32;
    let exponent = bits - 1 + power;
    if exponent > 1023 {
        return f64::INFINITY;
    }
    let precision = PRECISION + (exponent - LEAST_EXPONENT).min(0);
    if precision < 0 {
        return 0.0;
    }
    let dropped = bits - precision;
    let (kept, rest) = (whole >> dropped, whole & ((1 << dropped) - 1));
    let half = 1 << (dropped - 1);
    let is_up = rest > half || rest == half && (has_more || kept % 2 == 1);
    // The highest bit of the fraction counts as one in the exponent; so does a carry.
    let biased = (exponent - LEAST_EXPONENT).max(0) as u64;
    f64::from_bits((biased << (PRECISION - 1)) + kept as u64 + u64::from(is_up))
}

/// A natural number of any size in digits of 32 bits, the lowest first and the highest not zero.
#[derive(Default)]
struct Natural(Vec<u32>);

impl Natural {
    fn bits(&self) -> i32 {
        self.0.last().map_or(0, |highest| (32 * self.0.len()) as i32 - highest.leading_zeros() as i32)
    }

    fn multiply_add(&mut self, factor: u32, summand: u32) {
        let mut carry = u64::from(summand);
        for digit in &mut self.0 {
            carry += u64::from(*digit) * u64::from(factor);
            *digit = carry as u32;
            carry >>= 32;
        }
        self.0.extend((carry > 0).then_some(carry as u32));
    }

    fn shift_left(&mut self, bits: i32) {
        self.multiply_add(1 << (bits % 32), 0);
        self.0.splice(..0, (0..bits / 32).map(|_| 0));
    }

    fn halve(&mut self) {
        let mut carry = 0;
        for digit in self.0.iter_mut().rev() {
            let low = *digit << 31;
            *digit = *digit >> 1 | carry;
            carry = low;
        }
        self.trim();
    }

    fn compare(&self, other: &Self) -> Ordering {
        self.0.len().cmp(&other.0.len()).then_with(|| self.0.iter().rev().cmp(other.0.iter().rev()))
    }

    /// Subtracts a number that is not larger.
    fn subtract(&mut self, other: &Self) {
        let mut borrowed = false;
        for (n, digit) in self.0.iter_mut().enumerate() {
            let [first, second] = [other.0.get(n).copied().unwrap_or(0), u32::from(borrowed)];
            let (rest, is_below) = digit.overflowing_sub(first);
            let (rest, is_still_below) = rest.overflowing_sub(second);
            (*digit, borrowed) = (rest, is_below || is_still_below);
        }
        self.trim();
    }

    fn trim(&mut self) {
        while self.0.last() == Some(&0) {
            self.0.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str) {
        let expected: Option<f64> = text.parse().ok();
        assert_eq!(parse(text).map(f64::to_bits), expected.map(f64::to_bits), "{text}");
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in [
            "", "+", "-", ".", "e5", "1e", "1e+", "1.2.3", "1_000", " 1", "1 ", "--1", "+-1", "0x1", "1e5.0",
            "é",
        ] {
            check(text);
        }
        // What std takes beside numbers.
        assert_eq!(["inf", "nan", "infinity"].map(parse), [None; 3]);
        for text in
            ["0", "-0", "+1", "1.", ".5", "00012.500", "1E5", "1e-5", "1e+05", "-0.0e9", "0e999999999999"]
        {
            check(text);
        }
    }

    #[test]
    fn values_are_those_of_std_also_halfway_and_at_the_ends() {
        for text in [
            "9007199254740993",
            "9007199254740993.0000000000000000000000000000001",
            "2.2250738585072011e-308",
            "2.2250738585072014e-308",
            "4.9e-324",
            "2.4703282292062327e-324",
            "2.4703282292062328e-324",
            "2.5e-324",
            "1.7976931348623157e308",
            "1.7976931348623158e308",
            "1.7976931348623159e308",
            "1e309",
            "1e-400",
            "1e23",
            "8.5e22",
            "123456789012345e22",
            "123456789012345678e-40",
            "1e99999999999999",
            "1e-99999999999999",
        ] {
            check(text);
            check(&format!("-{text}"));
        }
        check(&format!("{}e-1000", "7".repeat(1000)));
        check(&format!("0.{}1", "0".repeat(400)));
        let mut rng = fastrand::Rng::with_seed(77);
        for _ in 0..3_000 {
            let value = f64::from_bits(rng.u64(..0x7ff0_0000_0000_0000));
            check(&format!("{value}"));
            check(&format!("{value:e}"));
            check(&format!("{value:.*e}", rng.usize(..25)));
            check(&format!("{}.{}e{}", rng.u64(..), rng.u64(..), rng.i32(-340..330)));
            // Halfway between two numbers, exactly, and a little above and below.
            let above = f64::from_bits(value.to_bits() + 1);
            let [low, high] = [value, above].map(|value| value.clamp(1e-280, 1e280));
            let middle = format!("{:.800e}", low / 2.0 + high / 2.0);
            check(&middle);
        }
    }

    #[test]
    fn halves_of_whole_numbers_go_to_the_even_one() {
        let mut rng = fastrand::Rng::with_seed(5);
        for _ in 0..500 {
            let odd = (rng.u128(1 << 52..1 << 53) << 1 | 1) << rng.u32(..60);
            check(&odd.to_string());
            check(&(odd - 1).to_string());
            check(&format!("{odd}.{}1", "0".repeat(900)));
        }
    }
}

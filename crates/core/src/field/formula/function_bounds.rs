//! Bounds of the functions in formulas, from the bounds of their arguments.
//!
//! Functions of libm may be wrong by an ulp or two, and need not be monotone to the last bit, so their
//! results are widened. At a single point the interpreter takes the value itself, so the bounds there are
//! tight.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::functions;
use crate::field::Bounds;

/// Neighbouring numbers by which a result of libm is widened on either side: twice its error, and more.
const ULPS: u32 = 8;

/// The interval of all numbers, without NaN.
const ALL: Bounds = Bounds::new(f64::NEG_INFINITY, f64::INFINITY);

/// Returns bounds of a function of libm that never decreases.
fn increasing(a: Bounds, function: fn(f64) -> f64) -> Bounds {
    a.increasing(function).widened(ULPS)
}

/// Returns bounds of a function that never decreases and whose arguments must be in [`low`, `high`].
fn increasing_within(a: Bounds, [low, high]: [f64; 2], function: fn(f64) -> f64) -> Bounds {
    if a.greatest < low || a.least > high {
        return Bounds::ANYTHING;
    }
    let inside = Bounds { least: a.least.max(low), greatest: a.greatest.min(high), ..a };
    increasing(inside, function).valid_if(a.least >= low && a.greatest <= high)
}

pub(super) fn sign(a: Bounds) -> Bounds {
    a.increasing(functions::sign)
}

pub(super) fn cbrt(a: Bounds) -> Bounds {
    increasing(a, libm::cbrt)
}

pub(super) fn exp(a: Bounds) -> Bounds {
    let result = increasing(a, libm::exp);
    Bounds { least: result.least.max(0.0), ..result }
}

pub(super) fn ln(a: Bounds) -> Bounds {
    increasing_within(a, [0.0, f64::INFINITY], libm::log)
}

pub(super) fn log10(a: Bounds) -> Bounds {
    increasing_within(a, [0.0, f64::INFINITY], libm::log10)
}

pub(super) fn log2(a: Bounds) -> Bounds {
    increasing_within(a, [0.0, f64::INFINITY], libm::log2)
}

/// Returns whether an interval may contain a number `offset` + k · `period` for a whole k.
fn may_contain(a: Bounds, offset: f64, period: f64) -> bool {
    // Arguments below have at most a million periods, so the quotients are off by less than 1e-9.
    let turns = |v: f64| (v - offset) / period;
    (turns(a.least) - 1e-9).ceil() <= turns(a.greatest) + 1e-9
}

/// Returns whether the bounds of an angle are narrow enough to know its period.
fn is_known_angle(a: Bounds) -> bool {
    a.least >= -1e6 && a.greatest <= 1e6
}

/// Returns bounds of sine or cosine, which has its greatest value at `crest` + 2πk.
fn wave(a: Bounds, crest: f64, function: fn(f64) -> f64) -> Bounds {
    let whole = Bounds::new(-1.0, 1.0).valid_if(a.valid && !a.has_infinity());
    if !is_known_angle(a) {
        return whole;
    }
    let ends = Bounds::from_results(&[function(a.least), function(a.greatest)], a.valid).widened(ULPS);
    let least = if may_contain(a, crest + PI, TAU) { -1.0 } else { ends.least };
    let greatest = if may_contain(a, crest, TAU) { 1.0 } else { ends.greatest };
    Bounds { least, greatest, valid: a.valid }.intersection(whole)
}

pub(super) fn sin(a: Bounds) -> Bounds {
    wave(a, FRAC_PI_2, libm::sin)
}

pub(super) fn cos(a: Bounds) -> Bounds {
    wave(a, 0.0, libm::cos)
}

pub(super) fn tan(a: Bounds) -> Bounds {
    if !is_known_angle(a) || may_contain(a, FRAC_PI_2, PI) {
        return ALL.valid_if(a.valid && !a.has_infinity());
    }
    increasing(a, libm::tan)
}

pub(super) fn asin(a: Bounds) -> Bounds {
    increasing_within(a, [-1.0, 1.0], libm::asin)
}

pub(super) fn acos(a: Bounds) -> Bounds {
    // It decreases: acos(v) = −(−acos(v)), and −acos(v) increases.
    increasing_within(a, [-1.0, 1.0], |v| -libm::acos(v)).negated()
}

pub(super) fn atan(a: Bounds) -> Bounds {
    increasing(a, libm::atan)
}

pub(super) fn sinh(a: Bounds) -> Bounds {
    increasing(a, libm::sinh)
}

pub(super) fn cosh(a: Bounds) -> Bounds {
    increasing(a.abs(), libm::cosh)
}

pub(super) fn tanh(a: Bounds) -> Bounds {
    increasing(a, libm::tanh)
}

pub(super) fn floor(a: Bounds) -> Bounds {
    a.increasing(f64::floor)
}

pub(super) fn ceil(a: Bounds) -> Bounds {
    a.increasing(f64::ceil)
}

pub(super) fn round(a: Bounds) -> Bounds {
    a.increasing(f64::round)
}

pub(super) fn trunc(a: Bounds) -> Bounds {
    a.increasing(f64::trunc)
}

pub(super) fn fract(a: Bounds) -> Bounds {
    // A tiny negative number minus −1 rounds to 1.
    if a.has_infinity() || a.least.floor() != a.greatest.floor() {
        return Bounds::new(0.0, 1.0).valid_if(a.valid && !a.has_infinity());
    }
    a.increasing(functions::fract)
}

/// Returns bounds of a function of two values at the four corners of the rectangle of their bounds.
fn at_corners(a: Bounds, b: Bounds, function: fn(f64, f64) -> f64) -> Bounds {
    let [p, q, r, s] = [a.least, a.greatest, b.least, b.greatest];
    let results = [function(p, r), function(p, s), function(q, r), function(q, s)];
    Bounds::from_results(&results, a.valid && b.valid)
}

pub(super) fn hypot(a: Bounds, b: Bounds) -> Bounds {
    let result = at_corners(a.abs(), b.abs(), libm::hypot).widened(ULPS);
    Bounds { least: result.least.max(0.0), ..result }
}

/// Returns bounds of the angle of a direction, which jumps from π to −π across the negative x axis. Elsewhere
/// its extremes over a rectangle are at the corners.
pub(super) fn atan2(y: Bounds, x: Bounds) -> Bounds {
    if y.has_zero() && x.least <= 0.0 {
        return Bounds::new(-PI, PI).valid_if(x.valid && y.valid);
    }
    at_corners(y, x, libm::atan2).widened(ULPS)
}

/// Returns bounds of `a^b`. A square is exact; other powers come from libm.
pub(super) fn power(a: Bounds, b: Bounds) -> Bounds {
    let valid = a.valid && b.valid;
    let exponent = b.is_one().then_some(b.least);
    let result = match exponent {
        Some(2.0) => return a.squared(),
        Some(n) if n.fract() == 0.0 => whole_power(a, n),
        _ if a.least >= 0.0 => power_of_positive(a, b),
        _ if a.least == f64::NEG_INFINITY || b.has_infinity() => Bounds::ANYTHING,
        // Of negative numbers only whole powers are numbers.
        Some(_) if a.greatest < 0.0 => Bounds::ANYTHING,
        Some(_) => power_of_positive(Bounds { least: 0.0, ..a }, b).valid_if(false),
        None => {
            let size = power_of_positive(a.abs(), b);
            size.union(size.negated()).valid_if(false)
        }
    };
    // libm has 1 for NaN to the power 0 and for 1 to the power NaN.
    if valid { result } else { result.union(Bounds::one(1.0)).valid_if(false) }
}

/// Returns bounds of a power with one whole exponent.
fn whole_power(a: Bounds, n: f64) -> Bounds {
    let exponent = Bounds::one(n);
    if n % 2.0 == 0.0 {
        let size = power_of_positive(a.abs(), exponent);
        return Bounds { least: size.least.max(0.0), ..size };
    }
    if n < 0.0 && a.has_zero() {
        return ALL;
    }
    Bounds::from_results(&[libm::pow(a.least, n), libm::pow(a.greatest, n)], true).widened(ULPS)
}

/// Returns bounds of powers of numbers that are at least 0. The logarithm of a power is the product of b and
/// the logarithm of a, so its extremes are at the corners.
fn power_of_positive(a: Bounds, b: Bounds) -> Bounds {
    let result = at_corners(a, b, libm::pow).widened(ULPS);
    // An odd negative power of −0 is −∞.
    let least = if a.least == 0.0 && b.least < 0.0 { f64::NEG_INFINITY } else { result.least.max(0.0) };
    Bounds { least, ..result }
}

pub(super) fn modulo(a: Bounds, b: Bounds) -> Bounds {
    let valid = a.valid && b.valid && !a.has_infinity() && !b.has_zero();
    let whole = Bounds { least: b.least.min(0.0), greatest: b.greatest.max(0.0), valid };
    let narrow = a.greatest - a.least <= 0.5 * b.least.abs();
    if !valid || !b.is_one() || !narrow {
        return whole;
    }
    // Within half a period the values rise, unless they jump down by at least half a period.
    let [first, last] = [a.least, a.greatest].map(|v| functions::modulo(v, b.least));
    if first <= last { Bounds::new(first, last) } else { whole }
}

pub(super) fn clamp(v: Bounds, lo: Bounds, hi: Bounds) -> Bounds {
    v.max(lo).min(hi)
}

/// a (1 − t) + b t is linear in t: its extremes are at the ends of t.
pub(super) fn mix(a: Bounds, b: Bounds, t: Bounds) -> Bounds {
    let computed = |t: Bounds| a.times(Bounds::one(1.0).minus(t)).plus(b.times(t));
    let whole = computed(t);
    let size = |v: Bounds| v.abs().greatest;
    // The four operations are each off by half an ulp of their result.
    let margin = 8.0 * f64::EPSILON * (size(a) * (1.0 + size(t)) + size(b) * size(t)) + f64::MIN_POSITIVE;
    if !margin.is_finite() || !whole.valid {
        return whole;
    }
    let ends = computed(Bounds::one(t.least)).union(computed(Bounds::one(t.greatest)));
    ends.expanded(margin).intersection(whole)
}

pub(super) fn step(edge: Bounds, v: Bounds) -> Bounds {
    let least = f64::from(u8::from(v.least >= edge.greatest));
    let greatest = f64::from(u8::from(v.greatest >= edge.least));
    Bounds { least, greatest, valid: edge.valid && v.valid }
}

pub(super) fn smoothstep(lo: Bounds, hi: Bounds, v: Bounds) -> Bounds {
    let unit = Bounds::new(0.0, 1.0);
    let (span, from_lo) = (hi.minus(lo), v.minus(lo));
    if span.has_zero() {
        let known = lo.valid && hi.valid && v.valid;
        let same = lo.is_one() && hi.is_one();
        let finite = ![lo, hi, v].iter().any(|bounds| bounds.has_infinity());
        return if same { step(lo, v) } else { unit.valid_if(known && finite) };
    }
    let share = from_lo.over(span);
    // Rises with the share, up to the rounding of its last steps.
    let curve = |t: f64| t * t * (3.0 - 2.0 * t);
    share.max(Bounds::one(0.0)).min(Bounds::one(1.0)).increasing(curve).widened(ULPS)
}

pub(super) fn gauss(d: Bounds, s: Bounds) -> Bounds {
    exp(d.over(s).squared().times(Bounds::one(-0.5)))
}

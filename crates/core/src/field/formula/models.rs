//! Runs a compiled formula on Taylor models of its values over a rectangle.

use std::f64::consts::{FRAC_PI_2, LN_2, LN_10};

use super::functions::OfThree;
use super::interval;
use super::machine::Enclosure;
use super::program::Op;
use crate::field::{Bounds, TaylorModel};

impl Enclosure for TaylorModel {
    fn from_bounds(bounds: Bounds) -> Self {
        Self::from_bounds(bounds)
    }

    fn bounds(&self) -> Bounds {
        self.bounds()
    }

    fn one(op: Op, a: Self) -> Self {
        let by_bounds = || interval::unary(op, a.bounds());
        let model = match op {
            _ if a.is_constant() => Self::UNKNOWN,
            Op::Negate => a.negated(),
            Op::Abs => a.abs(),
            Op::Sqrt => a.sqrt(),
            Op::One(function) => function.model.map_or(Self::UNKNOWN, |model| model(&a)),
            _ => Self::UNKNOWN,
        };
        model.or_bounds(by_bounds)
    }

    fn two(op: Op, a: Self, b: Self) -> Self {
        let by_bounds = || interval::binary(op, a.bounds(), b.bounds());
        let model = match op {
            _ if a.is_constant() && b.is_constant() => Self::UNKNOWN,
            Op::Add => return a.plus(&b),
            Op::Subtract => return a.minus(&b),
            Op::Multiply => a.times(&b),
            Op::Divide => a.over(&b),
            Op::Min => a.min(&b),
            Op::Max => a.max(&b),
            Op::Two(function) => function.model.map_or(Self::UNKNOWN, |model| model(&a, &b)),
            _ => Self::UNKNOWN,
        };
        model.or_bounds(by_bounds)
    }

    fn three(function: &OfThree, a: Self, b: Self, c: Self) -> Self {
        let model = function.model.map_or(Self::UNKNOWN, |model| model(&a, &b, &c));
        model.or_bounds(|| (function.bounds)(a.bounds(), b.bounds(), c.bounds()))
    }

    fn either(self, other: Self) -> Self {
        TaylorModel::either(&self, &other)
    }
}

/// Returns the largest size of a number between two.
fn size(bounds: Bounds) -> f64 {
    bounds.least.abs().max(bounds.greatest.abs())
}

pub(super) fn exp(a: &TaylorModel) -> TaylorModel {
    let value = libm::exp(a.middle());
    a.composed([value, value, 0.5 * value], libm::exp(a.bounds().greatest) / 6.0, 0.0)
}

pub(super) fn ln(a: &TaylorModel) -> TaylorModel {
    logarithm(a, libm::log, 1.0)
}

pub(super) fn log2(a: &TaylorModel) -> TaylorModel {
    logarithm(a, libm::log2, LN_2)
}

pub(super) fn log10(a: &TaylorModel) -> TaylorModel {
    logarithm(a, libm::log10, LN_10)
}

/// Returns a logarithm, and the natural logarithm of its base.
fn logarithm(a: &TaylorModel, function: fn(f64) -> f64, of_base: f64) -> TaylorModel {
    let Bounds { least, .. } = a.bounds();
    if least <= 0.0 {
        return TaylorModel::UNKNOWN;
    }
    let slope = 1.0 / (a.middle() * of_base);
    let third = 1.0 / (3.0 * of_base * least * least * least);
    a.composed([function(a.middle()), slope, -0.5 * slope / a.middle()], third, 0.0)
}

pub(super) fn sin(a: &TaylorModel) -> TaylorModel {
    let (sine, cosine) = libm::sincos(a.middle());
    wave(a, sine, cosine)
}

pub(super) fn cos(a: &TaylorModel) -> TaylorModel {
    let (sine, cosine) = libm::sincos(a.middle());
    wave(a, cosine, -sine)
}

/// Returns sine or cosine, from its value and its derivative in the middle.
fn wave(a: &TaylorModel, value: f64, slope: f64) -> TaylorModel {
    let Bounds { least, greatest, valid } = a.bounds();
    if !valid {
        return TaylorModel::UNKNOWN;
    }
    // The third derivative is minus the first, which changes at most as much as the angle.
    let third = (slope.abs() + (greatest - least)).min(1.0) / 6.0;
    a.composed([value, slope, -0.5 * value], third, 0.0)
}

pub(super) fn tan(a: &TaylorModel) -> TaylorModel {
    sin(a).over(&cos(a))
}

pub(super) fn sinh(a: &TaylorModel) -> TaylorModel {
    let (sine, cosine) = (libm::sinh(a.middle()), libm::cosh(a.middle()));
    a.composed([sine, cosine, 0.5 * sine], libm::cosh(size(a.bounds())) / 6.0, 0.0)
}

pub(super) fn cosh(a: &TaylorModel) -> TaylorModel {
    let (sine, cosine) = (libm::sinh(a.middle()), libm::cosh(a.middle()));
    a.composed([cosine, sine, 0.5 * cosine], libm::cosh(size(a.bounds())) / 6.0, 0.0)
}

/// Returns a bound of the error of a function's slope over the whole rectangle, if the slope is a difference
/// of numbers up to 1.
fn cancelled(a: &TaylorModel) -> f64 {
    let Bounds { least, greatest, .. } = a.bounds();
    let step = greatest - least;
    32.0 * f64::EPSILON * (step + step * step)
}

pub(super) fn tanh(a: &TaylorModel) -> TaylorModel {
    let value = libm::tanh(a.middle());
    let slope = 1.0 - value * value;
    // The third derivative is at most 2.
    a.composed([value, slope, -value * slope], 1.0 / 3.0, cancelled(a))
}

pub(super) fn atan(a: &TaylorModel) -> TaylorModel {
    let slope = 1.0 / (1.0 + a.middle() * a.middle());
    // The third derivative is at most 2.
    a.composed([libm::atan(a.middle()), slope, -a.middle() * slope * slope], 1.0 / 3.0, 0.0)
}

/// Returns the angle of a direction that is not near the negative x axis, where it jumps.
pub(super) fn atan2(y: &TaylorModel, x: &TaylorModel) -> TaylorModel {
    if x.bounds().least > 0.0 {
        return atan(&y.over(x));
    }
    let quarter = match y.bounds() {
        Bounds { least, .. } if least > 0.0 => FRAC_PI_2,
        Bounds { greatest, .. } if greatest < 0.0 => -FRAC_PI_2,
        _ => return TaylorModel::UNKNOWN,
    };
    TaylorModel::constant(quarter).minus(&atan(&x.over(y)))
}

pub(super) fn hypot(a: &TaylorModel, b: &TaylorModel) -> TaylorModel {
    a.squared().plus(&b.squared()).sqrt()
}

/// exp(−(d/s)²/2).
pub(super) fn gauss(d: &TaylorModel, s: &TaylorModel) -> TaylorModel {
    let share = d.over(s);
    if !s.is_constant() {
        return exp(&share.squared().times(&TaylorModel::constant(-0.5)));
    }
    let t = share.middle();
    let value = libm::exp(-0.5 * t * t);
    // The third derivative (3t − t³) e^(−t²/2) is at most 1.381.
    let bend = 0.5 * (t * t - 1.0) * value;
    // A rounded square changes the result by a share of t² e^(−t²/2) < 1.
    let rounding = 4.0 * f64::EPSILON;
    share.composed([value, -t * value, bend], 1.381 / 6.0, cancelled(&share) + rounding)
}

/// Returns a power with a constant exponent, or of a positive base.
pub(super) fn power(a: &TaylorModel, b: &TaylorModel) -> TaylorModel {
    if !b.is_constant() {
        return exp(&b.times(&ln(a)));
    }
    let n = b.middle();
    if n == 2.0 {
        return a.squared();
    }
    let Bounds { least, greatest, .. } = a.bounds();
    let is_smooth = least > 0.0 || (n.fract() == 0.0 && (n >= 0.0 || greatest < 0.0));
    if !is_smooth {
        return TaylorModel::UNKNOWN;
    }
    // A factor of 0 ends the series.
    let term = |factor: f64, t: f64, exponent: f64| match factor {
        0.0 => 0.0,
        _ => factor * libm::pow(t, exponent),
    };
    let factors = [1.0, n, 0.5 * n * (n - 1.0), n * (n - 1.0) * (n - 2.0) / 6.0];
    let series = [0, 1, 2].map(|order: usize| term(factors[order], a.middle(), n - order as f64));
    let third = [least, greatest].map(|t| term(factors[3], t, n - 3.0).abs());
    a.composed(series, third[0].max(third[1]), 0.0)
}

pub(super) fn clamp(v: &TaylorModel, lo: &TaylorModel, hi: &TaylorModel) -> TaylorModel {
    v.max(lo).min(hi)
}

pub(super) fn mix(a: &TaylorModel, b: &TaylorModel, t: &TaylorModel) -> TaylorModel {
    a.times(&TaylorModel::constant(1.0).minus(t)).plus(&b.times(t))
}

/// Returns a model for values between the limits. Beyond them, bounds show that the value is 0 or 1.
pub(super) fn smoothstep(lo: &TaylorModel, hi: &TaylorModel, v: &TaylorModel) -> TaylorModel {
    let span = hi.minus(lo);
    let Bounds { least, greatest, .. } = span.bounds();
    if least <= 0.0 && greatest >= 0.0 {
        return TaylorModel::UNKNOWN;
    }
    let share = v.minus(lo).over(&span);
    let Bounds { least, greatest, .. } = share.bounds();
    if !(least >= 0.0 && greatest <= 1.0) {
        return TaylorModel::UNKNOWN;
    }
    share.squared().times(&TaylorModel::constant(3.0).minus(&share.times(&TaylorModel::constant(2.0))))
}

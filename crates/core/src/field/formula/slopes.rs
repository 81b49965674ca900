//! The derivatives of functions in formulas.

use std::f64::consts::{LN_2, LN_10};

use super::derivatives::{ONE, Varying};
use super::function_bounds as bounds;
use super::gradient::{GradientBounds, times};
use super::machine::Enclosure;
use super::program::Op;
use crate::field::Bounds;

pub(super) fn exp(_: Bounds, result: Bounds) -> Bounds {
    result
}

pub(super) fn ln(a: Bounds, _: Bounds) -> Bounds {
    ONE.over(a)
}

pub(super) fn log2(a: Bounds, _: Bounds) -> Bounds {
    ONE.over(a.times(Bounds::one(LN_2)))
}

pub(super) fn log10(a: Bounds, _: Bounds) -> Bounds {
    ONE.over(a.times(Bounds::one(LN_10)))
}

pub(super) fn sin(a: Bounds, _: Bounds) -> Bounds {
    bounds::cos(a)
}

pub(super) fn cos(a: Bounds, _: Bounds) -> Bounds {
    bounds::sin(a).negated()
}

/// Bounds the derivative of the tangent; its result has no bounds if there is a pole.
pub(super) fn tan(_: Bounds, result: Bounds) -> Bounds {
    ONE.plus(result.squared())
}

pub(super) fn atan(a: Bounds, _: Bounds) -> Bounds {
    ONE.over(ONE.plus(a.squared()))
}

pub(super) fn sinh(a: Bounds, _: Bounds) -> Bounds {
    bounds::cosh(a)
}

pub(super) fn cosh(a: Bounds, _: Bounds) -> Bounds {
    bounds::sinh(a)
}

pub(super) fn tanh(_: Bounds, result: Bounds) -> Bounds {
    ONE.minus(result.squared())
}

/// Bounds the derivative of a power with a constant exponent: (aⁿ)′ = n aⁿ⁻¹ a′.
pub(super) fn power<G: GradientBounds>(a: Varying<G>, n: Varying<G>, value: Bounds) -> Varying<G> {
    if !n.is_constant() {
        return Varying::from_bounds(value);
    }
    let less = bounds::power(a.value, Bounds::one(n.value.least - 1.0));
    let by_derivative = a.gradient_times(times(n.value, less));
    let gradient = if n.value.least == 0.5 { a.gradient_of_root(by_derivative) } else { by_derivative };
    Varying::with_root(value, gradient, a.gradient.filter(|_| n.value.least == 2.0))
}

/// √(a² + b²)′ = (a a′ + b b′) / √(a² + b²), with factors from −1 to 1.
pub(super) fn hypot<G: GradientBounds>(a: Varying<G>, b: Varying<G>, value: Bounds) -> Varying<G> {
    let gradient = |a: Varying<G>, b: Varying<G>| {
        let factor = |of: Bounds| of.over(value).intersection(Bounds::new(-1.0, 1.0));
        let by_factors = a.gradient_times(factor(a.value))?.plus(&b.gradient_times(factor(b.value))?);
        Some(by_factors.or(G::of_hypot(&a.gradient?, &b.gradient?)))
    };
    Varying::new(value, gradient(a, b))
}

/// The greatest slope of the bell curve exp(−t²/2) is e^(−1/2), at t = 1.
const STEEPEST_OF_BELL: f64 = 0.606_530_659_712_634;

/// Bounds the derivative of the bell curve with a constant s: exp(−(d/s)²/2)′ = −d / s² · exp(−(d/s)²/2) ·
/// d′.
pub(super) fn gauss<G: GradientBounds>(d: Varying<G>, s: Varying<G>, value: Bounds) -> Varying<G> {
    if !s.is_constant() {
        return Varying::from_bounds(value);
    }
    let most = STEEPEST_OF_BELL / s.value.least.abs();
    let factor = times(d.value.over(s.value.squared()).negated(), value);
    let factor = if factor.valid { factor.intersection(Bounds::new(-most, most)) } else { factor };
    Varying::new(value, d.gradient_times(factor))
}

pub(super) fn clamp<G: GradientBounds>(v: Varying<G>, lo: Varying<G>, hi: Varying<G>) -> Option<G> {
    Varying::two(Op::Min, Varying::two(Op::Max, v, lo), hi).gradient
}

pub(super) fn mix<G: GradientBounds>(a: Varying<G>, b: Varying<G>, t: Varying<G>) -> Option<G> {
    let rest = Varying::two(Op::Subtract, Varying::from_bounds(ONE), t);
    let [first, second] = [(a, rest), (b, t)].map(|(v, share)| Varying::two(Op::Multiply, v, share));
    Some(first.gradient?.plus(&second.gradient?))
}

/// Bounds the derivative of the smooth step with constant limits: 6 t (1 − t) / (hi − lo) for the share t.
pub(super) fn smoothstep<G: GradientBounds>(lo: Varying<G>, hi: Varying<G>, v: Varying<G>) -> Option<G> {
    let span = hi.value.minus(lo.value);
    if !lo.is_constant() || !hi.is_constant() || span.has_zero() {
        return None;
    }
    let unit = |t: Bounds| t.max(Bounds::one(0.0)).min(ONE);
    let share = unit(v.value.minus(lo.value).over(span));
    let rise = share.times(ONE.minus(share)).times(Bounds::one(6.0));
    v.gradient_times(rise.min(Bounds::one(1.5)).over(span))
}

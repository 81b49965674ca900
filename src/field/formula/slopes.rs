//! The derivatives of functions in formulas.

use std::f64::consts::{LN_2, LN_10};

use super::derivatives::{ONE, Varying, sums, times};
use super::function_bounds as bounds;
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

/// Without bounds where the result has a pole.
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

/// With a constant exponent: (aⁿ)′ = n aⁿ⁻¹ a′.
pub(super) fn power(a: Varying, n: Varying, _: Bounds) -> Option<[Bounds; 2]> {
    if !n.is_constant() {
        return None;
    }
    let less = bounds::power(a.value, Bounds::one(n.value.least - 1.0));
    a.slopes_times(times(n.value, less))
}

/// √(a² + b²)′ = (a a′ + b b′) / √(a² + b²), with factors from −1 to 1.
pub(super) fn hypot(a: Varying, b: Varying, result: Bounds) -> Option<[Bounds; 2]> {
    let factor = |of: Bounds| of.over(result).intersection(Bounds::new(-1.0, 1.0));
    sums(a.slopes_times(factor(a.value)), b.slopes_times(factor(b.value)))
}

/// With a constant s: exp(−(d/s)²/2)′ = −d / s² · exp(−(d/s)²/2) · d′.
pub(super) fn gauss(d: Varying, s: Varying, result: Bounds) -> Option<[Bounds; 2]> {
    if !s.is_constant() {
        return None;
    }
    let factor = d.value.over(s.value.squared()).negated();
    d.slopes_times(times(factor, result))
}

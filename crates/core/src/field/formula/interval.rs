//! Runs a compiled formula on intervals: bounds of its values over a rectangle.

use super::functions::OfThree;
use super::machine::{self, Enclosure};
use super::program::{Op, Program};
use crate::field::Bounds;
use crate::geometry::Rect;

/// Returns bounds of the values of a program over a rectangle, with bounds of the third value.
pub(super) fn bounds(program: &Program, rect: &Rect, third: Bounds) -> Bounds {
    let [x, y] = [0, 1].map(|axis: usize| Bounds::new(rect.min[axis], rect.max[axis]));
    machine::run(program, [x, y, third])
}

impl Enclosure for Bounds {
    fn from_bounds(bounds: Bounds) -> Self {
        bounds
    }

    fn bounds(&self) -> Bounds {
        *self
    }

    fn one(op: Op, a: Self) -> Self {
        unary(op, a)
    }

    fn two(op: Op, a: Self, b: Self) -> Self {
        binary(op, a, b)
    }

    fn three(function: &OfThree, a: Self, b: Self, c: Self) -> Self {
        (function.bounds)(a, b, c)
    }

    fn either(self, other: Self) -> Self {
        self.union(other)
    }
}

/// Returns bounds of an operation on one value.
pub(super) fn unary(op: Op, a: Bounds) -> Bounds {
    match op {
        Op::Negate => a.negated(),
        Op::Abs => a.abs(),
        Op::Sqrt => a.sqrt(),
        Op::One(function) if a.is_one() => {
            at_point(a, function.value).unwrap_or_else(|| (function.bounds)(a))
        }
        Op::One(function) => (function.bounds)(a),
        _ => unreachable!("the machine runs every other operation itself"),
    }
}

/// Returns bounds of an operation on two values.
pub(super) fn binary(op: Op, a: Bounds, b: Bounds) -> Bounds {
    match op {
        Op::Add => a.plus(b),
        Op::Subtract => a.minus(b),
        Op::Multiply => a.times(b),
        Op::Divide => a.over(b),
        Op::Min => a.min(b),
        Op::Max => a.max(b),
        Op::Two(function) => {
            // The sign of a zero is not known, so bounds of it are not a point.
            let is_point = |v: Bounds| v.is_one() && v.least != 0.0;
            let value =
                if is_point(a) && is_point(b) { (function.value)(a.least, b.least) } else { f64::NAN };
            if value.is_nan() { (function.bounds)(a, b) } else { Bounds::one(value) }
        }
        _ => unreachable!("the machine runs every other operation itself"),
    }
}

/// Returns the value of a function at one number, if it is not NaN; at 0, the values at 0 and −0.
fn at_point(a: Bounds, function: fn(f64) -> f64) -> Option<Bounds> {
    let value = Bounds::one(function(a.least));
    let other = if a.least == 0.0 { Bounds::one(function(-a.least)) } else { value };
    let both = value.union(other);
    both.valid.then_some(both)
}

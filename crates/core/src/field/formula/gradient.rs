//! Bounds of a gradient over a rectangle.

use super::derivatives::Varying;
use super::functions::{OfThree, OfTwo, OfTwoVarying};
use crate::field::Bounds;

pub(super) const ZERO: Bounds = Bounds::new(0.0, 0.0);

/// Bound of the effect of rounding in a few operations, as a share of a bound.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Bounds of a gradient over a rectangle.
pub(super) trait GradientBounds: Copy + PartialEq {
    /// The gradient of a function whose square is the value, or `()` if such gradients are not followed.
    type Root: Copy;

    /// The gradient of a constant.
    const NONE: Self;

    /// Returns a sum.
    fn plus(&self, other: &Self) -> Self;

    /// Returns a product with numbers that are not larger than the bounds.
    fn times(&self, factor: Bounds) -> Self;

    /// Returns bounds that contain the gradients of both.
    fn union(&self, other: &Self) -> Self;

    /// Returns the gradient of √(a² + b²) from the gradients of a and b, for all values of a and b.
    fn of_hypot(a: &Self, b: &Self) -> Self;

    /// Returns the closer one of two that both hold.
    fn or(self, other: Self) -> Self;

    /// Keeps the gradient of a root with a value.
    fn keep(root: Option<Self>) -> Self::Root;

    /// Returns the gradient that was kept.
    fn kept(root: Self::Root) -> Option<Self>;

    /// Returns the derivative of a function of two values, if it is known.
    fn of_two(function: &OfTwo) -> Option<OfTwoVarying<Self>>;

    /// Returns the gradient of a function of three values, if it is known.
    fn of_three(function: &OfThree, values: [Varying<Self>; 3]) -> Option<Self>;
}

/// Bounds of the derivatives along x and y. Roots are not followed: half as much to copy at every step.
pub(super) type Along = [Bounds; 2];

/// Bounds of the derivatives along x and y, and of the length of the gradient.
///
/// The bounds along both axes alone make the length too large by up to √2: the gradient of the distance from
/// a point has the length 1, and its components are from −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gradient {
    pub along: Along,
    /// Upper bound of the length of the gradient; infinite if none is known.
    pub length: f64,
}

/// Returns whether the bounds along both axes are numbers.
pub(super) fn are_known(along: &Along) -> bool {
    along.iter().all(|slope| slope.valid && !slope.has_infinity())
}

impl GradientBounds for Along {
    type Root = ();

    const NONE: Self = [ZERO; 2];

    fn plus(&self, other: &Self) -> Self {
        [self[0].plus(other[0]), self[1].plus(other[1])]
    }

    fn times(&self, factor: Bounds) -> Self {
        self.map(|slope| times(slope, factor))
    }

    fn union(&self, other: &Self) -> Self {
        [self[0].union(other[0]), self[1].union(other[1])]
    }

    fn of_hypot(a: &Self, b: &Self) -> Self {
        [0, 1].map(|axis: usize| {
            let [p, q] = [a, b].map(|along| size(along[axis]));
            let most = rounded_up(libm::hypot(p, q));
            if most.is_finite() { Bounds::new(-most, most) } else { Bounds::ANYTHING }
        })
    }

    fn or(self, other: Self) -> Self {
        if are_known(&self) { self } else { other }
    }

    fn keep(_: Option<Self>) -> Self::Root {}

    fn kept((): Self::Root) -> Option<Self> {
        None
    }

    fn of_two(function: &OfTwo) -> Option<OfTwoVarying<Self>> {
        Some(function.derivative?.along)
    }

    fn of_three(function: &OfThree, [a, b, c]: [Varying<Self>; 3]) -> Option<Self> {
        (function.derivative.along)(a, b, c)
    }
}

impl Gradient {
    /// Returns bounds from those along the axes alone.
    pub fn of(along: Along) -> Self {
        Self::new(along, f64::INFINITY)
    }

    /// Returns bounds from those along the axes and a known bound of the length. The smaller length counts;
    /// NaN stands for an unknown one.
    fn new(along: Along, length: f64) -> Self {
        let [x, y] = along.map(size);
        let by_axes = rounded_up(libm::hypot(x, y));
        let length = if length < by_axes { length } else { by_axes };
        Self { along, length: if length.is_nan() { f64::INFINITY } else { length } }
    }
}

impl GradientBounds for Gradient {
    type Root = Option<Self>;

    const NONE: Self = Self { along: Along::NONE, length: 0.0 };

    fn plus(&self, other: &Self) -> Self {
        Self::new(self.along.plus(&other.along), rounded_up(self.length + other.length))
    }

    fn times(&self, factor: Bounds) -> Self {
        if self.length == 0.0 {
            return Self::NONE;
        }
        Self::new(self.along.times(factor), rounded_up(self.length * size(factor)))
    }

    fn union(&self, other: &Self) -> Self {
        Self::new(self.along.union(&other.along), self.length.max(other.length))
    }

    /// Bounds (a ∇a + b ∇b) / √(a² + b²). Its length is at most the largest singular value of the matrix with
    /// the rows ∇a and ∇b.
    fn of_hypot(a: &Self, b: &Self) -> Self {
        let along = Along::of_hypot(&a.along, &b.along);
        let longer = a.length.max(b.length);
        if longer == 0.0 || !longer.is_finite() {
            return Self::new(along, longer);
        }
        let product = a.along[0].times(b.along[0]).plus(a.along[1].times(b.along[1]));
        let (p, q) = (a.length / longer, b.length / longer);
        let product = (size(product) / longer / longer).min(p * q);
        // The largest eigenvalue of the matrix times its transpose, which has p², q² and the product as
        // entries, grows with each of them.
        let apart = 0.5 * (p * p - q * q);
        let square = 0.5 * (p * p + q * q) + (apart * apart + product * product).sqrt();
        Self::new(along, rounded_up(longer * square.sqrt()))
    }

    fn or(self, other: Self) -> Self {
        Self { along: self.along.or(other.along), length: self.length.min(other.length) }
    }

    fn keep(root: Option<Self>) -> Self::Root {
        root
    }

    fn kept(root: Self::Root) -> Option<Self> {
        root
    }

    fn of_two(function: &OfTwo) -> Option<OfTwoVarying<Self>> {
        Some(function.derivative?.with_length)
    }

    fn of_three(function: &OfThree, [a, b, c]: [Varying<Self>; 3]) -> Option<Self> {
        (function.derivative.with_length)(a, b, c)
    }
}

/// Returns a product; one with 0 is 0, whatever the other factor.
pub(super) fn times(a: Bounds, b: Bounds) -> Bounds {
    if a == ZERO || b == ZERO { ZERO } else { a.times(b) }
}

/// Returns the largest absolute value of the numbers within bounds.
fn size(bounds: Bounds) -> f64 {
    if bounds.valid { bounds.least.abs().max(bounds.greatest.abs()) } else { f64::INFINITY }
}

fn rounded_up(length: f64) -> f64 {
    length * (1.0 + ROUNDING)
}

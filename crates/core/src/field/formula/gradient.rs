//! What is known of a gradient over a rectangle.

use crate::field::Bounds;

pub(super) const ZERO: Bounds = Bounds::new(0.0, 0.0);

/// What rounding changes in a few operations, as a share of a bound.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Bounds of the derivatives along x and y, and of the length of the gradient.
///
/// The bounds along both axes alone make the length too large by up to √2: the gradient of the distance from
/// a point has the length 1, and its components are from −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gradient {
    pub along: [Bounds; 2],
    /// No gradient is longer; infinite where no bound is known.
    pub length: f64,
}

impl Gradient {
    /// That of a constant.
    pub const NONE: Self = Self { along: [ZERO; 2], length: 0.0 };

    /// From the bounds along the axes alone.
    pub fn of(along: [Bounds; 2]) -> Self {
        Self::new(along, f64::INFINITY)
    }

    /// With a length that is known beside the bounds along the axes; the smaller one counts. NaN tells
    /// nothing.
    fn new(along: [Bounds; 2], length: f64) -> Self {
        let [x, y] = along.map(size);
        let by_axes = rounded_up(libm::hypot(x, y));
        let length = if length < by_axes { length } else { by_axes };
        Self { along, length: if length.is_nan() { f64::INFINITY } else { length } }
    }

    /// Whether the bounds along both axes are numbers.
    pub fn is_known(&self) -> bool {
        self.along.iter().all(|slope| slope.valid && !slope.has_infinity())
    }

    /// A sum.
    pub fn plus(&self, other: &Self) -> Self {
        let along = [0, 1].map(|axis: usize| self.along[axis].plus(other.along[axis]));
        Self::new(along, rounded_up(self.length + other.length))
    }

    /// A product with numbers that are not larger than the bounds.
    pub fn times(&self, factor: Bounds) -> Self {
        if self.length == 0.0 {
            return Self::NONE;
        }
        let along = self.along.map(|slope| times(slope, factor));
        Self::new(along, rounded_up(self.length * size(factor)))
    }

    /// What holds for both.
    pub fn union(&self, other: &Self) -> Self {
        let along = [0, 1].map(|axis: usize| self.along[axis].union(other.along[axis]));
        Self::new(along, self.length.max(other.length))
    }

    /// The gradient of √(a² + b²) from those of a and b, whatever their values.
    ///
    /// It is (a ∇a + b ∇b) / √(a² + b²), so no longer than the largest singular value of the matrix with
    /// the rows ∇a and ∇b.
    pub fn of_hypot(a: &Self, b: &Self) -> Self {
        let along = [0, 1].map(|axis: usize| {
            let [p, q] = [a, b].map(|gradient| size(gradient.along[axis]));
            let most = rounded_up(libm::hypot(p, q));
            if most.is_finite() { Bounds::new(-most, most) } else { Bounds::ANYTHING }
        });
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

    /// The shorter one of two that both hold.
    pub fn or(self, other: Self) -> Self {
        let along = if self.is_known() { self.along } else { other.along };
        Self { along, length: self.length.min(other.length) }
    }
}

/// A product; one with 0 is 0, whatever the other factor.
pub(super) fn times(a: Bounds, b: Bounds) -> Bounds {
    if a == ZERO || b == ZERO { ZERO } else { a.times(b) }
}

/// No number is farther from 0.
fn size(bounds: Bounds) -> f64 {
    if bounds.valid { bounds.least.abs().max(bounds.greatest.abs()) } else { f64::INFINITY }
}

fn rounded_up(length: f64) -> f64 {
    length * (1.0 + ROUNDING)
}

//! Bounds of values over a rectangle, and how operations of f64 map them.

/// Bounds of values over a closed rectangle: each value is NaN or in the range from [`least`] to
/// [`greatest`].
///
/// The operations here bound the *rounded* results of f64 arithmetic. Addition, subtraction,
/// multiplication, division and the square root round to the nearest number, which keeps order, so the
/// rounded results at the ends of the intervals are the bounds and need no margin. A zero stands for both
/// 0 and −0.
///
/// [`least`]: Self::least
/// [`greatest`]: Self::greatest
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// No value is smaller than this.
    pub least: f64,
    /// No value is greater than this.
    pub greatest: f64,
    /// False where some value might be NaN.
    pub valid: bool,
}

impl Bounds {
    /// Any value, NaN too.
    pub const ANYTHING: Self = Self { least: f64::NEG_INFINITY, greatest: f64::INFINITY, valid: false };

    /// Returns values from `least` to `greatest`, none NaN.
    pub const fn new(least: f64, greatest: f64) -> Self {
        Self { least, greatest, valid: true }
    }

    /// Returns one value; for NaN, [`Self::ANYTHING`].
    pub const fn one(value: f64) -> Self {
        if value.is_nan() { Self::ANYTHING } else { Self::new(value, value) }
    }

    /// Returns whether every value is the same number. 0 and −0 count as the same.
    pub fn is_one(&self) -> bool {
        self.valid && self.least == self.greatest
    }

    /// Returns whether `value` may be one of the values, also if it is NaN.
    pub fn contains(&self, value: f64) -> bool {
        if value.is_nan() { !self.valid } else { (self.least..=self.greatest).contains(&value) }
    }

    /// Returns the bounds of the values of both.
    pub fn union(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
            valid: self.valid && other.valid,
        }
    }

    /// Returns the bounds of values that lie in both.
    pub fn intersection(self, other: Self) -> Self {
        Self {
            least: self.least.max(other.least),
            greatest: self.greatest.min(other.greatest),
            valid: self.valid || other.valid,
        }
    }

    /// These bounds where `valid` is true; otherwise with NaN among the values.
    pub fn valid_if(self, valid: bool) -> Self {
        Self { valid: self.valid && valid, ..self }
    }

    /// Returns the bounds with each end moved outwards by `count` neighbouring numbers of f64.
    pub fn widened(self, count: u32) -> Self {
        let (mut least, mut greatest) = (self.least, self.greatest);
        for _ in 0..count {
            (least, greatest) = (least.next_down(), greatest.next_up());
        }
        Self { least, greatest, ..self }
    }

    /// Returns the bounds with each end moved outwards by `margin`.
    pub fn expanded(self, margin: f64) -> Self {
        Self { least: self.least - margin, greatest: self.greatest + margin, ..self }
    }

    /// Returns bounds from the results at the ends of the intervals. Some of these may be NaN.
    pub(super) fn from_results(results: &[f64], valid: bool) -> Self {
        let numbers = results.iter().filter(|result| !result.is_nan()).map(|&result| Self::one(result));
        numbers.reduce(Self::union).unwrap_or(Self::ANYTHING).valid_if(valid)
    }

    /// Returns whether 0 may be among the values.
    pub(super) fn has_zero(self) -> bool {
        self.least <= 0.0 && self.greatest >= 0.0
    }

    pub(super) fn has_infinity(self) -> bool {
        self.least == f64::NEG_INFINITY || self.greatest == f64::INFINITY
    }

    /// Returns bounds of a function that never decreases and is computed without a rounding error, or rounded
    /// to the nearest number.
    pub(super) fn increasing(self, function: fn(f64) -> f64) -> Self {
        Self { least: function(self.least), greatest: function(self.greatest), valid: self.valid }
    }

    pub(super) fn negated(self) -> Self {
        Self { least: -self.greatest, greatest: -self.least, ..self }
    }

    pub(crate) fn abs(self) -> Self {
        let least = if self.has_zero() { 0.0 } else { self.least.abs().min(self.greatest.abs()) };
        Self { least, greatest: self.least.abs().max(self.greatest.abs()), ..self }
    }

    pub(super) fn sqrt(self) -> Self {
        if self.greatest < 0.0 {
            return Self::ANYTHING;
        }
        let root = Self { least: self.least.max(0.0), ..self }.increasing(f64::sqrt);
        root.valid_if(self.least >= 0.0)
    }

    pub(super) fn squared(self) -> Self {
        self.abs().increasing(|v| v * v)
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let opposite = |a: Self, b: Self| a.least == f64::NEG_INFINITY && b.greatest == f64::INFINITY;
        let valid = self.valid && other.valid && !opposite(self, other) && !opposite(other, self);
        let (least, greatest) = (self.least + other.least, self.greatest + other.greatest);
        // Of −∞ and ∞, any sum.
        let end = |sum: f64, any: f64| if sum.is_nan() { any } else { sum };
        Self { least: end(least, f64::NEG_INFINITY), greatest: end(greatest, f64::INFINITY), valid }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let vanishes = |a: Self, b: Self| a.has_zero() && b.has_infinity();
        let valid = self.valid && other.valid && !vanishes(self, other) && !vanishes(other, self);
        // A product 0 · ∞ is NaN. The other products bound the rest: there is also a product of 0 and a
        // number, or all products at the ends are infinite.
        let [a, b, c, d] = [self.least, self.greatest, other.least, other.greatest];
        Self::from_results(&[a * c, a * d, b * c, b * d], valid)
    }

    pub(super) fn over(self, other: Self) -> Self {
        let undefined =
            (self.has_zero() && other.has_zero()) || (self.has_infinity() && other.has_infinity());
        let valid = self.valid && other.valid && !undefined;
        // Division by 0 gives ∞ of either sign.
        if other.has_zero() {
            return Self { valid, ..Self::ANYTHING };
        }
        let [a, b, c, d] = [self.least, self.greatest, other.least, other.greatest];
        Self::from_results(&[a / c, a / d, b / c, b / d], valid)
    }

    /// Returns the smaller of two values, NaN if either is.
    pub(super) fn min(self, other: Self) -> Self {
        let (least, greatest) = (self.least.min(other.least), self.greatest.min(other.greatest));
        Self { least, greatest, valid: self.valid && other.valid }
    }

    /// Returns the larger of two values, NaN if either is.
    pub(super) fn max(self, other: Self) -> Self {
        let (least, greatest) = (self.least.max(other.least), self.greatest.max(other.greatest));
        Self { least, greatest, valid: self.valid && other.valid }
    }
}

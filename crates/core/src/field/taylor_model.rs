//! Taylor models of degree 2: polynomials near functions over a rectangle, with a bound of the remainder.

use super::Bounds;

/// A Taylor model of a function over a rectangle: a polynomial of degree 2 and a bound of the remainder, the
/// distance from it.
///
/// ```text
///  |         .-'  p + remainder    u and v are the coordinates in the rectangle, from −1 to 1.
///  |     _.-'  .  the function     |f(u, v) − p(u, v)| ≤ remainder, for the values as computed in f64:
///  | .-'' . ''  _.-'               every operation adds what its rounding can change.
///  | . ' ' _.-''  p − remainder
///  |___.-''____________________
/// ```
///
/// The remainder shrinks with the third power of the side of the rectangle where a function is smooth. Bounds
/// of the function over any part of the rectangle follow from the polynomial alone, however long the formula
/// of the function is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaylorModel {
    /// The coefficients of 1, u, v, u², uv and v².
    coefficients: [f64; 6],
    /// A bound of the distance from the polynomial: not negative, and infinite if the function may not be a
    /// finite number.
    remainder: f64,
}

/// Half a unit in the last place of 1, doubled: a bound of the relative error of an operation.
const EPSILON: f64 = f64::EPSILON;

/// More than what underflow can change in an operation.
const TINY: f64 = 1e-300;

impl TaylorModel {
    /// A function of which nothing is known.
    pub const UNKNOWN: Self = Self { coefficients: [0.0; 6], remainder: f64::INFINITY };

    /// Returns one number everywhere.
    pub const fn constant(value: f64) -> Self {
        if value.is_finite() {
            Self { coefficients: [value, 0.0, 0.0, 0.0, 0.0, 0.0], remainder: 0.0 }
        } else {
            Self::UNKNOWN
        }
    }

    /// Returns a coordinate: `middle` ± `half` along axis 0 or 1, for numbers within `remainder` of it.
    pub fn coordinate(axis: usize, middle: f64, half: f64, remainder: f64) -> Self {
        let mut coefficients = [middle, 0.0, 0.0, 0.0, 0.0, 0.0];
        coefficients[1 + axis] = half;
        Self { coefficients, remainder }
    }

    /// Returns a function of which bounds are known.
    pub fn from_bounds(Bounds { least, greatest, valid }: Bounds) -> Self {
        if !(valid && least.is_finite() && greatest.is_finite()) {
            return Self::UNKNOWN;
        }
        if least == greatest {
            return Self::constant(least);
        }
        let middle = 0.5 * least + 0.5 * greatest;
        let remainder = (greatest - middle).max(middle - least) * (1.0 + EPSILON) + TINY;
        Self { remainder, ..Self::constant(middle) }
    }

    /// Creates a polynomial and the largest distance from it.
    pub fn new(coefficients: [f64; 6], remainder: f64) -> Self {
        let is_known = remainder.is_finite() && coefficients.iter().all(|c| c.is_finite());
        if is_known { Self { coefficients, remainder } } else { Self::UNKNOWN }
    }

    /// Returns the coefficients of 1, u, v, u², uv and v².
    pub fn coefficients(&self) -> [f64; 6] {
        self.coefficients
    }

    /// Returns the largest distance from the polynomial.
    pub fn remainder(&self) -> f64 {
        self.remainder
    }

    /// Returns the value of the polynomial in the middle of the rectangle.
    pub fn middle(&self) -> f64 {
        self.coefficients[0]
    }

    /// Returns whether the function is known to be one number.
    pub fn is_constant(&self) -> bool {
        self.remainder == 0.0 && self.coefficients[1..].iter().all(|&c| c == 0.0)
    }

    /// Returns this model with `remainder` added to the distance from the polynomial.
    pub fn loosened(&self, remainder: f64) -> Self {
        Self::new(self.coefficients, self.remainder + remainder)
    }

    /// Returns how much the linear terms, and how much the quadratic ones, can change the value.
    fn reach(&self) -> [f64; 2] {
        let [_, a, b, c, d, e] = self.coefficients.map(f64::abs);
        [a + b, c + d + e]
    }

    /// Returns an upper bound of the absolute values.
    pub fn size(&self) -> f64 {
        let [linear, bend] = self.reach();
        self.coefficients[0].abs() + linear + bend + self.remainder
    }

    /// Returns bounds over the whole rectangle.
    pub fn bounds(&self) -> Bounds {
        self.bounds_over([0.0; 2], [1.0; 2])
    }

    /// Returns bounds over a part of the rectangle, by its centre and its half sides in the coordinates u and
    /// v.
    pub fn bounds_over(&self, [u, v]: [f64; 2], [half_u, half_v]: [f64; 2]) -> Bounds {
        let [c, cu, cv, cuu, cuv, cvv] = self.coefficients;
        // The same polynomial around the centre of the part.
        let value = c + u * (cu + cuu * u + cuv * v) + v * (cv + cvv * v);
        let slope_u = cu + 2.0 * cuu * u + cuv * v;
        let slope_v = cv + 2.0 * cvv * v + cuv * u;
        let linear = slope_u.abs() * half_u + slope_v.abs() * half_v + (cuv * half_u * half_v).abs();
        let (uu, vv) = (cuu * half_u * half_u, cvv * half_v * half_v);
        let remainder = self.remainder + if self.is_constant() { 0.0 } else { 32.0 * EPSILON * self.size() };
        let least = value - linear + uu.min(0.0) + vv.min(0.0) - remainder;
        let greatest = value + linear + uu.max(0.0) + vv.max(0.0) + remainder;
        if least.is_finite() && greatest.is_finite() {
            Bounds::new(least, greatest)
        } else {
            Bounds::ANYTHING
        }
    }

    /// Returns bounds over a convex polygon in the rectangle, by its corners in the coordinates u and v.
    pub fn bounds_in(&self, corners: impl ExactSizeIterator<Item = [f64; 2]> + Clone) -> Bounds {
        let [c, cu, cv, cuu, cuv, cvv] = self.coefficients;
        let value = |[u, v]: [f64; 2]| c + u * (cu + cuu * u + cuv * v) + v * (cv + cvv * v);
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut join = |value: f64| (least, greatest) = (least.min(value), greatest.max(value));
        let next = corners.clone().cycle().skip(1);
        for ([u, v], [to_u, to_v]) in corners.zip(next) {
            join(value([u, v]));
            // Along an edge, f is a polynomial of degree 2; these are its derivatives at the start.
            let [along_u, along_v] = [to_u - u, to_v - v];
            let slope = along_u * (cu + 2.0 * cuu * u + cuv * v) + along_v * (cv + 2.0 * cvv * v + cuv * u);
            let bend = 2.0 * (cuu * along_u * along_u + cuv * along_u * along_v + cvv * along_v * along_v);
            let share = -slope / bend;
            if share > 0.0 && share < 1.0 {
                join(value([u + share * along_u, v + share * along_v]));
            }
        }
        // Where the gradient is 0: in the polygon or beside it.
        let determinant = 4.0 * cuu * cvv - cuv * cuv;
        let at = [(cuv * cv - 2.0 * cvv * cu) / determinant, (cuv * cu - 2.0 * cuu * cv) / determinant];
        if at.iter().all(|v| v.abs() <= 1.0 + 1e-6) {
            join(value(at));
        }
        let remainder = self.remainder + 64.0 * EPSILON * self.size();
        let is_known = least.is_finite() && greatest.is_finite() && remainder.is_finite();
        if is_known { Bounds::new(least - remainder, greatest + remainder) } else { Bounds::ANYTHING }
    }

    /// −f.
    pub fn negated(&self) -> Self {
        Self { coefficients: self.coefficients.map(|c| -c), ..*self }
    }

    /// Returns a sum.
    pub fn plus(&self, other: &Self) -> Self {
        self.weighted(1.0, other, 1.0)
    }

    /// Returns a difference.
    pub fn minus(&self, other: &Self) -> Self {
        self.weighted(1.0, other, -1.0)
    }

    /// Returns a sum with a factor for each of the two.
    fn weighted(&self, factor: f64, other: &Self, other_factor: f64) -> Self {
        let (a, b) = (&self.coefficients, &other.coefficients);
        let coefficients = std::array::from_fn(|n| factor * a[n] + other_factor * b[n]);
        let size = factor.abs() * self.size() + other_factor.abs() * other.size();
        let remainder = factor.abs() * self.remainder + other_factor.abs() * other.remainder;
        Self::new(coefficients, remainder + 4.0 * EPSILON * size + TINY)
    }

    /// Products of more than two linear factors count as part of the remainder.
    pub fn times(&self, other: &Self) -> Self {
        if other.is_constant() {
            return self.scaled(other.middle());
        }
        if self.is_constant() {
            return other.scaled(self.middle());
        }
        let [a, au, av, auu, auv, avv] = self.coefficients;
        let [b, bu, bv, buu, buv, bvv] = other.coefficients;
        let coefficients = [
            a * b,
            a * bu + au * b,
            a * bv + av * b,
            a * buu + au * bu + auu * b,
            a * buv + au * bv + av * bu + auv * b,
            a * bvv + av * bv + avv * b,
        ];
        let ([linear, bend], [other_linear, other_bend]) = (self.reach(), other.reach());
        let (size, other_size) = (self.size(), other.size());
        let cut_off = linear * other_bend + bend * (other_linear + other_bend);
        let remainder = cut_off + size * other.remainder + other_size * self.remainder;
        Self::new(coefficients, remainder + 16.0 * EPSILON * size * other_size + TINY)
    }

    /// Returns a product with a number.
    fn scaled(&self, factor: f64) -> Self {
        let remainder = factor.abs() * self.remainder + 4.0 * EPSILON * factor.abs() * self.size() + TINY;
        Self::new(self.coefficients.map(|c| factor * c), remainder)
    }

    /// f².
    pub fn squared(&self) -> Self {
        self.times(self)
    }

    /// Returns a quotient.
    pub fn over(&self, other: &Self) -> Self {
        self.times(&other.inverse())
    }

    /// 1 / f.
    fn inverse(&self) -> Self {
        let Bounds { least, greatest, .. } = self.bounds();
        if least <= 0.0 && greatest >= 0.0 {
            return Self::UNKNOWN;
        }
        let nearest = least.abs().min(greatest.abs());
        let inverse = 1.0 / self.middle();
        let square = inverse * inverse;
        // The derivatives of 1/t, divided by factorials, are −1/t², 1/t³ and −1/t⁴.
        self.composed(
            [inverse, -square, square * inverse],
            1.0 / (nearest * nearest) / (nearest * nearest),
            0.0,
        )
    }

    /// √f.
    pub fn sqrt(&self) -> Self {
        let Bounds { least, .. } = self.bounds();
        if self.middle().min(least) <= 0.0 {
            return Self::UNKNOWN;
        }
        let root = self.middle().sqrt();
        let slope = 0.5 / root;
        let series = [root, slope, -0.25 * slope / self.middle()];
        self.composed(series, 0.0625 / (least * least * least.sqrt()), 0.0)
    }

    /// Returns a function of f, from its Taylor series at [`Self::middle`]: the value, the derivative, and
    /// half the second derivative. `third` is at least a sixth of the size of its third derivative over
    /// [`Self::bounds`]; by at most `error` the series is off, beyond a few ulps of each coefficient.
    pub fn composed(&self, [value, slope, bend]: [f64; 3], third: f64, error: f64) -> Self {
        let [_, u, v, uu, uv, vv] = self.coefficients;
        let coefficients = [
            value,
            slope * u,
            slope * v,
            slope * uu + bend * u * u,
            slope * uv + 2.0 * bend * u * v,
            slope * vv + bend * v * v,
        ];
        let ([linear, curved], own) = (self.reach(), self.remainder);
        let step = linear + curved + own;
        // (linear + curved + own)² without linear².
        let beyond = (2.0 * linear + curved) * curved + (2.0 * (linear + curved) + own) * own;
        let remainder = slope.abs() * own + bend.abs() * beyond + third * step * step * step + error;
        let rounding = 32.0 * EPSILON * (value.abs() + slope.abs() * step + bend.abs() * step * step);
        Self::new(coefficients, remainder * (1.0 + 1e-12) + rounding + TINY)
    }

    /// Returns the larger of two.
    pub fn max(&self, other: &Self) -> Self {
        let Bounds { least, greatest, valid } = self.minus(other).bounds();
        if !valid {
            return Self::UNKNOWN;
        }
        if least >= 0.0 {
            return *self;
        }
        if greatest <= 0.0 {
            return *other;
        }
        // With d = self − other: max(0, d) lies between two parallel lines of this slope, 2 · middle apart.
        let slope = greatest / (greatest - least);
        let middle = -0.5 * slope * least;
        let rounding = 1e-12 * middle + 4.0 * EPSILON * (greatest - least);
        let between = self.weighted(slope, other, 1.0 - slope);
        between.plus(&Self::constant(middle)).loosened(middle + rounding)
    }

    /// Returns the smaller of two.
    pub fn min(&self, other: &Self) -> Self {
        self.negated().max(&other.negated()).negated()
    }

    /// Returns the size without sign.
    pub fn abs(&self) -> Self {
        self.max(&self.negated())
    }

    /// Returns a model that holds for both functions: either may be the value at each point.
    pub fn either(&self, other: &Self) -> Self {
        if self == other {
            return *self;
        }
        let apart = self.minus(other).bounds();
        let remainder = 0.5 * apart.least.abs().max(apart.greatest.abs());
        let middle = self.weighted(0.5, other, 0.5);
        Self::new(middle.coefficients, middle.remainder + remainder)
    }

    /// Returns this model or the one made from `bounds`, whichever has the smaller remainder. Calls `bounds`
    /// only if this model is coarse.
    pub fn or_bounds(self, bounds: impl FnOnce() -> Bounds) -> Self {
        let [linear, bend] = self.reach();
        if self.remainder <= linear + bend {
            return self;
        }
        let other = Self::from_bounds(bounds());
        if other.remainder < self.remainder { other } else { self }
    }
}

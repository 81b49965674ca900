//! Target diameters as a function of a raster's own values.

use crate::field::Bounds;
use crate::raster::ValueRange;

/// A piecewise linear function from a value to a target diameter, constant beyond its ends.
///
/// ```text
/// diameter          .--------     last knot
///                  /
///             .---´
///    --------´                    first knot
///                       value
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ValueCurve {
    /// (value, target diameter in world units), in increasing order of value; never empty.
    knots: Vec<[f64; 2]>,
}

/// The values of a raster at which a curve is fine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FineAt {
    /// The least values.
    Least,
    /// The values nearest to 0, such as those of shallow water.
    Zero,
    /// The greatest values.
    Greatest,
}

/// Why knots make no curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// There is no knot.
    #[error("A curve of values needs at least one knot, a value and its target diameter.")]
    Empty,
    /// A value is not finite.
    #[error("Knot {knot} has the value {value}; it must be a finite number.")]
    Value {
        /// The number of the knot, counted from one.
        knot: usize,
        /// The number as it was given.
        value: f64,
    },
    /// A target diameter is not positive.
    #[error("Knot {knot} has the target diameter {diameter}; it must be a finite number above 0.")]
    Diameter {
        /// The number of the knot, counted from one.
        knot: usize,
        /// The number as it was given.
        diameter: f64,
    },
    /// The values do not increase.
    #[error(
        "Knot {knot} has the value {value}, which is not above the value {before} of the knot before it."
    )]
    Order {
        /// The number of the knot, counted from one.
        knot: usize,
        /// The number as it was given.
        value: f64,
        /// The value of the knot before.
        before: f64,
    },
}

impl ValueCurve {
    /// Returns the curve through knots [value, target diameter], in increasing order of value.
    ///
    /// # Errors
    /// Fails when there is no knot, a number is not valid, or the values do not increase.
    pub fn new(knots: Vec<[f64; 2]>) -> Result<Self, CurveError> {
        if knots.is_empty() {
            return Err(CurveError::Empty);
        }
        for (number, &[value, diameter]) in knots.iter().enumerate() {
            let knot = number + 1;
            if !value.is_finite() {
                return Err(CurveError::Value { knot, value });
            }
            if !(diameter > 0.0 && diameter.is_finite()) {
                return Err(CurveError::Diameter { knot, diameter });
            }
            match number.checked_sub(1).map(|before| knots[before][0]) {
                Some(before) if value <= before => return Err(CurveError::Order { knot, value, before }),
                _ => {}
            }
        }
        Ok(Self { knots })
    }

    /// Returns the straight line over a range of values, from the first of two target diameters, in world
    /// units, to the second; one knot where the range is one value. `None` if a number is not valid.
    pub fn over(values: ValueRange, [at_least, at_greatest]: [f64; 2]) -> Option<Self> {
        let mut knots = vec![[f64::from(values.least), at_least]];
        if !values.is_one() {
            knots.push([f64::from(values.greatest), at_greatest]);
        }
        Self::new(knots).ok()
    }

    /// Returns a curve that is fine at some values of a raster, with a knot at the median of the values on
    /// each side of them. `sorted` are finite values in ascending order; diameters are in world units. `None`
    /// if there is no value, or a number is not valid.
    pub fn fine_at(place: FineAt, sorted: &[f32], finest: f64, coarsest: f64) -> Option<Self> {
        let (&least, &greatest) = (sorted.first()?, sorted.last()?);
        let fine = match place {
            FineAt::Least => least,
            FineAt::Greatest => greatest,
            FineAt::Zero => 0.0f32.clamp(least, greatest),
        };
        let below = &sorted[..sorted.partition_point(|&value| value < fine)];
        let above = &sorted[sorted.partition_point(|&value| value <= fine)..];
        let between = (finest * coarsest).sqrt();
        let median = |side: &[f32]| side.get(side.len() / 2).map(|&value| (value, between));
        let knots = [
            below.first().map(|&value| (value, coarsest)),
            median(below),
            Some((fine, finest)),
            median(above),
            above.last().map(|&value| (value, coarsest)),
        ];
        let mut knots: Vec<(f32, f64)> = knots.into_iter().flatten().collect();
        // Where the median is the end, the end counts: it is the coarser of the two.
        knots.dedup_by(|next, kept| {
            let is_same = next.0 == kept.0;
            kept.1 = if is_same { kept.1.max(next.1) } else { kept.1 };
            is_same
        });
        Self::new(knots.into_iter().map(|(value, diameter)| [f64::from(value), diameter]).collect()).ok()
    }

    /// Returns this function with another knot [value, target diameter].
    ///
    /// # Errors
    /// Fails when a number is not valid, or there is a knot of this value.
    pub fn with_inserted(&self, knot: [f64; 2]) -> Result<Self, CurveError> {
        let mut knots = self.knots.clone();
        knots.insert(knots.partition_point(|&[value, _]| value < knot[0]), knot);
        Self::new(knots)
    }

    /// Returns this function with one more knot, halfway between the two neighbours that are furthest
    /// apart in value. `None` if there is no number between any two.
    pub fn with_another_knot(&self) -> Option<Self> {
        let halfway = |place: usize| 0.5 * self.knots[place - 1][0] + 0.5 * self.knots[place][0];
        // Half the distance: the distance itself may overflow.
        let gap = |place: &usize| halfway(*place) - self.knots[place - 1][0];
        let place = (1..self.knots.len()).max_by(|a, b| gap(a).total_cmp(&gap(b)))?;
        let value = halfway(place);
        let mut knots = self.knots.clone();
        knots.insert(place, [value, self.diameter(value)]);
        Self::new(knots).ok()
    }

    /// Returns the curve with another knot [value, target diameter] at a place, counted from 0.
    ///
    /// # Errors
    /// Fails when a number is not valid, or the values do not increase.
    pub fn with_knot(&self, place: usize, knot: [f64; 2]) -> Result<Self, CurveError> {
        let mut knots = self.knots.clone();
        knots[place] = knot;
        Self::new(knots)
    }

    /// Returns the curve without the knot at a place, counted from 0.
    ///
    /// # Errors
    /// Fails when it is the only one.
    pub fn without_knot(&self, place: usize) -> Result<Self, CurveError> {
        let mut knots = self.knots.clone();
        knots.remove(place);
        Self::new(knots)
    }

    /// Returns the knots as [value, target diameter], in increasing order of value.
    pub fn knots(&self) -> &[[f64; 2]] {
        &self.knots
    }

    /// Returns the target diameter for a value, in world units; NaN for NaN.
    pub fn diameter(&self, value: f64) -> f64 {
        if value.is_nan() {
            return value;
        }
        let next = self.knots.partition_point(|&[knot, _]| knot <= value);
        let (Some(before), Some(&after)) = (next.checked_sub(1), self.knots.get(next)) else {
            return self.knots[next.min(self.knots.len() - 1)][1];
        };
        let [[v0, d0], [v1, d1]] = [self.knots[before], after];
        // Halves, as the difference of two large values may overflow.
        let share = (0.5 * value - 0.5 * v0) / (0.5 * v1 - 0.5 * v0);
        (d0 * (1.0 - share) + d1 * share).clamp(d0.min(d1), d0.max(d1))
    }

    /// Returns bounds of the target diameter for the values from `least` to `greatest`.
    pub fn bounds(&self, least: f64, greatest: f64) -> Bounds {
        if least.is_nan() || greatest.is_nan() {
            return Bounds::ANYTHING;
        }
        let ends = Bounds::one(self.diameter(least)).union(Bounds::one(self.diameter(greatest)));
        let first = self.knots.partition_point(|&[value, _]| value < least);
        let between = self.knots[first..].iter().take_while(|&&[value, _]| value <= greatest);
        let all = between.map(|&[_, diameter]| Bounds::one(diameter)).fold(ends, Bounds::union);
        // Between two knots the sum of two products is off by a few ulps, and need not be monotone.
        all.widened(8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diameters_are_linear_between_knots_and_constant_beyond() {
        let mut random = fastrand::Rng::with_seed(31);
        for _ in 0..300 {
            let tenths: std::collections::BTreeSet<i32> =
                (0..random.usize(1..6)).map(|_| random.i32(-1000..1000)).collect();
            let knots: Vec<[f64; 2]> =
                tenths.into_iter().map(|value| [f64::from(value) / 10.0, 0.01 + random.f64()]).collect();
            let curve = ValueCurve::new(knots.clone()).unwrap();
            for &[value, diameter] in &knots {
                assert_eq!(curve.diameter(value), diameter, "{value} in {knots:?}");
            }
            for ends in knots.windows(2) {
                let [[v0, d0], [v1, d1]] = [ends[0], ends[1]];
                let value = v0 + random.f64() * (v1 - v0);
                let expected = d0 + (value - v0) * (d1 - d0) / (v1 - v0);
                assert!((curve.diameter(value) - expected).abs() < 1e-12, "{value} in {knots:?}");
            }
            let [first, last] = [knots[0], knots[knots.len() - 1]];
            for beyond in [1e-9, 1e9, f64::INFINITY] {
                assert_eq!(curve.diameter(first[0] - beyond), first[1], "{beyond} before {knots:?}");
                assert_eq!(curve.diameter(last[0] + beyond), last[1], "{beyond} behind {knots:?}");
            }
            assert!(curve.diameter(f64::NAN).is_nan());
        }
    }

    #[test]
    fn another_knot_lies_in_the_widest_gap_and_changes_no_diameter() {
        let curve = ValueCurve::new(vec![[-10.0, 0.5], [0.0, 0.1], [100.0, 2.1]]).unwrap();
        let finer = curve.with_another_knot().unwrap();
        assert_eq!(finer.knots().len(), 4);
        assert_eq!(finer.knots()[2][0], 50.0);
        for value in [-20.0, -5.0, 20.0, 50.0, 70.0, 200.0] {
            assert!((finer.diameter(value) - curve.diameter(value)).abs() < 1e-15, "{value}");
        }
        assert_eq!(finer.without_knot(2), Ok(curve));
        let full = ValueCurve::new(vec![[1.0, 0.5], [1.0f64.next_up(), 0.1]]).unwrap();
        assert_eq!(full.with_another_knot(), None);
        let widest = ValueCurve::new(vec![[f64::MIN, 0.5], [f64::MAX, 0.1]]).unwrap();
        assert_eq!(widest.with_another_knot().unwrap().knots()[1][0], 0.0);
    }

    #[test]
    fn a_curve_is_fine_at_low_high_or_shallow_values() {
        let knots = |place, values: &[f32]| {
            ValueCurve::fine_at(place, values, 0.01, 0.16).map(|curve| curve.knots().to_vec())
        };
        let depths = [-90.0, -30.0, -10.0, 20.0, 60.0];
        let ends = |first: f64, last: f64| vec![[-90.0, first], [-10.0, 0.04], [60.0, last]];
        let shore = [[-90.0, 0.16], [-30.0, 0.04], [0.0, 0.01], [60.0, 0.16]];
        assert_eq!(knots(FineAt::Zero, &depths), Some(shore.to_vec()));
        assert_eq!(knots(FineAt::Greatest, &depths), Some(ends(0.16, 0.01)));
        let low = [[-90.0, 0.01], [20.0, 0.04], [60.0, 0.16]];
        assert_eq!(knots(FineAt::Least, &depths), Some(low.to_vec()));
        assert_eq!(knots(FineAt::Zero, &depths[3..]), Some(vec![[20.0, 0.01], [60.0, 0.16]]));
        assert_eq!(knots(FineAt::Zero, &depths[..1]), Some(vec![[-90.0, 0.01]]));
        assert_eq!(knots(FineAt::Zero, &[]), None);
    }

    #[test]
    fn a_knot_is_inserted_in_its_order() {
        let curve = ValueCurve::new(vec![[0.0, 0.1], [100.0, 2.1]]).unwrap();
        assert_eq!(
            curve.with_inserted([50.0, 1.0]).unwrap().knots(),
            [[0.0, 0.1], [50.0, 1.0], [100.0, 2.1]]
        );
        assert_eq!(curve.with_inserted([-1.0, 1.0]).unwrap().knots()[0], [-1.0, 1.0]);
        assert!(matches!(curve.with_inserted([100.0, 1.0]), Err(CurveError::Order { .. })));
    }

    #[test]
    fn knots_are_changed_and_removed_within_the_rules() {
        let curve = ValueCurve::new(vec![[0.0, 0.1], [100.0, 2.1]]).unwrap();
        assert_eq!(curve.with_knot(1, [50.0, 1.0]).unwrap().knots(), [[0.0, 0.1], [50.0, 1.0]]);
        assert!(matches!(curve.with_knot(1, [-1.0, 1.0]), Err(CurveError::Order { knot: 2, .. })));
        let one = curve.without_knot(0).unwrap();
        assert_eq!(one.knots(), [[100.0, 2.1]]);
        assert_eq!(one.without_knot(0), Err(CurveError::Empty));
    }

    #[test]
    fn bounds_hold_every_diameter_and_are_reached() {
        let mut random = fastrand::Rng::with_seed(71);
        for _ in 0..2_000 {
            let mut value = -1.0;
            let mut knot = |_| {
                value += 1e-6 + random.f64();
                [value, 1e-3 + random.f64()]
            };
            let knots: Vec<[f64; 2]> = (0..7).map(&mut knot).collect();
            let curve = ValueCurve::new(knots).unwrap();
            let a = 8.0 * random.f64() - 2.0;
            let b = a + [0.0, 1e-9, 0.3, 3.0][random.usize(..4)] * random.f64();
            let bounds = curve.bounds(a, b);
            let (mut least, mut greatest) = (f64::INFINITY, 0.0f64);
            for n in 0..=100 {
                let diameter = curve.diameter((a + (b - a) * f64::from(n) / 100.0).clamp(a, b));
                assert!(bounds.contains(diameter), "{a} to {b}: {diameter}, {bounds:?}");
                (least, greatest) = (least.min(diameter), greatest.max(diameter));
            }
            for &[value, diameter] in curve.knots().iter().filter(|knot| (a..=b).contains(&knot[0])) {
                assert!(bounds.contains(diameter), "{value}");
                (least, greatest) = (least.min(diameter), greatest.max(diameter));
            }
            assert!(least - bounds.least < 1e-12 && bounds.greatest - greatest < 1e-12, "{bounds:?}");
        }
    }

    #[test]
    fn invalid_knots_are_refused_with_a_sentence() {
        for (knots, word) in [
            (vec![], "at least one knot"),
            (vec![[0.0, 1.0], [f64::NAN, 1.0]], "Knot 2 has the value NaN"),
            (vec![[0.0, 0.0]], "Knot 1 has the target diameter 0"),
            (vec![[0.0, f64::INFINITY]], "target diameter inf"),
            (vec![[0.0, 1.0], [0.0, 2.0]], "not above the value 0"),
        ] {
            let error = ValueCurve::new(knots).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        }
    }
}

//! The transfer curve from risk to target diameter.

use crate::text::Number;

/// The limits of the target diameter, and the curve from risk to target diameter between them. The curve
/// goes from `h_max` at risk 0 down to `h_risk` at risk 1:
///
/// h̄(risk) = h_max · (h_risk / h_max)^(risk^shape)
///
/// With shape 1, equal steps of risk divide the diameter by equal factors. Above 1 only high risk refines;
/// below 1 low risk refines already. `h_min` and `h_max` limit every target diameter, and
/// h_min ≤ h_risk ≤ h_max: a diameter that is painted or given by a formula can be smaller than any that
/// risk asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transfer {
    /// The smallest target diameter, in world units.
    pub h_min: f64,
    /// Target diameter at risk 1, in world units.
    pub h_risk: f64,
    /// The largest target diameter at risk 0, in world units.
    pub h_max: f64,
    /// Exponent of the risk, dimensionless.
    pub shape: f64,
}

/// Why the numbers of a transfer curve are not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// A diameter is not positive or not finite.
    #[error("The {name} {} is not valid: it must be positive and finite.", Number(*value))]
    Diameter {
        /// "smallest diameter", "largest diameter" or "diameter at risk 1".
        name: &'static str,
        /// The value as given.
        value: f64,
    },
    /// The smallest diameter is above the largest.
    #[error("The smallest diameter {} is above the largest, {}: exchange them.", Number(*h_min), Number(*h_max))]
    Reversed {
        /// The smallest diameter as given.
        h_min: f64,
        /// The largest diameter as given.
        h_max: f64,
    },
    /// The diameter at risk 1 is not within the limits.
    #[error(
        "The diameter at risk 1, {}, must be from the smallest diameter {} to the largest, {}.",
        Number(*h_risk), Number(*h_min), Number(*h_max)
    )]
    RiskOutsideLimits {
        /// The diameter at risk 1 as given.
        h_risk: f64,
        /// The smallest diameter.
        h_min: f64,
        /// The largest diameter.
        h_max: f64,
    },
    /// The exponent is out of range.
    #[error("The shape {} of the transfer curve must be between 0.05 and 20; 1 gives equal steps.", Number(*.0))]
    Shape(f64),
}

/// Turns a risk into a target diameter.
pub trait RiskToDiameter {
    /// Returns the target diameter in world units for a risk, which is clamped to 0 to 1. NaN gives NaN.
    fn diameter(&self, risk: f64) -> f64;
}

impl Transfer {
    /// Returns the curve of shape 1 that falls from the largest diameter to the smallest, both in world
    /// units.
    pub const fn between(h_min: f64, h_max: f64) -> Self {
        Self { h_min, h_risk: h_min, h_max, shape: 1.0 }
    }

    /// Returns the limits and the curve with another smallest diameter, in world units. The curve stays as
    /// far as the limit lets it: its end is raised where it would be below.
    pub fn with_smallest(self, h_min: f64) -> Self {
        Self { h_min, h_risk: self.h_risk.max(h_min), h_max: self.h_max.max(h_min), ..self }
    }

    /// Returns whether the curve is that of another transfer, whatever the smallest diameter.
    pub fn has_curve_of(&self, other: &Self) -> bool {
        let Self { h_min: _, h_risk, h_max, shape } = *self;
        (h_risk, h_max, shape) == (other.h_risk, other.h_max, other.shape)
    }

    /// Checks that the diameters are positive, finite and in order, and that the exponent is in range.
    ///
    /// # Errors
    /// Fails with the name of the number that is out of range.
    pub fn checked(self) -> Result<Self, TransferError> {
        let named = [
            ("smallest diameter", self.h_min),
            ("largest diameter", self.h_max),
            ("diameter at risk 1", self.h_risk),
        ];
        for (name, value) in named {
            if !(value > 0.0 && value.is_finite()) {
                return Err(TransferError::Diameter { name, value });
            }
        }
        if self.h_min > self.h_max {
            return Err(TransferError::Reversed { h_min: self.h_min, h_max: self.h_max });
        }
        let Self { h_min, h_risk, h_max, .. } = self;
        if !(h_min..=h_max).contains(&h_risk) {
            return Err(TransferError::RiskOutsideLimits { h_risk, h_min, h_max });
        }
        if !(0.05..=20.0).contains(&self.shape) {
            return Err(TransferError::Shape(self.shape));
        }
        Ok(self)
    }
}

impl RiskToDiameter for Transfer {
    fn diameter(&self, risk: f64) -> f64 {
        if risk.is_nan() {
            risk // with equal ends the curve would give a number: pow(1, NaN) is 1
        } else if risk <= 0.0 {
            self.h_max
        } else if risk >= 1.0 {
            self.h_risk
        } else {
            let fraction = libm::pow(risk, self.shape);
            self.h_max * libm::pow(self.h_risk / self.h_max, fraction)
        }
    }
}

/// Bounds of a [`Transfer`] as a table, to convert ranges of millions of pixels.
#[derive(Clone, Debug)]
pub struct TransferTable {
    knots: Vec<f64>,
}

const STEPS: usize = 2048;
/// Ranges of at most this number of steps are bounded by the curve itself.
const NARROW: usize = 8;
/// The curve is rounded by less than this share: `pow` by an ulp, and the exponent in it by another one,
/// times a logarithm below 710.
const ROUNDING: f64 = 1e-12;

impl TransferTable {
    /// Samples the curve at equal steps of risk.
    pub fn new(transfer: &Transfer) -> Self {
        let knots = (0..=STEPS).map(|i| transfer.diameter(i as f64 / STEPS as f64)).collect();
        Self { knots }
    }

    /// Returns a diameter that no risk of at most `greatest` goes below, and one that no risk of at least
    /// `least` exceeds. They are the values at the knots around these risks. If few knots are between them,
    /// they are the values of the curve itself, from which the table is made: a search needs bounds that get
    /// closer as its cells get smaller.
    #[inline]
    pub fn enclosing(&self, curve: &Transfer, least: f64, greatest: f64) -> [f64; 2] {
        let place = |risk: f64| risk.clamp(0.0, 1.0) * STEPS as f64;
        let [low, high] = [place(least) as usize, place(greatest).ceil() as usize];
        if high - low > NARROW {
            return [self.knots[high], self.knots[low]];
        }
        let [least, greatest] = [curve.diameter(greatest), curve.diameter(least)];
        [self.knots[high].max(least * (1.0 - ROUNDING)), self.knots[low].min(greatest * (1.0 + ROUNDING))]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVEN: Transfer = Transfer::between(0.01, 1.0);

    #[test]
    fn the_curve_has_both_ends_and_equal_steps_between() {
        assert_eq!(EVEN.diameter(0.0), 1.0);
        assert_eq!(EVEN.diameter(1.0), 0.01);
        assert!((EVEN.diameter(0.5) - 0.1).abs() < 1e-15);
        assert_eq!(EVEN.diameter(-3.0), 1.0);
        assert_eq!(EVEN.diameter(7.0), 0.01);
        assert!(Transfer { h_risk: 1.0, ..EVEN }.diameter(f64::NAN).is_nan());
    }

    #[test]
    fn a_smaller_limit_leaves_the_curve_and_a_larger_one_raises_its_end() {
        let finer = EVEN.with_smallest(0.001);
        assert!(finer.has_curve_of(&EVEN) && finer.checked().is_ok());
        assert_eq!((finer.h_min, finer.diameter(1.0)), (0.001, 0.01));
        let coarser = EVEN.with_smallest(0.1);
        assert_eq!((coarser.diameter(1.0), coarser.h_max), (0.1, 1.0));
        assert_eq!(EVEN.with_smallest(2.0), Transfer::between(2.0, 2.0));
    }

    #[test]
    fn the_table_encloses_the_curve() {
        for shape in [0.3, 1.0, 4.0] {
            let curve = Transfer { shape, ..EVEN };
            let table = TransferTable::new(&curve);
            for i in 0..=10_000 {
                let (risk, more) = (f64::from(i) / 10_000.0, (f64::from(i) / 10_000.0 + 0.01).min(1.0));
                let [least, greatest] = table.enclosing(&curve, risk, more);
                assert!(least <= curve.diameter(more) && curve.diameter(risk) <= greatest, "{shape} {risk}");
                // Near 0 a curve of a small shape is steep.
                assert!(i < 50 || greatest < 1.1 * curve.diameter(risk), "{shape} {risk}");
            }
            // Near values have near bounds.
            for risk in [0.2, 0.6, 0.9] {
                let [least, greatest] = table.enclosing(&curve, risk, risk + 1e-9);
                assert!(greatest < least * (1.0 + 1e-7), "{shape} {risk}: {least} {greatest}");
            }
            assert_eq!(
                (table.enclosing(&curve, 0.0, 0.0), table.enclosing(&curve, 1.0, 1.0)),
                ([1.0; 2], [0.01; 2])
            );
        }
    }

    #[test]
    fn curves_with_values_out_of_range_are_refused() {
        for bad in [
            Transfer { h_min: 0.0, ..EVEN },
            Transfer { h_min: f64::NAN, ..EVEN },
            Transfer { h_max: f64::INFINITY, ..EVEN },
            Transfer { h_min: 2.0, ..EVEN },
            Transfer { h_risk: 0.001, ..EVEN },
            Transfer { h_risk: 1.5, ..EVEN },
            Transfer { h_risk: f64::NAN, ..EVEN },
            Transfer { shape: 0.0, ..EVEN },
        ] {
            assert!(bad.checked().is_err(), "{bad:?}");
        }
    }
}

//! Converts the values of a layer to target diameters.

use std::sync::Arc;

use crate::field::{Bounds, RiskToDiameter, Transfer, TransferTable};
use crate::layers::{Combine, Depths, ValueCurve};
use crate::raster::ValueRange;

use super::asked::Ternary;

/// The risk of places without a value: it asks for nothing.
pub const NO_RISK: f32 = f32::NEG_INFINITY;

/// The target diameters for the values of a layer, prepared for comparisons with the limits of
/// [`EdgeLengths`](crate::earth::EdgeLengths).
///
/// A value asks for more than level l when its target diameter is below ℓ_b of level l, Eq. (1). Risk and
/// diameter depend on the value monotonically, so that this is one comparison with a number for each limit.
#[derive(Clone, Debug)]
pub enum Reading {
    /// Risk: at least the limit of the level.
    Risk {
        /// The smallest risk that is below each limit; infinite where none is.
        least: Box<[f32]>,
        transfer: Transfer,
        table: TransferTable,
        /// Risks up to this one ask for nothing: 0 in paint and of threats; elsewhere 0 asks for the largest
        /// diameter.
        nothing: f32,
    },
    /// Target diameter: at most the limit of the level.
    Diameter {
        /// The largest diameter that is below each limit; zero where none is.
        most: Box<[f32]>,
    },
    /// A curve of the values; infinity asks for nothing.
    Curve { curve: Arc<ValueCurve>, lengths: Arc<[f64]> },
    /// One diameter for all values from the first to the second number.
    Band { between: [f64; 2], diameter: f64, lengths: Arc<[f64]> },
    /// What is asked of depths; infinity is a pixel without a value.
    Depth { depths: Depths, factor: f64, lengths: Arc<[f64]> },
}

/// The answer for the values of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RangeAnswer {
    /// The share of the points at which the values are below a limit.
    pub asks: Ternary,
    /// The share of the points at which the values have a target diameter.
    pub present: Ternary,
}

impl RangeAnswer {
    /// No target diameter anywhere.
    pub const NOTHING: Self = Self { asks: Ternary::Never, present: Ternary::Never };

    /// Returns whether the range needs to be divided to know more.
    #[inline]
    pub fn is_undecided(self) -> bool {
        self.asks == Ternary::Maybe || self.present == Ternary::Maybe
    }
}

/// The least and the greatest target diameter in a rectangle, in world units; infinite where nothing is asked
/// for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diameters {
    /// No point asks for less.
    pub least: f64,
    /// No point asks for more.
    pub greatest: f64,
    /// The share of the points that have a target diameter.
    pub present: Ternary,
}

impl Diameters {
    /// No target diameter anywhere.
    pub const NOTHING: Self = Self { least: f64::INFINITY, greatest: f64::INFINITY, present: Ternary::Never };

    /// Returns the share of the points whose target is below a diameter.
    fn share_below(self, diameter: f64) -> Ternary {
        share(self.least < diameter, self.greatest < diameter)
    }
}

impl Reading {
    /// Returns risks.
    pub fn risk(transfer: &Transfer, lengths: &[f64], nothing: f32) -> Self {
        let table = TransferTable::new(transfer);
        let asks = |risk: f32, length: f64| transfer.diameter(f64::from(risk)) < length;
        let limit = |&length: &f64| least_risk(|risk| asks(risk, length));
        Self::Risk { least: lengths.iter().map(limit).collect(), transfer: *transfer, table, nothing }
    }

    /// Returns target diameters.
    pub fn diameter(lengths: &[f64]) -> Self {
        Self::Diameter { most: lengths.iter().map(|&length| largest_below(length)).collect() }
    }

    /// Returns what a layer of depths asks for that is combined in this way.
    pub fn of_depths(depths: &Depths, combine: Combine, lengths: &Arc<[f64]>) -> Self {
        let factor = depths.sizes().rule.factor_in(combine);
        Self::Depth { depths: depths.clone(), factor, lengths: lengths.clone() }
    }

    /// Returns the answer for the values of a range: whether they are below a limit, and whether they have a
    /// target at all.
    #[inline]
    pub fn answer(&self, range: ValueRange, limit: usize) -> RangeAnswer {
        let ValueRange { least, greatest } = range;
        let asks = || self.question(limit).asks(range);
        match self {
            Self::Risk { nothing, .. } => {
                RangeAnswer { asks: asks(), present: share(greatest > *nothing, least > *nothing) }
            }
            Self::Diameter { .. } => {
                RangeAnswer { asks: asks(), present: share(least < f32::INFINITY, greatest < f32::INFINITY) }
            }
            Self::Curve { lengths, .. } | Self::Band { lengths, .. } | Self::Depth { lengths, .. } => {
                let diameters = self.diameters(range);
                RangeAnswer { asks: diameters.share_below(lengths[limit]), present: diameters.present }
            }
        }
    }

    /// Returns the question whether values are below a limit, to be put to many ranges.
    #[inline]
    pub fn question(&self, limit: usize) -> ValueTest<'_> {
        match self {
            Self::Risk { least, .. } => ValueTest::AtLeast(least[limit]),
            Self::Diameter { most } => ValueTest::AtMost(most[limit]),
            Self::Curve { lengths, .. } | Self::Band { lengths, .. } | Self::Depth { lengths, .. } => {
                ValueTest::Below { reading: self, diameter: lengths[limit] }
            }
        }
    }

    /// Returns the diameter that a number asks for, not rounded; infinite where it asks for nothing, and NaN,
    /// zero or less where it is not valid.
    pub fn diameter_of(&self, value: f64) -> f64 {
        match self {
            Self::Risk { nothing, .. } if value <= f64::from(*nothing) => f64::INFINITY,
            Self::Risk { transfer, .. } => transfer.diameter(value),
            Self::Diameter { .. } => value,
            Self::Curve { .. } | Self::Band { .. } | Self::Depth { .. } => {
                self.diameters(ValueRange::one(value as f32)).least
            }
        }
    }

    /// Returns the diameters that the values of a range ask for.
    pub fn diameters(&self, range: ValueRange) -> Diameters {
        let ValueRange { least, greatest } = range;
        match self {
            Self::Risk { transfer, table, nothing, .. } => {
                let present = share(greatest > *nothing, least > *nothing);
                let [low, high] = match least == greatest {
                    true => [transfer.diameter(f64::from(least)); 2],
                    false => table.enclosing(transfer, f64::from(least), f64::from(greatest)),
                };
                Diameters {
                    least: if present == Ternary::Never { f64::INFINITY } else { low },
                    greatest: if present == Ternary::Always { high } else { f64::INFINITY },
                    present,
                }
            }
            Self::Diameter { .. } => Diameters {
                least: f64::from(least),
                greatest: f64::from(greatest),
                present: share(least < f32::INFINITY, greatest < f32::INFINITY),
            },
            Self::Curve { curve, .. } => {
                let present = share(least < f32::INFINITY, greatest < f32::INFINITY);
                let [low, high] = [least, greatest].map(|value| f64::from(value.min(f32::MAX)));
                let asked = match low == high {
                    true => Bounds::one(curve.diameter(low)),
                    false => curve.bounds(low, high),
                };
                let least = if present == Ternary::Never { f64::INFINITY } else { asked.least };
                let greatest = if present == Ternary::Always { asked.greatest } else { f64::INFINITY };
                Diameters { least, greatest, present }
            }
            Self::Band { between: [from, to], diameter, .. } => {
                let [least, greatest] = [least, greatest].map(f64::from);
                let present = share(greatest >= *from && least <= *to, least >= *from && greatest <= *to);
                let [least, greatest] = match present {
                    Ternary::Always => [*diameter; 2],
                    Ternary::Maybe => [*diameter, f64::INFINITY],
                    Ternary::Never => [f64::INFINITY; 2],
                };
                Diameters { least, greatest, present }
            }
            Self::Depth { depths, factor, .. } if least < f32::INFINITY => {
                let asked = depths.asked(f64::from(least), f64::from(greatest.min(f32::MAX)));
                let present = share(asked.any, asked.all && greatest < f32::INFINITY);
                let greatest =
                    if present == Ternary::Always { factor * asked.greatest } else { f64::INFINITY };
                Diameters { least: factor * asked.least, greatest, present }
            }
            Self::Depth { .. } => Diameters::NOTHING,
        }
    }
}

/// Which values are below a certain limit.
#[derive(Clone, Copy, Debug)]
pub enum ValueTest<'a> {
    /// Values that are at least this one.
    AtLeast(f32),
    /// Values that are at most this one.
    AtMost(f32),
    /// Values that the reading converts to a diameter smaller than this one.
    Below { reading: &'a Reading, diameter: f64 },
}

impl ValueTest<'_> {
    /// Returns how many of the values of a range ask for more.
    #[inline]
    pub fn asks(self, range: ValueRange) -> Ternary {
        let ValueRange { least, greatest } = range;
        match self {
            Self::AtLeast(limit) => share(greatest >= limit, least >= limit),
            Self::AtMost(limit) => share(least <= limit, greatest <= limit),
            Self::Below { reading, diameter } => reading.diameters(range).share_below(diameter),
        }
    }

    /// Returns whether a greater or a lower value always asks for more: then a range with [`Ternary::Maybe`]
    /// has a value that asks.
    #[inline]
    pub fn is_monotone(self) -> bool {
        matches!(self, Self::AtLeast(_) | Self::AtMost(_))
    }
}

impl Reading {
    /// Returns bounds of the derivative of the diameter by the value, between two values; 1 for diameters,
    /// and not known for readings that may jump.
    pub fn slopes(&self, least: f64, greatest: f64) -> Bounds {
        match self {
            // h̄ log(h_risk / h_max) k risk^(k − 1), which is negative
            Self::Risk { transfer, .. } => {
                let Transfer { h_min: _, h_risk, h_max, shape } = *transfer;
                let [low, high] = [least, greatest].map(|risk| libm::pow(risk, shape - 1.0));
                let power = Bounds::new(low.min(high), low.max(high));
                let diameter = Bounds::new(transfer.diameter(greatest), transfer.diameter(least));
                let factor = libm::log(h_risk / h_max) * shape;
                let factor = Bounds::new(factor * (1.0 + 1e-12), factor * (1.0 - 1e-12));
                diameter.times(power).times(factor)
            }
            Self::Diameter { .. } => Bounds::one(1.0),
            Self::Curve { .. } | Self::Band { .. } | Self::Depth { .. } => Bounds::ANYTHING,
        }
    }
}

#[inline]
fn share(any: bool, all: bool) -> Ternary {
    if all {
        Ternary::Always
    } else if any {
        Ternary::Maybe
    } else {
        Ternary::Never
    }
}

/// Returns the largest number below `length`.
pub fn largest_below(length: f64) -> f32 {
    let nearest = length as f32;
    if f64::from(nearest) < length { nearest } else { nearest.next_down() }
}

/// Returns the smallest risk from 0 to 1 that `asks`, which no smaller and every greater risk does; infinite
/// if none does. By bisection of the bits: those of positive numbers have the order of the numbers.
fn least_risk(asks: impl Fn(f32) -> bool) -> f32 {
    if !asks(1.0) {
        return f32::INFINITY;
    }
    let (mut low, mut high) = (0u32, 1f32.to_bits());
    while low < high {
        let middle = low + (high - low) / 2;
        if asks(f32::from_bits(middle)) { high = middle } else { low = middle + 1 }
    }
    f32::from_bits(low)
}

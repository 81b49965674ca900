//! The classes of histograms.

use super::QualityMeasure;
use super::tally::MeasuredPlace;

/// A share of a class by which a number may miss its bound by rounding: 45° counts as 45°.
const ROUNDING: f64 = 1e-9;
/// Classes of time steps, each twice as long as the one before.
const OCTAVES: usize = 12;

/// A class of a histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualityBin {
    /// The least number of the class.
    pub from: f64,
    /// The greatest number of the class, or where the next class begins; infinite in one without an end.
    pub to: f64,
    /// The triangles or nodes with such a number.
    pub count: usize,
    /// The worst of them; `None` without any.
    pub worst: Option<MeasuredPlace>,
}

/// How numbers are divided into classes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Classes {
    /// Classes of one width. The last one has no end where `is_open`.
    Even { from: f64, width: f64, count: usize, is_open: bool, bound: Bound },
    /// The first class begins at this number, and each other one at twice that of the class before it.
    Octaves(f64),
}

/// The class that a number on the bound between two belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bound {
    /// The one above it.
    Above,
    /// The one below it.
    Below,
}

impl Classes {
    /// Returns the classes of a measure; those of time steps begin at the least one.
    pub fn of(measure: QualityMeasure, least: f64) -> Self {
        let even =
            |from, width, count, is_open| Self::Even { from, width, count, is_open, bound: Bound::Above };
        match measure {
            QualityMeasure::SmallestAngle => even(0.0, 5.0, 12, false),
            QualityMeasure::LargestAngle => even(60.0, 5.0, 24, false),
            QualityMeasure::EdgeRatio => even(1.0, 0.25, 17, true),
            // A triangle that is as long as h̄ honours it.
            QualityMeasure::TargetRatio => {
                Self::Even { from: 0.0, width: 0.1, count: 21, is_open: true, bound: Bound::Below }
            }
            QualityMeasure::TimeStep => Self::Octaves(least),
            QualityMeasure::Valence => even(1.0, 1.0, 12, true),
            QualityMeasure::LinkLength => even(0.0, 0.09, 20, true),
            QualityMeasure::LinkCosine => even(0.0, 0.05, 20, false),
        }
    }

    /// Returns how many there are.
    pub fn count(self) -> usize {
        match self {
            Self::Even { count, .. } => count,
            Self::Octaves(_) => OCTAVES,
        }
    }

    /// Returns the class of a number.
    pub fn of_number(self, number: f64) -> usize {
        let place = match self {
            Self::Even { from, width, bound: Bound::Above, .. } => {
                ((number - from) / width + ROUNDING).floor()
            }
            Self::Even { from, width, bound: Bound::Below, .. } => {
                ((number - from) / width - ROUNDING).ceil() - 1.0
            }
            Self::Octaves(least) => (libm::log2(number / least) + ROUNDING).floor(),
        };
        // Negative numbers become 0.
        (place as usize).min(self.count() - 1)
    }

    /// Returns the bounds of a class.
    pub fn bounds(self, class: usize) -> [f64; 2] {
        let is_last = class + 1 == self.count();
        match self {
            Self::Even { from, width, is_open, .. } => {
                let bound = |class: usize| from + width * class as f64;
                [bound(class), if is_last && is_open { f64::INFINITY } else { bound(class + 1) }]
            }
            Self::Octaves(least) => {
                let bound = |class: usize| least * (1_u32 << class) as f64;
                [bound(class), if is_last { f64::INFINITY } else { bound(class + 1) }]
            }
        }
    }
}

//! Models of the risk of threats.

use std::ops::ControlFlow;

use super::models::Place;
use super::threats::NO_SURVIVAL;
use super::{Threat, ThreatLaw, Threats};
use crate::field::{Bounds, Quadratic};

/// More than the rounding errors in a share of the peak.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl Threats {
    /// A model of the combined risk.
    pub(super) fn model(&self, place: &Place) -> Quadratic {
        let one = Quadratic::constant(1.0);
        let mut survival = one;
        let certain = self.visit_meeting(&place.rect(), |threat| {
            let risk = threat.model(place);
            if !(risk.is_constant() && risk.middle() == 0.0) {
                survival = survival.times(&one.minus(&risk));
            }
            if survival.size() < NO_SURVIVAL { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if certain.is_break() { one } else { one.minus(&survival) }
    }
}

impl Threat {
    /// A model of the risk.
    fn model(&self, place: &Place) -> Quadratic {
        let share = self.law.model(&self.squared_share(place));
        share.times(&Quadratic::constant(self.peak)).or_bounds(|| self.bounds(&place.rect()))
    }

    /// The square of distance / range.
    fn squared_share(&self, place: &Place) -> Quadratic {
        let share = (place.middle - self.at) / self.range;
        let half = place.half / self.range;
        let coefficients = [
            share.length_squared(),
            2.0 * share.x * half.x,
            2.0 * share.y * half.y,
            half.x * half.x,
            0.0,
            half.y * half.y,
        ];
        // The coordinates are off by `rest`, and each operation by a few ulps.
        let farthest = share.abs() + half;
        let off = place.rest / self.range + 8.0 * f64::EPSILON * farthest;
        Quadratic::new(coefficients, 4.0 * farthest.dot(off))
    }
}

impl ThreatLaw {
    /// A model of the share of the peak, from one of the square of distance / range.
    fn model(self, squared: &Quadratic) -> Quadratic {
        let Bounds { least, greatest, valid } = squared.bounds();
        let (one, zero) = (Quadratic::constant(1.0), Quadratic::constant(0.0));
        let flat = match self {
            Self::Radar => 0.25,
            Self::Gaussian => 0.0,
            Self::Disc => 0.5625,
        };
        if !valid {
            return Quadratic::UNKNOWN;
        }
        if greatest < flat * (1.0 - 1e-12) {
            return one;
        }
        if least > 1.0 + 1e-12 {
            return zero;
        }
        let s = squared.middle();
        let is_within = least >= flat && greatest <= 1.0;
        let cut_off = |share: Quadratic| if is_within { share } else { share.min(&one).max(&zero) };
        match self {
            Self::Radar if least <= 0.1 => Quadratic::UNKNOWN,
            Self::Radar => {
                // (s⁻² − 1) / 15
                let power = 1.0 / (15.0 * s * s);
                let third = 4.0 / (15.0 * least * least * least * least * least);
                let series = [power - 1.0 / 15.0, -2.0 * power / s, 3.0 * power / (s * s)];
                cut_off(squared.composed(series, third, ROUNDING))
            }
            Self::Gaussian => {
                let rim = libm::exp(-4.5);
                let scale = 1.0 / (1.0 - rim);
                let value = scale * libm::exp(-4.5 * s);
                // 4.5³ = 91.125
                let third = scale * 91.125 / 6.0 * libm::exp(-4.5 * least);
                let series = [value - scale * rim, -4.5 * value, 10.125 * value];
                cut_off(squared.composed(series, third, ROUNDING))
            }
            Self::Disc => disc(squared, is_within),
        }
    }
}

/// t² (3 − 2t) for t = 4 (1 − √s) within 0 and 1. `on_rim` says that t stays within.
fn disc(squared: &Quadratic, on_rim: bool) -> Quadratic {
    let s = squared.middle();
    let t = (4.0 * (1.0 - s.max(0.0).sqrt())).clamp(0.0, 1.0);
    let root = s.max(0.5625).sqrt();
    let value = t * t * (3.0 - 2.0 * t);
    let (fall, fall_bend) = (-2.0 / root, 1.0 / (root * root * root));
    let rise = 6.0 * t * (1.0 - t);
    let slope = rise * fall;
    if on_rim {
        // The third derivative is 12 · 8 s^−1.5 + 3 · 6 · 2 s^−2 + 1.5 · 1.5 s^−2.5 at most, for s ≥ 9/16.
        let bend = 0.5 * ((6.0 - 12.0 * t) * fall * fall + rise * fall_bend);
        return squared.composed([value, slope, bend], 59.0, ROUNDING);
    }
    // At both ends of the rim the derivative is continuous. The second derivative is at most 6 · 4 / s +
    // 1.5 s^−1.5, for s ≥ 9/16.
    let Bounds { least, greatest, .. } = squared.bounds();
    let step = (greatest - s).max(s - least);
    squared.composed([value, slope, 0.0], 0.0, 23.2 * step * step + ROUNDING)
}

//! How the risk of one threat varies over a square: polynomials of the square of distance / range.

use glam::DVec2;

use super::models::ModelDomain;
use super::{Threat, ThreatLaw};
use crate::field::TaylorModel;

/// More than the rounding errors in a share of the peak.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The square of distance / range over a place, as a polynomial of the coordinates u and v in the place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Squared {
    /// The value in the middle of the rectangle.
    pub middle: f64,
    /// The coefficients of u and v.
    pub linear: [f64; 2],
    /// The coefficients of u² and v².
    pub bend: [f64; 2],
    /// The largest distance from the polynomial.
    pub rest: f64,
    /// No value is smaller.
    least: f64,
    /// No value is greater, and none is farther from that in the middle than this is.
    greatest: f64,
}

/// The risk as a polynomial of degree 2 in the step from [`Squared::middle`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Series {
    pub value: f64,
    pub slope: f64,
    pub bend: f64,
    /// The largest distance from the polynomial over the place.
    pub rest: f64,
}

impl Squared {
    pub fn new(threat: &Threat, place: &ModelDomain) -> Self {
        let inverse = 1.0 / threat.range;
        let offset = (place.middle - threat.at) * inverse;
        let half = place.half * inverse;
        let (nearest, farthest) = ((offset.abs() - half).max(DVec2::ZERO), offset.abs() + half);
        // The coordinates are off by `place.rest`, and each operation by a few ulps.
        let off = place.rest * inverse + 8.0 * f64::EPSILON * farthest;
        let rest = 4.0 * farthest.dot(off);
        Self {
            middle: offset.length_squared(),
            linear: (2.0 * offset * half).to_array(),
            bend: (half * half).to_array(),
            rest,
            least: (nearest.length_squared() - rest).max(0.0),
            greatest: farthest.length_squared() + rest,
        }
    }

    /// Returns the square of distance / range as a model.
    pub fn model(&self) -> TaylorModel {
        let ([u, v], [uu, vv]) = (self.linear, self.bend);
        TaylorModel::new([self.middle, u, v, uu, 0.0, vv], self.rest)
    }

    /// Returns an upper bound of the difference of a value from the one in the middle.
    pub fn step(&self) -> f64 {
        let ([u, v], [uu, vv]) = (self.linear, self.bend);
        (u.abs() + v.abs() + uu + vv + self.rest) * (1.0 + 16.0 * f64::EPSILON)
    }
}

impl Series {
    const fn constant(value: f64) -> Self {
        Self { value, slope: 0.0, bend: 0.0, rest: 0.0 }
    }

    /// Σ cₙ xⁿ for n up to 4, where x is `scale` times the step and at most `reach` in size, ± `tail`.
    ///
    /// Of all polynomials of a lower degree, ¾ r² x is the nearest to x³ for |x| ≤ r, up to r³ / 4, and
    /// r² x² − r⁴ / 8 the nearest to x⁴, up to r⁴ / 8 (Chebyshev).
    fn economized(coefficients: [f64; 5], tail: f64, scale: f64, reach: f64) -> Self {
        let [value, slope, bend, third, fourth] = coefficients;
        let square = reach * reach;
        let eighth = 0.125 * fourth * square * square;
        Self {
            value: value - eighth,
            slope: scale * (slope + 0.75 * third * square),
            bend: scale * scale * (bend + fourth * square),
            rest: 0.25 * third.abs() * square * reach + eighth.abs() + tail,
        }
    }

    /// Returns values from this polynomial to `apart` beside it, to either side.
    fn beside(self, apart: f64) -> Self {
        let half = 0.5 * apart;
        Self { value: self.value + half, rest: self.rest + half.abs(), ..self }
    }

    fn times(self, factor: f64) -> Self {
        let Self { value, slope, bend, rest } = self;
        Self { value: factor * value, slope: factor * slope, bend: factor * bend, rest: factor * rest }
    }
}

impl Threat {
    /// Returns the risk from the square of distance / range; `None` where the threat is not felt.
    pub(super) fn series(&self, squared: &Squared) -> Option<Series> {
        let is_felt = squared.least <= 1.0 && self.peak > 0.0;
        is_felt.then(|| self.law.series(squared).times(self.peak))
    }
}

impl ThreatLaw {
    /// Up to this square of distance / range, the share of the peak is 1.
    fn flat(self) -> f64 {
        match self {
            Self::Radar => 0.25,
            Self::Gaussian => 0.0,
            Self::Disc => 0.5625,
        }
    }

    /// Returns the share of the peak. Where it varies much, bounds of it: it never rises with the distance.
    fn series(self, squared: &Squared) -> Series {
        if squared.greatest.is_nan() {
            return Series::constant(0.0).beside(1.0);
        }
        if squared.greatest < self.flat() {
            return Series::constant(1.0);
        }
        let series = match self {
            Self::Radar if squared.least < 0.25 => radar_around_its_rim(squared),
            Self::Radar => radar(squared),
            Self::Gaussian => gaussian(squared),
            Self::Disc => disc(squared),
        };
        let step = squared.step();
        let is_flat = series.rest <= series.slope.abs() * step;
        if is_flat {
            return Series { rest: series.rest + ROUNDING, ..series };
        }
        let [low, high] = [squared.greatest, squared.least].map(|s| self.share(s));
        let bounds = Series::constant(low).beside(high - low);
        let closer = if bounds.rest <= series.rest || series.rest.is_nan() { bounds } else { series };
        Series { rest: closer.rest + ROUNDING, ..closer }
    }
}

/// (s⁻² − 1) / 15 from s = 1/4 on, and 0 beyond 1.
///
/// s⁻² = c⁻² (1 − 2x + 3x² − 4x³ + …) for s = c (1 + x). From x⁵ on, the terms add up to 6 |x|⁵ / (1 − |x|)²
/// at most.
fn radar(squared: &Squared) -> Series {
    let inverse = 1.0 / squared.middle;
    let power = inverse * inverse / 15.0;
    let reach = inverse * squared.step();
    let coefficients = [power - 1.0 / 15.0, -2.0 * power, 3.0 * power, -4.0 * power, 5.0 * power];
    let tail = if reach <= 0.4 { 17.0 * power * fifth_power(reach) } else { f64::INFINITY };
    // Beyond 1 the polynomial goes on below 0, at most as steeply as at 1.
    Series::economized(coefficients, tail, inverse, reach)
        .beside(2.0 / 15.0 * (squared.greatest - 1.0).max(0.0))
}

/// Returns the chord of the radar's share around s = 1/4, where it begins to fall.
///
/// ```text
///   1 ----.         Between 1/4 and the greatest s the share is convex: it lies below the straight line to
///     ' .  \        the end, and above the tangents at both ends. Before 1/4 the chord lies below it, at most
///       '  . \      at 1/4.
///     chord  ' `-.
/// ```
fn radar_around_its_rim(squared: &Squared) -> Series {
    const RIM: f64 = 0.25;
    const STEEPEST: f64 = -128.0 / 15.0;
    let Squared { middle, least, greatest, .. } = *squared;
    let end = ThreatLaw::Radar.share(greatest);
    let slope = (end - 1.0) / (greatest - least);
    let above = -slope * (RIM - least);
    let beyond = greatest - RIM;
    let (mean, last) = ((end - 1.0) / beyond, -2.0 / 15.0 / (greatest * greatest * greatest));
    let last = if greatest < 1.0 { last.max(STEEPEST) } else { 0.0 };
    let mean = mean.clamp(STEEPEST, last);
    let below = beyond * (mean - STEEPEST) * (last - mean) / (last - STEEPEST);
    let chord = Series { slope, ..Series::constant(1.0 + slope * (middle - least)) };
    Series { value: chord.value - below, ..chord }.beside(above + below)
}

/// (e^(−4.5 s) − e^(−4.5)) / (1 − e^(−4.5)), and 0 beyond 1.
///
/// e^x = 1 + x + x²/2 + … for x = −4.5 d. From x⁵ on, the terms add up to |x|⁵ e^|x| / 120 at most.
fn gaussian(squared: &Squared) -> Series {
    /// e^(−4.5)
    const RIM: f64 = 0.011_108_996_538_242_306;
    const SCALE: f64 = 1.0 / (1.0 - RIM);
    let value = SCALE * libm::exp(-4.5 * squared.middle);
    let reach = 4.5 * squared.step();
    let coefficients = [value - SCALE * RIM, value, value / 2.0, value / 6.0, value / 24.0];
    // For t ≤ 1.5, e^t ≤ 1 + t + t².
    let growth = if reach <= 1.5 { 1.0 + reach + reach * reach } else { f64::INFINITY };
    let tail = value / 120.0 * fifth_power(reach) * growth;
    // Beyond 1 the polynomial goes on below 0, at most as steeply as at 1.
    Series::economized(coefficients, tail, -4.5, reach)
        .beside(4.5 * SCALE * RIM * (squared.greatest - 1.0).max(0.0))
}

/// t² (3 − 2t) = −80 + 288 √s − 336 s + 128 s √s for t = 4 (1 − √s) within 0 and 1, and 0 or 1 beyond.
///
/// For s = c (1 + x), the binomial series of √s and s √s have coefficients that fall from x² on; from x⁵ on,
/// the terms add up to 7/256 and 3/256 times |x|⁵ / (1 − |x|) at most.
fn disc(squared: &Squared) -> Series {
    let Squared { middle, least, greatest, .. } = *squared;
    let t_at = |s: f64| 4.0 * (1.0 - s.sqrt());
    let t = t_at(middle);
    let (root, cube) = (1.0 - 0.25 * t, middle * (1.0 - 0.25 * t));
    let inverse = 1.0 / middle;
    let reach = inverse * squared.step();
    let coefficients = [
        t * t * (3.0 - 2.0 * t),
        144.0 * root - 336.0 * middle + 192.0 * cube,
        48.0 * cube - 36.0 * root,
        18.0 * root - 8.0 * cube,
        3.0 * cube - 11.25 * root,
    ];
    // The sums lose three digits.
    let rounding = 1e3 * ROUNDING;
    let tail = if reach <= 0.5 { (15.75 * root + 3.0 * cube) * fifth_power(reach) } else { f64::INFINITY };
    let series = Series::economized(coefficients, tail + rounding, inverse, reach);
    if least >= 0.5625 && greatest <= 1.0 {
        return series;
    }
    // Before the rim the polynomial falls below 1, and beyond it rises above 0.
    let (first, last) = (t_at(least).max(1.0), t_at(greatest).min(0.0));
    let before = (first - 1.0) * (first - 1.0) * (1.0 + 2.0 * first);
    let beyond = last * last * (3.0 - 2.0 * last);
    series.beside(before).beside(-beyond)
}

fn fifth_power(v: f64) -> f64 {
    let square = v * v;
    square * square * v
}

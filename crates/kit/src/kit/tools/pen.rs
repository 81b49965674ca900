//! The pressure of a pen, where the system reports it.

use glam::DVec2;

use meshbrush_core::paint::PathPoint;

/// What the pressure of a pen changes, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenResponse {
    /// Whether it changes the radius of the brush.
    pub changes_radius: bool,
    /// Whether it changes the strength of the brush.
    pub changes_strength: bool,
    /// The exponent γ of the curve: at the pressure p the brush has the share p^γ. Below 1 a light touch does
    /// much, above 1 only a firm one.
    pub exponent: f64,
}

impl Default for PenResponse {
    fn default() -> Self {
        Self { changes_radius: true, changes_strength: false, exponent: 1.0 }
    }
}

impl PenResponse {
    /// The exponents that a person can choose.
    pub const EXPONENTS: std::ops::RangeInclusive<f64> = 0.25..=4.0;

    /// Returns the share of the radius and of the strength at a pressure of 0 to 1.
    fn shares(&self, pressure: f64) -> [f64; 2] {
        let share = pressure.clamp(0.0, 1.0).powf(self.exponent).max(LEAST_SHARE);
        [self.changes_radius, self.changes_strength].map(|changes| if changes { share } else { 1.0 })
    }
}

/// A pen that reports its pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pen {
    /// What the pressure changes.
    pub response: PenResponse,
    /// Its pressure, 0 to 1, while it is down.
    pressure: Option<f64>,
    /// Whether a pressure was ever reported.
    seen: bool,
}

/// The least share of the radius or the strength: a stroke must stay visible.
const LEAST_SHARE: f64 = 0.05;

impl Pen {
    /// Takes a reported pressure, or `None` when the pen is lifted.
    pub fn set_pressure(&mut self, pressure: Option<f64>) {
        self.pressure = pressure.filter(|pressure| pressure.is_finite());
        self.seen |= self.pressure.is_some();
    }

    /// Returns whether the system has reported a pressure since the program was started.
    pub fn is_known(&self) -> bool {
        self.seen
    }

    /// Returns a point of a stroke, with the brush as the pressure makes it.
    pub fn path_point(&self, at: DVec2) -> PathPoint {
        let [size, strength] = self.pressure.map_or([1.0; 2], |pressure| self.response.shares(pressure));
        PathPoint { size, strength, ..PathPoint::from(at) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_monotone_and_ends_at_the_whole_brush() {
        for exponent in [0.25, 0.5, 1.0, 2.0, 4.0] {
            let response = PenResponse { changes_strength: true, exponent, ..PenResponse::default() };
            let shares: Vec<f64> = (0..=20).map(|n| response.shares(f64::from(n) / 20.0)[1]).collect();
            assert!(shares.is_sorted(), "{exponent}");
            assert_eq!((shares[0], shares[20]), (LEAST_SHARE, 1.0), "{exponent}");
        }
        let soft = PenResponse { exponent: 0.5, ..PenResponse::default() };
        assert_eq!(soft.shares(0.25), [0.5, 1.0], "the strength stays");
    }
}

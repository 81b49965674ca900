//! The pressure of a pen, where the system reports it.

use glam::DVec2;

use meshbrush_core::paint::PathPoint;

/// The effect of the pressure of a pen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PenEffect {
    /// Nothing.
    None,
    /// The radius of the brush.
    #[default]
    Size,
    /// The strength of the brush.
    Strength,
}

/// A pen that reports its pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pen {
    /// The effect of the pressure.
    pub effect: PenEffect,
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
        let share = self.pressure.map_or(1.0, |pressure| pressure.clamp(LEAST_SHARE, 1.0));
        let whole = PathPoint::from(at);
        match self.effect {
            PenEffect::None => whole,
            PenEffect::Size => PathPoint { size: share, ..whole },
            PenEffect::Strength => PathPoint { strength: share, ..whole },
        }
    }
}

//! Speeds that are typed, and times.

use std::str::FromStr;

/// A speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// In metres per second, above 0.
    metres_per_second: f64,
}

/// The units of speeds, in metres per second.
const UNITS: [(&str, f64); 3] = [("kn", Speed::KNOT), ("m/s", 1.0), ("km/h", 1.0 / 3.6)];

/// Why a text is no speed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} is no speed: write a number above 0 with its unit, as in 12 kn, 6 m/s or 20 km/h.")]
pub struct SpeedError(String);

impl Speed {
    /// A knot, a nautical mile in an hour, in metres per second.
    pub const KNOT: f64 = 1852.0 / 3600.0;

    /// Returns a speed in knots; `None` unless it is a finite number above 0.
    pub fn from_knots(knots: f64) -> Option<Self> {
        Self::new(knots * Self::KNOT)
    }

    fn new(metres_per_second: f64) -> Option<Self> {
        let is_speed = metres_per_second.is_finite() && metres_per_second > 0.0;
        is_speed.then_some(Self { metres_per_second })
    }

    /// Returns the seconds that a length in metres takes.
    pub fn seconds(self, metres: f64) -> f64 {
        metres / self.metres_per_second
    }
}

impl FromStr for Speed {
    type Err = SpeedError;

    fn from_str(text: &str) -> Result<Self, SpeedError> {
        let typed = text.trim();
        let read = UNITS.iter().find_map(|&(unit, size)| {
            let number: f64 = typed.strip_suffix(unit)?.trim_end().parse().ok()?;
            Self::new(number * size)
        });
        read.ok_or_else(|| SpeedError(text.to_owned()))
    }
}

/// Returns a time in hours and whole minutes: `12 h 5 min`.
pub fn hours_and_minutes(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round();
    let (hours, minutes) = ((minutes / 60.0).floor(), minutes % 60.0);
    if hours > 0.0 { format!("{hours} h {minutes} min") } else { format!("{minutes} min") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_has_a_unit() {
        for (text, seconds) in
            [("12 kn", 161.987), ("10 m/s", 100.0), (" 36km/h ", 100.0), ("1e1 m/s", 100.0)]
        {
            let speed: Speed = text.parse().unwrap();
            assert!((speed.seconds(1000.0) - seconds).abs() < 0.01, "{text}: {}", speed.seconds(1000.0));
        }
        for text in ["12", "0 kn", "-3 m/s", "kn", "inf kn", "nan m/s", "5 mph", ""] {
            let error = text.parse::<Speed>().unwrap_err().to_string();
            assert!(error.ends_with("as in 12 kn, 6 m/s or 20 km/h."), "{error}");
        }
        assert_eq!(Speed::from_knots(0.0), None);
    }

    #[test]
    fn times_are_rounded_to_minutes() {
        let times = [(29.0, "0 min"), (59.0 * 60.0 + 31.0, "1 h 0 min"), (93_784.0, "26 h 3 min")];
        for (seconds, text) in times {
            assert_eq!(hours_and_minutes(seconds), text);
        }
    }
}

//! A bar of a round length.

use meshbrush_mesh::text::{LengthUnit, digits, round_below};

/// A bar of a round length.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleBar {
    /// Its length in the unit.
    pub length: f64,
    /// Its length in pixels or points.
    pub length_px: f64,
    /// The length, with its unit.
    pub text: String,
}

impl ScaleBar {
    /// Returns the longest bar up to a length in pixels or points, where a length of 1 has `px_per_length`;
    /// `None` where that is no scale.
    pub fn new(px_per_length: f64, longest_px: f64, unit: LengthUnit) -> Option<Self> {
        let limit = longest_px / px_per_length;
        if !(limit.is_normal() && limit > 0.0) {
            return None;
        }
        let length = round_below(limit);
        Some(Self { length, length_px: length * px_per_length, text: text(length, unit) })
    }
}

/// Returns a length with its unit: thousands of metres are kilometres.
fn text(length: f64, unit: LengthUnit) -> String {
    match unit == LengthUnit::Metre && length >= 1000.0 {
        true => LengthUnit::Kilometre.after(&digits(length / 1000.0, 3)),
        false => unit.after(&digits(length, 3)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_is_round_and_no_longer_than_asked() {
        for (px_per_length, unit, text, length) in [
            (3.0, LengthUnit::Kilometre, "50 km", 150.0),
            (0.001, LengthUnit::Metre, "200 km", 200.0),
            (0.4, LengthUnit::Metre, "500 m", 200.0),
            (190.0, LengthUnit::None, "1", 190.0),
        ] {
            let bar = ScaleBar::new(px_per_length, 200.0, unit).unwrap();
            assert_eq!(bar.text, text);
            assert!((bar.length_px - length).abs() < 1e-9, "{bar:?}");
        }
        for px_per_length in [0.0, f64::INFINITY, f64::NAN, -1.0] {
            assert_eq!(ScaleBar::new(px_per_length, 200.0, LengthUnit::None), None);
        }
    }
}

//! The rules of a number in the window: its range, and its changes by typing, dragging and the wheel.

use std::ops::RangeInclusive;

use super::format;
use meshbrush_mesh::text::typed;

/// Points that a pointer moves to change a number by a factor of ten, or over the whole of its range.
const PX_PER_DECADE: f64 = 200.0;
/// Points that stand for one step of the wheel or of an arrow key.
pub(super) const PX_PER_STEP: f64 = 10.0;

/// A number, the values that it can have, and how it reads.
pub(super) struct NumberInput<'a> {
    /// The name of the number in sentences.
    pub name: &'a str,
    /// The present value.
    pub value: f64,
    /// The values that it can have. [`f64::MIN_POSITIVE`] as its start means every positive number.
    pub range: RangeInclusive<f64>,
    /// The unit, which may be typed or left out.
    pub unit: &'a str,
    /// Values are multiples of it above the start of the range, or of zero if the range has no start.
    pub step: Option<f64>,
    /// Whether equal movements are equal factors.
    pub logarithmic: bool,
    /// The value that the menu of the number offers, if there is one.
    pub default: Option<f64>,
    /// How a value reads, with its unit.
    pub show: &'a dyn Fn(f64) -> String,
}

/// A value that was entered, and a sentence if it is not the one that was typed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entered {
    pub value: f64,
    pub remark: Option<String>,
}

impl NumberInput<'_> {
    /// Returns the value that `text` stands for.
    ///
    /// # Errors
    /// Fails with a sentence that says what was not understood.
    pub fn read(&self, text: &str) -> Result<Entered, String> {
        let typed = typed::number(text, self.unit)?;
        if typed <= 0.0 && *self.range.start() == f64::MIN_POSITIVE {
            return Err(format!("{} must be greater than zero.", self.name));
        }
        let whole = self.step == Some(1.0);
        let rounded = if whole { typed.round() } else { typed };
        let value = rounded.clamp(*self.range.start(), *self.range.end());
        let shown = (self.show)(value);
        let remark = if value != rounded {
            let (side, end) =
                if value < rounded { ("above", "largest value, ") } else { ("below", "smallest value, ") };
            let typed = text.trim();
            Some(format!("{typed} is {side} the {end}{shown}. {} was set to that.", self.name))
        } else if rounded != typed {
            Some(format!("{} is a whole number. It was set to {shown}.", self.name))
        } else {
            None
        };
        Ok(Entered { value, remark })
    }

    /// Returns the value as it is offered for editing.
    pub fn exact(&self) -> String {
        self.value.to_string()
    }

    /// `from` moved by `px` points.
    pub fn moved(&self, from: f64, px: f64) -> f64 {
        let (low, high) = (*self.range.start(), *self.range.end());
        let moved = if self.logarithmic && from > 0.0 {
            let moved = format::rounded(from * 10_f64.powf(px / PX_PER_DECADE), 3);
            self.step.map_or(moved, |step| from + steps(moved - from, step, px))
        } else if let Some(step) = self.step {
            from + steps(px * (high - low).min(100.0 * step) / PX_PER_DECADE, step, px)
        } else {
            let unit = self.linear_unit(from);
            ((from + px * unit) / unit).round() * unit
        };
        // A multiple of 0.01 is not exact in binary: 0.7 stays 0.7.
        format::rounded(moved, 12).clamp(low, high)
    }

    /// Returns how much a point of movement changes a linear number.
    fn linear_unit(&self, from: f64) -> f64 {
        let width = self.range.end() - self.range.start();
        let size = if width.is_finite() && width < 1e6 { width } else { from.abs().max(1.0) };
        10_f64.powf((size / PX_PER_DECADE).log10().floor())
    }
}

/// `change` in whole steps, at least one in the direction of a step of the wheel.
fn steps(change: f64, step: f64, px: f64) -> f64 {
    let whole = (change / step).round() * step;
    if whole == 0.0 && px.abs() >= PX_PER_STEP { step * px.signum() } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(value: f64, range: RangeInclusive<f64>) -> NumberInput<'static> {
        NumberInput {
            name: "Size",
            value,
            range,
            unit: "m",
            step: None,
            logarithmic: false,
            default: None,
            show: &|value| format!("{value} m"),
        }
    }

    #[test]
    fn a_value_out_of_range_says_what_it_became() {
        let size = input(0.5, 0.01..=1.0);
        let far = size.read("5 m").unwrap();
        assert_eq!(far.value, 1.0);
        assert_eq!(far.remark.unwrap(), "5 m is above the largest value, 1 m. Size was set to that.");
        assert_eq!(size.read("25 cm"), Ok(Entered { value: 0.25, remark: None }));
        assert!(size.read("0").unwrap().remark.unwrap().contains("below the smallest value, 0.01 m"));
        assert!(size.read("wide").is_err());
        let any = input(0.5, f64::MIN_POSITIVE..=f64::MAX);
        assert_eq!(any.read("-1").unwrap_err(), "Size must be greater than zero.");
    }

    #[test]
    fn whole_numbers_are_rounded_with_a_remark() {
        let pixels = NumberInput { step: Some(1.0), ..input(16.0, 16.0..=2048.0) };
        let rounded = pixels.read("100.4").unwrap();
        assert_eq!(rounded.value, 100.0);
        assert!(rounded.remark.unwrap().contains("whole number"));
    }

    #[test]
    fn movement_is_a_factor_where_the_scale_is_logarithmic() {
        let size = NumberInput { logarithmic: true, ..input(0.5, 1e-4..=100.0) };
        assert_eq!(size.moved(0.5, 200.0), 5.0);
        assert_eq!(size.moved(0.5, -400.0), 0.005);
        assert_eq!(size.moved(0.5, 1e5), 100.0, "the end of the range");
        let pixels = NumberInput { step: Some(1.0), logarithmic: true, ..input(16.0, 16.0..=2048.0) };
        assert_eq!(pixels.moved(512.0, PX_PER_STEP), 574.0);
        assert_eq!(pixels.moved(2.0, PX_PER_STEP), 16.0);
    }

    #[test]
    fn movement_is_a_difference_elsewhere() {
        let strength = NumberInput { step: Some(0.01), ..input(0.5, 0.0..=1.0) };
        assert_eq!(strength.moved(0.7, 20.0), 0.8);
        assert_eq!(strength.moved(0.7, -PX_PER_STEP), 0.65);
        // A whole number moves by as many steps, however wide its range is.
        let count = NumberInput { step: Some(1.0), ..input(500.0, 0.0..=1e6) };
        assert_eq!(count.moved(500.0, 20.0), 510.0);
        let few = NumberInput { step: Some(1.0), ..input(5.0, 0.0..=10.0) };
        assert_eq!(few.moved(5.0, 60.0), 8.0);
        let left = input(0.0, f64::MIN..=f64::MAX);
        assert_eq!(left.moved(0.0, 10.0), 0.01);
        assert_eq!(left.moved(-500.0, 10.0), -490.0);
    }
}

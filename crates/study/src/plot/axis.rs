//! Axes: scale, the part that is shown, and ticks.

use crate::text::{digits, fixed, with_unit};

/// An axis of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity on the axis.
    pub label: String,
    /// The unit of its values; empty without one.
    pub unit: String,
    /// How values are spread along it.
    pub scale: Scale,
}

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly, with ticks at whole numbers only.
    Whole,
    /// Values are placed by their logarithm. Only positive values are shown.
    Logarithmic,
}

impl Axis {
    /// Creates an axis without a unit.
    pub fn new(label: impl Into<String>, scale: Scale) -> Self {
        Self { label: label.into(), unit: String::new(), scale }
    }

    /// Adds a unit.
    pub fn unit(mut self, unit: &str) -> Self {
        self.unit = unit.into();
        self
    }

    /// Returns the text beside the axis: label and unit.
    pub fn title(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} ({})", self.label, self.unit) }
    }

    /// Returns a number with the unit.
    pub fn with_unit(&self, number: &str) -> String {
        with_unit(number, &self.unit)
    }

    /// Returns the position of a value along the axis: the value itself, or its decimal logarithm. `None` of
    /// a value that the axis cannot show.
    pub fn position(&self, value: f64) -> Option<f64> {
        let position = match self.scale {
            Scale::Linear | Scale::Whole => value,
            Scale::Logarithmic if value > 0.0 => libm::log10(value),
            Scale::Logarithmic => return None,
        };
        position.is_finite().then_some(position)
    }

    /// Returns the value at a position.
    pub fn value(&self, position: f64) -> f64 {
        match self.scale {
            Scale::Linear | Scale::Whole => position,
            Scale::Logarithmic => libm::exp10(position),
        }
    }

    /// Returns whether the axis can show a value.
    pub fn shows(&self, value: f64) -> bool {
        self.position(value).is_some()
    }
}

/// The part of an axis that is shown, as positions ([`Axis::position`]).
#[derive(Clone, Debug, PartialEq)]
pub struct AxisRange {
    scale: Scale,
    low: f64,
    high: f64,
}

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The position of the tick on the axis.
    pub position: f64,
    /// The value there.
    pub label: String,
}

impl AxisRange {
    /// Returns the range of values with some room around them. `from_zero`: a linear axis begins at 0, a
    /// logarithmic one a little below the least value.
    pub(super) fn around(axis: &Axis, values: Vec<f64>, from_zero: bool) -> Self {
        let positions = values.into_iter().filter_map(|value| axis.position(value));
        let (mut low, mut high) =
            positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        match axis.scale {
            Scale::Whole => {}
            Scale::Linear if from_zero => {
                (low, high) = (low.min(0.0), high.max(0.0));
                high += 0.05 * (high - low);
            }
            Scale::Linear => {
                let room = 0.05 * (high - low);
                (low, high) = (if low >= 0.0 { (low - room).max(0.0) } else { low - room }, high + room);
            }
            Scale::Logarithmic => {
                let room = (0.05 * (high - low)).max(0.05);
                (low, high) = (low - if from_zero { 0.3 } else { room }, high + room);
            }
        }
        if low >= high {
            let room = if axis.scale == Scale::Whole || low == 0.0 { 0.5 } else { 0.5 * low.abs() };
            (low, high) = (low - room, high + room);
        }
        Self { scale: axis.scale, low, high }
    }

    /// Returns the range, extended on both sides.
    pub(super) fn widened(self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by, ..self }
    }

    /// Returns the lowest position.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// Returns the highest position, above the lowest one.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Returns how far a position is from the lowest to the highest one, 0 to 1.
    pub fn share(&self, position: f64) -> f64 {
        (position - self.low) / (self.high - self.low)
    }

    /// Returns at most `most` ticks at round values; at least two if there is room for two.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        let most = most.max(2);
        match self.scale {
            Scale::Linear => self.even_ticks(most, 0.0),
            Scale::Whole => self.even_ticks(most, 1.0),
            Scale::Logarithmic => self.decade_ticks(most),
        }
    }

    /// Multiples of 1, 2 or 5 times a power of ten, at least `least`.
    fn even_ticks(&self, most: usize, least: f64) -> Vec<Tick> {
        let rough = (self.high - self.low) / most as f64;
        let power = libm::exp10(libm::floor(libm::log10(rough)));
        let steps = [1.0, 2.0, 5.0, 10.0, 20.0].map(|times| times * power).into_iter();
        let counted = |step: f64| (libm::floor(self.high / step) - libm::ceil(self.low / step)) as usize + 1;
        let step = steps.filter(|step| *step >= least).find(|step| counted(*step) <= most);
        let step = step.unwrap_or(least.max(20.0 * power));
        let decimals = (-libm::floor(libm::log10(step) + 1e-9)).clamp(0.0, 17.0) as usize;
        let first = libm::ceil(self.low / step - 1e-9);
        let last = libm::floor(self.high / step + 1e-9);
        let at = |number: f64| number * step;
        let numbers = (0..).map(|i| first + f64::from(i)).take_while(|number| *number <= last);
        // Small numbers are written with a power of ten.
        let label = |value| if decimals > 4 { digits(value, 12) } else { fixed(value, decimals) };
        numbers.map(at).map(|position| Tick { position, label: label(position) }).collect()
    }

    /// Powers of ten, with 2 and 5 times them where there are few.
    fn decade_ticks(&self, most: usize) -> Vec<Tick> {
        let decades = self.high - self.low;
        let every = libm::ceil(decades / most as f64).max(1.0);
        let between: &[f64] = match most as f64 / decades {
            room if room >= 4.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let first = libm::floor(self.low / every) * every;
        let powers = (0..).map(|i| first + every * f64::from(i)).take_while(|power| *power <= self.high);
        let values = powers.flat_map(|power| {
            between.iter().map(move |times| (power + libm::log10(*times), times * libm::exp10(power)))
        });
        let inside = |position: f64| (self.low - 1e-9..=self.high + 1e-9).contains(&position);
        let mut ticks: Vec<Tick> = values
            .filter(|(position, _)| inside(*position))
            .map(|(position, value)| Tick { position, label: number(value) })
            .collect();
        if ticks.len() < 2 {
            ticks = self.value_ticks(most);
        }
        ticks
    }

    /// Evenly spread values on a logarithmic axis, where it is shorter than from 1 to 2.
    fn value_ticks(&self, most: usize) -> Vec<Tick> {
        let [low, high] = [self.low, self.high].map(libm::exp10);
        let ticks = Self { scale: Scale::Linear, low, high }.even_ticks(most, 0.0);
        ticks.into_iter().map(|tick| Tick { position: libm::log10(tick.position), ..tick }).collect()
    }
}

/// Returns a number as readouts show it.
pub(super) fn number(value: f64) -> String {
    digits(value, 6)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, values: &[f64], most: usize) -> Vec<String> {
        let axis = Axis::new("x", scale);
        let range = AxisRange::around(&axis, values.to_vec(), false);
        range.ticks(most).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_at_most_as_many_as_asked_for() {
        assert_eq!(labels(Scale::Linear, &[0.0, 1.0], 6), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(Scale::Linear, &[-3.0, 9.0], 5), ["0", "5"]);
        assert_eq!(labels(Scale::Whole, &[0.0, 3.0], 9), ["0", "1", "2", "3"]);
        assert_eq!(labels(Scale::Whole, &[0.0, 40.0], 6), ["0", "10", "20", "30", "40"]);
        assert_eq!(labels(Scale::Linear, &[0.0, 30_000.0], 4), ["0", "10,000", "20,000", "30,000"]);
        assert_eq!(labels(Scale::Logarithmic, &[1.0, 1000.0], 5), ["1", "10", "100", "1,000"]);
        assert_eq!(
            labels(Scale::Logarithmic, &[0.001, 0.02], 9),
            ["0.001", "0.002", "0.005", "0.01", "0.02"]
        );
        assert_eq!(labels(Scale::Logarithmic, &[1e-9, 1e9], 4), ["1e-5", "1", "100,000"]);
        assert!(labels(Scale::Logarithmic, &[3.0, 3.5], 5).len() >= 2);
        assert_eq!(labels(Scale::Linear, &[-0.5, 0.5], 3), ["−0.5", "0.0", "0.5"]);
        assert_eq!(labels(Scale::Linear, &[0.0, 4e-6], 3), ["0", "2e-6", "4e-6"]);
    }

    #[test]
    fn an_axis_from_zero_has_zero() {
        for (values, low, high) in [([3.0, 9.0], 0.0, 9.45), ([-9.0, -3.0], -9.0, 0.45)] {
            let range = AxisRange::around(&Axis::new("x", Scale::Linear), values.to_vec(), true);
            assert_eq!([range.low(), range.high()], [low, high]);
        }
        // Values from zero on have no room below zero.
        let range = AxisRange::around(&Axis::new("x", Scale::Linear), vec![0.1, 9.0], false);
        assert_eq!(range.low(), 0.0);
    }

    #[test]
    fn around_decades_there_is_a_twentieth_of_them_or_of_one() {
        for (greatest, room) in [(1e10, 0.5), (10.0, 0.05), (2.0, 0.05)] {
            let range = AxisRange::around(&Axis::new("x", Scale::Logarithmic), vec![1.0, greatest], false);
            let decades = libm::log10(greatest);
            assert!((range.low() + room).abs() < 1e-12 && (range.high() - decades - room).abs() < 1e-12);
        }
    }

    #[test]
    fn every_tick_is_inside_and_says_its_value() {
        let random =
            |seed: u64| (seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / (1u64 << 24) as f64;
        for seed in 0..2000 {
            let size = libm::exp10(12.0 * random(3 * seed) - 6.0);
            let from = size * random(3 * seed + 1) + 1e-12;
            let values = vec![from, from + size * random(3 * seed + 2)];
            for scale in [Scale::Linear, Scale::Logarithmic] {
                let axis = Axis::new("x", scale);
                let range = AxisRange::around(&axis, values.clone(), false);
                assert!(range.low() < range.high());
                let ticks = range.ticks(6);
                assert!((1..=18).contains(&ticks.len()), "{values:?}: {ticks:?}");
                for tick in &ticks {
                    assert!((-1e-6..=1.0 + 1e-6).contains(&range.share(tick.position)), "{tick:?}");
                    let said: f64 = tick.label.replace(',', "").replace('−', "-").parse().unwrap();
                    let value = axis.value(tick.position);
                    assert!((said - value).abs() <= 1e-4 * value.abs() + 1e-9, "{tick:?} {value}");
                }
                assert!(ticks.windows(2).all(|two| two[0].label != two[1].label), "{ticks:?}");
            }
        }
    }

    #[test]
    fn one_value_and_no_value_have_a_range() {
        for scale in [Scale::Linear, Scale::Whole, Scale::Logarithmic] {
            for values in [vec![], vec![5.0], vec![0.0], vec![f64::NAN]] {
                let range = AxisRange::around(&Axis::new("x", scale), values, true);
                assert!(range.low() < range.high() && range.low().is_finite(), "{range:?}");
            }
        }
    }
}

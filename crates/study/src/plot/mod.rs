//! Plots as plain data: axes, and series of points, lines or bars.
//!
//! The window and the files draw plots from the same data, with the same ranges and ticks.

mod axis;
mod csv;
mod svg;

use std::io::{self, Write};
use std::path::Path;

pub use axis::{Axis, AxisRange, Scale, Tick};
pub use csv::write as write_csv;
pub use svg::write as write_svg;

use axis::number;

/// The endings of files that a plot can be written to.
pub const ENDINGS: [&str; 2] = ["svg", "csv"];

/// Writes a plot as the ending of `path` says; without one of [`ENDINGS`] as a drawing.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, plot: &Plot, path: &Path) -> io::Result<()> {
    let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    if is_table { write_csv(out, plot) } else { write_svg(out, plot) }
}

/// How much of the distance between two bars all bars of one place take.
const BARS: f64 = 0.8;

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The title of the plot.
    pub title: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// The series, the lowest first.
    pub series: Vec<Series>,
    /// A sentence below it; may be empty.
    pub note: String,
}

/// Points that belong together, with their name in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The name of the series.
    pub name: String,
    /// How it is drawn.
    pub mark: Mark,
    /// `[x, y]` of each point, in the order in which a line joins them.
    pub points: Vec<[f64; 2]>,
    /// The minimum and the maximum y that each point stands for, drawn as an error bar; empty without any.
    pub spans: Vec<[f64; 2]>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A bar for each point, beside those of other series. Bars are meant for whole x.
    Bars,
    /// A dot for each point.
    Points,
    /// A line from point to point.
    Line,
}

impl Series {
    /// Creates a series of points.
    pub fn new(name: impl Into<String>, mark: Mark, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), mark, points, spans: Vec::new() }
    }

    /// Adds the error bar of each point: from the least to the greatest y.
    pub fn spans(mut self, spans: Vec<[f64; 2]>) -> Self {
        self.spans = spans;
        self
    }

    /// Returns the ends of all error bars, the lower one first.
    pub fn error_bars(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.points.iter().zip(&self.spans).map(|([x, _], span)| span.map(|y| [*x, y]))
    }
}

impl Plot {
    /// Returns the range of each axis, x first: it contains all points with their bars and error bars, and
    /// the origin if there are bars.
    pub fn ranges(&self) -> [AxisRange; 2] {
        let has_bars = self.series.iter().any(|series| series.mark == Mark::Bars);
        let [x, y] = [0, 1].map(|axis| {
            let points = self.series.iter().flat_map(|series| series.points.iter().copied());
            let ends = self.series.iter().flat_map(|series| series.error_bars().flatten());
            points.chain(ends).map(move |point| point[axis]).collect::<Vec<f64>>()
        });
        let mut x = AxisRange::around(&self.x, x, false);
        if self.x.scale == Scale::Whole || (has_bars && self.x.scale == Scale::Linear) {
            x = x.widened(0.5);
        }
        [x, AxisRange::around(&self.y, y, has_bars)]
    }

    /// Returns whether both axes can show a point.
    pub fn shows(&self, [x, y]: [f64; 2]) -> bool {
        self.x.shows(x) && self.y.shows(y)
    }

    /// Returns the beginnings and widths of the bars of a series, on the x axis and relative to x: bars
    /// of one x are beside each other.
    pub fn bar_span(&self, series: usize) -> [f64; 2] {
        let is_bars = |series: &&Series| series.mark == Mark::Bars;
        let count = self.series.iter().filter(is_bars).count().max(1) as f64;
        let before = self.series[..series].iter().filter(is_bars).count() as f64;
        let width = BARS / count;
        [width * before - 0.5 * BARS, width]
    }

    /// Returns the values of the plot at an x, a line for each series: the point whose x is nearest on the
    /// axis.
    pub fn readout(&self, x: f64) -> Vec<String> {
        let Some(place) = self.x.position(x) else { return Vec::new() };
        let nearest = |series: &Series| {
            let shown = series.points.iter().filter(|point| self.shows(**point));
            let distance = |point: &&[f64; 2]| (self.x.position(point[0]).unwrap_or(place) - place).abs();
            let [x, y] = *shown.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            let value = |axis: &Axis, value: f64| axis.with_unit(&number(value));
            Some(format!(
                "{} {}: {} {}",
                self.x.label,
                value(&self.x, x),
                series.name.to_lowercase(),
                value(&self.y, y)
            ))
        };
        self.series.iter().filter_map(nearest).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot() -> Plot {
        let series = |name: &str, mark, points: &[[f64; 2]]| Series::new(name, mark, points.to_vec());
        Plot {
            title: "Bisections".into(),
            x: Axis::new("level", Scale::Whole),
            y: Axis::new("bisections", Scale::Linear),
            series: vec![
                series("Required", Mark::Bars, &[[0.0, 200.0], [1.0, 1234.0]]),
                series("Forced", Mark::Bars, &[[0.0, 0.0], [1.0, 80.0]]),
            ],
            note: String::new(),
        }
    }

    #[test]
    fn bars_of_one_place_are_beside_each_other_within_the_range() {
        let plot = plot();
        let [[first, width], [second, _]] = [0, 1].map(|series| plot.bar_span(series));
        assert!((first + width - second).abs() < 1e-12);
        let [x, y] = plot.ranges();
        assert_eq!([x.low(), x.high()], [-0.5, 1.5]);
        assert!(first >= -0.5 && second + width <= 0.5);
        assert!(y.low() == 0.0 && y.high() >= 1234.0);
    }

    #[test]
    fn the_range_contains_the_error_bars() {
        let mut plot = plot();
        plot.series[0] = plot.series[0].clone().spans(vec![[200.0, 210.0], [1234.0, 5000.0]]);
        assert!(plot.ranges()[1].high() >= 5000.0);
        let bars: Vec<_> = plot.series[0].error_bars().collect();
        assert_eq!(bars, [[[0.0, 200.0], [0.0, 210.0]], [[1.0, 1234.0], [1.0, 5000.0]]]);
        assert_eq!(plot.series[1].error_bars().count(), 0);
    }

    #[test]
    fn the_readout_has_the_nearest_point_of_each_series() {
        assert_eq!(plot().readout(0.8), ["level 1: required 1,234", "level 1: forced 80"]);
        assert_eq!(plot().readout(-3.0), ["level 0: required 200", "level 0: forced 0"]);
    }

    #[test]
    fn points_that_an_axis_cannot_show_do_not_count() {
        let mut plot = plot();
        plot.y.scale = Scale::Logarithmic;
        assert_eq!(plot.readout(0.0), ["level 0: required 200", "level 1: forced 80"]);
        plot.series[0].points.push([f64::NAN, f64::INFINITY]);
        assert!(plot.ranges().iter().all(|range| range.low() < range.high() && range.high() < 10.0));
    }
}

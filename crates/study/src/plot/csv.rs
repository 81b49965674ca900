//! A plot as a table.
//!
//! The first column is x, and there is a column for each series, which is empty where the series has no
//! point. If the points of some series do not run from left to right, there is a row for each point instead,
//! with the columns `series`, x and y. In the first form, a series with error bars has two more columns: the
//! minimum and the maximum.

use std::io::{self, Write};

use super::{Plot, Series};
use crate::text::Number;

/// Writes the table.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut impl Write, plot: &Plot) -> io::Result<()> {
    let (x, y) = (field(&plot.x.title()), field(&plot.y.title()));
    if !plot.series.iter().all(runs_to_the_right) {
        writeln!(out, "series,{x},{y}")?;
        for series in &plot.series {
            for [x, y] in &series.points {
                writeln!(out, "{},{},{}", field(&series.name), Number(*x), Number(*y))?;
            }
        }
        return Ok(());
    }
    let mut places: Vec<f64> =
        plot.series.iter().flat_map(|series| &series.points).map(|point| point[0]).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    write!(out, "{x}")?;
    for series in &plot.series {
        write!(out, ",{}", field(&series.name))?;
        if !series.spans.is_empty() {
            let ends = ["least", "greatest"].map(|end| field(&format!("{}, {end}", series.name)));
            write!(out, ",{}", ends.join(","))?;
        }
    }
    writeln!(out)?;
    for x in places {
        write!(out, "{}", Number(x))?;
        for series in &plot.series {
            let place = series.points.iter().position(|point| point[0] == x);
            write_value(out, place.map(|place| series.points[place][1]))?;
            for end in (0..2).filter(|_| !series.spans.is_empty()) {
                write_value(out, place.and_then(|place| series.spans.get(place)).map(|span| span[end]))?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Writes a field with a number, or an empty one.
fn write_value(out: &mut impl Write, value: Option<f64>) -> io::Result<()> {
    match value {
        Some(value) => write!(out, ",{}", Number(value)),
        None => write!(out, ","),
    }
}

fn runs_to_the_right(series: &Series) -> bool {
    series.points.is_sorted_by(|a, b| a[0] < b[0])
}

/// Returns a text as a field of the table.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, Mark, Scale};

    fn table(series: Vec<Series>) -> String {
        let x = Axis::new("level", Scale::Whole);
        let y = Axis::new("h", Scale::Logarithmic).unit("km");
        let mut out = Vec::new();
        write(&mut out, &Plot { title: "h".into(), x, y, series, note: String::new() }).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn series_are_columns_over_a_common_x() {
        let smallest = Series::new("smallest, h", Mark::Points, vec![[0.0, 0.5], [2.0, 0.25]]);
        let bound = Series::new("bound", Mark::Line, vec![[0.0, 1.0], [1.0, 0.7], [2.0, 0.5]]);
        assert_eq!(
            table(vec![smallest, bound]),
            "level,\"smallest, h\",bound\n0,0.5,1\n1,,0.7\n2,0.25,0.5\n"
        );
    }

    #[test]
    fn error_bars_have_columns_of_their_own() {
        let measured = Series::new("time", Mark::Points, vec![[0.0, 2.0], [1.0, 3.0]])
            .spans(vec![[2.0, 2.5], [3.0, 9.0]]);
        let fit = Series::new("fit", Mark::Line, vec![[0.0, 2.0], [0.5, 2.5]]);
        assert_eq!(
            table(vec![measured, fit]),
            "level,time,\"time, least\",\"time, greatest\",fit\n0,2,2,2.5,2\n0.5,,,,2.5\n1,3,3,9,\n"
        );
    }

    #[test]
    fn a_series_that_turns_back_has_a_row_for_each_point() {
        let front = Series::new("front", Mark::Line, vec![[2.0, 1.0], [1.0, 3.0], [1.0, 4.0]]);
        assert_eq!(table(vec![front]), "series,level,h (km)\nfront,2,1\nfront,1,3\nfront,1,4\n");
    }
}

//! `points.csv`: a table with columns `x` and `y`, or `lon` and `lat`, and perhaps others.

use std::io::{BufRead, BufReader};
use std::path::Path;

use glam::DVec2;

use super::ReadError;
use super::disk::File;
use super::error::{Flaw, PlacedFlaw};
use super::table::{Columns, Rows};
use meshbrush_core::earth::Projection;
use meshbrush_mesh::text::Grouped;

/// Names of the columns, in lower case.
const NAMES: [&[&str]; 2] = [&["x", "lon", "lng", "long", "longitude"], &["y", "lat", "latitude"]];

/// Most points that are read: a pipe may have no end.
const MOST_POINTS: usize = 100_000_000;

/// The points of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct PointTable {
    /// The numbers in the two columns, in the order of the rows.
    pub rows: Vec<DVec2>,
    /// Whether the header calls the columns longitudes and latitudes.
    pub are_lonlat: bool,
    /// Whether a header names the columns. Otherwise the first two are taken for x and y.
    pub has_header: bool,
}

impl PointTable {
    /// Returns the points in world units. In the plane of a projection, longitudes and latitudes are degrees,
    /// and x and y are metres in the plane.
    pub fn points(self, projection: Option<Projection>) -> Vec<DVec2> {
        match projection.filter(|_| self.are_lonlat) {
            Some(projection) => self.rows.iter().map(|&at| projection.plane_from_geographic(at)).collect(),
            None => self.rows,
        }
    }
}

/// Reads the points of a table, in the order of its rows, as the numbers in two columns.
///
/// # Errors
/// Fails as [`read_table`] does.
pub fn read(path: &Path) -> Result<Vec<DVec2>, ReadError> {
    read_table(path).map(|table| table.rows)
}

/// Reads the points of a table as [`read`] does, from any input, such as bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read_table`] does.
pub fn read_from(input: impl BufRead, name: &Path) -> Result<Vec<DVec2>, ReadError> {
    read_table_from(input, name).map(|table| table.rows)
}

/// Reads the points of a table.
///
/// The header names the columns, in any order and case; `lon` and `lat` stand for `x` and `y`, and other
/// columns are ignored. Without a header, a table of numbers has x and y first. Fields are separated by
/// commas, semicolons or tabs, and follow RFC 4180: one that begins with a quotation mark may contain
/// separators, but it must end on its line. Without commas between fields, a comma may be the decimal point.
/// White space around fields and blank lines are ignored. `NaN` and `inf` are read as numbers: the location
/// of such a point answers that it is invalid.
///
/// # Errors
/// Fails when the file cannot be read, has no header with `x` and `y`, or a field is not a number; the error
/// names the line.
pub fn read_table(path: &Path) -> Result<PointTable, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| parse(BufReader::new(file)));
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads the points of a table as [`read_table`] does, from any input, such as bytes or standard input.
/// Errors call the file `name`.
///
/// # Errors
/// Fails as [`read_table`] does.
pub fn read_table_from(input: impl BufRead, name: &Path) -> Result<PointTable, ReadError> {
    parse(input).map_err(|flaw| flaw.in_file(name))
}

fn parse(source: impl BufRead) -> Result<PointTable, PlacedFlaw> {
    parse_at_most(source, MOST_POINTS)
}

fn parse_at_most(source: impl BufRead, most: usize) -> Result<PointTable, PlacedFlaw> {
    let mut rows = Rows::new(source);
    let Columns { places, are_named: has_header } = rows.read_columns(NAMES, 2)?;
    let [Some(x), Some(y)] = places else { unreachable!("both columns are required") };
    let are_lonlat = has_header && rows.is_longitude(x);
    let mut points = Vec::new();
    while rows.advance()? {
        if points.len() == most {
            let problem =
                format!("it has more than {} points, which is the limit. Divide it.", Grouped(most));
            return Err(Flaw::Syntax(problem).into());
        }
        points.push(DVec2::new(rows.number(x, "x")?, rows.number(y, "y")?));
    }
    Ok(PointTable { rows: points, are_lonlat, has_header })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Vec<DVec2>, String> {
        let table = parse(text.as_bytes()).map(|table| table.rows);
        table.map_err(|e| format!("{}: {}", e.place, e.flaw))
    }

    #[test]
    fn points_are_read_as_spreadsheets_write_them() {
        let point = |x, y| DVec2::new(x, y);
        assert_eq!(parsed("x,y\n1,2\n"), Ok(vec![point(1.0, 2.0)]));
        assert_eq!(
            parsed("\u{feff}x,y\r\n\r\n1,2\r\n\r\n3e-1,-4"),
            Ok(vec![point(1.0, 2.0), point(0.3, -4.0)])
        );
        let quoted = "name,\"Y\", X ,note\n\"a, \"\"b\"\"\",\"2\", 1 ,\n";
        assert_eq!(parsed(quoted), Ok(vec![point(1.0, 2.0)]));
        assert_eq!(parsed("x,y\n"), Ok(vec![]));
        assert_eq!(parsed("x,y\r\n1,\"2\"\r\n"), Ok(vec![point(1.0, 2.0)]));
        for text in
            ["x;y\n1;2\n", "Lon\tLat\n1\t2\n", "lat;name;lon\n2,0;a,b;1,0\n", "longitude,latitude\n1,2"]
        {
            assert_eq!(parsed(text), Ok(vec![point(1.0, 2.0)]), "{text}");
        }
        for text in ["1,2\n3,4\n", "1;2;9\n3;4\n", "\n1,0;2,0\n3\t;4\n"] {
            assert_eq!(parsed(text), Ok(vec![point(1.0, 2.0), point(3.0, 4.0)]), "{text}");
        }
        let odd = parsed("x,y\nNaN,inf\n").unwrap();
        assert!(odd[0].x.is_nan() && odd[0].y == f64::INFINITY);
    }

    #[test]
    fn an_input_without_end_is_refused_at_the_limit() {
        let rows = |count: usize| format!("x,y\n{}", "1,2\n".repeat(count));
        assert_eq!(parse_at_most(rows(3).as_bytes(), 3).map(|table| table.rows.len()).ok(), Some(3));
        let refused = parse_at_most(rows(4).as_bytes(), 3).unwrap_err().flaw.to_string();
        assert!(refused.starts_with("it has more than 3 points"), "{refused}");
    }

    #[test]
    fn errors_name_their_line() {
        for (text, expected) in [
            ("", ": there is no header"),
            ("\n\na,b\n", ", line 3: the header is `a,b`, and it must name the columns x and y."),
            ("1,2\n1,b\n", ", line 2: y is `b`, which is not a number."),
            ("x,y\n1,2\n\n1\n", ", line 4: there is no y."),
            ("x,y\n,2\n", ", line 2: there is no x."),
            ("x,y\n1,two\n", ", line 2: y is `two`, which is not a number."),
            ("x,y\r1,2\r3,4\r", ", line 1: the header is `x,y\\r1,2\\r3,4`"),
            ("x,y,note\n1,2,\"a\n3,4,b\n", ", line 2: a quotation mark is not closed"),
            ("x,y\n\"1,2\n", ", line 2: a quotation mark is not closed"),
        ] {
            let message = parsed(text).unwrap_err();
            assert!(message.starts_with(expected), "{text:?} gave {message}");
        }
        let endless = "x".repeat(3 << 20);
        assert!(parsed(&endless).unwrap_err().contains("longer than a megabyte"));
        assert!(parse(&b"x,y\n\xff\xfe,1\n"[..]).is_err());
    }
}

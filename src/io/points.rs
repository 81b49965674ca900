//! `points.csv`: a table with columns `x` and `y`, or `lon` and `lat`, and perhaps others.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use csv_core::{ReadRecordResult, ReaderBuilder, Terminator};
use glam::DVec2;

use super::error::{PlacedFlaw, shown};
use super::{Flaw, ReadError};

/// Longest line that is read, in bytes. Without a limit a file without line breaks would fill the memory.
const LONGEST_LINE: u64 = 1 << 20;

/// What separates fields: the first of these under which the header names both coordinates.
const DELIMITERS: [u8; 3] = *b",;\t";
/// Names of the columns, in lower case.
const NAMES: [&[&str]; 2] = [&["x", "lon", "lng", "long", "longitude"], &["y", "lat", "latitude"]];

/// Reads the points of a table, in world units, in the order of its rows.
///
/// The header names the columns, in any order and case; `lon` and `lat` stand for `x` and `y`, and other
/// columns are ignored. Fields are separated by commas, semicolons or tabs, and follow RFC 4180: one that
/// begins with a quotation mark may contain separators, but it must end on its line. Without commas between
/// fields, a comma may be the decimal point. White space around fields and blank lines are ignored. `NaN` and
/// `inf` are read as numbers: the location of such a point answers that it is invalid.
///
/// # Errors
/// When the file cannot be read, has no header with `x` and `y`, or a field is not a number; the error names
/// the line.
pub fn read(path: &Path) -> Result<Vec<DVec2>, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| parse(BufReader::new(file)));
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads the points of a table as [`read`] does, from any input, such as bytes or standard input. Errors call
/// the file `name`.
///
/// # Errors
/// As [`read`].
pub fn read_from(input: impl BufRead, name: &Path) -> Result<Vec<DVec2>, ReadError> {
    parse(input).map_err(|flaw| flaw.in_file(name))
}

fn parse(source: impl BufRead) -> Result<Vec<DVec2>, PlacedFlaw> {
    let mut rows = Rows::new(source);
    let [x, y] = rows.read_header()?;
    let mut points = Vec::new();
    while rows.advance()? {
        points.push(DVec2::new(rows.number(x, "x")?, rows.number(y, "y")?));
    }
    Ok(points)
}

fn parser(delimiter: u8) -> csv_core::Reader {
    // Of a line break in two bytes the first is white space at the end of the last field.
    ReaderBuilder::new().delimiter(delimiter).terminator(Terminator::Any(b'\n')).build()
}

/// The rows of a table, one at a time.
struct Rows<R> {
    source: R,
    delimiter: u8,
    parser: csv_core::Reader,
    /// The number of the current line, counted from one.
    line: usize,
    /// The fields of the current row, one after the other, and where each ends.
    text: String,
    ends: Vec<usize>,
}

impl<R: BufRead> Rows<R> {
    fn new(source: R) -> Self {
        let delimiter = DELIMITERS[0];
        Self { source, delimiter, parser: parser(delimiter), line: 0, text: String::new(), ends: Vec::new() }
    }

    /// Reads the header, finds out what separates the fields, and returns the columns of x and y.
    fn read_header(&mut self) -> Result<[usize; 2], PlacedFlaw> {
        let Some(line) = self.next_line()? else {
            let problem = "there is no header; the first line must name the columns x and y.";
            return Err(Flaw::Syntax(problem.into()).into());
        };
        for delimiter in DELIMITERS {
            (self.delimiter, self.parser) = (delimiter, parser(delimiter));
            self.parse_line(line.clone())?;
            let place = |names: &[&str]| {
                self.fields().position(|field| names.iter().any(|name| field.eq_ignore_ascii_case(name)))
            };
            if let [Some(x), Some(y)] = NAMES.map(place) {
                return Ok([x, y]);
            }
        }
        let header = String::from_utf8_lossy(&line);
        let problem =
            format!("the header is `{}`, and it must name the columns x and y.", shown(40, header.trim()));
        Err(Flaw::Syntax(problem).at(self.line))
    }

    /// Goes to the next line that is not blank. Returns whether there is one.
    fn advance(&mut self) -> Result<bool, PlacedFlaw> {
        match self.next_line()? {
            Some(line) => self.parse_line(line).map(|()| true),
            None => Ok(false),
        }
    }

    /// The next line that is not blank, with its line break.
    fn next_line(&mut self) -> Result<Option<Vec<u8>>, PlacedFlaw> {
        loop {
            let mut bytes = Vec::new();
            let read = self.source.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes)?;
            if read == 0 {
                return Ok(None);
            }
            self.line += 1;
            if read as u64 == LONGEST_LINE {
                return Err(Flaw::Syntax("the line is longer than a megabyte.".into()).at(self.line));
            }
            if !bytes.trim_ascii().is_empty() {
                return Ok(Some(bytes));
            }
        }
    }

    /// Splits a line into fields.
    fn parse_line(&mut self, mut line: Vec<u8>) -> Result<(), PlacedFlaw> {
        let flaw = |problem: &str| Flaw::Syntax(problem.into()).at(self.line);
        // The parser waits for the end of the line; the last one of a file may have none.
        line.push(b'\n');
        // Fields are shorter than their line, and a line has fewer fields than bytes.
        let mut text = vec![0; line.len()];
        self.ends.resize(line.len(), 0);
        self.parser.reset();
        // It also removes a byte order mark, which spreadsheets put before the first line.
        let (result, _, bytes, fields) = self.parser.read_record(&line, &mut text, &mut self.ends);
        if result != ReadRecordResult::Record {
            return Err(flaw("a quotation mark is not closed on its line."));
        }
        text.truncate(bytes);
        self.ends.truncate(fields);
        self.text = String::from_utf8(text).map_err(|_| flaw("the line is not UTF-8 text."))?;
        Ok(())
    }

    /// The fields of the current row, without the white space around them.
    fn fields(&self) -> impl Iterator<Item = &str> {
        (0..self.ends.len()).filter_map(|column| self.field(column))
    }

    fn field(&self, column: usize) -> Option<&str> {
        let start = if column == 0 { 0 } else { *self.ends.get(column - 1)? };
        self.text.get(start..*self.ends.get(column)?).map(str::trim)
    }

    /// The number in a column of the current row.
    fn number(&self, column: usize, name: &str) -> Result<f64, PlacedFlaw> {
        let flaw = |problem| Flaw::Syntax(problem).at(self.line);
        let text = self.field(column).filter(|text| !text.is_empty());
        let text = text.ok_or_else(|| flaw(format!("there is no {name}.")))?;
        let with_point = |text: &str| (self.delimiter != b',').then(|| text.replace(',', "."));
        let parsed = text.parse().ok().or_else(|| with_point(text)?.parse().ok());
        parsed.ok_or_else(|| flaw(format!("{name} is `{}`, which is not a number.", shown(40, text))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Vec<DVec2>, String> {
        parse(text.as_bytes()).map_err(|e| format!("{}: {}", e.place, e.flaw))
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
        let odd = parsed("x,y\nNaN,inf\n").unwrap();
        assert!(odd[0].x.is_nan() && odd[0].y == f64::INFINITY);
    }

    #[test]
    fn errors_name_their_line() {
        for (text, expected) in [
            ("", ": there is no header"),
            ("\n\n1,2\n", ", line 3: the header is `1,2`, and it must name the columns x and y."),
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

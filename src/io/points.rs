//! `points.csv`: a table with columns `x` and `y`, and perhaps others.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use glam::DVec2;

use super::error::{PlacedFlaw, shown};
use super::{Flaw, ReadError};

/// Longest line taken, in bytes. Keeps a file without line breaks from filling the memory.
const LONGEST_LINE: u64 = 1 << 20;

/// Reads the points of a table, in world units.
///
/// The header names the columns, in any order and case; columns other than `x` and `y` are passed over. Fields may be
/// quoted, blank lines are skipped. `NaN` and `inf` are numbers here: what they mean is for the search to answer.
///
/// # Errors
/// When the file cannot be read, has no header with `x` and `y`, or a field is not a number; with the line.
pub fn read(path: &Path) -> Result<Vec<DVec2>, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| parse(BufReader::new(file)));
    read.map_err(|flaw| flaw.in_file(path))
}

/// As [`read`], from bytes.
///
/// # Errors
/// As [`read`]; the file is then called as given.
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Vec<DVec2>, ReadError> {
    parse(bytes).map_err(|flaw| flaw.in_file(name))
}

fn parse(source: impl BufRead) -> Result<Vec<DVec2>, PlacedFlaw> {
    let mut lines = Lines { source, number: 0 };
    let Some(header) = lines.next_line()? else {
        return Err(
            Flaw::Syntax("there is no header; the first line must name the columns x and y.".into()).into()
        );
    };
    let place = |name| header.iter().position(|field| field.eq_ignore_ascii_case(name));
    let (Some(x), Some(y)) = (place("x"), place("y")) else {
        let problem = format!(
            "the header is `{}`, and it must name the columns x and y.",
            shown(40, &header.join(","))
        );
        return Err(Flaw::Syntax(problem).at(lines.number));
    };
    let mut points = Vec::new();
    while let Some(fields) = lines.next_line()? {
        let number =
            |column: usize, name: &str| coordinate(fields.get(column), name).map_err(|f| f.at(lines.number));
        points.push(DVec2::new(number(x, "x")?, number(y, "y")?));
    }
    Ok(points)
}

fn coordinate(field: Option<&String>, name: &str) -> Result<f64, Flaw> {
    let Some(text) = field.filter(|text| !text.is_empty()) else {
        return Err(Flaw::Syntax(format!("there is no {name}.")));
    };
    text.parse().map_err(|_| Flaw::Syntax(format!("{name} is `{}`, which is not a number.", shown(40, text))))
}

struct Lines<R> {
    source: R,
    /// Of the last line read, counted from one.
    number: usize,
}

impl<R: BufRead> Lines<R> {
    /// The fields of the next line that is not blank, `None` at the end of the file.
    fn next_line(&mut self) -> Result<Option<Vec<String>>, PlacedFlaw> {
        loop {
            let mut bytes = Vec::new();
            let read = self.source.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes)?;
            if read == 0 {
                return Ok(None);
            }
            self.number += 1;
            if read as u64 == LONGEST_LINE {
                return Err(Flaw::Syntax("the line is longer than a megabyte.".into()).at(self.number));
            }
            let Ok(line) = String::from_utf8(bytes) else {
                return Err(Flaw::Syntax("the line is not UTF-8 text.".into()).at(self.number));
            };
            // Spreadsheets put a byte order mark before the first line.
            let line = line.trim_start_matches('\u{feff}').trim();
            if !line.is_empty() {
                return Ok(Some(fields(line).map_err(|flaw| flaw.at(self.number))?));
            }
        }
    }
}

/// Splits a line at commas outside quotation marks; a doubled mark inside stands for itself.
fn fields(line: &str) -> Result<Vec<String>, Flaw> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        let field = fields.last_mut().expect("the list begins with one field and only grows");
        match c {
            '"' if quoted && characters.peek() == Some(&'"') => {
                characters.next();
                field.push('"');
            }
            '"' if quoted || field.trim().is_empty() => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            _ => field.push(c),
        }
    }
    if quoted {
        return Err(Flaw::Syntax("a quotation mark is not closed on its line.".into()));
    }
    Ok(fields.into_iter().map(|field| field.trim().to_owned()).collect())
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
        let odd = parsed("x,y\nNaN,inf\n").unwrap();
        assert!(odd[0].x.is_nan() && odd[0].y == f64::INFINITY);
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        for (text, expected) in [
            ("", ": there is no header"),
            ("\n\n1,2\n", ", line 3: the header is `1,2`, and it must name the columns x and y."),
            ("x,y\n1,2\n\n1\n", ", line 4: there is no y."),
            ("x,y\n,2\n", ", line 2: there is no x."),
            ("x,y\n1,two\n", ", line 2: y is `two`, which is not a number."),
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

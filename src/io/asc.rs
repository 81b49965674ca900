//! `.asc`: the ESRI ASCII grid, a raster with its own placement.
//!
//! A header of names and numbers (`ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`,
//! `cellsize` or `dx` and `dy`, and perhaps `NODATA_value`), then the values, the top row first. Case, line
//! breaks and the order of the header do not matter.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use glam::DVec2;

use super::error::PlacedFlaw;
use super::{Flaw, ReadError};
use crate::geometry::Rect;
use crate::raster::{MAX_SIDE, Raster};

/// Reads a grid. Pixels without a value (`NODATA_value`, and `nan` as GDAL writes it) are NaN.
///
/// # Errors
/// When the file cannot be read, breaks a rule of the format (with the line), or has more than [`MAX_SIDE`]
/// pixels along a side.
pub fn read(path: &Path) -> Result<Raster, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| parse(BufReader::new(file)));
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads a grid as [`read`] does, from bytes. Errors call the file `name`.
///
/// # Errors
/// As [`read`].
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Raster, ReadError> {
    parse(bytes).map_err(|flaw| flaw.in_file(name))
}

fn parse(source: impl BufRead) -> Result<Raster, PlacedFlaw> {
    let mut words = Words { source, line: 1 };
    let (header, first_value) = Header::parse(&mut words)?;
    let [columns, rows] = header.size()?;
    let bounds = header.bounds([columns, rows])?;
    let no_data = header.number("nodata_value");
    let has_value = |value: f64| !value.is_nan() && Some(value) != no_data;
    let count = columns as usize * rows as usize;
    // Grows with the values in the file: a header alone takes no memory.
    let mut values = Vec::new();
    let mut next = Some(first_value);
    while let Some(word) = next {
        if values.len() == count {
            let problem = format!("there are more values than {columns} columns × {rows} rows");
            return Err(Flaw::Syntax(problem + "; check ncols and nrows.").at(words.line));
        }
        let value = number(&word, words.line)?;
        values.push(if has_value(value) { single(value, words.line)? } else { f32::NAN });
        next = words.next()?;
    }
    if values.len() < count {
        return Err(Flaw::CutOff.at(words.line));
    }
    let bottom_row_first = values.chunks_exact(columns as usize).rev().flatten().copied().collect();
    Ok(Raster::from_values(bounds, [columns, rows], bottom_row_first))
}

/// The names of the header in lower case, with their numbers.
struct Header(HashMap<String, f64>);

const NAMES: [&str; 10] = [
    "ncols",
    "nrows",
    "xllcorner",
    "yllcorner",
    "xllcenter",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
];

impl Header {
    /// Reads names and numbers up to the first number in the place of a name, which is the first value;
    /// returns it, too.
    fn parse(words: &mut Words<impl BufRead>) -> Result<(Self, String), PlacedFlaw> {
        let mut known = HashMap::new();
        loop {
            let name = words.required()?;
            let is_nan = name.eq_ignore_ascii_case("nan");
            if is_nan || name.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
                return Ok((Self(known), name));
            }
            let lower = name.to_ascii_lowercase();
            if !NAMES.contains(&lower.as_str()) {
                let problem =
                    format!("`{name}` is not part of the header of an ESRI ASCII grid, which begins with");
                return Err(Flaw::Syntax(problem + " ncols, nrows, xllcorner, yllcorner and cellsize.")
                    .at(words.line));
            }
            let value = words.required()?;
            // Each name is allowed once, so the loop is bounded by the list of names.
            let number = number(&value, words.line)?;
            if number.is_nan() && lower != "nodata_value" {
                return Err(Flaw::Syntax(format!("`{name}` is nan, and it must be a number.")).at(words.line));
            }
            if known.insert(lower, number).is_some() {
                return Err(Flaw::Syntax(format!("`{name}` is twice in the header.")).at(words.line));
            }
        }
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.0.get(name).copied()
    }

    fn required(&self, name: &str) -> Result<f64, Flaw> {
        self.number(name).ok_or_else(|| Flaw::Syntax(format!("the header has no `{name}`.")))
    }

    fn size(&self) -> Result<[u32; 2], Flaw> {
        let size = [self.required("ncols")?, self.required("nrows")?];
        if let Some(&side) = size.iter().find(|side| side.fract() != 0.0 || **side < 0.0) {
            return Err(Flaw::Syntax(format!("ncols and nrows are whole numbers, and {side} is not.")));
        }
        if size.iter().any(|&side| !(1.0..=f64::from(MAX_SIDE)).contains(&side)) {
            return Err(Flaw::Size { columns: size[0] as u64, rows: size[1] as u64 });
        }
        Ok(size.map(|side| side as u32))
    }

    fn bounds(&self, size: [u32; 2]) -> Result<Rect, Flaw> {
        let cell = match (self.number("dx"), self.number("dy")) {
            (Some(dx), Some(dy)) => DVec2::new(dx, dy),
            _ => DVec2::splat(self.required("cellsize")?),
        };
        let corner = |corner: &str, center: &str, cell: f64| match self.number(center) {
            Some(center) => Ok(center - 0.5 * cell),
            None => self.required(corner),
        };
        let min =
            DVec2::new(corner("xllcorner", "xllcenter", cell.x)?, corner("yllcorner", "yllcenter", cell.y)?);
        let bounds = Rect::new(min, min + cell * DVec2::new(f64::from(size[0]), f64::from(size[1])));
        if bounds.is_proper() {
            Ok(bounds)
        } else {
            Err(Flaw::Syntax(format!("with cells of {} × {} the grid covers no rectangle.", cell.x, cell.y)))
        }
    }
}

/// A finite number, or NaN, which GDAL writes for a cell without a value.
fn number(word: &str, line: usize) -> Result<f64, PlacedFlaw> {
    // Some programs write a decimal comma, depending on the language of the system.
    let parsed = word.parse().or_else(|_| word.replace(',', ".").parse());
    parsed.ok().filter(|value: &f64| !value.is_infinite()).ok_or_else(|| {
        Flaw::Syntax(format!("`{word}` is not a number, and a number is expected here.")).at(line)
    })
}

/// A value in single precision, as rasters have it.
fn single(value: f64, line: usize) -> Result<f32, PlacedFlaw> {
    let single = value as f32;
    if single.is_finite() {
        return Ok(single);
    }
    let problem =
        format!("the value {value:e} is too large: a raster has single precision, up to {:.1e}", f32::MAX);
    Err(Flaw::Syntax(
        problem + ". If it marks pixels without a value, name it with NODATA_value in the header.",
    )
    .at(line))
}

/// Words between white space.
struct Words<R> {
    source: R,
    /// The line of the last word, counted from one.
    line: usize,
}

/// Longer than any number that a program writes, in bytes. Without a limit a file without white space would
/// fill the memory.
const LONGEST_WORD: usize = 400;

impl<R: BufRead> Words<R> {
    fn required(&mut self) -> Result<String, PlacedFlaw> {
        self.next()?.ok_or_else(|| Flaw::CutOff.at(self.line))
    }

    /// The next word, `None` at the end of the file.
    fn next(&mut self) -> Result<Option<String>, PlacedFlaw> {
        let mut word = Vec::new();
        // Each iteration consumes a byte or stops, and the end of the file stops it, too.
        while let Some(&byte) = self.source.fill_buf()?.first() {
            if byte.is_ascii_whitespace() {
                if !word.is_empty() {
                    break; // a line break after the word is counted with the next word
                }
                self.line += usize::from(byte == b'\n');
            } else {
                word.push(byte);
            }
            self.source.consume(1);
            if word.len() > LONGEST_WORD {
                break;
            }
        }
        let text = String::from_utf8_lossy(&word);
        if word.len() > LONGEST_WORD || word.contains(&0) {
            let start: String = text.chars().take(20).collect();
            let problem = format!("`{}…` is not a word of an ESRI ASCII grid.", start.escape_debug());
            return Err(Flaw::Syntax(problem).at(self.line));
        }
        Ok((!word.is_empty()).then(|| text.into_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Raster, String> {
        parse(text.as_bytes()).map_err(|e| format!("{}: {}", e.place, e.flaw))
    }

    #[test]
    fn a_grid_lies_where_its_header_says_and_its_first_row_is_the_top_row() {
        let raster =
            parsed("NCOLS 3\nnrows 2\nxllcorner 10\nyllcorner -4\ncellsize 2\nnodata_value -9999\n1 2 3\n4 -9999 6\n")
                .unwrap();
        assert_eq!(raster.bounds(), Rect::new(glam::dvec2(10.0, -4.0), glam::dvec2(16.0, 0.0)));
        assert_eq!(raster.size(), [3, 2]);
        assert_eq!((raster.get(0, 0), raster.get(2, 0), raster.get(0, 1)), (4.0, 6.0, 1.0));
        assert!(raster.get(1, 0).is_nan());
    }

    #[test]
    fn nan_is_a_cell_without_a_value() {
        for no_data in ["", "NODATA_value nan\n", "NODATA_value -9999\n"] {
            let header = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
            let raster = parsed(&format!("{header}{no_data}nan 5")).unwrap();
            assert!(raster.get(0, 0).is_nan() && raster.get(1, 0) == 5.0, "{no_data}");
        }
    }

    #[test]
    fn centres_and_separate_cell_sides_are_understood() {
        let raster = parsed("ncols 1 nrows 2 xllcenter 1 yllcenter 1.5 dx 2 dy 1\r\n7\r\n8").unwrap();
        assert_eq!(raster.bounds(), Rect::new(glam::dvec2(0.0, 1.0), glam::dvec2(2.0, 3.0)));
        assert_eq!(raster.values(), [8.0, 7.0]);
    }

    #[test]
    fn errors_name_their_line() {
        let header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
        for (text, expected) in [
            (String::new(), ", line 1: the file ends too early"),
            ("P5 3 3".into(), ", line 1: `P5` is not part of the header"),
            ("ncols 2\nncols 2\n".into(), ", line 2: `ncols` is twice"),
            ("ncols 2\nnrows two\n".into(), ", line 2: `two` is not a number"),
            ("ncols 2\nnrows 2\n1 2 3 4".into(), ": the header has no `cellsize`."),
            ("ncols 2.5\nnrows 2\n1".into(), ": ncols and nrows are whole numbers, and 2.5 is not."),
            ("ncols 9e9 nrows 9e9 1".into(), ": 9,000,000,000 × 9,000,000,000 pixels cannot be read"),
            (header.replace("size 1", "size 0") + "1 2\n3 4", ": with cells of 0 × 0"),
            (format!("{header}1 2\n3"), ", line 7: the file ends too early"),
            (format!("{header}1 2\n3 x"), ", line 7: `x` is not a number"),
            (format!("{header}1 2\n3 inf"), ", line 7: `inf` is not a number"),
            ("ncols nan\n1".into(), ", line 1: `ncols` is nan"),
            (format!("{header}1 2\n3 4\n5"), ", line 8: there are more values"),
            (format!("{header}1 2\n3 -9e99"), ", line 7: the value -9e99 is too large"),
            ("1".repeat(10_000), ", line 1: `11111111111111111111…` is not a word"),
        ] {
            let message = parsed(&text).unwrap_err();
            assert!(message.starts_with(expected), "{text:.60} gave {message}");
        }
    }
}

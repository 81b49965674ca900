//! `.asc`: the ESRI ASCII grid, a raster with its own placement.
//!
//! A header of names and numbers (`ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`,
//! `cellsize` or `dx` and `dy`, and perhaps `NODATA_value`), then the values, the top row first. Case, line
//! breaks and the order of the header do not matter.

use std::collections::HashMap;
use std::fmt;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;

use glam::DVec2;

use super::coordinate_system::CoordinateSystem;
use super::disk::File;
use super::error::PlacedFlaw;
use super::gdal_metadata::BandMetadata;
use super::rows::reverse_rows;
use super::samples::{NoData, SampleType, SampleUnpacking, no_rectangle};
use super::vertical::ValueUnit;
use super::{FileGrid, Flaw, GridPlace, Meter, Number, RasterFormatSpec, ReadError, ReadRaster};
use meshbrush_core::raster::{LONGEST_SIDE, Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::excerpt;

/// The format, for the list of all formats of rasters.
pub static RASTER: RasterFormatSpec =
    RasterFormatSpec { endings: &["asc"], has_parts: false, read: ReadRaster::Grid(read_grid) };

/// Reads a grid. Pixels without a value (`NODATA_value`, and `nan` as GDAL writes it) are NaN.
///
/// # Errors
/// Fails when the file cannot be read, breaks a rule of the format (with the line), or has too many pixels
/// for a raster.
pub fn read(path: &Path) -> Result<Raster, ReadError> {
    read_metered(path, &Meter::default())
}

/// Reads a grid as [`read`] does, and counts the bytes of the file.
///
/// # Errors
/// Fails as [`read`] does, and when the work was cancelled.
pub fn read_metered(path: &Path, meter: &Meter) -> Result<Raster, ReadError> {
    read_placed(path, None, meter).map(|grid| grid.raster)
}

/// Reads a grid, and the text beside it that describes its coordinates (`.prj`).
fn read_grid(path: &Path, place: &GridPlace, meter: &Meter) -> Result<FileGrid, ReadError> {
    let mut grid = read_placed(path, place.over, meter)?;
    grid.system = CoordinateSystem::beside(path);
    grid.facts.positive = grid.system.as_ref().and_then(|system| system.vertical.positive);
    Ok(if place.over.is_some() { grid } else { grid.in_degrees() })
}

/// Reads a grid over the given rectangle, or else over that of its header.
fn read_placed(path: &Path, place: Option<Rect>, meter: &Meter) -> Result<FileGrid, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| {
        meter.expect(file.length()?);
        let metadata = BandMetadata::beside(path, 0);
        let vertical = CoordinateSystem::beside(path).map(|system| system.vertical).unwrap_or_default();
        let unit = ValueUnit::named(metadata.unit.as_deref().unwrap_or_default()).or(vertical.unit);
        let unpacking = SampleUnpacking {
            scale: metadata.scale.unwrap_or(1.0),
            offset: metadata.offset.unwrap_or(0.0),
            unit,
            ..SampleUnpacking::plain(REMEDY)
        };
        parse_over(BufReader::with_capacity(1 << 16, meter.count(file)), place, unpacking)
    });
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads a grid as [`read`] does, from bytes. Errors call the file `name`.
///
/// # Errors
/// Fails as [`read`] does.
pub fn from_bytes(bytes: &[u8], name: &Path) -> Result<Raster, ReadError> {
    parse(bytes).map_err(|flaw| flaw.in_file(name))
}

/// Writes a grid that [`read`] reads: the values bit for bit, the bounds as [`bounds_as_written`] returns
/// them. Values are finite, or NaN for pixels without a value.
///
/// # Errors
/// Fails with the errors of `out`.
pub fn write(out: &mut dyn Write, raster: &Raster) -> io::Result<()> {
    let ([columns, rows], cell) = (raster.size(), cell(raster));
    let min = raster.bounds().min;
    writeln!(out, "ncols {columns}\nnrows {rows}")?;
    writeln!(out, "xllcorner {}\nyllcorner {}", Number(min.x), Number(min.y))?;
    if cell.x == cell.y {
        writeln!(out, "cellsize {}", Number(cell.x))?;
    } else {
        writeln!(out, "dx {}\ndy {}", Number(cell.x), Number(cell.y))?;
    }
    let no_data = no_data(raster);
    if let Some(no_data) = no_data {
        writeln!(out, "NODATA_value {no_data}")?;
    }
    for y in (0..rows).rev() {
        let mut line = String::new();
        for &value in raster.row(y, 0..columns) {
            let value = if value.is_nan() { no_data.unwrap_or(value) } else { value };
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(&Single(value).to_string());
        }
        writeln!(out, "{line}")?;
    }
    Ok(())
}

/// Returns the bounds of a grid as its header states them. They can differ from the raster's bounds by
/// rounding.
pub fn bounds_as_written(raster: &Raster) -> Rect {
    let (min, [columns, rows]) = (raster.bounds().min, raster.size());
    Rect::new(min, upper_corner(min, cell(raster), [columns, rows]))
}

/// Returns the sides of a cell from which a reader finds the upper right corner, exactly where that is
/// possible.
fn cell(raster: &Raster) -> DVec2 {
    let (Rect { min, max }, size) = (raster.bounds(), raster.size().map(f64::from));
    let side = |min: f64, max: f64, count: f64| {
        let side = (max - min) / count;
        let near = [side, side.next_up(), side.next_down()];
        near.into_iter().find(|side| min + side * count == max).unwrap_or(side)
    };
    DVec2::new(side(min.x, max.x, size[0]), side(min.y, max.y, size[1]))
}

fn upper_corner(min: DVec2, cell: DVec2, [columns, rows]: [u32; 2]) -> DVec2 {
    min + cell * DVec2::new(f64::from(columns), f64::from(rows))
}

/// Returns a number that no pixel has, if some pixels have no value, or would have none in a file that names
/// no such number.
fn no_data(raster: &Raster) -> Option<f32> {
    let values = raster.values();
    let default = DEFAULT_NO_DATA as f32;
    values.iter().any(|&value| value.is_nan() || value == default).then(|| {
        let mut candidate = default;
        while values.contains(&candidate) {
            candidate *= 10.0;
        }
        candidate
    })
}

/// The shortest text that reads back as the same number.
struct Single(f32);

impl fmt::Display for Single {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-4..1e7).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

fn parse(source: impl BufRead) -> Result<Raster, PlacedFlaw> {
    parse_over(source, None, SampleUnpacking::plain(REMEDY)).map(|grid| grid.raster)
}

/// `unpacking` is what is said beside the file about its values.
fn parse_over(
    source: impl BufRead,
    place: Option<Rect>,
    mut unpacking: SampleUnpacking,
) -> Result<FileGrid, PlacedFlaw> {
    let mut words = Words { source, line: 1, word: String::new() };
    let header = AscHeader::parse(&mut words)?;
    let [columns, rows] = header.size()?;
    let bounds = header.bounds([columns, rows])?;
    unpacking.marks = vec![header.no_data()];
    unpacking.has_declared = header.number(NO_DATA).is_some();
    let count = columns as usize * rows as usize;
    // Grows with the values in the file: a header alone takes no memory.
    let mut values: Vec<f32> = Vec::new();
    let mut has_word = true;
    while has_word {
        if values.len() == count {
            let problem = format!("there are more values than {columns} columns × {rows} rows");
            return Err(Flaw::Syntax(problem + "; check ncols and nrows.").at(words.line));
        }
        let value =
            if header.is_no_data(words.text()) { f64::NAN } else { number(words.text(), words.line)? };
        // Cells have single precision, in which GDAL compares them: the last digit of a number may differ.
        let single = f64::from(value as f32);
        let value = if single.is_infinite() { value } else { single };
        values.push(unpacking.value(value).map_err(|flaw| flaw.at(words.line))?);
        has_word = words.advance()?;
    }
    if values.len() < count {
        return Err(Flaw::CutOff.at(words.line));
    }
    reverse_rows(&mut values, columns);
    let raster = Raster::from_values(place.unwrap_or(bounds), [columns, rows], values);
    Ok(FileGrid { raster, system: None, facts: unpacking.facts() })
}

/// The number of cells without a value where the header names none.
const DEFAULT_NO_DATA: f64 = -9999.0;

/// What the header says.
struct AscHeader {
    /// Its names in lower case, with their numbers.
    numbers: HashMap<String, f64>,
    /// What marks a cell without a value, where that is no number.
    no_data_word: Option<String>,
}

const NAMES: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "dx", "dy", NO_DATA];
const NO_DATA: &str = "nodata_value";

impl AscHeader {
    /// Reads names and numbers up to the first number in the place of a name. That is the first value; it
    /// stays the current word.
    fn parse(words: &mut Words<impl BufRead>) -> Result<Self, PlacedFlaw> {
        let mut known = HashMap::new();
        let mut no_data_word = None;
        loop {
            let name = words.required()?.to_owned();
            let is_nan = name.eq_ignore_ascii_case("nan");
            if is_nan || name.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
                return Ok(Self { numbers: known, no_data_word });
            }
            let lower = name.to_ascii_lowercase();
            if !NAMES.contains(&lower.as_str()) {
                let problem =
                    format!("`{name}` is not part of the header of an ESRI ASCII grid, which begins with");
                return Err(Flaw::Syntax(problem + " ncols, nrows, xllcorner, yllcorner and cellsize.")
                    .at(words.line));
            }
            let value = words.required()?.to_owned();
            let is_word = value.chars().all(|c| c.is_ascii_alphabetic()) && value.parse::<f64>().is_err();
            if lower == NO_DATA && is_word && no_data_word.is_none() {
                no_data_word = Some(value);
                continue;
            }
            // Each name is allowed once, so the loop is bounded by the list of names.
            let number = number(&value, words.line)?;
            if number.is_nan() && lower != NO_DATA {
                return Err(Flaw::Syntax(format!("`{name}` is nan, and it must be a number.")).at(words.line));
            }
            if known.insert(lower, number).is_some() {
                return Err(Flaw::Syntax(format!("`{name}` is twice in the header.")).at(words.line));
            }
        }
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.numbers.get(name).copied()
    }

    /// Returns the number of cells without a value.
    fn no_data(&self) -> NoData {
        NoData::rounded(self.number(NO_DATA).unwrap_or(DEFAULT_NO_DATA), SampleType::Single)
    }

    /// Returns whether a word stands for a cell without a value.
    fn is_no_data(&self, word: &str) -> bool {
        self.no_data_word.as_deref() == Some(word)
    }

    fn required(&self, name: &str) -> Result<f64, Flaw> {
        self.number(name).ok_or_else(|| Flaw::Syntax(format!("the header has no `{name}`.")))
    }

    fn size(&self) -> Result<[u32; 2], Flaw> {
        let size = [self.required("ncols")?, self.required("nrows")?];
        if let Some(&side) = size.iter().find(|side| side.fract() != 0.0 || **side < 0.0) {
            return Err(Flaw::Syntax(format!("ncols and nrows are whole numbers, and {side} is not.")));
        }
        let longest = f64::from(LONGEST_SIDE);
        if size.iter().any(|&side| side > longest) || !is_raster_size(size.map(|side| side as u32)) {
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
        let bounds = Rect::new(min, upper_corner(min, cell, size));
        if bounds.is_proper() { Ok(bounds) } else { Err(no_rectangle(cell.x, cell.y)) }
    }
}

/// Returns a finite number, or NaN, which GDAL writes for a cell without a value.
fn number(word: &str, line: usize) -> Result<f64, PlacedFlaw> {
    // Some programs write a decimal comma, depending on the language of the system.
    let parsed = word.parse().or_else(|_| word.replace(',', ".").parse());
    parsed.ok().filter(|value: &f64| !value.is_infinite()).ok_or_else(|| {
        Flaw::Syntax(format!("`{word}` is not a number, and a number is expected here.")).at(line)
    })
}

/// What helps where a value is too large.
const REMEDY: &str = "If it marks pixels without a value, name it with NODATA_value in the header.";

/// Words between white space.
struct Words<R> {
    source: R,
    /// The line of the last word, counted from one.
    line: usize,
    /// The current word.
    word: String,
}

/// Longer than any number that a program writes, in bytes. Without a limit a file without white space would
/// fill the memory.
const LONGEST_WORD: usize = 400;

impl<R: BufRead> Words<R> {
    /// The current word.
    fn text(&self) -> &str {
        &self.word
    }

    /// Goes to the next word and returns it.
    fn required(&mut self) -> Result<&str, PlacedFlaw> {
        if self.advance()? { Ok(&self.word) } else { Err(Flaw::CutOff.at(self.line)) }
    }

    /// Goes to the next word. Returns whether there is one.
    fn advance(&mut self) -> Result<bool, PlacedFlaw> {
        self.skip_white_space()?;
        let mut word = std::mem::take(&mut self.word).into_bytes();
        word.clear();
        // Each iteration takes a whole buffer or stops, and the end of the file stops it, too.
        loop {
            let bytes = self.source.fill_buf()?;
            let end = bytes.iter().position(u8::is_ascii_whitespace);
            let part = end.unwrap_or(bytes.len());
            word.extend_from_slice(&bytes[..part.min(LONGEST_WORD + 1)]);
            let is_last = bytes.is_empty() || end.is_some() || word.len() > LONGEST_WORD;
            self.source.consume(part);
            if is_last {
                break;
            }
        }
        match String::from_utf8(word) {
            Ok(word) if word.len() <= LONGEST_WORD && !word.contains('\0') => {
                self.word = word;
                Ok(!self.word.is_empty())
            }
            Ok(other) => Err(self.not_a_word(&other)),
            Err(other) => Err(self.not_a_word(&String::from_utf8_lossy(other.as_bytes()))),
        }
    }

    /// Goes to the next byte of a word, and counts lines.
    fn skip_white_space(&mut self) -> Result<(), PlacedFlaw> {
        loop {
            let bytes = self.source.fill_buf()?;
            let end = bytes.iter().position(|byte| !byte.is_ascii_whitespace());
            let white = end.unwrap_or(bytes.len());
            self.line += bytes[..white].iter().filter(|&&byte| byte == b'\n').count();
            let is_last = bytes.is_empty() || end.is_some();
            self.source.consume(white);
            if is_last {
                return Ok(());
            }
        }
    }

    fn not_a_word(&self, text: &str) -> PlacedFlaw {
        let problem = format!("`{}` is not a word of an ESRI ASCII grid.", excerpt(20, text));
        Flaw::Syntax(problem).at(self.line)
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
    fn words_may_lie_across_buffers() {
        let text = "ncols 3\r\nnrows 2\nxllcorner 10.25\nyllcorner -4\n\ncellsize 2\n1.125 2 3e-2\n\t44 5 6";
        let whole = parse(text.as_bytes()).unwrap();
        for capacity in 1..20 {
            assert_eq!(parse(BufReader::with_capacity(capacity, text.as_bytes())).unwrap(), whole);
            let cut =
                parse(BufReader::with_capacity(capacity, &text.as_bytes()[..text.len() - 2])).unwrap_err();
            assert_eq!(cut.place, super::super::PlaceInFile::Line(8), "{capacity}");
        }
    }

    #[test]
    fn a_row_may_be_longer_than_a_field_is_wide() {
        let columns = 10_000;
        let header = format!("ncols {columns} nrows 2 xllcorner 0 yllcorner 0 cellsize 1\n");
        let raster = parsed(&(header + &"7 ".repeat(columns) + &"8 ".repeat(columns))).unwrap();
        assert_eq!((raster.size(), raster.get(9_999, 0), raster.get(0, 1)), ([10_000, 2], 8.0, 7.0));
        for size in ["ncols 65537 nrows 1", "ncols 20000 nrows 20000", "ncols 0 nrows 1"] {
            let refused = parsed(&format!("{size} xllcorner 0 yllcorner 0 cellsize 1\n1")).unwrap_err();
            assert!(refused.contains("pixels cannot be read") && refused.contains("65,536"), "{refused}");
        }
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
            (header.replace("size 1", "size 0") + "1 2\n3 4", ": with pixels of 0 × 0"),
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

    #[test]
    fn what_is_written_is_read_bit_for_bit() {
        let mut random = fastrand::Rng::with_seed(31);
        for n in 0..50 {
            let min = DVec2::new(random.f64() - 0.5, 1e3 * random.f64());
            let side = DVec2::new(0.1 + random.f64(), 10.0 * random.f64() + 0.1);
            let size = [random.u32(1..9), random.u32(1..9)];
            let mut value = || match random.u8(..6) {
                0 if n > 10 => f32::NAN,
                1 => -9999.0,
                2 => f32::MIN_POSITIVE * random.f32(),
                _ => 1e9 * (random.f32() - 0.5),
            };
            let values = (0..size[0] * size[1]).map(|_| value()).collect();
            let raster = Raster::from_values(Rect::new(min, min + side), size, values);
            let mut text = Vec::new();
            write(&mut text, &raster).unwrap();
            let read = from_bytes(&text, Path::new("a.asc")).unwrap();
            let bits = |raster: &Raster| raster.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!((read.size(), bits(&read)), (size, bits(&raster)));
            assert_eq!(read.bounds(), bounds_as_written(&raster));
            assert!((read.bounds().max - raster.bounds().max).abs().max_element() < 1e-12);
            let mut again = Vec::new();
            write(&mut again, &Raster::from_values(raster.bounds(), size, read.values().to_vec())).unwrap();
            assert_eq!(again, text);
        }
        let exact = Raster::filled(Rect::new(DVec2::new(-1.5, 2.0), DVec2::new(2.5, 3.0)), [8, 3], 0.0);
        assert_eq!(bounds_as_written(&exact), exact.bounds());
    }
}

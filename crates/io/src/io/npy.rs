//! `.npy`: an array of NumPy, a raster without a placement of its own.
//!
//! Arrays with two dimensions are read: the first counts rows from the top, the second columns. Samples are
//! whole or floating-point numbers of 8 to 64 bits, in either order of bytes, row by row or column by column.

use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

use super::disk::File;
use super::error::PlacedFlaw;
use super::rows::reverse_rows;
use super::samples::SampleUnpacking;
use super::{FileGrid, Flaw, Meter, RasterFormatSpec, ReadError, ReadRaster, ValueFacts};
use meshbrush_core::raster::{Raster, is_raster_size};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::text::excerpt;

/// The format, for the list of all formats of rasters.
pub static RASTER: RasterFormatSpec =
    RasterFormatSpec { endings: &["npy"], has_parts: false, read: ReadRaster::Array(read_grid) };

const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// Most bytes of a header. That of an array without fields has about 100.
const MOST_HEADER: u32 = 1 << 16;
/// Samples that are read at once.
const BLOCK: usize = 1 << 13;

/// Reads an array over the given rectangle, in world units. NaN is a pixel without a value. The meter counts
/// the bytes of the file.
///
/// # Errors
/// Fails when the file cannot be read, is no array of numbers with two dimensions, is cut off, has too many
/// pixels for a raster, or a value beyond single precision; and when the work was cancelled.
pub fn read(path: &Path, place: Rect, meter: &Meter) -> Result<Raster, ReadError> {
    read_grid(path, place, meter).map(|grid| grid.raster)
}

fn read_grid(path: &Path, place: Rect, meter: &Meter) -> Result<FileGrid, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from).and_then(|file| {
        meter.expect(file.length()?);
        Ok(decode_grid(BufReader::with_capacity(1 << 16, meter.count(file)), place)?)
    });
    read.map_err(|flaw| flaw.in_file(path))
}

/// Reads as [`read`] does, from any source of bytes.
///
/// # Errors
/// Fails as [`read`] does.
pub fn decode(source: impl Read, place: Rect) -> Result<Raster, Flaw> {
    decode_grid(source, place).map(|grid| grid.raster)
}

fn decode_grid(mut source: impl Read, place: Rect) -> Result<FileGrid, Flaw> {
    let header = NpyHeader::read(&mut source)?;
    let (mut values, facts) = header.values(&mut source)?;
    if header.is_by_columns {
        values = by_rows(&values, header.size);
    }
    reverse_rows(&mut values, header.size[0]);
    Ok(FileGrid { raster: Raster::from_values(place, header.size, values), system: None, facts })
}

/// Returns values that come column by column in the order of rows.
fn by_rows(values: &[f32], [columns, rows]: [u32; 2]) -> Vec<f32> {
    let (columns, rows) = (columns as usize, rows as usize);
    let of_row = |row: usize| (0..columns).map(move |column| values[column * rows + row]);
    (0..rows).flat_map(of_row).collect()
}

/// What the header says.
struct NpyHeader {
    /// [columns, rows].
    size: [u32; 2],
    sample: NpySample,
    is_by_columns: bool,
}

/// The type of a sample.
#[derive(Clone, Copy)]
struct NpySample {
    /// `f` floating-point, `i` signed, `u` unsigned, `b` true or false.
    kind: char,
    bytes: usize,
    is_big_endian: bool,
}

impl NpyHeader {
    fn read(source: &mut impl Read) -> Result<Self, Flaw> {
        let [start @ .., major, _] = bytes::<8>(source)?;
        if &start != MAGIC {
            return Err(Flaw::Syntax("this is not an array of NumPy: it begins with other bytes.".into()));
        }
        let length = match major {
            1 => u16::from_le_bytes(bytes(source)?).into(),
            2 | 3 => u32::from_le_bytes(bytes(source)?),
            _ => {
                let problem =
                    format!("the file has version {major} of the format, and versions 1 to 3 are read.");
                return Err(Flaw::Syntax(problem + " Save it with a common version of NumPy."));
            }
        };
        if length > MOST_HEADER {
            return Err(Flaw::Syntax(format!(
                "the header has {length} bytes; that of a plain array has about 100."
            )));
        }
        let mut text = vec![0; length as usize];
        source.read_exact(&mut text).map_err(cut_off)?;
        Self::parse(&String::from_utf8_lossy(&text))
    }

    /// Parses the dictionary, such as `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`.
    fn parse(text: &str) -> Result<Self, Flaw> {
        let sample = NpySample::parse(value_of(text, "descr")?)?;
        let is_by_columns = value_of(text, "fortran_order")?.starts_with("True");
        let shape = value_of(text, "shape")?;
        let inner = shape.strip_prefix('(').and_then(|shape| shape.split_once(')'));
        let (inner, _) = inner.ok_or_else(|| Flaw::Syntax("the header has no list of dimensions.".into()))?;
        let sides: Vec<&str> = inner.split(',').map(str::trim).filter(|side| !side.is_empty()).collect();
        let [rows, columns] = sides[..] else {
            let count = sides.len();
            let problem =
                format!("the array has {count} dimensions, and a raster has two: rows and columns.");
            return Err(Flaw::Syntax(problem + " Save one slice of it."));
        };
        let side = |text: &str| {
            let problem =
                || Flaw::Syntax(format!("the number of rows or columns is “{}”.", excerpt(40, text)));
            text.parse::<u64>().map_err(|_| problem())
        };
        let (columns, rows) = (side(columns)?, side(rows)?);
        let size = [columns, rows].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        if !is_raster_size(size) {
            return Err(Flaw::Size { columns, rows });
        }
        Ok(Self { size, sample, is_by_columns })
    }

    /// Returns the values in the order of the file. Memory grows with the values in the file.
    fn values(&self, source: &mut impl Read) -> Result<(Vec<f32>, ValueFacts), Flaw> {
        let count = self.size[0] as usize * self.size[1] as usize;
        let mut unpacking = SampleUnpacking::plain("Save numbers that are no data as nan.");
        let mut values = Vec::new();
        let mut block = vec![0; BLOCK * self.sample.bytes];
        while values.len() < count {
            let part = &mut block[..BLOCK.min(count - values.len()) * self.sample.bytes];
            source.read_exact(part).map_err(cut_off)?;
            for sample in part.chunks_exact(self.sample.bytes) {
                values.push(unpacking.value(self.sample.number(sample))?);
            }
        }
        Ok((values, unpacking.facts()))
    }
}

impl NpySample {
    /// Parses a type such as `'<f8'`.
    fn parse(text: &str) -> Result<Self, Flaw> {
        let quoted = text.strip_prefix(['\'', '"']).and_then(|text| text.split(['\'', '"']).next());
        let parsed = quoted.and_then(|code| {
            let mut letters = code.chars();
            let (order, kind) = (letters.next()?, letters.next()?);
            let bytes = letters.as_str().parse().ok()?;
            let is_known = match kind {
                'f' => matches!(bytes, 4 | 8),
                'i' | 'u' => matches!(bytes, 1 | 2 | 4 | 8),
                'b' => bytes == 1,
                _ => false,
            };
            let is_known = is_known && "<>|=".contains(order);
            is_known.then_some(Self { kind, bytes, is_big_endian: order == '>' })
        });
        parsed.ok_or_else(|| {
            let code = excerpt(40, quoted.unwrap_or(text));
            Flaw::Syntax(format!(
                "the array has samples of the type “{code}”, and whole and floating-point numbers of 8 to 64 bits are \
                 read. Save it as float32 or float64."
            ))
        })
    }

    fn number(self, bytes: &[u8]) -> f64 {
        let add = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        let pattern = match self.is_big_endian {
            true => bytes.iter().fold(0, add),
            false => bytes.iter().rev().fold(0, add),
        };
        let unused = 64 - 8 * self.bytes;
        match (self.kind, self.bytes) {
            ('f', 4) => f32::from_bits(pattern as u32).into(),
            ('f', _) => f64::from_bits(pattern),
            ('i', _) => ((pattern << unused) as i64 >> unused) as f64,
            _ => pattern as f64,
        }
    }
}

/// Returns the text of a dictionary from the value of a key on.
fn value_of<'a>(text: &'a str, key: &str) -> Result<&'a str, Flaw> {
    let found = [format!("'{key}'"), format!("\"{key}\"")].into_iter().find_map(|key| text.split_once(&key));
    let value = found.and_then(|(_, rest)| rest.trim_start().strip_prefix(':'));
    value
        .map(str::trim_start)
        .ok_or_else(|| Flaw::Syntax(format!("the header has no “{key}”. Save it again.")))
}

fn bytes<const N: usize>(source: &mut impl Read) -> Result<[u8; N], Flaw> {
    let mut bytes = [0; N];
    source.read_exact(&mut bytes).map_err(cut_off)?;
    Ok(bytes)
}

fn cut_off(error: std::io::Error) -> Flaw {
    if error.kind() == ErrorKind::UnexpectedEof { Flaw::CutOff } else { Flaw::Io(error) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a file with a header of the given version.
    fn file(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
        let length = header.len();
        let length = if version == 1 {
            (length as u16).to_le_bytes().to_vec()
        } else {
            (length as u32).to_le_bytes().to_vec()
        };
        [MAGIC, &[version, 0][..], &length, header.as_bytes(), data].concat()
    }

    fn header(code: &str, order: &str, shape: &str) -> String {
        format!("{{'descr': '{code}', 'fortran_order': {order}, 'shape': {shape}, }}        \n")
    }

    fn said(bytes: &[u8]) -> String {
        decode(bytes, Rect::UNIT).unwrap_err().to_string()
    }

    /// Returns the bytes of whole numbers in a type.
    fn encoded(code: &str, numbers: &[i32]) -> Vec<u8> {
        let of = |number: i32| match &code[1..] {
            "f4" => (number as f32).to_le_bytes().to_vec(),
            "f8" => f64::from(number).to_le_bytes().to_vec(),
            other => i64::from(number).to_le_bytes()[..other[1..].parse().unwrap()].to_vec(),
        };
        let ordered = |number: &i32| {
            let mut bytes = of(*number);
            if code.starts_with('>') {
                bytes.reverse();
            }
            bytes
        };
        numbers.iter().flat_map(ordered).collect()
    }

    #[test]
    fn every_type_order_and_version_is_read_exactly() {
        let place = Rect::new(glam::dvec2(1.0, 2.0), glam::dvec2(4.0, 4.0));
        for code in [
            "<f4", ">f4", "<f8", ">f8", "|i1", "<i2", ">i2", "<i4", ">i4", "<i8", ">i8", "|u1", "<u2", ">u4",
            "|b1",
        ] {
            let numbers = match &code[1..] {
                "u1" | "i1" => [1, 2, 127, 4, 5, 6],
                "b1" => [0, 1, 1, 0, 0, 1],
                "u2" | "u4" => [1, 2, 65535, 4, 5, 6],
                _ => [1, -2, 32767, -30000, 5, 6],
            };
            let [a, b, c, d, e, f] = numbers.map(|number| number as f32);
            for version in 1..=3 {
                let by_rows = file(version, &header(code, "False", "(2, 3)"), &encoded(code, &numbers));
                let raster = decode(&*by_rows, place).unwrap();
                assert_eq!((raster.size(), raster.bounds()), ([3, 2], place), "{code}");
                assert_eq!(raster.values(), [d, e, f, a, b, c], "{code}");
                let by_columns = file(version, &header(code, "True", "(2, 3)"), &encoded(code, &numbers));
                assert_eq!(decode(&*by_columns, place).unwrap().values(), [b, d, f, a, c, e], "{code}");
            }
        }
    }

    #[test]
    fn nan_is_no_value_and_infinity_is_refused() {
        let data: Vec<u8> = [f32::NAN, 1.0].iter().flat_map(|value| value.to_le_bytes()).collect();
        let raster = decode(&*file(1, &header("<f4", "False", "(1, 2)"), &data), Rect::UNIT).unwrap();
        assert!(raster.get(0, 0).is_nan() && raster.get(1, 0) == 1.0);
        let infinite = file(1, &header("<f8", "False", "(1, 1)"), &f64::INFINITY.to_le_bytes());
        assert!(said(&infinite).contains("the value inf is too large"));
    }

    #[test]
    fn what_is_no_raster_is_refused_with_a_sentence() {
        for (version, code, shape, says) in [
            (1, "<f4", "(3,)", "1 dimensions"),
            (1, "<f4", "(3, 1, 2)", "3 dimensions"),
            (1, "<f4", "()", "0 dimensions"),
            (1, "<f4", "(70000, 2)", "2 × 70,000 pixels"),
            (1, "<f4", "(0, 2)", "2 × 0 pixels"),
            (1, "<f4", "(60000, 60000)", "60,000 × 60,000 pixels"),
            (1, "<f4", "(99999999999999999999, 2)", "“99999999999999999999”"),
            (1, "<f4", "(-1, 2)", "“-1”"),
            (1, "<c8", "(1, 2)", "the type “<c8”"),
            (1, "<f2", "(1, 2)", "the type “<f2”"),
            (9, "<f4", "(1, 2)", "version 9"),
        ] {
            let sentence = said(&file(version, &header(code, "False", shape), &[0; 8]));
            assert!(sentence.contains(says) && sentence.ends_with('.'), "{shape} {code}: {sentence}");
        }
        assert!(
            said(&file(1, "{'descr': [('a', '<f4')], 'fortran_order': False}", &[])).contains("the type")
        );
        assert!(said(&file(1, "{}", &[])).contains("no “descr”"));
        assert!(said(b"\x93NUMPX\x01\0").contains("other bytes"));
        assert!(said(&[&MAGIC[..], &[2, 0, 255, 255, 255, 255]].concat()).contains("4294967295 bytes"));
    }

    #[test]
    fn every_cut_is_an_error() {
        let whole = file(2, &header("<i2", "True", "(2, 3)"), &[1; 12]);
        for end in 0..whole.len() {
            assert!(decode(&whole[..end], Rect::UNIT).is_err(), "cut at {end}");
        }
    }
}

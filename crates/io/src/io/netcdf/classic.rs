//! The header and the samples of files in the classic forms: CDF-1, CDF-2 with 64-bit offsets, and CDF-5 with
//! 64-bit lengths.
//!
//! The crate `netcdf-reader` reads these forms, too. But version 0.12 refuses files with an attribute that
//! goes beyond their first 64 KiB, with a name that is not UTF-8, or cut off within a later record than those
//! that are wanted; and it reads all of a file into memory where a count in the header is damaged.

use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

use super::super::Flaw;
use super::contents::{Dimension, ReadAttribute, ReadVariable, Source, StoredType};
use meshbrush_mesh::text::excerpt;

/// The first bytes of a file; the version follows.
pub(super) const MAGIC: &[u8; 3] = b"CDF";
/// Most bytes of a header, without long attributes. That of a grid has a few thousand.
const MOST_HEADER: u64 = 1 << 26;
/// Most dimensions, variables or attributes in a list.
const MOST_ENTRIES: u64 = 1 << 16;
/// Most bytes of an attribute that is kept. Longer ones are histories.
const MOST_ATTRIBUTE: u64 = 1 << 16;
/// Most bytes of a name.
const MOST_NAME: u64 = 1 << 12;
/// Most dimensions of a variable.
const MOST_RANK: u64 = 1 << 10;
/// The number of records of a file that was not closed: as many as it holds.
const UNKNOWN_RECORDS: u32 = u32::MAX;

/// A file in a classic form.
pub(super) struct Classic<S> {
    source: S,
    /// Bytes of the file.
    length: u64,
    variables: Vec<ReadVariable>,
    places: Vec<VariablePlace>,
    /// Bytes from one record to the next.
    record_bytes: u64,
}

/// Where the samples of a variable begin, and whether there is a part of it in each record.
#[derive(Clone, Copy)]
struct VariablePlace {
    begin: u64,
    is_record: bool,
}

impl<S: Read + Seek> Classic<S> {
    /// Reads the header.
    ///
    /// # Errors
    /// Fails when the source cannot be read or is cut off, or when the header breaks a rule of the format.
    pub(super) fn open(mut source: S) -> Result<Self, Flaw> {
        let length = source.seek(SeekFrom::End(0))?;
        source.seek(SeekFrom::Start(0))?;
        let mut header = ClassicHeader { source: BufReader::new(&mut source), version: 0, left: MOST_HEADER };
        let (mut variables, places, records) = header.read()?;
        let record_bytes = record_bytes(&variables, &places)?;
        let first = places.iter().filter(|place| place.is_record).map(|place| place.begin).min();
        let held = length.saturating_sub(first.unwrap_or(length)).checked_div(record_bytes);
        let records = records.unwrap_or(held.unwrap_or(0));
        for (variable, _) in variables.iter_mut().zip(&places).filter(|(_, place)| place.is_record) {
            variable.dimensions[0].length = records;
        }
        Ok(Self { source, length, variables, places, record_bytes })
    }
}

/// Returns the bytes of a record: of all parts, each padded to a multiple of four. One alone is not padded.
fn record_bytes(variables: &[ReadVariable], places: &[VariablePlace]) -> Result<u64, Flaw> {
    let parts = variables.iter().zip(places).filter(|(_, place)| place.is_record);
    let sizes: Vec<u128> = parts.map(|(variable, _)| size(variable, &variable.dimensions[1..])).collect();
    let all = match sizes[..] {
        [one] => one,
        _ => sizes.iter().map(|size| size.next_multiple_of(4)).fold(0, u128::saturating_add),
    };
    u64::try_from(all).map_err(|_| syntax("its records are larger than any file"))
}

/// Returns the bytes of samples of a variable along some dimensions.
fn size(variable: &ReadVariable, dimensions: &[Dimension]) -> u128 {
    // Text has one byte per letter, and is not read.
    let sample = variable.sample.map_or(1, StoredType::bytes) as u128;
    dimensions
        .iter()
        .fold(sample, |size, dimension| size.saturating_mul(dimension.length.into()).min(1 << 100))
}

impl<S: Read + Seek> Source for Classic<S> {
    fn variables(&self) -> &[ReadVariable] {
        &self.variables
    }

    fn block(&mut self, variable: usize, corner: &[u64], extent: &[u64]) -> Result<Vec<f64>, Flaw> {
        let (place, variable) = (self.places[variable], &self.variables[variable]);
        let Some(sample) = variable.sample else { return Err(syntax("the variable is text")) };
        let mut strides: Vec<u128> = (1..=variable.dimensions.len())
            .map(|from| size(variable, &variable.dimensions[from..]))
            .collect();
        if place.is_record {
            strides[0] = self.record_bytes.into();
        }
        let offset = |index: &[u64]| {
            let steps = index.iter().zip(&strides).map(|(&index, &stride)| u128::from(index) * stride);
            u128::from(place.begin) + steps.sum::<u128>()
        };
        let last: Vec<u64> = corner.iter().zip(extent).map(|(corner, extent)| corner + extent - 1).collect();
        if offset(&last) + sample.bytes() as u128 > self.length.into() {
            return Err(Flaw::CutOff);
        }
        // Samples of a record variable with one dimension are apart.
        let is_apart = place.is_record && strides.len() == 1;
        let (outer, run) =
            if is_apart { (extent.len(), 1) } else { (extent.len() - 1, extent[extent.len() - 1]) };
        let count: u64 = extent.iter().product();
        let mut samples = Vec::with_capacity(count as usize);
        let mut bytes = vec![0; run as usize * sample.bytes()];
        let mut index = corner.to_vec();
        loop {
            self.source.seek(SeekFrom::Start(offset(&index) as u64))?;
            self.source.read_exact(&mut bytes).map_err(cut_off)?;
            sample.decode(&bytes, &mut samples);
            let Some(next) = (0..outer).rfind(|&at| index[at] < last[at]) else { return Ok(samples) };
            index[next] += 1;
            index[next + 1..].copy_from_slice(&corner[next + 1..]);
        }
    }
}

impl StoredType {
    /// Returns the type with a number in the format.
    fn of(code: u32) -> Result<Option<Self>, Flaw> {
        Ok(Some(match code {
            1 => Self::I8,
            2 => return Ok(None),
            3 => Self::I16,
            4 => Self::I32,
            5 => Self::F32,
            6 => Self::F64,
            7 => Self::U8,
            8 => Self::U16,
            9 => Self::U32,
            10 => Self::I64,
            11 => Self::U64,
            _ => return Err(syntax(&format!("its header has a type with the number {code}"))),
        }))
    }

    /// Appends the numbers that big-endian bytes are.
    fn decode(self, bytes: &[u8], numbers: &mut Vec<f64>) {
        match self {
            Self::I8 => numbers.extend(bytes.iter().map(|&byte| f64::from(byte as i8))),
            Self::U8 => numbers.extend(bytes.iter().map(|&byte| f64::from(byte))),
            Self::I16 => decode(bytes, numbers, |bytes| i16::from_be_bytes(bytes).into()),
            Self::U16 => decode(bytes, numbers, |bytes| u16::from_be_bytes(bytes).into()),
            Self::I32 => decode(bytes, numbers, |bytes| i32::from_be_bytes(bytes).into()),
            Self::U32 => decode(bytes, numbers, |bytes| u32::from_be_bytes(bytes).into()),
            Self::I64 => decode(bytes, numbers, |bytes| i64::from_be_bytes(bytes) as f64),
            Self::U64 => decode(bytes, numbers, |bytes| u64::from_be_bytes(bytes) as f64),
            Self::F32 => decode(bytes, numbers, |bytes| f32::from_be_bytes(bytes).into()),
            Self::F64 => decode(bytes, numbers, f64::from_be_bytes),
        }
    }
}

fn decode<const N: usize>(bytes: &[u8], numbers: &mut Vec<f64>, number: fn([u8; N]) -> f64) {
    numbers.extend(bytes.as_chunks().0.iter().map(|&bytes| number(bytes)));
}

/// Reads a header from its start.
struct ClassicHeader<R> {
    source: R,
    version: u8,
    /// Bytes that it may still have.
    left: u64,
}

/// The variables, their places, and the number of records if the file says it.
type Described = (Vec<ReadVariable>, Vec<VariablePlace>, Option<u64>);

impl<R: Read + Seek> ClassicHeader<R> {
    fn read(&mut self) -> Result<Described, Flaw> {
        let [magic @ .., version] = self.bytes::<4>()?;
        if &magic != MAGIC || ![1, 2, 5].contains(&version) {
            return Err(syntax("it begins with other bytes than CDF-1, CDF-2 or CDF-5"));
        }
        self.version = version;
        let records = match version {
            5 => Some(self.length()?).filter(|&records| records != u64::MAX),
            _ => Some(self.u32()?).filter(|&records| records != UNKNOWN_RECORDS).map(u64::from),
        };
        let dimensions =
            self.list(10, |header| Ok(Dimension { name: header.name()?, length: header.length()? }))?;
        self.attributes()?;
        let variables = self.list(11, |header| header.variable(&dimensions))?;
        let (variables, places) = variables.into_iter().unzip();
        Ok((variables, places, records))
    }

    fn variable(&mut self, dimensions: &[Dimension]) -> Result<(ReadVariable, VariablePlace), Flaw> {
        let name = self.name()?;
        let rank = self.length()?;
        if rank > MOST_RANK {
            return Err(syntax(&format!("the variable “{}” has {rank} dimensions", excerpt(40, &name))));
        }
        let mut own = Vec::new();
        for _ in 0..rank {
            let number = self.length()?;
            let dimension = usize::try_from(number).ok().and_then(|number| dimensions.get(number));
            let missing = || syntax(&format!("“{}” has a dimension that is missing", excerpt(40, &name)));
            own.push(dimension.ok_or_else(missing)?.clone());
        }
        let is_record = own.first().is_some_and(|dimension| dimension.length == 0);
        let attributes = self.attributes()?;
        let sample = StoredType::of(self.u32()?)?;
        self.length()?; // The size of the variable, which is too large for its number in some files.
        let begin = if self.version == 1 { self.u32()?.into() } else { u64::from_be_bytes(self.bytes()?) };
        Ok((ReadVariable { name, sample, dimensions: own, attributes }, VariablePlace { begin, is_record }))
    }

    fn attributes(&mut self) -> Result<Vec<(String, ReadAttribute)>, Flaw> {
        let list = self.list(12, |header| Ok((header.name()?, header.value()?)))?;
        Ok(list.into_iter().filter_map(|(name, value)| Some((name, value?))).collect())
    }

    /// Reads the value of an attribute; `None` for a long one.
    fn value(&mut self) -> Result<Option<ReadAttribute>, Flaw> {
        let sample = StoredType::of(self.u32()?)?;
        let bytes = self.length()?.saturating_mul(sample.map_or(1, StoredType::bytes) as u64);
        let padded = bytes.checked_next_multiple_of(4).and_then(|bytes| i64::try_from(bytes).ok());
        let padded = padded.ok_or(Flaw::CutOff)?;
        if bytes > MOST_ATTRIBUTE {
            self.source.seek(SeekFrom::Current(padded))?;
            return Ok(None);
        }
        let bytes = self.padded(bytes)?;
        Ok(Some(match sample {
            None => ReadAttribute::Text(String::from_utf8_lossy(&bytes).into_owned()),
            Some(sample) => {
                let mut numbers = Vec::new();
                sample.decode(&bytes, &mut numbers);
                ReadAttribute::Numbers(sample, numbers)
            }
        }))
    }

    /// Reads a list of the kind with a number; an empty one may have the number 0.
    fn list<T>(
        &mut self,
        kind: u32,
        mut entry: impl FnMut(&mut Self) -> Result<T, Flaw>,
    ) -> Result<Vec<T>, Flaw> {
        let (found, count) = (self.u32()?, self.length()?);
        if count > MOST_ENTRIES || (found != kind && (found, count) != (0, 0)) {
            let problem = format!("a list in its header has the kind {found} and {count} entries");
            return Err(syntax(&problem));
        }
        (0..count).map(|_| entry(self)).collect()
    }

    fn name(&mut self) -> Result<String, Flaw> {
        let bytes = self.length()?;
        if bytes > MOST_NAME {
            return Err(syntax(&format!("a name in its header has {bytes} bytes")));
        }
        Ok(String::from_utf8_lossy(&self.padded(bytes)?).into_owned())
    }

    /// Reads a number that is longer in CDF-5.
    fn length(&mut self) -> Result<u64, Flaw> {
        if self.version == 5 { Ok(u64::from_be_bytes(self.bytes()?)) } else { Ok(self.u32()?.into()) }
    }

    fn u32(&mut self) -> Result<u32, Flaw> {
        Ok(u32::from_be_bytes(self.bytes()?))
    }

    /// Reads bytes that are padded to a multiple of four.
    fn padded(&mut self, bytes: u64) -> Result<Vec<u8>, Flaw> {
        let mut read = vec![0; bytes.next_multiple_of(4) as usize];
        self.fill(&mut read)?;
        read.truncate(bytes as usize);
        Ok(read)
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Flaw> {
        let mut bytes = [0; N];
        self.fill(&mut bytes)?;
        Ok(bytes)
    }

    fn fill(&mut self, bytes: &mut [u8]) -> Result<(), Flaw> {
        let left = self.left.checked_sub(bytes.len() as u64);
        self.left = left.ok_or_else(|| syntax(&format!("its header has more than {MOST_HEADER} bytes")))?;
        self.source.read_exact(bytes).map_err(cut_off)
    }
}

fn cut_off(error: std::io::Error) -> Flaw {
    if error.kind() == ErrorKind::UnexpectedEof { Flaw::CutOff } else { Flaw::Io(error) }
}

fn syntax(problem: &str) -> Flaw {
    Flaw::Syntax(format!("this is not a classic NetCDF file that can be read ({problem}). Export it again."))
}

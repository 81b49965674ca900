//! The header and the samples of NetCDF-4 files, which are HDF5 files. They are read by the crate
//! `netcdf-reader`, with limits for its memory and without mapping files into memory.

use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::sync::{Arc, Mutex, PoisonError};

use netcdf_reader::{
    Error, NcAttrValue, NcFile, NcOpenOptions, NcSliceInfo, NcSliceInfoElem, NcType, NcVariable, Storage,
    StorageBuffer,
};

use super::super::Flaw;
use super::contents::{Dimension, Sample, Source, Value, Variable};
use meshbrush_mesh::text::excerpt;

/// Most bytes of decompressed chunks that are kept for the next block.
const MOST_CACHE: usize = 1 << 28;
/// Most bytes of a chunk after decompression.
const MOST_CHUNK: usize = 1 << 29;
/// Most bytes of the description of a group or a variable.
const MOST_HEADER: usize = 1 << 24;

/// A NetCDF-4 file.
pub(super) struct Hdf {
    file: NcFile,
    variables: Vec<Variable>,
}

impl Hdf {
    /// Reads the descriptions of the variables.
    ///
    /// # Errors
    /// Fails when the source cannot be read or is cut off, or when it is no NetCDF-4 file.
    pub(super) fn open(source: impl Read + Seek + Send + 'static) -> Result<Self, Flaw> {
        let mut source = source;
        let length = source.seek(SeekFrom::End(0))?;
        let options = NcOpenOptions {
            chunk_cache_bytes: MOST_CACHE,
            max_chunk_bytes: MOST_CHUNK,
            max_object_header_bytes: MOST_HEADER,
            ..NcOpenOptions::default()
        };
        let bytes = Arc::new(Bytes { source: Mutex::new(source), length });
        let file = NcFile::from_storage_with_options(bytes, options).map_err(flaw)?;
        let variables = file.variables().map_err(flaw)?.iter().map(variable).collect();
        Ok(Self { file, variables })
    }
}

impl Source for Hdf {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn block(&mut self, variable: usize, corner: &[u64], extent: &[u64]) -> Result<Vec<f64>, Flaw> {
        let slice = |(&start, &count)| NcSliceInfoElem::Slice { start, end: start + count, step: 1 };
        let selections = corner.iter().zip(extent).map(slice).collect();
        let name = &self.variables[variable].name;
        let read = self.file.read_variable_slice_as_f64(name, &NcSliceInfo { selections });
        let read = read.map_err(flaw)?;
        let (samples, _) = read.into_raw_vec_and_offset();
        let expected: u64 = extent.iter().product();
        if samples.len() as u64 != expected {
            return Err(syntax(&format!("{expected} samples of “{name}” are expected, and fewer are there")));
        }
        Ok(samples)
    }
}

fn variable(described: &NcVariable) -> Variable {
    let dimensions = described.dimensions.iter();
    let attributes = described.attributes.iter();
    Variable {
        name: described.name.clone(),
        sample: sample(&described.dtype),
        dimensions: dimensions.map(|d| Dimension { name: d.name.clone(), length: d.size }).collect(),
        attributes: attributes.filter_map(|a| Some((a.name.clone(), value(&a.value)?))).collect(),
    }
}

fn sample(kind: &NcType) -> Option<Sample> {
    Some(match kind {
        NcType::Byte => Sample::I8,
        NcType::UByte => Sample::U8,
        NcType::Short => Sample::I16,
        NcType::UShort => Sample::U16,
        NcType::Int => Sample::I32,
        NcType::UInt => Sample::U32,
        NcType::Int64 => Sample::I64,
        NcType::UInt64 => Sample::U64,
        NcType::Float => Sample::F32,
        NcType::Double => Sample::F64,
        _ => return None,
    })
}

fn value(value: &NcAttrValue) -> Option<Value> {
    Some(match value {
        NcAttrValue::Chars(text) => Value::Text(text.clone()),
        NcAttrValue::Strings(texts) => Value::Text(texts.first()?.clone()),
        NcAttrValue::UserDefined { .. } => return None,
        NcAttrValue::Bytes(list) => numbers(Sample::I8, list),
        NcAttrValue::UBytes(list) => numbers(Sample::U8, list),
        NcAttrValue::Shorts(list) => numbers(Sample::I16, list),
        NcAttrValue::UShorts(list) => numbers(Sample::U16, list),
        NcAttrValue::Ints(list) => numbers(Sample::I32, list),
        NcAttrValue::UInts(list) => numbers(Sample::U32, list),
        NcAttrValue::Int64s(list) => Value::Numbers(Sample::I64, list.iter().map(|&n| n as f64).collect()),
        NcAttrValue::UInt64s(list) => Value::Numbers(Sample::U64, list.iter().map(|&n| n as f64).collect()),
        NcAttrValue::Floats(list) => numbers(Sample::F32, list),
        NcAttrValue::Doubles(list) => numbers(Sample::F64, list),
    })
}

fn numbers<T: Copy + Into<f64>>(sample: Sample, list: &[T]) -> Value {
    Value::Numbers(sample, list.iter().map(|&number| number.into()).collect())
}

/// The bytes of a file, for the crate.
struct Bytes<S> {
    source: Mutex<S>,
    length: u64,
}

impl<S: Read + Seek + Send> Storage for Bytes<S> {
    fn len(&self) -> u64 {
        self.length
    }

    fn read_range(&self, offset: u64, len: usize) -> Result<StorageBuffer, hdf5_reader::error::Error> {
        let end = offset.checked_add(len as u64);
        if end.is_none_or(|end| end > self.length) {
            return Err(std::io::Error::from(ErrorKind::UnexpectedEof).into());
        }
        let mut source = self.source.lock().unwrap_or_else(PoisonError::into_inner);
        let mut bytes = vec![0; len];
        source.seek(SeekFrom::Start(offset))?;
        source.read_exact(&mut bytes)?;
        Ok(StorageBuffer::from_vec(bytes))
    }
}

fn flaw(error: Error) -> Flaw {
    use hdf5_reader::error::Error as Inner;
    match error {
        Error::UnexpectedEof { .. } | Error::Hdf5(Inner::UnexpectedEof { .. }) => Flaw::CutOff,
        Error::Io(e) | Error::Hdf5(Inner::Io(e)) if e.kind() == ErrorKind::UnexpectedEof => Flaw::CutOff,
        Error::Io(e) | Error::Hdf5(Inner::Io(e)) => Flaw::Io(e),
        other => syntax(other.to_string().trim_end_matches('.')),
    }
}

fn syntax(problem: &str) -> Flaw {
    let problem = excerpt(160, problem);
    Flaw::Syntax(format!(
        "this is not a NetCDF-4 file that can be read ({problem}). Copy it as classic NetCDF, for example with nccopy -k \
         cdf5."
    ))
}

//! The header and the samples of NetCDF-4 files, which are HDF5 files. They are read by the crate
//! `netcdf-reader`, with limits for its memory and without mapping files into memory.

use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::sync::{Arc, Mutex, PoisonError};

use netcdf_reader::{
    Error, NcAttrValue, NcFile, NcOpenOptions, NcSliceInfo, NcSliceInfoElem, NcType, NcVariable, Storage,
    StorageBuffer,
};

use super::super::Flaw;
use super::contents::{Dimension, ReadAttribute, ReadVariable, Source, StoredType};
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
    variables: Vec<ReadVariable>,
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
        let bytes = Arc::new(HdfBytes { source: Mutex::new(source), length });
        let file = NcFile::from_storage_with_options(bytes, options).map_err(flaw)?;
        let variables = file.variables().map_err(flaw)?.iter().map(variable).collect();
        Ok(Self { file, variables })
    }
}

impl Source for Hdf {
    fn variables(&self) -> &[ReadVariable] {
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

fn variable(described: &NcVariable) -> ReadVariable {
    let dimensions = described.dimensions.iter();
    let attributes = described.attributes.iter();
    ReadVariable {
        name: described.name.clone(),
        sample: sample(&described.dtype),
        dimensions: dimensions.map(|d| Dimension { name: d.name.clone(), length: d.size }).collect(),
        attributes: attributes.filter_map(|a| Some((a.name.clone(), value(&a.value)?))).collect(),
    }
}

fn sample(kind: &NcType) -> Option<StoredType> {
    Some(match kind {
        NcType::Byte => StoredType::I8,
        NcType::UByte => StoredType::U8,
        NcType::Short => StoredType::I16,
        NcType::UShort => StoredType::U16,
        NcType::Int => StoredType::I32,
        NcType::UInt => StoredType::U32,
        NcType::Int64 => StoredType::I64,
        NcType::UInt64 => StoredType::U64,
        NcType::Float => StoredType::F32,
        NcType::Double => StoredType::F64,
        _ => return None,
    })
}

fn value(value: &NcAttrValue) -> Option<ReadAttribute> {
    Some(match value {
        NcAttrValue::Chars(text) => ReadAttribute::Text(text.clone()),
        NcAttrValue::Strings(texts) => ReadAttribute::Text(texts.first()?.clone()),
        NcAttrValue::UserDefined { .. } => return None,
        NcAttrValue::Bytes(list) => numbers(StoredType::I8, list),
        NcAttrValue::UBytes(list) => numbers(StoredType::U8, list),
        NcAttrValue::Shorts(list) => numbers(StoredType::I16, list),
        NcAttrValue::UShorts(list) => numbers(StoredType::U16, list),
        NcAttrValue::Ints(list) => numbers(StoredType::I32, list),
        NcAttrValue::UInts(list) => numbers(StoredType::U32, list),
        NcAttrValue::Int64s(list) => {
            ReadAttribute::Numbers(StoredType::I64, list.iter().map(|&n| n as f64).collect())
        }
        NcAttrValue::UInt64s(list) => {
            ReadAttribute::Numbers(StoredType::U64, list.iter().map(|&n| n as f64).collect())
        }
        NcAttrValue::Floats(list) => numbers(StoredType::F32, list),
        NcAttrValue::Doubles(list) => numbers(StoredType::F64, list),
    })
}

fn numbers<T: Copy + Into<f64>>(sample: StoredType, list: &[T]) -> ReadAttribute {
    ReadAttribute::Numbers(sample, list.iter().map(|&number| number.into()).collect())
}

/// The bytes of a file, for the crate.
struct HdfBytes<S> {
    source: Mutex<S>,
    length: u64,
}

impl<S: Read + Seek + Send> Storage for HdfBytes<S> {
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

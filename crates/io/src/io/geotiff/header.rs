//! The sizes in the first directory of a TIFF file, read before the decoder multiplies them.

use std::io::{Read, Seek, SeekFrom};

use super::super::Flaw;
use meshbrush_core::raster::is_raster_size;

const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
/// Most entries of a directory. Those of rasters have a few dozen.
const MOST_ENTRIES: u64 = 4096;

/// Checks the number of columns and rows, and leaves the source at its start.
///
/// # Errors
/// Fails when the source is not a TIFF file, is cut off, or has a picture that is too large for a raster.
pub(super) fn check(source: &mut (impl Read + Seek)) -> Result<(), Flaw> {
    let mut header = Header { source, is_big_endian: false };
    let sizes = header.sizes()?;
    // A damaged file may have a tag twice: then the largest size counts.
    let largest = |of: u16| {
        let of_tag = sizes.iter().filter(|(tag, _)| *tag == of).map(|&(_, value)| value);
        of_tag.max().unwrap_or(1)
    };
    let [columns, rows] = [largest(WIDTH), largest(HEIGHT)];
    if !is_raster_size([columns, rows].map(|side| u32::try_from(side).unwrap_or(u32::MAX))) {
        return Err(Flaw::Size { columns, rows });
    }
    header.source.seek(SeekFrom::Start(0))?;
    Ok(())
}

struct Header<'a, R> {
    source: &'a mut R,
    is_big_endian: bool,
}

impl<R: Read + Seek> Header<'_, R> {
    /// Returns every width and height in the first directory, with its tag.
    fn sizes(&mut self) -> Result<Vec<(u16, u64)>, Flaw> {
        self.source.seek(SeekFrom::Start(0))?;
        self.is_big_endian = match &self.bytes::<2>()? {
            b"II" => false,
            b"MM" => true,
            _ => return Err(Flaw::Tiff("it begins with other bytes".into())),
        };
        let is_big = match self.number(2)? {
            42 => false,
            43 => true,
            _ => return Err(Flaw::Tiff("it begins with other bytes".into())),
        };
        if is_big {
            self.number(4)?;
        }
        let directory = self.number(if is_big { 8 } else { 4 })?;
        // Beyond what the system can address.
        self.source.seek(SeekFrom::Start(directory)).map_err(|_| Flaw::CutOff)?;
        let count = self.number(if is_big { 8 } else { 2 })?;
        if count > MOST_ENTRIES {
            return Err(Flaw::Tiff(format!("its directory has {count} entries")));
        }
        let mut sizes = Vec::new();
        for _ in 0..count {
            let tag = self.number(2)? as u16;
            let kind = self.number(2)?;
            self.number(if is_big { 8 } else { 4 })?;
            let value = self.bytes::<4>()?;
            let value = if is_big { [value, self.bytes::<4>()?].concat() } else { value.to_vec() };
            if tag == WIDTH || tag == HEIGHT {
                sizes.push((tag, self.value(kind, &value)?));
            }
        }
        Ok(sizes)
    }

    /// Returns a whole number of the given type in the place of a value.
    fn value(&self, kind: u64, bytes: &[u8]) -> Result<u64, Flaw> {
        let length = match kind {
            1 => 1,
            3 => 2,
            4 => 4,
            16 if bytes.len() == 8 => 8,
            _ => return Err(Flaw::Tiff("its width or height is not a whole number".into())),
        };
        Ok(self.whole(&bytes[..length]))
    }

    fn number(&mut self, length: usize) -> Result<u64, Flaw> {
        let bytes = match length {
            2 => self.bytes::<2>()?.to_vec(),
            4 => self.bytes::<4>()?.to_vec(),
            _ => self.bytes::<8>()?.to_vec(),
        };
        Ok(self.whole(&bytes))
    }

    fn whole(&self, bytes: &[u8]) -> u64 {
        let add = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        if self.is_big_endian { bytes.iter().fold(0, add) } else { bytes.iter().rev().fold(0, add) }
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Flaw> {
        let mut bytes = [0; N];
        self.source.read_exact(&mut bytes).map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => Flaw::CutOff,
            _ => Flaw::Io(error),
        })?;
        Ok(bytes)
    }
}

//! The directories of a TIFF file: sizes, read before the decoder multiplies them, and what the pictures are.

use std::io::{self, Read, Seek, SeekFrom};

use super::super::Flaw;
use meshbrush_core::raster::is_raster_size;

const KIND_OF_PICTURE: u16 = 254;
const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const COLORS: u16 = 262;
/// The bit of `NewSubfileType` for a mask of another picture, and that for a picture of a lower resolution.
const IS_MASK: u64 = 4;
const IS_REDUCED: u64 = 1;
/// Most directories that are looked at. A picture has one for itself, for each overview, and their masks.
const MOST_DIRECTORIES: usize = 64;
/// Most entries of a directory. Those of rasters have a few dozen.
const MOST_ENTRIES: u64 = 4096;

/// What a directory says about its picture.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Directory {
    /// [columns, rows].
    size: [u64; 2],
    kind: u64,
    /// The number for what its colours are (`PhotometricInterpretation`), if it says it.
    pub(super) colors: Option<u64>,
    /// Where that number stands in the file, if it has 16 bits.
    colors_at: Option<u64>,
}

/// The directories of a file.
pub(super) struct Directories {
    /// That of the first picture, and those of the others.
    pub(super) first: Directory,
    others: Vec<Directory>,
    is_big_endian: bool,
}

/// Reads the directories, checks the number of columns and rows of the first picture, and leaves the source
/// at its start.
///
/// # Errors
/// Fails when the source is not a TIFF file, is cut off, or has a picture that is too large for a raster.
pub(super) fn directories(source: &mut (impl Read + Seek)) -> Result<Directories, Flaw> {
    let mut header = TiffHeader { source, is_big_endian: false, is_big: false };
    let start = header.start()?;
    let (first, mut next) = header.directory(start)?;
    let [columns, rows] = first.size;
    if !is_raster_size([columns, rows].map(|side| u32::try_from(side).unwrap_or(u32::MAX))) {
        return Err(Flaw::Size { columns, rows });
    }
    let mut others = Vec::new();
    while next != 0 && others.len() < MOST_DIRECTORIES {
        // What follows a damaged directory is not known.
        let Ok((directory, after)) = header.directory(next) else { break };
        others.push(directory);
        next = after;
    }
    header.source.seek(SeekFrom::Start(0))?;
    Ok(Directories { first, others, is_big_endian: header.is_big_endian })
}

impl Directories {
    /// Returns the number of the picture that is the mask of the first one, if there is one.
    pub(super) fn mask(&self) -> Option<usize> {
        let is_mask = |other: &Directory| {
            other.kind & (IS_MASK | IS_REDUCED) == IS_MASK && other.size == self.first.size
        };
        self.others.iter().position(is_mask).map(|place| place + 1)
    }
}

/// A TIFF file whose pictures say that their samples are grey, so that the decoder returns samples as they
/// are stored, and those of masks too.
pub(super) struct Colorless<R> {
    source: R,
    at: u64,
    /// Where the numbers for colours stand, and what is read there.
    grey: Vec<(u64, [u8; 2])>,
}

impl<R: Read + Seek> Colorless<R> {
    /// The source is at its start.
    pub(super) fn new(source: R, directories: &Directories) -> Self {
        let grey = if directories.is_big_endian { [0, 1] } else { [1, 0] };
        let places = directories.others.iter().chain([&directories.first]).filter_map(|of| of.colors_at);
        Self { source, at: 0, grey: places.map(|at| (at, grey)).collect() }
    }
}

impl<R: Read> Read for Colorless<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        for (start, bytes) in &self.grey {
            for (place, &byte) in (*start..).zip(bytes) {
                if let Some(offset) = place.checked_sub(self.at).filter(|&offset| offset < count as u64) {
                    buffer[offset as usize] = byte;
                }
            }
        }
        self.at += count as u64;
        Ok(count)
    }
}

impl<R: Seek> Seek for Colorless<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.source.seek(to)?;
        Ok(self.at)
    }
}

struct TiffHeader<'a, R> {
    source: &'a mut R,
    is_big_endian: bool,
    /// Whether it is a BigTIFF.
    is_big: bool,
}

impl<R: Read + Seek> TiffHeader<'_, R> {
    /// Returns where the first directory is.
    fn start(&mut self) -> Result<u64, Flaw> {
        self.source.seek(SeekFrom::Start(0))?;
        self.is_big_endian = match &self.bytes::<2>()? {
            b"II" => false,
            b"MM" => true,
            _ => return Err(Flaw::Tiff("it begins with other bytes".into())),
        };
        self.is_big = match self.number(2)? {
            42 => false,
            43 => true,
            _ => return Err(Flaw::Tiff("it begins with other bytes".into())),
        };
        if self.is_big {
            self.number(4)?;
        }
        self.number(self.word())
    }

    /// The bytes of an offset in the file.
    fn word(&self) -> usize {
        if self.is_big { 8 } else { 4 }
    }

    /// Reads a directory. Returns where the next one is, 0 after the last.
    fn directory(&mut self, at: u64) -> Result<(Directory, u64), Flaw> {
        // Beyond what the system can address.
        self.source.seek(SeekFrom::Start(at)).map_err(|_| Flaw::CutOff)?;
        let count = self.number(if self.is_big { 8 } else { 2 })?;
        if count > MOST_ENTRIES {
            return Err(Flaw::Tiff(format!("its directory has {count} entries")));
        }
        let mut directory = Directory::default();
        let mut size = [None; 2];
        for n in 0..count {
            let tag = self.number(2)? as u16;
            let kind = self.number(2)?;
            self.number(self.word())?;
            let value = self.bytes::<4>()?;
            let value = if self.is_big { [value, self.bytes::<4>()?].concat() } else { value.to_vec() };
            match tag {
                // A damaged file may have a tag twice: then the largest size counts.
                WIDTH => size[0] = size[0].max(Some(self.value(kind, &value)?)),
                HEIGHT => size[1] = size[1].max(Some(self.value(kind, &value)?)),
                KIND_OF_PICTURE => directory.kind = self.value(kind, &value).unwrap_or(0),
                COLORS => {
                    directory.colors = self.value(kind, &value).ok();
                    let word = self.word() as u64;
                    let entries = at + if self.is_big { 8 } else { 2 };
                    directory.colors_at = (kind == 3).then_some(entries + n * (4 + 2 * word) + 4 + word);
                }
                _ => {}
            }
        }
        directory.size = size.map(|side| side.unwrap_or(1));
        let next = self.number(self.word()).unwrap_or(0);
        Ok((directory, next))
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

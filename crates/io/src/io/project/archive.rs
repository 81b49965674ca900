//! The container: a ZIP archive of a few parts, of the simplest kind, which every tool reads.
//!
//! Written are deflated entries with sizes and CRC-32 in the local header and without dates or extra fields,
//! so that equal parts give equal bytes. Read are also archives that other tools repacked (stored entries,
//! extra fields, another order), if they are not encrypted and below 4 GiB.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Read, Write};

use crc32fast::Hasher;
use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;

use super::super::{Flaw, Meter};
use super::limits::{Limits, Sizes, TooLarge};
use meshbrush_mesh::text::excerpt;

/// The bytes with which every archive begins.
pub const FIRST_BYTES: &[u8] = b"PK\x03\x04";
const LOCAL: u32 = u32::from_le_bytes(*b"PK\x03\x04");
const CENTRAL: u32 = u32::from_le_bytes(*b"PK\x01\x02");
const END: u32 = u32::from_le_bytes(*b"PK\x05\x06");
const END_BYTES: usize = 22;
const CENTRAL_BYTES: usize = 46;
const LOCAL_BYTES: usize = 30;
const DEFLATED: u16 = 8;
/// Bytes that are packed at once.
pub(super) const BUFFER: usize = 1 << 16;
/// 1 January 1980, the first date of the format.
const NO_DATE: u16 = 0x21;

/// A packed part.
#[derive(Debug)]
pub struct ArchivePart<'a> {
    packed: &'a [u8],
    method: u16,
    /// The number of unpacked bytes, as declared.
    size: u64,
    crc: u32,
}

/// The parts of an archive with their names.
#[derive(Debug, Default)]
pub struct Archive<'a>(BTreeMap<&'a str, ArchivePart<'a>>);

impl<'a> Archive<'a> {
    /// Reads the directory without unpacking anything.
    ///
    /// # Errors
    /// Fails when the bytes are not an archive, are cut off or damaged, or use features of the format that
    /// are not supported, and when a part declares more bytes than the limits allow.
    pub fn open(bytes: &'a [u8], limits: Limits) -> Result<Self, Flaw> {
        if !bytes.starts_with(FIRST_BYTES) {
            return Err(Flaw::Syntax(match bytes {
                [] => "the file is empty. Use another copy.".into(),
                _ => "this is not a Meshbrush project.".into(),
            }));
        }
        let end = bytes[end_record(bytes).ok_or(Flaw::CutOff)?..].as_ref();
        let (count, length, start) = (u16_at(end, 10)?, u32_at(end, 12)?, u32_at(end, 16)?);
        let (start, length) = (start as usize, length as usize);
        let directory = start.checked_add(length).and_then(|stop| bytes.get(start..stop));
        let mut rest = directory.ok_or(Flaw::Damaged)?;
        let (mut parts, mut sizes) = (BTreeMap::new(), Sizes::new(limits));
        for _ in 0..count {
            let (name, part, after) = entry(bytes, rest, start)?;
            sizes.add(name, part.size, part.packed.len() as u64).map_err(flaw)?;
            if parts.insert(name, part).is_some() {
                return Err(Flaw::Syntax(format!("there are two parts called {}.", excerpt(40, name))));
            }
            rest = after;
        }
        sizes.finish(bytes.len() as u64).map_err(flaw)?;
        // With a wrong count, parts that a project need not have would go unnoticed.
        if rest.is_empty() { Ok(Self(parts)) } else { Err(Flaw::Damaged) }
    }

    /// Returns the part with this name.
    pub fn part(&self, name: &str) -> Option<&ArchivePart<'a>> {
        self.0.get(name)
    }

    /// Takes out the parts that `choose` wants, in the order of their names, each with what it makes of the
    /// name.
    pub fn take_parts<T>(&mut self, choose: impl Fn(&str) -> Option<T>) -> Vec<(T, ArchivePart<'a>)> {
        let (mut taken, mut left) = (Vec::new(), BTreeMap::new());
        for (name, part) in std::mem::take(&mut self.0) {
            match choose(name) {
                Some(chosen) => taken.push((chosen, part)),
                None => _ = left.insert(name, part),
            }
        }
        self.0 = left;
        taken
    }

    /// Takes in the parts of another archive, in place of those with the same names.
    pub fn replace_parts(&mut self, other: Self) {
        self.0.extend(other.0);
    }
}

impl<'a> ArchivePart<'a> {
    /// Returns a reader that unpacks the part. The meter counts the packed bytes. Memory is allocated for
    /// what is read, not for what is declared.
    pub fn unpack(&self, meter: &Meter) -> Unpacking<'a> {
        let packed = meter.count(self.packed);
        let bytes: Box<dyn Read + 'a> = match self.method {
            DEFLATED => Box::new(DeflateDecoder::new(packed)),
            _ => Box::new(packed),
        };
        Unpacking { bytes, left: self.size, crc: Hasher::new(), expected: self.crc }
    }

    /// Returns all bytes of the part.
    ///
    /// # Errors
    /// Fails when the bytes are damaged.
    pub fn bytes(&self, meter: &Meter) -> Result<Vec<u8>, Flaw> {
        let mut unpacking = self.unpack(meter);
        let mut bytes = Vec::new();
        unpacking.read_to_end(&mut bytes).map_err(|_| Flaw::Damaged)?;
        unpacking.finish()?;
        Ok(bytes)
    }
}

/// Unpacks a part, and no more bytes than declared.
pub struct Unpacking<'a> {
    bytes: Box<dyn Read + 'a>,
    left: u64,
    crc: Hasher,
    expected: u32,
}

impl Read for Unpacking<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let most = self.left.min(buffer.len() as u64) as usize;
        let read = self.bytes.read(&mut buffer[..most])?;
        self.crc.update(&buffer[..read]);
        self.left -= read as u64;
        Ok(read)
    }
}

impl Unpacking<'_> {
    /// Returns the number of declared bytes that were not read yet.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Checks the part after its last byte.
    ///
    /// # Errors
    /// Fails when bytes are left, or the checksum does not match.
    pub fn finish(mut self) -> Result<(), Flaw> {
        if self.left > 0 {
            return Err(Flaw::Syntax(format!("it has {} bytes more than its values take.", self.left)));
        }
        let surplus = self.bytes.read(&mut [0]).map_err(|_| Flaw::Damaged)?;
        let valid = self.left == 0 && surplus == 0 && self.crc.finalize() == self.expected;
        if valid { Ok(()) } else { Err(Flaw::Damaged) }
    }
}

/// Returns the position of the end record, whose comment must end exactly at the end of the file.
fn end_record(bytes: &[u8]) -> Option<usize> {
    let last = bytes.len().checked_sub(END_BYTES)?;
    let first = last.saturating_sub(usize::from(u16::MAX));
    (first..=last).rev().find(|&at| {
        u32_at(bytes, at).is_ok_and(|signature| signature == END)
            && u16_at(bytes, at + 20)
                .is_ok_and(|comment| at + END_BYTES + usize::from(comment) == bytes.len())
    })
}

/// Reads one entry of the directory: its name, its part, and the rest of the directory.
fn entry<'a>(
    bytes: &'a [u8],
    directory: &'a [u8],
    end: usize,
) -> Result<(&'a str, ArchivePart<'a>, &'a [u8]), Flaw> {
    if u32_at(directory, 0)? != CENTRAL {
        return Err(Flaw::Damaged);
    }
    let (flags, method) = (u16_at(directory, 8)?, u16_at(directory, 10)?);
    let (crc, packed, size) = (u32_at(directory, 16)?, u32_at(directory, 20)?, u32_at(directory, 24)?);
    let lengths = [28, 30, 32].map(|at| u16_at(directory, at).map(usize::from));
    let [name_length, extra, comment] = lengths;
    let (name_length, extra, comment) = (name_length?, extra?, comment?);
    let start = u32_at(directory, 42)? as usize;
    let name = directory.get(CENTRAL_BYTES..CENTRAL_BYTES + name_length).ok_or(Flaw::Damaged)?;
    let after = directory.get(CENTRAL_BYTES + name_length + extra + comment..).ok_or(Flaw::Damaged)?;
    let text = str::from_utf8(name).map_err(|_| Flaw::Damaged)?;
    if flags & 1 != 0 || !matches!(method, 0 | DEFLATED) || [packed, size].contains(&u32::MAX) {
        return Err(Flaw::Syntax(format!(
            "\"{}\" in it is encrypted or packed with a method that projects do not use. Pack it again without encryption.",
            excerpt(40, text)
        )));
    }
    let local = bytes.get(start..end).ok_or(Flaw::Damaged)?;
    let name_there = local.get(LOCAL_BYTES..LOCAL_BYTES + usize::from(u16_at(local, 26)?));
    if u32_at(local, 0)? != LOCAL || name_there != Some(name) {
        return Err(Flaw::Damaged);
    }
    let data = LOCAL_BYTES + name_length + usize::from(u16_at(local, 28)?);
    let packed = local.get(data..data + packed as usize).ok_or(Flaw::Damaged)?;
    Ok((text, ArchivePart { packed, method, size: u64::from(size), crc }, after))
}

fn flaw(problem: TooLarge) -> Flaw {
    Flaw::Syntax(format!("{problem}."))
}

impl From<TooLarge> for io::Error {
    fn from(problem: TooLarge) -> Self {
        Self::other(problem)
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Result<u16, Flaw> {
    bytes.get(at..).and_then(|rest| rest.first_chunk()).map(|b| u16::from_le_bytes(*b)).ok_or(Flaw::Damaged)
}

fn u32_at(bytes: &[u8], at: usize) -> Result<u32, Flaw> {
    bytes.get(at..).and_then(|rest| rest.first_chunk()).map(|b| u32::from_le_bytes(*b)).ok_or(Flaw::Damaged)
}

/// Writes an archive part by part.
pub struct ArchiveWriter<W> {
    out: W,
    written: u32,
    directory: Vec<u8>,
    count: u16,
    sizes: Sizes,
}

impl<W: Write> ArchiveWriter<W> {
    /// Creates an archive without parts, which will not pass the limits.
    pub fn new(out: W, limits: Limits) -> Self {
        Self { out, written: 0, directory: Vec::new(), count: 0, sizes: Sizes::new(limits) }
    }

    /// Adds a part. The meter counts its bytes before packing.
    ///
    /// # Errors
    /// Fails with the errors of the output and of `write`, when the archive would pass a limit, and when the
    /// work was cancelled.
    pub fn add(
        &mut self,
        name: &str,
        meter: &Meter,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut packing = Packing::new();
        // Texts come in pieces of a few bytes, and the packer takes a microsecond for each piece.
        let mut buffered = BufWriter::with_capacity(BUFFER, meter.count(&mut packing));
        write(&mut buffered)?;
        buffered.flush()?;
        drop(buffered);
        self.add_packed(name, packing)
    }

    /// Adds a part that was packed.
    ///
    /// # Errors
    /// Fails with the errors of the output, and when the archive would pass a limit.
    pub fn add_packed(&mut self, name: &str, packing: Packing) -> io::Result<()> {
        let (packed, size, crc) = packing.finish()?;
        self.sizes.add(name, size, packed.len() as u64)?;
        let (packed_size, size) = (small(packed.len() as u64)?, small(size)?);
        // The fields from "version needed" to "length of extra fields" are the same in both headers. Bit 11:
        // the name is UTF-8.
        let mut common = Vec::new();
        for word in [20, 1 << 11, DEFLATED, 0, NO_DATE] {
            common.extend(u16::to_le_bytes(word));
        }
        for word in [crc, packed_size, size] {
            common.extend(word.to_le_bytes());
        }
        common.extend((name.len() as u16).to_le_bytes());
        common.extend(0u16.to_le_bytes());
        let local = [&LOCAL.to_le_bytes(), &common[..], name.as_bytes()].concat();
        self.directory.extend([&CENTRAL.to_le_bytes()[..], &20u16.to_le_bytes(), &common].concat());
        self.directory.extend([0; 10]);
        self.directory.extend(self.written.to_le_bytes());
        self.directory.extend(name.as_bytes());
        self.out.write_all(&local)?;
        self.out.write_all(&packed)?;
        self.written = small(u64::from(self.written) + (local.len() + packed.len()) as u64)?;
        self.count += 1;
        Ok(())
    }

    /// Writes the directory, which completes the archive.
    ///
    /// # Errors
    /// Fails with the errors of the output, and when the archive would pass a limit.
    pub fn finish(mut self) -> io::Result<W> {
        self.sizes.finish(u64::from(self.written) + (self.directory.len() + END_BYTES) as u64)?;
        let mut end = END.to_le_bytes().to_vec();
        for word in [0, 0, self.count, self.count] {
            end.extend(word.to_le_bytes());
        }
        end.extend(small(self.directory.len() as u64)?.to_le_bytes());
        end.extend(self.written.to_le_bytes());
        end.extend([0; 2]);
        self.out.write_all(&self.directory)?;
        self.out.write_all(&end)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

fn small(bytes: u64) -> io::Result<u32> {
    u32::try_from(bytes)
        .ok()
        .filter(|&n| n < u32::MAX)
        .ok_or_else(|| io::Error::other("it would be larger than 4 GiB"))
}

/// Packs the bytes of a part.
pub struct Packing {
    packed: DeflateEncoder<Vec<u8>>,
    crc: Hasher,
    size: u64,
}

impl Packing {
    /// Creates a part without bytes.
    pub fn new() -> Self {
        Self::by(Compression::new(4))
    }

    /// Creates a part that is packed in less time, into more bytes.
    pub fn quick() -> Self {
        Self::by(Compression::fast())
    }

    fn by(level: Compression) -> Self {
        Self { packed: DeflateEncoder::new(Vec::new(), level), crc: Hasher::new(), size: 0 }
    }

    /// Returns the packed bytes, and the number and CRC-32 of the bytes before packing.
    fn finish(self) -> io::Result<(Vec<u8>, u64, u32)> {
        Ok((self.packed.finish()?, self.size, self.crc.finalize()))
    }
}

impl Write for Packing {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.packed.write_all(bytes)?;
        self.crc.update(bytes);
        self.size += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

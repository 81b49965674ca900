//! A stamp of the contents of a file, to find out whether another program changed it.

use std::io::{self, Read, Write};
use std::path::Path;

use super::Meter;
use super::disk::{self, File};

/// The number of bytes of a file, and their CRC-32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    bytes: u64,
    checksum: u32,
}

impl FileStamp {
    /// Returns the stamp of these bytes.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, checksum: crc32fast::hash(bytes) }
    }

    /// Returns the stamp of a file on the disk; `None` if there is no such file, or it is not a regular file.
    ///
    /// # Errors
    /// Fails with the errors of the file system, and when the work was cancelled.
    pub fn from_file(path: &Path, meter: &Meter) -> io::Result<Option<Self>> {
        if !disk::is_file(path) {
            return Ok(None);
        }
        let (mut file, mut stamping) = (File::open(path)?, Stamping::new(io::sink()));
        let mut buffer = vec![0; 1 << 16];
        loop {
            meter.check()?;
            match file.read(&mut buffer)? {
                0 => return Ok(Some(stamping.stamp())),
                count => stamping.write_all(&buffer[..count])?,
            }
        }
    }
}

/// Passes bytes on, and takes their stamp.
pub struct Stamping<W> {
    out: W,
    bytes: u64,
    checksum: crc32fast::Hasher,
}

impl<W: Write> Stamping<W> {
    /// Returns counts and checks the bytes that are written to `out`, from none on.
    pub fn new(out: W) -> Self {
        Self { out, bytes: 0, checksum: crc32fast::Hasher::new() }
    }

    /// Returns the stamp of all bytes so far.
    pub fn stamp(&self) -> FileStamp {
        FileStamp { bytes: self.bytes, checksum: self.checksum.clone().finalize() }
    }
}

impl<W: Write> Write for Stamping<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.checksum.update(&bytes[..count]);
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

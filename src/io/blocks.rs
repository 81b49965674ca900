//! A compressed array as VTK stores it: blocks that are compressed independently, after a table of their
//! sizes.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::Meter;

/// Bytes of a block before compression. Larger blocks compress hardly better.
pub const BLOCK: usize = 1 << 18;

/// Compresses the bytes of an array block by block, with one block in memory at a time.
///
/// The meter counts the bytes before compression. The same bytes always give the same blocks: a first pass
/// can measure them, and a second pass writes them.
pub struct Blocks<'a, F> {
    meter: &'a Meter,
    raw: Vec<u8>,
    compressed: Vec<u8>,
    take: F,
}

impl<'a, F: FnMut(&[u8]) -> io::Result<()>> Blocks<'a, F> {
    /// Compresses into `take`, which receives one compressed block after the other.
    pub fn new(meter: &'a Meter, take: F) -> Self {
        Self { meter, raw: Vec::with_capacity(BLOCK), compressed: Vec::new(), take }
    }

    /// Compresses the rest as the last block.
    ///
    /// # Errors
    /// Errors of `take`, and when the work was cancelled.
    pub fn finish(mut self) -> io::Result<()> {
        if self.raw.is_empty() { Ok(()) } else { self.compress_block() }
    }

    fn compress_block(&mut self) -> io::Result<()> {
        // Higher levels take several times as long for files a tenth smaller.
        let mut encoder = ZlibEncoder::new(std::mem::take(&mut self.compressed), Compression::fast());
        encoder.write_all(&self.raw)?;
        self.compressed = encoder.finish()?;
        (self.take)(&self.compressed)?;
        self.meter.add(self.raw.len() as u64)?;
        self.raw.clear();
        self.compressed.clear();
        Ok(())
    }
}

impl<F: FnMut(&[u8]) -> io::Result<()>> Write for Blocks<'_, F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(BLOCK - self.raw.len());
        self.raw.extend_from_slice(&bytes[..taken]);
        if self.raw.len() == BLOCK {
            self.compress_block()?;
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

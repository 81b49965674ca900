//! VTK's way to store a compressed array: blocks, each compressed by itself, after a table of their sizes.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::Meter;

/// Bytes of a block before compression. A larger one compresses hardly better.
pub const BLOCK: usize = 1 << 18;

/// Takes the bytes of an array and hands on one compressed block after another, so that memory holds one block only.
///
/// The meter counts the bytes of the array and not what is handed on: the first pass takes as long as the second.
///
/// The same bytes always give the same blocks: what is counted in one pass can be announced and then written in another.
pub struct Blocks<'a, F> {
    meter: &'a Meter,
    raw: Vec<u8>,
    compressed: Vec<u8>,
    take: F,
}

impl<'a, F: FnMut(&[u8]) -> io::Result<()>> Blocks<'a, F> {
    /// `take` gets each compressed block.
    pub fn new(meter: &'a Meter, take: F) -> Self {
        Self { meter, raw: Vec::with_capacity(BLOCK), compressed: Vec::new(), take }
    }

    /// Hands on what is left in the last block.
    ///
    /// # Errors
    /// Those of `take`, and when the work was cancelled.
    pub fn finish(mut self) -> io::Result<()> {
        if self.raw.is_empty() { Ok(()) } else { self.hand_on() }
    }

    fn hand_on(&mut self) -> io::Result<()> {
        // Quick: the higher levels take several times as long for a tenth less.
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
            self.hand_on()?;
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

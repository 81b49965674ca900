//! A compressed array as VTK stores it: blocks that are compressed independently, after a table of their
//! sizes.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::Meter;

/// Bytes of a block before compression. Larger blocks compress hardly better.
pub const BLOCK: usize = 1 << 18;

/// Compresses the bytes of an array block by block, a block for each thread at a time.
///
/// The meter counts the bytes before compression. The same bytes always give the same blocks: a first pass
/// can measure them, and a second pass writes them.
pub struct Blocks<'a, F> {
    meter: &'a Meter,
    /// Blocks that are full, and one that is being filled.
    blocks: Vec<CompressedBlock>,
    /// The one that is being filled.
    current: usize,
    take: F,
}

#[derive(Clone, Default)]
struct CompressedBlock {
    raw: Vec<u8>,
    compressed: Vec<u8>,
}

impl CompressedBlock {
    fn compress(&mut self) -> io::Result<()> {
        self.compressed.clear();
        // Higher levels take several times as long for files a tenth smaller.
        let mut encoder = ZlibEncoder::new(std::mem::take(&mut self.compressed), Compression::fast());
        encoder.write_all(&self.raw)?;
        self.compressed = encoder.finish()?;
        Ok(())
    }
}

impl<'a, F: FnMut(&[u8]) -> io::Result<()>> Blocks<'a, F> {
    /// Compresses into `take`, which receives one compressed block after the other.
    pub fn new(meter: &'a Meter, take: F) -> Self {
        Self {
            meter,
            blocks: vec![CompressedBlock::default(); rayon::current_num_threads()],
            current: 0,
            take,
        }
    }

    /// Compresses the rest, the last block maybe shorter.
    ///
    /// # Errors
    /// Fails with the errors of `take`, and when the work was cancelled.
    pub fn finish(mut self) -> io::Result<()> {
        self.compress_blocks()
    }

    fn compress_blocks(&mut self) -> io::Result<()> {
        let is_begun = self.blocks.get(self.current).is_some_and(|block| !block.raw.is_empty());
        let begun = &mut self.blocks[..self.current + usize::from(is_begun)];
        begun.par_iter_mut().try_for_each(CompressedBlock::compress)?;
        for block in begun {
            (self.take)(&block.compressed)?;
            self.meter.add(block.raw.len() as u64)?;
            block.raw.clear();
        }
        self.current = 0;
        Ok(())
    }
}

impl<F: FnMut(&[u8]) -> io::Result<()>> Write for Blocks<'_, F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let raw = &mut self.blocks[self.current].raw;
        let taken = bytes.len().min(BLOCK - raw.len());
        raw.extend_from_slice(&bytes[..taken]);
        if raw.len() == BLOCK {
            self.current += 1;
            if self.current == self.blocks.len() {
                self.compress_blocks()?;
            }
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

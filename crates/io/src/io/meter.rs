use std::io::{self, Read, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Bytes between two checks of a meter: often enough for a person, rare enough to cost nothing.
const BLOCK: u64 = 1 << 16;

/// Counts the progress of work on a file, and cancels it.
///
/// Clones share one state: one thread works with a clone, another reads or cancels it. The meter counts bytes
/// of a file, or bytes before compression; in both cases the work is complete when the expected number is
/// done.
#[derive(Clone, Debug, Default)]
pub struct Meter(Arc<Readings>);

#[derive(Debug, Default)]
struct Readings {
    done: AtomicU64,
    /// 0 if it is not known.
    total: AtomicU64,
    cancelled: Arc<AtomicBool>,
}

/// The work was cancelled before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it was cancelled")]
pub struct Cancelled;

impl From<Cancelled> for io::Error {
    fn from(cancelled: Cancelled) -> Self {
        // Not `Interrupted`: std repeats calls that fail with it.
        Self::other(cancelled)
    }
}

impl Meter {
    /// Returns a meter that is cancelled by this flag, as by a signal.
    pub fn cancelled_by(flag: Arc<AtomicBool>) -> Self {
        Self(Arc::new(Readings { cancelled: flag, ..Readings::default() }))
    }

    /// Cancels the work: it ends at its next check.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work was cancelled. It may still complete, if it was cancelled after the last
    /// check.
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }

    /// Call this between the steps of long work.
    ///
    /// # Errors
    /// Fails when the work was cancelled.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Begins to count the bytes of a file, and sets their number.
    pub fn expect(&self, bytes: u64) {
        self.0.done.store(0, Ordering::Relaxed);
        self.0.total.store(bytes, Ordering::Relaxed);
    }

    /// Adds to the number of bytes done.
    ///
    /// # Errors
    /// Fails when the work was cancelled.
    pub fn add(&self, bytes: u64) -> Result<(), Cancelled> {
        self.0.done.fetch_add(bytes, Ordering::Relaxed);
        self.check()
    }

    /// Returns the number of bytes done.
    pub fn done(&self) -> u64 {
        self.0.done.load(Ordering::Relaxed)
    }

    /// Returns the number of bytes in all, if it is known.
    pub fn total(&self) -> Option<u64> {
        Some(self.0.total.load(Ordering::Relaxed)).filter(|&total| total > 0)
    }

    /// Wraps an input or output to count its bytes.
    pub fn count<T>(&self, inner: T) -> Counted<T> {
        Counted { inner, meter: self.clone(), uncounted: 0, begun: false }
    }
}

/// An input or an output whose bytes a [`Meter`] counts.
///
/// Once the work is cancelled, it fails with [`Cancelled`] as an [`io::Error`]: at the first call, when it is
/// flushed, and otherwise within 64 KiB.
#[derive(Debug)]
pub struct Counted<T> {
    inner: T,
    meter: Meter,
    /// Bytes not yet added to the meter.
    uncounted: u64,
    begun: bool,
}

impl<T> Counted<T> {
    /// Updates and checks the meter before the first byte and after each block.
    fn check(&mut self) -> io::Result<()> {
        if self.uncounted < BLOCK && std::mem::replace(&mut self.begun, true) {
            return Ok(());
        }
        Ok(self.meter.add(std::mem::take(&mut self.uncounted))?)
    }
}

impl<T> Drop for Counted<T> {
    fn drop(&mut self) {
        // Ignored: the work is over, and a later check reports that it was cancelled.
        let _ = self.meter.add(self.uncounted);
    }
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.check()?;
        let read = self.inner.read(buffer)?;
        self.uncounted += read as u64;
        Ok(read)
    }
}

impl<S: Seek> Seek for Counted<S> {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.inner.seek(position)
    }
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.check()?;
        let written = self.inner.write(bytes)?;
        self.uncounted += written as u64;
        Ok(written)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.check()?;
        self.inner.write_all(bytes)?;
        self.uncounted += bytes.len() as u64;
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.meter.add(std::mem::take(&mut self.uncounted))?;
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Several blocks and a part of one.
    const BYTES: usize = 5 * BLOCK as usize + 77;

    #[test]
    fn every_byte_read_or_written_is_counted_once() {
        let meter = Meter::default();
        meter.expect(2 * BYTES as u64);
        let mut out = meter.count(Vec::new());
        for piece in [7u8; BYTES].chunks(1000) {
            out.write_all(piece).unwrap();
        }
        drop(out);
        assert_eq!(meter.done(), BYTES as u64);
        let mut back = Vec::new();
        meter.count(&[7u8; BYTES][..]).read_to_end(&mut back).unwrap();
        assert_eq!(back, [7u8; BYTES]);
        assert_eq!((meter.done(), meter.total()), (2 * BYTES as u64, Some(2 * BYTES as u64)));
        assert_eq!(Meter::default().total(), None);
    }

    #[test]
    fn cancelled_work_does_not_begin_and_ends_within_a_block() {
        let meter = Meter::default();
        let mut out = meter.count(Vec::new());
        let mut input = meter.count(io::repeat(1));
        let mut bytes = [0; 1000];
        out.write_all(&bytes).unwrap();
        input.read_exact(&mut bytes).unwrap();
        meter.clone().cancel();
        assert!(meter.count(io::sink()).write_all(b"x").is_err());
        assert!(meter.count(io::empty()).read(&mut bytes).is_err());
        assert!(out.flush().is_err());
        let most = BLOCK as usize / bytes.len() + 1;
        let written = (0..).take_while(|_| out.write_all(&bytes).is_ok()).take(most + 1).count();
        let read = (0..).take_while(|_| input.read_exact(&mut bytes).is_ok()).take(most + 1).count();
        assert!(written <= most && read <= most, "{written} {read}");
    }

    #[test]
    fn the_error_says_that_the_work_was_cancelled_and_std_does_not_retry() {
        let meter = Meter::default();
        meter.cancel();
        let mut all = Vec::new();
        // After `Interrupted`, `read_to_end` would never end.
        let error = meter.count(io::repeat(1)).read_to_end(&mut all).unwrap_err();
        assert_eq!(error.to_string(), "it was cancelled");
        assert!(error.get_ref().is_some_and(|inner| inner.is::<Cancelled>()));
    }
}

//! Signals that end the program. While files are written, they first cancel the writing, so that no part of a
//! file is left behind.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use super::Meter;

/// Listens for the signals that end a program. Each kind is heard once: a second signal of the same kind ends
/// the program at once.
#[derive(Default)]
pub struct Interruption {
    cancelled: Arc<AtomicBool>,
    signal: Arc<AtomicUsize>,
}

impl Interruption {
    /// Begins to listen. A signal that this process ignores, for example because of `nohup`, stays ignored.
    ///
    /// # Errors
    /// Fails when the operating system refuses.
    #[cfg(unix)]
    pub fn listen() -> io::Result<Self> {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        use signal_hook::flag;

        let own = Self::default();
        for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal)) {
            // The first action finds the flag of an earlier signal; the others set it.
            flag::register_conditional_default(signal, own.cancelled.clone())?;
            flag::register(signal, own.cancelled.clone())?;
            flag::register_usize(signal, own.signal.clone(), signal.unsigned_abs() as usize)?;
        }
        Ok(own)
    }

    /// On other systems, the system ends the program at once.
    #[cfg(not(unix))]
    pub fn listen() -> io::Result<Self> {
        Ok(Self::default())
    }

    /// Returns a meter that a signal cancels.
    pub fn meter(&self) -> Meter {
        Meter::cancelled_by(self.cancelled.clone())
    }

    /// Ends the program as the signal would have, if one came.
    pub fn end_program(&self) {
        let signal = self.signal.load(Ordering::Relaxed);
        #[cfg(unix)]
        if signal != 0 {
            // It returns only for a signal that ends nothing.
            let _ = signal_hook::low_level::emulate_default_handler(signal as i32);
        }
        #[cfg(not(unix))]
        let _ = signal;
    }
}

/// Returns whether the process ignores a signal; the kernel shows this on Linux only.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

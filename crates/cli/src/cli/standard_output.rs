//! Standard output, also where the program was started without one: Rust opens the null device in its place,
//! and what is printed would vanish without a word.

use std::io::{self, StdoutLock, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the program was started without a standard output.
static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Looks before `main`, and before Rust opens the null device.
#[cfg(unix)]
#[used]
#[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__mod_init_func"))]
#[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".init_array"))]
#[allow(
    unsafe_code,
    reason = "SAFETY: the section lists functions that are called before `main`; this one only asks the \
                               system for the flags of a descriptor"
)]
static LOOK: extern "C" fn() = {
    extern "C" fn look() {
        let is_open = rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_ok();
        IS_CLOSED.store(!is_open, Ordering::Relaxed);
    }
    look
};

/// Fails where standard output is closed.
///
/// # Errors
/// Fails with a sentence.
pub fn check() -> io::Result<()> {
    match IS_CLOSED.load(Ordering::Relaxed) {
        true => Err(io::Error::other("standard output is closed")),
        false => Ok(()),
    }
}

/// Standard output, which fails where it is closed.
pub struct StandardOutput(StdoutLock<'static>);

impl StandardOutput {
    /// Locks it.
    pub fn lock() -> Self {
        Self(io::stdout().lock())
    }
}

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        check()?;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

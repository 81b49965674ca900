//! Named pipes, where files are expected: the program at the other end is waited for, but not forever.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;
use std::time::Duration;

/// How long a pipe is waited for whose writer has not come. Who names a pipe has usually started it before.
const WAIT_FOR_WRITER: Duration = Duration::from_secs(1);
/// How long a pipe is waited for whose reader has not come. It may be started last, once there is something
/// to read.
const WAIT_FOR_READER: Duration = Duration::from_secs(30);

/// Opens a named pipe for reading.
///
/// # Errors
/// Fails with the errors of the file system, and if nobody opens the pipe for writing within 1 s.
pub(super) fn open_to_read(path: &Path) -> io::Result<File> {
    let nobody = "nobody writes to this pipe; start its writer first";
    open_within(WAIT_FOR_WRITER, path, File::options().read(true), File::options().write(true), nobody)
}

/// Opens a named pipe for writing.
///
/// # Errors
/// Fails with the errors of the file system, and if nobody opens the pipe for reading within 30 s.
pub(super) fn open_to_write(path: &Path) -> io::Result<File> {
    let nobody = "nobody reads this pipe; start its reader first";
    open_within(WAIT_FOR_READER, path, File::options().write(true), File::options().read(true), nobody)
}

/// Opens one end of a pipe on a thread of its own, for to open waits for the other end. If nobody has opened
/// that within `wait`, this opens it, so that the thread ends.
#[cfg(unix)]
fn open_within(
    wait: Duration,
    path: &Path,
    end: &mut OpenOptions,
    other_end: &mut OpenOptions,
    nobody: &str,
) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt as _;
    use std::sync::mpsc;

    let (opened, result) = mpsc::channel();
    let (end, of_thread) = (end.clone(), path.to_owned());
    std::thread::Builder::new().name("pipe".to_owned()).spawn(move || opened.send(end.open(of_thread)))?;
    result.recv_timeout(wait).unwrap_or_else(|_| {
        drop(other_end.custom_flags(libc::O_NONBLOCK).open(path));
        Err(io::Error::other(nobody.to_owned()))
    })
}

#[cfg(not(unix))]
fn open_within(
    _: Duration,
    path: &Path,
    end: &mut OpenOptions,
    _: &mut OpenOptions,
    _: &str,
) -> io::Result<File> {
    end.open(path)
}

//! The files that are read and written: those of the system, or in a browser, whose pages have none, files
//! that are kept in memory.
//!
//! A page keeps files there that a person gave it, and hands on those that were written. All names are in one
//! folder, so a recipe finds its rasters.

use std::collections::BTreeMap;
use std::fs::FileType;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::pipe;

/// Files in memory, in one folder.
#[derive(Debug, Default)]
struct Folder {
    files: BTreeMap<PathBuf, Arc<[u8]>>,
    /// Those that writers wrote, until [`take_written`] is called.
    written: Vec<PathBuf>,
}

/// The files in memory, where all files are there.
static FOLDER: Mutex<Option<Folder>> = Mutex::new(None);

fn folder() -> MutexGuard<'static, Option<Folder>> {
    FOLDER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps all files in memory from now on, instead of on the disk.
pub fn keep_in_memory() {
    folder().get_or_insert_default();
}

/// Returns whether all files are in memory.
pub fn is_in_memory() -> bool {
    folder().is_some()
}

/// Puts a file into memory, where files are kept there.
pub fn put(path: &Path, bytes: Vec<u8>) {
    if let Some(folder) = &mut *folder() {
        folder.files.insert(path.to_owned(), bytes.into());
    }
}

/// Puts a file into memory that a writer wrote.
pub(super) fn put_written(path: &Path, bytes: Vec<u8>) {
    put(path, bytes);
    if let Some(folder) = &mut *folder() {
        folder.written.push(path.to_owned());
    }
}

/// Removes a file from memory.
pub(super) fn remove(path: &Path) {
    if let Some(folder) = &mut *folder() {
        folder.files.remove(path);
    }
}

/// Returns the contents of a file in memory.
pub fn contents(path: &Path) -> Option<Arc<[u8]>> {
    folder().as_ref()?.files.get(path).cloned()
}

/// Returns the files in memory that were written since the last call, with their contents.
pub fn take_written() -> Vec<(PathBuf, Arc<[u8]>)> {
    let mut folder = folder();
    let Some(folder) = &mut *folder else { return Vec::new() };
    let written = std::mem::take(&mut folder.written);
    let with_contents = |path: PathBuf| Some((path.clone(), folder.files.get(&path)?.clone()));
    written.into_iter().filter_map(with_contents).collect()
}

/// Returns the names of all files in memory, with their sizes in bytes; `None` where files are on the disk.
pub(super) fn names() -> Option<Vec<(PathBuf, u64)>> {
    let folder = folder();
    let files = &folder.as_ref()?.files;
    Some(files.iter().map(|(path, bytes)| (path.clone(), bytes.len() as u64)).collect())
}

/// Returns whether there is a regular file at a path.
pub(super) fn is_file(path: &Path) -> bool {
    find(path).unwrap_or(false)
}

/// Returns whether what is at a path is a regular file.
///
/// # Errors
/// Fails where nothing is there, and with the errors of the file system.
pub(super) fn find(path: &Path) -> io::Result<bool> {
    if is_in_memory() { in_memory(path).map(|_| true) } else { Ok(path.metadata()?.is_file()) }
}

/// Returns the contents of a file in memory.
fn in_memory(path: &Path) -> io::Result<Arc<[u8]>> {
    let missing = "it is not among the files that were opened; open it together with the file that needs it";
    contents(path).ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, missing))
}

/// A file that is read.
#[derive(Debug)]
pub enum File {
    /// On the disk.
    OnDisk(std::fs::File),
    /// In memory.
    InMemory(Cursor<Arc<[u8]>>),
}

impl File {
    /// Opens a file, or a pipe that somebody writes to.
    ///
    /// # Errors Fails with the errors of the file system, where there is no such file in memory, for a named
    /// pipe to which nobody writes, and for what is neither a file nor a pipe: to read it may never end.
    pub fn open(path: impl AsRef<Path>) -> io::Result<Self> {
        let path = path.as_ref();
        if is_in_memory() {
            return in_memory(path).map(Cursor::new).map(Self::InMemory);
        }
        let file = match std::fs::metadata(path)?.file_type() {
            kind if kind.is_file() || is_opened_pipe(path, kind) => std::fs::File::open(path),
            kind if is_pipe(kind) => pipe::open_to_read(path),
            kind if kind.is_dir() => Err(io::Error::other("it is a folder, and a file is expected")),
            _ => Err(io::Error::other("it is a device, and a file is expected")),
        };
        file.map(Self::OnDisk)
    }

    /// Returns the size of the file in bytes.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn length(&self) -> io::Result<u64> {
        match self {
            Self::OnDisk(file) => Ok(file.metadata()?.len()),
            Self::InMemory(bytes) => Ok(bytes.get_ref().len() as u64),
        }
    }
}

/// Returns the size of a file in bytes; 0 for one that cannot be opened.
pub fn bytes_of(path: &Path) -> u64 {
    File::open(path).and_then(|file| file.length()).unwrap_or(0)
}

/// Returns whether it is a pipe that is open already, as the input of the program and `<(command)` of a shell
/// are: to open it waits for nobody.
fn is_opened_pipe(path: &Path, kind: FileType) -> bool {
    is_pipe(kind) && ["/dev/stdin", "/dev/fd", "/proc"].iter().any(|place| path.starts_with(place))
}

/// Returns whether it is a pipe, with a name or without.
#[cfg(unix)]
pub(super) fn is_pipe(kind: FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&kind)
}

#[cfg(not(unix))]
pub(super) fn is_pipe(_: FileType) -> bool {
    false
}

impl Read for File {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::OnDisk(file) => file.read(buffer),
            Self::InMemory(bytes) => bytes.read(buffer),
        }
    }
}

impl Seek for File {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Self::OnDisk(file) => file.seek(to),
            Self::InMemory(bytes) => bytes.seek(to),
        }
    }
}

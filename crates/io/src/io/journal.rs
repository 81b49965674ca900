//! `.journal`: unsaved work, stored gesture by gesture in case the program crashes.
//!
//! Eight bytes of magic, then records:
//!
//! ```text
//! kind (1 byte) | seconds since 1970 (8) | length of the content (4) | CRC-32 of all the rest (4) | content
//! ```
//!
//! Numbers are little-endian. The first record is a whole project with its path. Then come the paint and
//! settings after each gesture that changed them, and a mark whenever nothing is unsaved. A raster or picture
//! is written once. Reading stops at the first incomplete record: the program ended while writing it.
//!
//! The program that writes a journal holds a lock on it, which the operating system releases when the program
//! ends in any way. So a journal without a lock was left behind.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::Meter;
use super::project::{self, PartNames, Project};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::PaintLayers;

const MAGIC: &[u8; 8] = b"MBJOUR02";
const HEAD: usize = 17;
const ENDING: &str = "journal";
/// The ending of a journal whose first record is not complete.
const PART: &str = "part";
/// Largest journal read: a little more than the largest project and its growth.
const MOST_BYTES: u64 = 5 << 30;
/// Growth after which a new journal would be smaller.
const MOST_GROWTH: u64 = 64 << 20;

const WHOLE: u8 = 1;
const PAINT: u8 = 2;
const CLEAN: u8 = 3;
const SETTINGS: u8 = 4;

/// A journal being written.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    grown: u64,
    /// The rasters and pictures that it has.
    names: PartNames,
}

impl Journal {
    /// Begins a journal in a folder, which is created if necessary. When this returns, the journal is
    /// complete and locked; it is on the disk after [`Syncing::wait`].
    ///
    /// `home` is the project's file, if it has one; `time` is in seconds since 1970.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn begin(folder: &Path, project: &Project, home: Option<&Path>, time: u64) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        // Locked before it gets the name by which journals are found.
        let (file, part) = new_file(folder)?;
        let path = part.with_extension(ENDING);
        let mut journal = Self { file, path, grown: 0, names: PartNames::default() };
        let mut begin = || -> io::Result<()> {
            let mut content = home_bytes(home);
            project::write_named(&mut content, project, &mut journal.names)?;
            journal.file.write_all(MAGIC)?;
            journal.append(WHOLE, time, &content)?;
            fs::rename(&part, &journal.path)
        };
        if let Err(error) = begin() {
            let _ = fs::remove_file(&part); // the first error is the one to report
            return Err(error);
        }
        journal.grown = 0;
        Ok(journal)
    }

    /// Adds the pixels that a gesture changed: the tiles in which the paint after it differs from that
    /// before it.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn add_paint(&mut self, before: &PaintLayers, after: &PaintLayers, time: u64) -> io::Result<()> {
        let mut content = Vec::new();
        project::write_paint_changes(&mut content, before, after)?;
        self.append(PAINT, time, &content)
    }

    /// Adds the settings after a gesture.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn add_settings(&mut self, settings: Settings, time: u64) -> io::Result<()> {
        let mut content = Vec::new();
        let project = Project { settings, paint: PaintLayers::default() };
        project::write_named(&mut content, &project, &mut self.names)?;
        self.append(SETTINGS, time, &content)
    }

    /// Marks that nothing is unsaved, and which file the project belongs to.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn mark_clean(&mut self, home: Option<&Path>, time: u64) -> io::Result<()> {
        self.append(CLEAN, time, &home_bytes(home))
    }

    /// Returns a handle to wait for the disk on another thread.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn syncing(&self) -> io::Result<Syncing> {
        self.file.try_clone().map(Syncing)
    }

    /// Returns whether so much was added that a new journal would be much smaller.
    pub fn is_long(&self) -> bool {
        self.grown > MOST_GROWTH
    }

    /// Deletes the journal.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(&self.path)
    }

    fn append(&mut self, kind: u8, time: u64, content: &[u8]) -> io::Result<()> {
        let length = u32::try_from(content.len()).map_err(io::Error::other)?;
        let mut record = vec![kind];
        record.extend(time.to_le_bytes());
        record.extend(length.to_le_bytes());
        record.extend(checksum(&record, content).to_le_bytes());
        record.extend(content);
        self.grown += record.len() as u64;
        // One call writes the record: bytes written before the program is killed belong to the system and are
        // not lost.
        self.file.write_all(&record)
    }
}

/// A journal whose bytes are being written to the disk.
#[derive(Debug)]
pub struct Syncing(File);

impl Syncing {
    /// Waits until everything added so far is on the disk, which can take seconds.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn wait(&self) -> io::Result<()> {
        self.0.sync_data()
    }
}

/// Creates and locks a file under a name that no other process uses.
fn new_file(folder: &Path) -> io::Result<(File, PathBuf)> {
    let mut n = 0;
    loop {
        let path = folder.join(format!("{}-{n}.{PART}", std::process::id()));
        n += 1;
        if path.with_extension(ENDING).exists() {
            continue;
        }
        match File::options().write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            opened => {
                let file = opened?;
                match file.try_lock() {
                    // Another window can take it for an abandoned one before it is locked, and remove it.
                    Ok(()) if path.exists() => return Ok((file, path)),
                    Ok(()) | Err(TryLockError::WouldBlock) => {}
                    Err(TryLockError::Error(error)) => {
                        let _ = fs::remove_file(&path); // the first error is the one to report
                        return Err(error);
                    }
                }
            }
        }
    }
}

fn checksum(head: &[u8], content: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(head);
    crc.update(content);
    crc.finalize()
}

/// Returns the length of a path and the path in UTF-8; empty without a path, or if it is not UTF-8.
fn home_bytes(home: Option<&Path>) -> Vec<u8> {
    let text = home.and_then(Path::to_str).unwrap_or_default();
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

/// Unsaved work that a program left behind. The journal is locked until this is dropped.
#[derive(Debug)]
pub struct Abandoned {
    /// The document after the last complete record.
    pub project: Project,
    /// The project's file, if it was ever saved.
    pub home: Option<PathBuf>,
    /// The time of that record, in seconds since 1970.
    pub time: u64,
    path: PathBuf,
    _lock: File,
}

impl Abandoned {
    /// Deletes the journal.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(&self.path)
    }
}

/// The contents of a journal that an earlier run left.
#[derive(Debug)]
pub enum Left {
    /// Unsaved work.
    Work(Box<Abandoned>),
    /// Work that cannot be read. The journal stays there.
    Unreadable {
        /// The journal.
        path: PathBuf,
        /// Why, as a sentence without its full stop.
        problem: String,
    },
}

/// Returns the contents of the journals of earlier runs in a folder, one journal at a time. Journals that a
/// running program has locked are skipped; journals without unsaved work are deleted.
pub fn left(folder: &Path) -> impl Iterator<Item = Left> + use<> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let has_ending = |path: &Path, wanted: &str| path.extension().is_some_and(|ending| ending == wanted);
    for part in paths.iter().filter(|path| has_ending(path, PART)) {
        if let Ok(Some(_lock)) = locked(part) {
            let _ = fs::remove_file(part); // the next start tries again
        }
    }
    paths.retain(|path| has_ending(path, ENDING));
    paths.into_iter().filter_map(|path| {
        let taken_over = taken_over(&path).transpose()?;
        Some(taken_over.map_or_else(|problem| Left::Unreadable { path, problem }, Left::Work))
    })
}

/// Opens a file and locks it; `None` if another program has locked it.
fn locked(path: &Path) -> io::Result<Option<File>> {
    // Some network disks lock only files that are open for writing.
    let file = File::options().read(true).write(true).open(path)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Returns the unsaved work of a journal, if it has any.
fn taken_over(path: &Path) -> Result<Option<Box<Abandoned>>, String> {
    let Some(file) = locked(path).map_err(|error| error.to_string())? else { return Ok(None) };
    let mut bytes = Vec::new();
    (&file).take(MOST_BYTES).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    let kept = Kept::parse(&bytes)?;
    if kept.clean {
        let _ = fs::remove_file(path); // the next start tries again
        return Ok(None);
    }
    let Kept { project, home, time, .. } = kept;
    Ok(Some(Box::new(Abandoned { project, home, time, path: path.to_owned(), _lock: file })))
}

/// The content of a journal.
struct Kept {
    project: Project,
    home: Option<PathBuf>,
    time: u64,
    clean: bool,
}

impl Kept {
    /// Combines all records up to the first incomplete one.
    ///
    /// # Errors
    /// Fails with the reason why the first record cannot be read, as a sentence without its full stop.
    fn parse(bytes: &[u8]) -> Result<Self, String> {
        let mut rest = bytes.strip_prefix(MAGIC).ok_or("another version of Meshbrush wrote it")?;
        let damaged = "its first record is damaged";
        let (kind, time, content) = next_record(&mut rest).ok_or(damaged)?;
        let (home, content) = split_home(content).filter(|_| kind == WHOLE).ok_or(damaged)?;
        let (mut names, meter) = (PartNames::default(), Meter::default());
        let project = project::parse_named(content, &mut names, &meter)
            .map_err(|flaw| flaw.flaw.to_string().trim_end_matches('.').to_owned())?;
        let mut kept = Self { project, home, time, clean: false };
        while let Some((kind, time, content)) = next_record(&mut rest) {
            // Also where the record cannot be read: something was unsaved then.
            kept.clean = false;
            match kind {
                PAINT => {
                    let Project { settings, paint } = &mut kept.project;
                    if project::read_paint_changes(content, settings, paint).is_err() {
                        break;
                    }
                }
                SETTINGS => {
                    let Ok(new) = project::parse_named(content, &mut names, &meter) else { break };
                    kept.project.settings = new.settings;
                }
                CLEAN => {
                    let Some((home, _)) = split_home(content) else { break };
                    kept.home = home;
                    kept.clean = true;
                }
                _ => break,
            }
            kept.time = time;
        }
        Ok(kept)
    }
}

/// Kind, time and content of the next record, if it is complete.
fn next_record<'a>(rest: &mut &'a [u8]) -> Option<(u8, u64, &'a [u8])> {
    let (head, after) = rest.split_first_chunk::<HEAD>()?;
    let [kind, middle @ .., _, _, _, _] = head;
    let (time, length) = middle.split_at(8);
    let time = u64::from_le_bytes(time.try_into().ok()?);
    let length = u32::from_le_bytes(length.try_into().ok()?) as usize;
    let content = after.get(..length)?;
    if checksum(&head[..HEAD - 4], content).to_le_bytes() != head[HEAD - 4..] {
        return None;
    }
    *rest = &after[length..];
    Some((*kind, time, content))
}

fn split_home(content: &[u8]) -> Option<(Option<PathBuf>, &[u8])> {
    let (length, rest) = content.split_first_chunk()?;
    let (home, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    let home = str::from_utf8(home).ok()?;
    Some(((!home.is_empty()).then(|| home.into()), rest))
}

#[cfg(test)]
mod tests;

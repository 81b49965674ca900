//! `.journal`: unsaved work, stored gesture by gesture in case the program crashes.
//!
//! Eight bytes of magic, then records:
//!
//! ```text
//! kind (1 byte) | seconds since 1970 (8) | length of the content (4) | CRC-32 of all the rest (4) | content
//! ```
//!
//! Numbers are little-endian. The first record is the path of a project and the whole of it. Then come what
//! each gesture changed, and a mark whenever nothing is unsaved. Reading stops at the first incomplete
//! record: the program ended while writing it.
//!
//! Once a journal is twice as long as its first record, another thread packs a new one with what the document
//! is by then, while the old one takes further records:
//!
//! ```text
//! Growing ── renewal ──→ Renewing          both have the records that come in the meantime
//!    ↑                      │ Renewal::pack, Renewed::wait_for_disk
//!    └────── replace ───────┘              the new file gets the name of the old one
//! ```
//!
//! So each record is written twice at most, and all whole documents together, but for the last one, have
//! fewer bytes than the records: what is written is at most three times what gestures changed, and one whole
//! document.
//!
//! The program that writes a journal holds a lock on it, which the operating system releases when the program
//! ends in any way. So a journal without a lock was left behind.

mod left;

use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::Meter;
use super::project::{Change, Project, Recorded};
pub use left::{Abandoned, Left, left};
use meshbrush_core::document::Settings;
use meshbrush_core::layers::PaintLayers;

const MAGIC: &[u8; 8] = b"MBJOUR01";
const HEAD: usize = 17;
const ENDING: &str = "journal";
/// The ending of a journal whose first record is not complete.
const PART: &str = "part";
/// A journal is not renewed before it has grown by so much, however small the document is.
const LEAST_GROWTH: u64 = if cfg!(test) { 4 << 10 } else { 4 << 20 };

const WHOLE: u8 = 1;
const GESTURE: u8 = 2;
const CLEAN: u8 = 3;

/// A journal being written.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    /// The project's file.
    home: Option<PathBuf>,
    recorded: Recorded,
    /// Bytes of the whole document at the beginning.
    whole: u64,
    /// Bytes of the records since.
    grown: u64,
    stage: RenewalStage,
}

/// Whether a shorter journal is being made.
#[derive(Debug)]
enum RenewalStage {
    /// It is not.
    Growing,
    /// Another thread packs it, until the meter is cancelled. These records are not in it yet.
    Renewing { meter: Meter, missing: Vec<u8> },
}

impl Journal {
    /// Begins a journal in a folder, which is created if necessary. When this returns, the journal is
    /// complete and locked; it is on the disk after [`Syncing::wait`].
    ///
    /// `home` is the project's file, if it has one; `time` is in seconds since 1970. The meter counts bytes
    /// before packing.
    ///
    /// # Errors
    /// Fails with the errors of the file system, and when the work was cancelled.
    pub fn begin(
        folder: &Path,
        project: Project,
        home: Option<&Path>,
        time: u64,
        meter: &Meter,
    ) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let (recorded, change) = Recorded::begin(project)?;
        let (folder, home, meter) = (folder.to_owned(), home.map(Path::to_owned), meter.clone());
        let Renewed { file, part, bytes, .. } =
            Renewal { folder, home: home.clone(), change, time, meter }.pack()?;
        let path = part.with_extension(ENDING);
        fs::rename(&part, &path).inspect_err(|_| {
            let _ = fs::remove_file(&part); // the first error is the one to report
        })?;
        Ok(Self { file, path, home, recorded, whole: bytes, grown: 0, stage: RenewalStage::Growing })
    }

    /// Adds the state of the document after a gesture: its settings, unless they are as before, and its
    /// paint. What is written is what differs.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn add(&mut self, settings: Option<Settings>, paint: &PaintLayers, time: u64) -> io::Result<()> {
        let change = self.recorded.advance(settings, paint)?;
        if change.is_empty() {
            return Ok(());
        }
        self.append(&record(GESTURE, time, |out| change.write(out, &Meter::default()))?)
    }

    /// Marks that nothing is unsaved, and which file the project belongs to.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn mark_clean(&mut self, home: Option<&Path>, time: u64) -> io::Result<()> {
        self.home = home.map(Path::to_owned);
        self.append(&record(CLEAN, time, |out| out.write_all(&home_bytes(home)))?)
    }

    /// Returns a handle to wait for the disk on another thread.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn syncing(&self) -> io::Result<Syncing> {
        self.file.try_clone().map(Syncing)
    }

    /// Returns the work of making a shorter journal, once this one has grown much, and not while such work
    /// is under way. `time` is in seconds since 1970.
    pub fn renewal(&mut self, time: u64) -> Option<Renewal> {
        let is_long = self.grown > self.whole.max(LEAST_GROWTH);
        if !is_long || matches!(self.stage, RenewalStage::Renewing { .. }) {
            return None;
        }
        let meter = Meter::default();
        self.stage = RenewalStage::Renewing { meter: meter.clone(), missing: Vec::new() };
        let folder = self.path.parent().unwrap_or(Path::new("")).to_owned();
        let change = self.recorded.begin_again();
        Some(Renewal { folder, home: self.home.clone(), change, time, meter })
    }

    /// Writes to a shorter journal what has come while it was made. Most of it should then go to the disk
    /// before [`Self::replace_by`].
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn complete(&mut self, renewed: &mut Renewed) -> io::Result<()> {
        if let RenewalStage::Renewing { missing, .. } = &mut self.stage {
            renewed.file.write_all(missing)?;
            renewed.grown += std::mem::take(missing).len() as u64;
        }
        Ok(())
    }

    /// Goes on in a shorter journal, which takes the name of this one.
    ///
    /// # Errors
    /// Fails with the errors of the file system. Records are then added to the longer journal.
    pub fn replace_by(&mut self, mut renewed: Renewed) -> io::Result<()> {
        if renewed.is_unwanted() || !matches!(self.stage, RenewalStage::Renewing { .. }) {
            return renewed.discard();
        }
        let completed = self.complete(&mut renewed).and_then(|()| fs::rename(&renewed.part, &self.path));
        if let Err(error) = completed {
            let _ = renewed.discard(); // the first error is the one to report
            return Err(error);
        }
        let Renewed { file, bytes, grown, .. } = renewed;
        (self.file, self.whole, self.grown, self.stage) = (file, bytes, grown, RenewalStage::Growing);
        Ok(())
    }

    /// Gives up the work of making a shorter journal. The next attempt follows when this one is twice as
    /// long.
    pub fn give_up_renewal(&mut self) {
        if let RenewalStage::Renewing { meter, .. } = &self.stage {
            meter.cancel();
            self.whole = self.whole.max(self.grown);
            self.grown = 0;
            self.stage = RenewalStage::Growing;
        }
    }

    /// Deletes the journal.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn remove(mut self) -> io::Result<()> {
        self.give_up_renewal();
        fs::remove_file(&self.path)
    }

    /// One call writes a record: bytes written before the program is killed belong to the system and are not
    /// lost.
    fn append(&mut self, record: &[u8]) -> io::Result<()> {
        self.file.write_all(record)?;
        self.grown += record.len() as u64;
        if let RenewalStage::Renewing { missing, .. } = &mut self.stage {
            missing.extend(record);
        }
        Ok(())
    }
}

/// The work of packing a whole document to a new journal.
#[derive(Debug)]
pub struct Renewal {
    folder: PathBuf,
    home: Option<PathBuf>,
    change: Change,
    time: u64,
    meter: Meter,
}

impl Renewal {
    /// Packs the document and writes it, which can take many seconds.
    ///
    /// # Errors
    /// Fails with the errors of the file system, and when the work was given up.
    pub fn pack(self) -> io::Result<Renewed> {
        let content = |out: &mut Vec<u8>| {
            out.write_all(&home_bytes(self.home.as_deref()))?;
            self.change.write(out, &self.meter)
        };
        let record = record(WHOLE, self.time, content)?;
        // Locked before it gets the name by which journals are found.
        let (mut file, part) = new_file(&self.folder)?;
        if let Err(error) = file.write_all(MAGIC).and_then(|()| file.write_all(&record)) {
            let _ = fs::remove_file(&part); // the first error is the one to report
            return Err(error);
        }
        Ok(Renewed { file, part, bytes: record.len() as u64, grown: 0, meter: self.meter })
    }
}

/// A journal that does not have its name yet.
#[derive(Debug)]
pub struct Renewed {
    file: File,
    part: PathBuf,
    /// Bytes of the whole document.
    bytes: u64,
    /// Bytes of the records since.
    grown: u64,
    meter: Meter,
}

impl Renewed {
    /// Returns whether the work was given up, since there is another document.
    pub fn is_unwanted(&self) -> bool {
        self.meter.is_cancelled()
    }

    /// Waits until everything written so far is on the disk, which can take seconds.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn wait_for_disk(&self) -> io::Result<()> {
        self.file.sync_data()
    }

    /// Deletes it.
    ///
    /// # Errors
    /// Fails with the errors of the file system.
    pub fn discard(self) -> io::Result<()> {
        fs::remove_file(&self.part)
    }
}

/// Returns the bytes of a record.
fn record(kind: u8, time: u64, write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> io::Result<Vec<u8>> {
    let mut record = vec![0; HEAD];
    write(&mut record)?;
    let (head, content) = record.split_at_mut(HEAD);
    let length = u32::try_from(content.len()).map_err(io::Error::other)?;
    let (rest, crc) = head.split_at_mut(HEAD - 4);
    rest[0] = kind;
    rest[1..9].copy_from_slice(&time.to_le_bytes());
    rest[9..].copy_from_slice(&length.to_le_bytes());
    crc.copy_from_slice(&checksum(rest, content).to_le_bytes());
    Ok(record)
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

#[cfg(test)]
mod tests;

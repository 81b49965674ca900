//! The journals that earlier runs left behind.

use std::fs::{self, File, TryLockError};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::super::error::Flaw;
use super::super::project::{Project, Replay};
use super::{CLEAN, ENDING, GESTURE, HEAD, MAGIC, PART, WHOLE, checksum};

/// Largest journal read: twice the largest project.
const MOST_BYTES: u64 = 8 << 30;

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
    (&file).take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("it is larger than {} GiB", MOST_BYTES >> 30));
    }
    let kept = KeptJournal::parse(&bytes)?;
    if kept.clean {
        let _ = fs::remove_file(path); // the next start tries again
        return Ok(None);
    }
    let KeptJournal { project, home, time, .. } = kept;
    Ok(Some(Box::new(Abandoned { project, home, time, path: path.to_owned(), _lock: file })))
}

/// The content of a journal.
pub(super) struct KeptJournal {
    pub(super) project: Project,
    home: Option<PathBuf>,
    pub(super) time: u64,
    pub(super) clean: bool,
}

impl KeptJournal {
    /// Combines all records up to the first incomplete one, or the first that another version wrote.
    ///
    /// # Errors
    /// Fails with the reason why the first record cannot be read, as a sentence without its full stop.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, String> {
        let mut rest = bytes.strip_prefix(MAGIC).ok_or("another version of Meshbrush wrote it")?;
        let records: Vec<Record> = std::iter::from_fn(|| Record::next(&mut rest)).collect();
        let mut count = records.len();
        loop {
            match Self::of(&records[..count]) {
                // Also where a record cannot be read: something was unsaved then.
                Ok(kept) => return Ok(Self { clean: kept.clean && count == records.len(), ..kept }),
                Err(Flawed { at: 0, problem }) => return Err(problem),
                Err(Flawed { at, .. }) => count = at,
            }
        }
    }

    /// Combines records.
    fn of(records: &[Record]) -> Result<Self, Flawed> {
        let damaged = || Flawed { at: 0, problem: "its first record is damaged".into() };
        let (first, later) = records.split_first().ok_or_else(damaged)?;
        let (mut home, content) =
            split_home(first.content).filter(|_| first.kind == WHOLE).ok_or_else(damaged)?;
        let (mut replay, mut clean) = (Replay::default(), false);
        replay.add(content).map_err(|flaw| Flawed { at: 0, problem: sentence(&flaw) })?;
        for (record, at) in later.iter().zip(1..) {
            let flawed = |problem: String| Flawed { at, problem };
            match record.kind {
                GESTURE => replay.add(record.content).map_err(|flaw| flawed(sentence(&flaw)))?,
                CLEAN => (home, _) = split_home(record.content).ok_or_else(|| flawed(String::new()))?,
                _ => return Err(flawed(String::new())),
            }
            clean = record.kind == CLEAN;
        }
        let project =
            replay.project().map_err(|flaw| Flawed { at: later.len(), problem: sentence(&flaw.flaw) })?;
        Ok(Self { project, home, time: records[later.len()].time, clean })
    }
}

/// The number of the first record that cannot be read, and why.
struct Flawed {
    at: usize,
    problem: String,
}

fn sentence(flaw: &Flaw) -> String {
    flaw.to_string().trim_end_matches('.').to_owned()
}

struct Record<'a> {
    kind: u8,
    time: u64,
    content: &'a [u8],
}

impl<'a> Record<'a> {
    /// Takes the next record, if it is complete.
    fn next(rest: &mut &'a [u8]) -> Option<Self> {
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
        Some(Self { kind: *kind, time, content })
    }
}

fn split_home(content: &[u8]) -> Option<(Option<PathBuf>, &[u8])> {
    let (length, rest) = content.split_first_chunk()?;
    let (home, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
    let home = str::from_utf8(home).ok()?;
    Some(((!home.is_empty()).then(|| home.into()), rest))
}

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

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::Meter;
use super::project::{self, PartNames, Project};
use crate::document::Settings;
use crate::layers::PaintLayers;

const MAGIC: &[u8; 8] = b"MBJOUR02";
const HEAD: usize = 17;
const ENDING: &str = "journal";
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
    /// Errors of the file system.
    pub fn begin(folder: &Path, project: &Project, home: Option<&Path>, time: u64) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let (file, part) = new_file(folder)?;
        // Locked before it gets the name by which journals are found.
        file.try_lock().map_err(io::Error::other)?;
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
    /// Errors of the file system.
    pub fn add_paint(&mut self, before: &PaintLayers, after: &PaintLayers, time: u64) -> io::Result<()> {
        let mut content = Vec::new();
        project::write_paint_changes(&mut content, before, after)?;
        self.append(PAINT, time, &content)
    }

    /// Adds the settings after a gesture.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn add_settings(&mut self, settings: Settings, time: u64) -> io::Result<()> {
        let mut content = Vec::new();
        let project = Project { settings, paint: PaintLayers::default() };
        project::write_named(&mut content, &project, &mut self.names)?;
        self.append(SETTINGS, time, &content)
    }

    /// Marks that nothing is unsaved, and which file the project belongs to.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn mark_clean(&mut self, home: Option<&Path>, time: u64) -> io::Result<()> {
        self.append(CLEAN, time, &home_bytes(home))
    }

    /// A handle to wait for the disk on another thread.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn syncing(&self) -> io::Result<Syncing> {
        self.file.try_clone().map(Syncing)
    }

    /// Whether so much was added that a new journal would be much smaller.
    pub fn is_long(&self) -> bool {
        self.grown > MOST_GROWTH
    }

    /// Deletes the journal.
    ///
    /// # Errors
    /// Errors of the file system.
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
        // In one call: what is written before the program is killed belongs to the system and is not lost.
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
    /// Errors of the file system.
    pub fn wait(&self) -> io::Result<()> {
        self.0.sync_data()
    }
}

/// Creates a file under a name that no other process uses.
fn new_file(folder: &Path) -> io::Result<(File, PathBuf)> {
    let mut n = 0;
    loop {
        let path = folder.join(format!("{}-{n}.part", std::process::id()));
        n += 1;
        if path.with_extension(ENDING).exists() {
            continue;
        }
        match File::options().write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            opened => return Ok((opened?, path)),
        }
    }
}

fn checksum(head: &[u8], content: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(head);
    crc.update(content);
    crc.finalize()
}

/// The length of a path and the path in UTF-8; empty without a path, or if it is not UTF-8.
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
    /// Errors of the file system.
    pub fn remove(self) -> io::Result<()> {
        fs::remove_file(&self.path)
    }
}

/// The unsaved work of the journals in a folder that no running program has locked. Journals without unsaved
/// work are deleted, and journals that cannot be read are left there.
pub fn abandoned(folder: &Path) -> Vec<Abandoned> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == ENDING));
    paths.sort();
    paths.into_iter().filter_map(taken_over).collect()
}

fn taken_over(path: PathBuf) -> Option<Abandoned> {
    let file = File::open(&path).ok()?;
    file.try_lock().ok()?;
    let mut bytes = Vec::new();
    (&file).take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
    let kept = Kept::parse(&bytes)?;
    if kept.clean {
        let _ = fs::remove_file(&path); // the next start tries again
        return None;
    }
    let Kept { project, home, time, .. } = kept;
    Some(Abandoned { project, home, time, path, _lock: file })
}

/// The content of a journal.
struct Kept {
    project: Project,
    home: Option<PathBuf>,
    time: u64,
    clean: bool,
}

impl Kept {
    /// `None` if the first record is incomplete.
    fn parse(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes.strip_prefix(MAGIC)?;
        let (kind, time, content) = next_record(&mut rest)?;
        let (home, content) = split_home(content).filter(|_| kind == WHOLE)?;
        let (mut names, meter) = (PartNames::default(), Meter::default());
        let project = project::parse_named(content, &mut names, &meter).ok()?;
        let mut kept = Self { project, home, time, clean: false };
        while let Some((kind, time, content)) = next_record(&mut rest) {
            match kind {
                PAINT => {
                    let Project { settings, paint } = &mut kept.project;
                    if project::read_paint_changes(content, settings, paint).is_err() {
                        break;
                    }
                    kept.clean = false;
                }
                SETTINGS => {
                    let Ok(new) = project::parse_named(content, &mut names, &meter) else { break };
                    kept.project.settings = new.settings;
                    kept.clean = false;
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
        Some(kept)
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
mod tests {
    use super::*;
    use crate::document::{Document, Edits, Example, Setting, Settings};
    use crate::layers::{Layer, LayerKind, RasterReading, RasterSource};
    use crate::paint::{Brush, DiameterChange, Medium};
    use crate::raster::{Raster, RasterPyramid};
    use glam::dvec2;
    use std::sync::Arc;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("meshbrush-journal-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    fn example() -> Document {
        let mut document = Example::Threats.document(|| unreachable!(), || unreachable!());
        document.take_edits();
        document
    }

    /// Paints or erases, and returns the paint before and after.
    fn gesture(document: &mut Document, n: u32) -> [PaintLayers; 2] {
        let before = document.paint().clone();
        let medium = if n % 3 == 2 { Medium::Eraser } else { Medium::Diameter(0.01, DiameterChange::Finer) };
        document.begin_stroke(Brush { medium, radius: 0.05, hardness: 0.5, strength: 0.7 });
        let at = f64::from(n) * 0.618 % 1.0;
        document.draw_to(dvec2(at, 0.3));
        document.draw_to(dvec2(0.5, at));
        document.end_stroke();
        let Edits { settings, all_paint, layers } = document.take_edits();
        assert!(!settings && !all_paint && layers.len() == 1, "strokes change paint alone");
        [before, document.paint().clone()]
    }

    fn add_gesture(journal: &mut Journal, document: &mut Document, n: u32, time: u64) {
        let [before, after] = gesture(document, n);
        journal.add_paint(&before, &after, time).unwrap();
    }

    #[test]
    fn a_journal_cut_anywhere_has_all_complete_records() {
        let folder = folder("cuts");
        let mut document = example();
        let mut journal = Journal::begin(&folder, &Project::of(&document), None, 100).unwrap();
        let mut versions =
            vec![(fs::metadata(&journal.path).unwrap().len() as usize, document.paint().clone())];
        for n in 0..12 {
            add_gesture(&mut journal, &mut document, n, 101 + u64::from(n));
            versions.push((fs::metadata(&journal.path).unwrap().len() as usize, document.paint().clone()));
        }
        let bytes = fs::read(&journal.path).unwrap();
        for cut in (0..bytes.len())
            .step_by(bytes.len() / 23)
            .chain(versions.iter().flat_map(|&(end, _)| [end - 1, end]))
        {
            let whole = versions.partition_point(|&(end, _)| end <= cut);
            match Kept::parse(&bytes[..cut]) {
                None => assert_eq!(whole, 0, "cut at {cut}"),
                Some(kept) => {
                    assert_eq!((kept.time, kept.clean), (99 + whole as u64, false));
                    let kept = kept.project.into_document().unwrap();
                    assert!(*kept.paint() == versions[whole - 1].1, "cut at {cut}");
                }
            }
        }
        let mut damaged = bytes.clone();
        damaged[versions[4].0 + 40] ^= 4;
        assert_eq!(Kept::parse(&damaged).unwrap().time, 104);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn settings_are_kept_beside_the_paint() {
        let folder = folder("settings");
        let mut document = example();
        let mut journal = Journal::begin(&folder, &Project::of(&document), None, 1).unwrap();
        add_gesture(&mut journal, &mut document, 0, 2);
        document.set(Setting::SmallestDiameter(0.0123)).unwrap();
        let Edits { settings, all_paint, layers } = document.take_edits();
        assert!(settings && !all_paint && layers.is_empty());
        journal.add_settings(document.settings().clone(), 3).unwrap();
        drop(journal);
        let kept = abandoned(&folder).pop().unwrap().project.into_document().unwrap();
        assert_eq!(kept.settings(), document.settings());
        assert!(kept.paint() == document.paint());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn rasters_and_pictures_are_written_once() {
        let folder = folder("once");
        let mut random = fastrand::Rng::with_seed(3);
        let mut raster = |name: &str| {
            let values = (0..100 * 100).map(|_| random.f32()).collect();
            let raster = Raster::from_values(crate::geometry::Rect::UNIT, [100, 100], values);
            let source = RasterSource { name: name.into(), raster: Arc::new(RasterPyramid::new(raster)) };
            LayerKind::Raster { source, reading: RasterReading::Risk }
        };
        let rgba = (0..4 * 100 * 100).map(|n: u32| (n * n % 251) as u8 | (n % 4 / 3 * 255) as u8).collect();
        let mut settings = Settings { layers: Layer::stack([raster("first")]), ..Settings::default() };
        settings.background = Some(crate::document::Background {
            name: "map".into(),
            picture: Arc::new(crate::document::Picture { size: [100, 100], rgba }),
            bounds: crate::geometry::Rect::UNIT,
            opacity: 0.5,
        });
        let project = Project { settings: settings.clone(), paint: PaintLayers::default() };
        let mut journal = Journal::begin(&folder, &project, None, 1).unwrap();
        let length = |journal: &Journal| fs::metadata(&journal.path).unwrap().len();
        let mut before = length(&journal);
        for n in 0..5 {
            let is_new = n == 2;
            if is_new {
                settings.layers = Layer::stack([settings.layers[0].kind.clone(), raster("second")]);
            }
            settings.layers[0].name = format!("Slope {n}");
            journal.add_settings(settings.clone(), 2).unwrap();
            let grown = length(&journal) - std::mem::replace(&mut before, length(&journal));
            assert_eq!(grown > 20_000, is_new, "{grown} bytes in record {n}");
            assert!(is_new || grown < 3_000, "{grown} bytes in record {n}");
        }
        drop(journal);
        assert_eq!(abandoned(&folder).pop().unwrap().project.settings, settings);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn only_unlocked_journals_with_unsaved_work_are_offered() {
        let folder = folder("offered");
        let mut document = example();
        let home = Path::new("/tmp/threats.meshbrush");
        let mut journal = Journal::begin(&folder, &Project::of(&document), None, 1).unwrap();
        assert!(abandoned(&folder).is_empty(), "it is held");
        journal.mark_clean(Some(home), 2).unwrap();
        add_gesture(&mut journal, &mut document, 0, 3);
        drop(journal);
        let found = abandoned(&folder);
        assert_eq!((found.len(), found[0].time, found[0].home.as_deref()), (1, 3, Some(home)));
        assert!(abandoned(&folder).is_empty(), "another window was offered it");
        drop(found);
        assert_eq!(abandoned(&folder).len(), 1, "and may be again");
        abandoned(&folder).pop().unwrap().remove().unwrap();

        let mut journal = Journal::begin(&folder, &Project::of(&document), None, 1).unwrap();
        journal.mark_clean(None, 2).unwrap();
        drop(journal);
        assert!(abandoned(&folder).is_empty());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "nothing unsaved: it is removed");
        fs::remove_dir_all(folder).unwrap();
    }
}

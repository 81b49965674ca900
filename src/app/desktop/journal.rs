//! Unsaved work, recorded gesture by gesture on another thread, and offered for restoring after a crash.
//!
//! ```text
//!   record ─→ entries ─→ keep ─→ Journal               what changed, at once
//!                ↑        ├───→ renew ─→ a new journal  whole documents, in the background
//!                │        │        │
//!                └────────│────────┘
//!                         └───→ wait_for_disk
//! ```
//!
//! A gesture is kept as soon as `keep` has written what it changed: after the entry that it is writing when
//! the gesture ends, and in one entry with the gestures that ended meanwhile. Only the first entry of a
//! document is a whole one.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};

use eframe::egui::Context;

use meshbrush_core::document::Settings;
use meshbrush_core::layers::PaintLayers;
use meshbrush_io::io::Meter;
use meshbrush_io::io::journal::{self, Abandoned, Journal, Left, Renewal, Renewed};
use meshbrush_io::io::project::Project;
use meshbrush_kit::kit::EditRecorder;
use meshbrush_kit::kit::clock::{Duration, Instant};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Output, Taken};
use meshbrush_kit::kit::project::ProjectFile;
use meshbrush_kit::kit::recovery::{self, now};
use meshbrush_kit::kit::session::Session;
use meshbrush_ui::widgets::ConfirmAnswer;

/// An entry that the thread writes.
enum JournalEntry {
    /// Everything, and the file that it belongs to.
    Whole(Box<Project>, Option<PathBuf>),
    /// The document after a gesture: its settings, if they changed, and its paint.
    Gesture(Option<Box<Settings>>, PaintLayers),
    /// The document has no unsaved changes.
    Clean(Option<PathBuf>),
    /// The work of an earlier run is no longer needed.
    Forget(Box<Abandoned>),
    /// A shorter journal is packed, if that was possible.
    Packed(std::io::Result<Renewed>),
    /// What a shorter journal has so far is on the disk.
    Synced(Renewed),
    /// The end; the journal is deleted, or left for the next start.
    End { remove: bool },
}

impl JournalEntry {
    /// Takes in the next entry, if one of both suffices.
    ///
    /// # Errors
    /// Fails with both entries, if each is to be written.
    fn merged(self, later: Self) -> Result<Self, [Box<Self>; 2]> {
        match (self, later) {
            (Self::Whole(mut project, home), Self::Gesture(settings, paint)) => {
                if let Some(settings) = settings {
                    project.settings = *settings;
                }
                project.paint = paint;
                Ok(Self::Whole(project, home))
            }
            (Self::Gesture(before, _), Self::Gesture(settings, paint)) => {
                Ok(Self::Gesture(settings.or(before), paint))
            }
            (Self::Whole(..), later @ Self::Whole(..)) => Ok(later),
            (entry, later) => Err([entry, later].map(Box::new)),
        }
    }
}

/// Keeps a journal of the document.
pub struct JournalKeeper {
    sender: Sender<JournalEntry>,
    /// They write entries, pack shorter journals and wait for the disk, and send problems, until the end.
    writing: [Option<Job<String>>; 3],
    /// Cancels the first entry of a document, when nothing is to be kept.
    ending: Meter,
    /// Looks for what earlier runs left behind.
    _finding: Job<()>,
    found: Receiver<Left>,
    /// Journals of earlier runs that cannot be read.
    unreadable: Vec<String>,
    /// The work of an earlier run that the user is asked about.
    offered: Option<Abandoned>,
    broken: bool,
}

impl JournalKeeper {
    /// Starts a journal in a folder, and looks there for what earlier runs left behind.
    pub fn new(folder: PathBuf, jobs: &Jobs) -> Self {
        let (sender, entries) = channel();
        let (disk, written) = channel();
        // A journal can be large: the next one is read when the one before it is looked at.
        let (found_sender, found) = sync_channel(1);
        let (renewals, to_renew) = channel();
        let place = folder.clone();
        let finding = jobs.start(JobKind::Journal, move |output| {
            for left in journal::left(&place) {
                if found_sender.send(left).is_err() {
                    // The window has closed in the meantime.
                    return;
                }
                output.wake();
            }
        });
        let report = |output: &Output<String>, result: std::io::Result<()>| {
            if let Err(problem) = result {
                output.send(problem.to_string());
            }
        };
        let keeper = Keeping { folder, journal: None, disk, renewals, ending: Meter::default() };
        let ending = keeper.ending.clone();
        let keeping = jobs.start(JobKind::Journal, move |output| report(output, keeper.run(&entries)));
        let to_keep = sender.clone();
        let renewing = jobs.start(JobKind::Journal, move |_| renew(&to_renew, &to_keep));
        let waiting = jobs.start(JobKind::Journal, move |output| report(output, wait_for_disk(&written)));
        Self {
            sender,
            writing: [keeping, renewing, waiting].map(Some),
            ending,
            _finding: finding,
            found,
            offered: None,
            unreadable: Vec::new(),
            broken: false,
        }
    }

    /// Returns whether the user is being asked about the work of an earlier run.
    pub fn is_asking(&self) -> bool {
        self.offered.is_some()
    }

    /// Offers the next work that an earlier run left behind. Returns a sentence about work that cannot be
    /// read.
    pub fn offer_next(&mut self) -> Option<String> {
        while self.offered.is_none() {
            match self.found.try_recv().ok()? {
                Left::Work(work) => self.offered = Some(*work),
                Left::Unreadable { path, problem } => {
                    self.unreadable.push(format!("{}: {problem}", path.display()));
                    return Some(format!(
                        "Unsaved work of an earlier run cannot be read, and is kept. {}. Delete the file if you do not need \
                         it.",
                        self.unreadable.join("; ")
                    ));
                }
            }
        }
        None
    }

    /// Takes the answer about the work of an earlier run, and returns the command to run now.
    pub fn answer(&mut self, answer: ConfirmAnswer) -> Option<Command> {
        let (command, forgotten) = recovery::take_answer(&mut self.offered, answer);
        forgotten.into_iter().for_each(|left| self.forget(left));
        command
    }

    /// Takes the work that is offered, to restore it.
    pub fn take_offered(&mut self) -> Option<Abandoned> {
        self.offered.take()
    }

    /// Deletes what an earlier run left behind, once everything recorded so far is on the disk.
    pub fn forget(&self, left: Abandoned) {
        self.enter(JournalEntry::Forget(Box::new(left)));
    }

    /// Records that nothing is unsaved.
    pub fn note_saved(&self, project: &ProjectFile) {
        self.enter(JournalEntry::Clean(project.path().map(Path::to_owned)));
    }

    /// Returns the problem since the last call, if there was one.
    fn problem(&self) -> Option<String> {
        self.writing.iter().flatten().find_map(|job| match job.take_ready() {
            Taken::Value(problem) => Some(problem),
            Taken::Working | Taken::Ended => None,
        })
    }

    fn enter(&self, entry: JournalEntry) {
        // A thread that ended has reported its problem.
        let _ = self.sender.send(entry);
    }

    /// Waits until everything is written; then deletes the journal, or leaves it for the next start.
    pub fn end(&mut self, remove: bool, jobs: &Jobs) {
        if remove {
            self.ending.cancel();
        }
        self.enter(JournalEntry::End { remove });
        self.writing.iter_mut().filter_map(Option::take).for_each(|job| jobs.wait_for_end(&job));
    }
}

/// The threads hold senders to each other: without this they would wait for ever.
impl Drop for JournalKeeper {
    fn drop(&mut self) {
        self.enter(JournalEntry::End { remove: false });
    }
}

/// Writes entries as they come. It never waits for the disk: what the system has been given outlives the
/// program.
struct Keeping {
    folder: PathBuf,
    journal: Option<Journal>,
    disk: Sender<ToDisk>,
    renewals: Sender<ToRenew>,
    ending: Meter,
}

impl Keeping {
    /// Writes entries until the end.
    fn run(mut self, entries: &Receiver<JournalEntry>) -> std::io::Result<()> {
        let mut next = None;
        while let Some(mut entry) = next.take().or_else(|| entries.recv().ok()) {
            while let Ok(later) = entries.try_recv() {
                match entry.merged(later) {
                    Ok(merged) => entry = merged,
                    Err([first, second]) => {
                        (entry, next) = (*first, Some(*second));
                        break;
                    }
                }
            }
            if let JournalEntry::End { remove } = entry {
                return self.end(remove);
            }
            let outdated = self.write(entry)?;
            let renewal = self.journal.as_mut().and_then(|journal| journal.renewal(now()));
            // Threads that ended have reported their problems.
            if let Some(renewal) = renewal {
                _ = self.renewals.send(ToRenew::Pack(renewal));
            }
            let syncing = self.journal.as_ref().map(Journal::syncing).transpose()?;
            _ = self.disk.send(ToDisk { syncing, outdated });
        }
        Ok(())
    }

    /// Writes an entry. Returns what is to be deleted once everything is on the disk.
    fn write(&mut self, entry: JournalEntry) -> std::io::Result<Option<Outdated>> {
        match (entry, &mut self.journal) {
            (JournalEntry::Whole(project, home), journal) => {
                let old = journal.take().map(|mut old| {
                    old.give_up_renewal();
                    Outdated::Own(Box::new(old))
                });
                match Journal::begin(&self.folder, *project, home.as_deref(), now(), &self.ending) {
                    Ok(new) => *journal = Some(new),
                    Err(_) if self.ending.is_cancelled() => {}
                    Err(error) => return Err(error),
                }
                return Ok(old);
            }
            (JournalEntry::Gesture(settings, paint), Some(journal)) => {
                journal.add(settings.map(|settings| *settings), &paint, now())?;
            }
            (JournalEntry::Clean(home), Some(journal)) => journal.mark_clean(home.as_deref(), now())?,
            (JournalEntry::Packed(Ok(mut renewed)), Some(journal)) if !renewed.is_unwanted() => {
                match journal.complete(&mut renewed) {
                    Ok(()) => _ = self.renewals.send(ToRenew::Sync(renewed)),
                    Err(_) => {
                        journal.give_up_renewal();
                        renewed.discard()?;
                    }
                }
            }
            (JournalEntry::Synced(renewed), Some(journal)) => {
                if journal.replace_by(renewed).is_err() {
                    journal.give_up_renewal();
                }
            }
            // The longer journal has everything as well.
            (JournalEntry::Packed(Err(_)), Some(journal)) => journal.give_up_renewal(),
            (JournalEntry::Packed(Ok(renewed)) | JournalEntry::Synced(renewed), _) => renewed.discard()?,
            (JournalEntry::Forget(left), _) => return Ok(Some(Outdated::Left(left))),
            (
                JournalEntry::Gesture(..)
                | JournalEntry::Clean(_)
                | JournalEntry::Packed(Err(_))
                | JournalEntry::End { .. },
                _,
            ) => {}
        }
        Ok(None)
    }

    fn end(self, remove: bool) -> std::io::Result<()> {
        match self.journal {
            Some(journal) if remove => journal.remove(),
            Some(mut journal) => {
                journal.give_up_renewal();
                Ok(())
            }
            None => Ok(()),
        }
    }
}

/// Work on a shorter journal that takes long.
enum ToRenew {
    Pack(Renewal),
    Sync(Renewed),
}

/// Packs shorter journals and waits for the disk.
fn renew(work: &Receiver<ToRenew>, to_keep: &Sender<JournalEntry>) {
    while let Ok(work) = work.recv() {
        let entry = match work {
            ToRenew::Pack(renewal) => JournalEntry::Packed(renewal.pack()),
            ToRenew::Sync(renewed) => match renewed.wait_for_disk() {
                Ok(()) => JournalEntry::Synced(renewed),
                Err(error) => {
                    _ = renewed.discard(); // the longer journal has everything as well
                    JournalEntry::Packed(Err(error))
                }
            },
        };
        let Err(unsent) = to_keep.send(entry) else { continue };
        if let JournalEntry::Packed(Ok(renewed)) | JournalEntry::Synced(renewed) = unsent.0 {
            _ = renewed.discard(); // the window has closed in the meantime
        }
    }
}

/// The files to sync to the disk, and the files to delete afterwards.
struct ToDisk {
    syncing: Option<journal::Syncing>,
    outdated: Option<Outdated>,
}

enum Outdated {
    Own(Box<Journal>),
    Left(Box<Abandoned>),
}

/// How long nothing must have been written before the thread waits for the disk. The system blocks writes to
/// a file in that time, and the next gesture would be lost if the program were killed.
const QUIET: Duration = Duration::from_secs(1);
/// The longest that this is put off.
const LONGEST_DELAY: Duration = Duration::from_secs(30);

/// Waits for the disk, once for everything that came in the meantime.
fn wait_for_disk(written: &Receiver<ToDisk>) -> std::io::Result<()> {
    while let Ok(first) = written.recv() {
        let start = Instant::now();
        let (mut syncing, mut outdated) = (None, Vec::new());
        let more = || if start.elapsed() < LONGEST_DELAY { written.recv_timeout(QUIET).ok() } else { None };
        for item in std::iter::once(first).chain(std::iter::from_fn(more)) {
            syncing = item.syncing.or(syncing);
            outdated.extend(item.outdated);
        }
        if let Some(syncing) = syncing {
            syncing.wait()?;
        }
        for outdated in outdated {
            match outdated {
                Outdated::Own(journal) => journal.remove()?,
                Outdated::Left(left) => left.remove()?,
            }
        }
    }
    Ok(())
}

impl EditRecorder for JournalKeeper {
    fn record(&mut self, session: &mut Session, project: &ProjectFile) {
        let edited = project.is_edited(session);
        if let Some(problem) = self.problem() {
            self.broken = true;
            let text = "Unsaved work is no longer kept in case of a crash";
            session.report(format!("{text}: {problem}. Save the project from time to time."));
        }
        let document = session.document_mut();
        if self.broken || document.is_in_gesture() {
            return;
        }
        let edits = document.take_edits();
        if edits.is_empty() {
            return;
        }
        let home = project.path().map(Path::to_owned);
        self.enter(match edits.all_paint {
            true => JournalEntry::Whole(Box::new(Project::of(document)), home),
            false => JournalEntry::Gesture(
                edits.settings.then(|| Box::new(document.settings().clone())),
                document.paint().clone(),
            ),
        });
        if !edited {
            self.note_saved(project);
        }
    }
}

/// Asks whether to restore what an earlier run left behind.
pub fn question(ctx: &Context, keeper: &JournalKeeper, project: &ProjectFile, commands: &mut Vec<Command>) {
    if let Some(Abandoned { project: left, home, time, .. }) = &keeper.offered {
        recovery::question(ctx, (left, home.as_deref(), *time), project, commands);
    }
}

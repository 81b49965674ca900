//! Unsaved work, recorded gesture by gesture on another thread, and offered for restoring after a crash.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};

use eframe::egui::Context;

use crate::app::clock::{Duration, Instant};
use crate::app::command::Command;
use crate::app::jobs::{Job, Jobs, Kind, Output, Taken};
use crate::app::project::ProjectFile;
use crate::app::recovery::{self, now};
use crate::app::session::Session;
use crate::app::widgets::Answer;
use meshbrush_core::document::{Edits, Settings};
use meshbrush_core::layers::PaintLayers;
use meshbrush_io::io::journal::{self, Abandoned, Left};
use meshbrush_io::io::project::Project;

/// An entry that the thread writes.
enum Entry {
    /// Everything, and the file that it belongs to.
    Whole(Box<Project>, Option<PathBuf>),
    /// The paint before and after a gesture.
    Paint(Box<[PaintLayers; 2]>),
    /// Settings as they are after one.
    Settings(Box<Settings>),
    /// The document has no unsaved changes.
    Clean(Option<PathBuf>),
    /// The work of an earlier run is no longer needed.
    Forget(Box<Abandoned>),
    /// The end; the journal is deleted, or left for the next start.
    End { remove: bool },
}

/// Keeps a journal of the document.
pub struct JournalKeeper {
    sender: Sender<Entry>,
    /// They write entries and wait for the disk, and send problems, until the end.
    writing: [Option<Job<String>>; 2],
    /// Looks for what earlier runs left behind.
    _finding: Job<()>,
    found: Receiver<Left>,
    /// Journals of earlier runs that cannot be read.
    unreadable: Vec<String>,
    /// The journal is so long that it should start again with the whole document.
    wants_whole: Arc<AtomicBool>,
    /// The work of an earlier run that the user is asked about.
    offered: Option<Abandoned>,
    /// The paint that the journal has so far.
    recorded: PaintLayers,
    broken: bool,
}

impl JournalKeeper {
    /// Starts a journal in a folder, and looks there for what earlier runs left behind.
    pub fn new(folder: PathBuf, jobs: &Jobs) -> Self {
        let (sender, entries) = channel();
        let (disk, written) = channel();
        // A journal can be large: the next one is read when the one before it is looked at.
        let (found_sender, found) = sync_channel(1);
        let wants_whole = Arc::new(AtomicBool::new(false));
        let (wants, place) = (wants_whole.clone(), folder.clone());
        let finding = jobs.start(Kind::Journal, move |output| {
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
        let keeping =
            jobs.start(Kind::Journal, move |output| report(output, keep(&folder, &entries, &wants, disk)));
        let waiting = jobs.start(Kind::Journal, move |output| report(output, wait_for_disk(&written)));
        Self {
            sender,
            writing: [Some(keeping), Some(waiting)],
            _finding: finding,
            found,
            wants_whole,
            offered: None,
            unreadable: Vec::new(),
            recorded: PaintLayers::default(),
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
    pub fn answer(&mut self, answer: Answer) -> Option<Command> {
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
        self.enter(Entry::Forget(Box::new(left)));
    }

    /// Records that nothing is unsaved.
    pub fn note_saved(&self, project: &ProjectFile) {
        self.enter(Entry::Clean(project.path().map(Path::to_owned)));
    }

    /// Returns the problem since the last call, if there was one.
    fn problem(&self) -> Option<String> {
        self.writing.iter().flatten().find_map(|job| match job.take_ready() {
            Taken::Value(problem) => Some(problem),
            Taken::Working | Taken::Ended => None,
        })
    }

    fn enter(&self, entry: Entry) {
        // A thread that ended has reported its problem.
        let _ = self.sender.send(entry);
    }

    /// Waits until everything is written; then deletes the journal, or leaves it for the next start.
    pub fn end(&mut self, remove: bool, jobs: &Jobs) {
        self.enter(Entry::End { remove });
        self.writing.iter_mut().filter_map(Option::take).for_each(|job| jobs.wait_for_end(&job));
    }
}

/// Writes entries as they come, until the end. It never waits for the disk: what the system has been given
/// outlives the program.
fn keep(
    folder: &Path,
    entries: &Receiver<Entry>,
    wants_whole: &AtomicBool,
    disk: Sender<ToDisk>,
) -> std::io::Result<()> {
    let mut journal: Option<journal::Journal> = None;
    while let Ok(entry) = entries.recv() {
        let mut outdated = None;
        match (entry, &mut journal) {
            (Entry::Whole(project, home), _) => {
                let new = journal::Journal::begin(folder, &project, home.as_deref(), now())?;
                outdated = journal.replace(new).map(Outdated::Own);
            }
            (Entry::Paint(both), Some(journal)) => journal.add_paint(&both[0], &both[1], now())?,
            (Entry::Settings(settings), Some(journal)) => journal.add_settings(*settings, now())?,
            (Entry::Clean(home), Some(journal)) => journal.mark_clean(home.as_deref(), now())?,
            (Entry::Paint(_) | Entry::Settings(_) | Entry::Clean(_), None) => {}
            (Entry::Forget(left), _) => outdated = Some(Outdated::Left(left)),
            (Entry::End { remove: false }, _) => return Ok(()),
            (Entry::End { remove: true }, _) => return journal.map_or(Ok(()), journal::Journal::remove),
        }
        wants_whole.store(journal.as_ref().is_some_and(journal::Journal::is_long), Ordering::Relaxed);
        let syncing = journal.as_ref().map(journal::Journal::syncing).transpose()?;
        // A thread that ended has reported its problem.
        let _ = disk.send(ToDisk { syncing, outdated });
    }
    Ok(())
}

/// The files to sync to the disk, and the files to delete afterwards.
struct ToDisk {
    syncing: Option<journal::Syncing>,
    outdated: Option<Outdated>,
}

enum Outdated {
    Own(journal::Journal),
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

/// Hands finished gestures to the journal.
pub fn record(keeper: &mut JournalKeeper, session: &mut Session, project: &ProjectFile) {
    let edited = project.is_edited(session);
    if let Some(problem) = keeper.problem() {
        keeper.broken = true;
        let text = "Unsaved work is no longer kept in case of a crash";
        session.report(format!("{text}: {problem}. Save the project from time to time."));
    }
    let document = session.document_mut();
    if keeper.broken || document.is_in_gesture() {
        return;
    }
    let edits = document.take_edits();
    if edits.is_empty() {
        return;
    }
    let Edits { settings, all_paint, layers } = edits;
    if all_paint || keeper.wants_whole.load(Ordering::Relaxed) {
        let home = project.path().map(Path::to_owned);
        keeper.recorded = document.paint().clone();
        keeper.enter(Entry::Whole(Box::new(Project::of(document)), home));
    } else {
        if !layers.is_empty() {
            let before = std::mem::replace(&mut keeper.recorded, document.paint().clone());
            keeper.enter(Entry::Paint(Box::new([before, document.paint().clone()])));
        }
        if settings {
            keeper.enter(Entry::Settings(Box::new(document.settings().clone())));
        }
    }
    if !edited {
        keeper.note_saved(project);
    }
}

/// Asks whether to restore what an earlier run left behind.
pub fn question(ctx: &Context, keeper: &JournalKeeper, project: &ProjectFile, commands: &mut Vec<Command>) {
    if let Some(Abandoned { project: left, home, time, .. }) = &keeper.offered {
        recovery::question(ctx, (left, home.as_deref(), *time), project, commands);
    }
}

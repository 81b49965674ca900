//! Unsaved work, kept gesture by gesture off the window's thread, and offered back after a crash.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use eframe::egui::Context;

use super::App;
use super::command::Command;
use super::widgets::{Answer, ConfirmDialog};
use crate::document::{Edits, Settings};
use crate::io::journal::{self, Abandoned};
use crate::io::project::Project;
use crate::paint::Tiles;

/// What is to be written.
enum Entry {
    /// Everything, and the file that it belongs to.
    Whole(Box<Project>, Option<PathBuf>),
    /// Tiles as they are after a gesture.
    Tiles(Tiles),
    /// Settings as they are after one.
    Settings(Box<Settings>),
    /// Nothing is unsaved.
    Clean(Option<PathBuf>),
    /// What was taken over need not be kept any longer.
    Forget(Box<Abandoned>),
    /// The end; the journal is taken away, or left for the next start.
    End { remove: bool },
}

/// Keeps a journal of the document.
pub struct JournalKeeper {
    sender: Sender<Entry>,
    thread: Option<JoinHandle<()>>,
    found: Receiver<Abandoned>,
    problems: Receiver<String>,
    /// The journal has grown so long that it is better begun anew.
    wants_whole: Arc<AtomicBool>,
    /// What is offered at present.
    offered: Option<Abandoned>,
    broken: bool,
}

impl JournalKeeper {
    /// Begins in the given folder, and looks there for what earlier runs have left behind.
    pub fn new(folder: PathBuf, ctx: &Context) -> Self {
        let (sender, entries) = channel();
        let (problem_sender, problems) = channel();
        let (found_sender, found) = channel();
        let wants_whole = Arc::new(AtomicBool::new(false));
        let (wants, place, window) = (wants_whole.clone(), folder.clone(), ctx.clone());
        thread::spawn(move || {
            for left in journal::abandoned(&place) {
                // The window may have closed in the meantime.
                let _ = found_sender.send(left);
            }
            window.request_repaint();
        });
        let window = ctx.clone();
        let tell = move |result: std::io::Result<()>| {
            if let Err(problem) = result {
                let _ = problem_sender.send(problem.to_string());
                window.request_repaint();
            }
        };
        let thread = thread::spawn(move || {
            let (disk, written) = channel();
            let also_tell = tell.clone();
            let waiting = thread::spawn(move || also_tell(wait_for_disk(&written)));
            tell(keep(&folder, &entries, &wants, disk));
            let _ = waiting.join(); // nothing is left to be done about a panic there
        });
        Self { sender, thread: Some(thread), found, problems, wants_whole, offered: None, broken: false }
    }

    /// Whether a question is on the screen.
    pub fn is_asking(&self) -> bool {
        self.offered.is_some()
    }

    fn enter(&self, entry: Entry) {
        // A thread that ended has said why.
        let _ = self.sender.send(entry);
    }

    /// Waits until all is written; then the journal is removed, or left for the next start.
    pub fn end(&mut self, remove: bool) {
        self.enter(Entry::End { remove });
        if let Some(thread) = self.thread.take() {
            let _ = thread.join(); // nothing is left to be done about a panic there
        }
    }
}

/// Writes entries as they come, until the end. It never waits for the disk: what is handed to the system
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
            (Entry::Tiles(tiles), Some(journal)) => journal.add_tiles(&tiles, now())?,
            (Entry::Settings(settings), Some(journal)) => journal.add_settings(*settings, now())?,
            (Entry::Clean(home), Some(journal)) => journal.mark_clean(home.as_deref(), now())?,
            (Entry::Tiles(_) | Entry::Settings(_) | Entry::Clean(_), None) => {}
            (Entry::Forget(left), _) => outdated = Some(Outdated::Left(left)),
            (Entry::End { remove: false }, _) => return Ok(()),
            (Entry::End { remove: true }, _) => return journal.map_or(Ok(()), journal::Journal::remove),
        }
        wants_whole.store(journal.as_ref().is_some_and(journal::Journal::is_long), Ordering::Relaxed);
        let syncing = journal.as_ref().map(journal::Journal::syncing).transpose()?;
        // A thread that ended has said why.
        let _ = disk.send(ToDisk { syncing, outdated });
    }
    Ok(())
}

/// A journal that has come so far, and what may go once it is on the disk.
struct ToDisk {
    syncing: Option<journal::Syncing>,
    outdated: Option<Outdated>,
}

enum Outdated {
    Own(journal::Journal),
    Left(Box<Abandoned>),
}

/// How long nothing must have been written before the disk is waited for: the system lets nobody write to a
/// file in that time, and the next gesture would be lost if the program were killed.
const QUIET: Duration = Duration::from_secs(1);
/// How long it is put off at most.
const LONGEST_DELAY: Duration = Duration::from_secs(30);

/// Waits for the disk: once for all that has come in the meantime.
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

/// Seconds since 1970.
fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

impl App {
    /// Hands what was edited to the journal, once a gesture has ended.
    pub(super) fn follow_journal(&mut self) {
        let edited = self.is_edited();
        let Some(keeper) = &mut self.journal else { return };
        if let Ok(problem) = keeper.problems.try_recv() {
            keeper.broken = true;
            let text = "Unsaved work is no longer kept for the case of a crash";
            self.session.report(format!("{text}: {problem}. Save the project from time to time."));
        }
        let document = self.session.document_mut();
        if keeper.broken || document.is_in_gesture() {
            return;
        }
        let edits = document.take_edits();
        if edits.is_empty() {
            return;
        }
        let Edits { settings, all_paint, tiles } = edits;
        if all_paint || keeper.wants_whole.load(Ordering::Relaxed) {
            let home = self.project.path().map(Path::to_owned);
            keeper.enter(Entry::Whole(Box::new(Project::of(document)), home));
        } else {
            if !tiles.is_empty() {
                keeper.enter(Entry::Tiles(document.paint().tiles(tiles)));
            }
            if settings {
                keeper.enter(Entry::Settings(Box::new(document.settings().clone())));
            }
        }
        if !edited {
            self.note_clean();
        }
    }

    /// Tells the journal when nothing is unsaved.
    pub(super) fn note_clean(&mut self) {
        let clean = !self.is_edited();
        if let (Some(keeper), true) = (&self.journal, clean) {
            keeper.enter(Entry::Clean(self.project.path().map(Path::to_owned)));
        }
    }

    /// Offers what an earlier run has left behind.
    pub(super) fn recovery_ui(&mut self, ctx: &Context) {
        let Some(keeper) = &mut self.journal else { return };
        if keeper.offered.is_none() {
            keeper.offered = keeper.found.try_recv().ok();
        }
        if self.project.is_asking() || self.project.is_leaving() {
            // "Restore" was chosen, and first it is decided what becomes of the current document.
            return;
        }
        let Some(left) = &keeper.offered else { return };
        let name = &left.project.settings.name;
        let home = left.home.as_deref().and_then(Path::file_name);
        let name = home.map_or(name.clone(), |home| home.to_string_lossy().into_owned());
        let body = format!(
            "“{name}” was not saved when Meshbrush ended unexpectedly, {}.",
            ago(now().saturating_sub(left.time))
        );
        let dialog = ConfirmDialog::new("Restore unsaved work?", &body, "Restore");
        let Some(answer) = dialog.alternative("Discard").cancel("Later").show(ctx) else { return };
        match answer {
            // It stays offered: the command may be cancelled to keep the current document.
            Answer::Confirmed => self.commands.push(Command::Restore),
            Answer::Alternative => {
                if let Some(left) = keeper.offered.take() {
                    keeper.enter(Entry::Forget(Box::new(left)));
                }
            }
            Answer::Cancelled => keeper.offered = None,
        }
    }

    /// Opens the work that is offered, and keeps it in this run's journal from now on.
    pub(super) fn restore(&mut self) {
        let Some(left) = self.journal.as_mut().and_then(|keeper| keeper.offered.take()) else { return };
        let document = match left.project.clone().into_document() {
            Ok(document) => document,
            Err(problem) => return self.session.report(problem),
        };
        self.show_document(document);
        let version = self.session.document().version();
        self.project.belongs_to(left.home.clone(), version, false);
        self.follow_journal();
        if let Some(keeper) = &self.journal {
            keeper.enter(Entry::Forget(Box::new(left)));
        }
    }
}

/// A time in the past, in words.
fn ago(seconds: u64) -> String {
    let units = [(86_400, "day"), (3600, "hour"), (60, "minute")];
    match units.into_iter().find(|&(length, _)| seconds >= length) {
        None => "less than a minute ago".into(),
        Some((length, unit)) => {
            let count = seconds / length;
            format!("{count} {unit}{} ago", if count == 1 { "" } else { "s" })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ago;

    #[test]
    fn times_are_told_in_the_largest_unit() {
        for (seconds, words) in [
            (0, "less than a minute ago"),
            (60, "1 minute ago"),
            (7199, "1 hour ago"),
            (7200, "2 hours ago"),
            (200_000, "2 days ago"),
        ] {
            assert_eq!(ago(seconds), words);
        }
    }
}

//! Unsaved work, kept gesture by gesture off the window's thread, and offered back after a crash.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{SystemTime, UNIX_EPOCH};

use eframe::egui::Context;

use super::App;
use super::widgets::{Answer, ConfirmDialog};
use crate::document::Edits;
use crate::io::journal::{self, Abandoned};
use crate::io::project::Project;
use crate::paint::Tiles;

/// What is to be written.
enum Entry {
    /// Everything, and the file that it belongs to.
    Whole(Box<Project>, Option<PathBuf>),
    /// Tiles as they are after a gesture.
    Tiles(Tiles),
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
        let (wants, ctx) = (wants_whole.clone(), ctx.clone());
        let thread = thread::spawn(move || {
            for left in journal::abandoned(&folder) {
                let _ = found_sender.send(left);
            }
            ctx.request_repaint();
            if let Err(problem) = keep(&folder, &entries, &wants) {
                // The window may have closed in the meantime.
                let _ = problem_sender.send(problem.to_string());
                ctx.request_repaint();
            }
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

/// Writes entries as they come, until the end.
fn keep(folder: &Path, entries: &Receiver<Entry>, wants_whole: &AtomicBool) -> std::io::Result<()> {
    let mut journal: Option<journal::Journal> = None;
    while let Ok(first) = entries.recv() {
        // All that waits is handed to the system before the disk is waited for.
        for entry in std::iter::once(first).chain(std::iter::from_fn(|| entries.try_recv().ok())) {
            match (entry, &mut journal) {
                (Entry::Whole(project, home), _) => {
                    let new = journal::Journal::begin(folder, &project, home.as_deref(), now())?;
                    if let Some(old) = journal.replace(new) {
                        old.remove()?;
                    }
                    wants_whole.store(false, Ordering::Relaxed);
                }
                (Entry::Tiles(tiles), Some(journal)) => {
                    journal.add_tiles(&tiles, now())?;
                    wants_whole.store(journal.is_long(), Ordering::Relaxed);
                }
                (Entry::Clean(home), Some(journal)) => journal.mark_clean(home.as_deref(), now())?,
                (Entry::Tiles(_) | Entry::Clean(_), None) => {}
                (Entry::Forget(left), _) => left.remove()?,
                (Entry::End { remove: false }, _) => return Ok(()),
                (Entry::End { remove: true }, _) => return journal.map_or(Ok(()), journal::Journal::remove),
            }
        }
        if let Some(journal) = &journal {
            journal.sync()?;
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
        match edits {
            Edits::Tiles(places) if !keeper.wants_whole.load(Ordering::Relaxed) => {
                keeper.enter(Entry::Tiles(document.layers().tiles(places)));
            }
            _ => {
                let home = self.project.path().map(Path::to_owned);
                keeper.enter(Entry::Whole(Box::new(Project::of(document)), home));
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
        let Some(left) = keeper.offered.take() else { return };
        match answer {
            Answer::Confirmed => self.restore(left),
            Answer::Alternative => keeper.enter(Entry::Forget(Box::new(left))),
            Answer::Cancelled => {}
        }
    }

    /// Shows what was left behind, as an edit that can be undone, and keeps it in this run's journal from now on.
    fn restore(&mut self, left: Abandoned) {
        let document = match left.project.clone().into_document() {
            Ok(document) => document,
            Err(problem) => return self.session.report(problem),
        };
        self.show_document("restore", document);
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

//! Files being read and written off the window's thread: how far each is, and how it is cancelled.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::Context;

use super::busy::Busy;
use super::command::{Command, Opened};
use super::document_id::DocumentId;
use super::home::{Home, Loss};
use super::jobs::{Job, JobKind, Jobs, Taken};
use super::threads::Threads;
use meshbrush_io::io::{self, Meter};
use meshbrush_mesh::mesh::Progress;

/// How often an otherwise idle window shows the progress of work.
const PACE: Duration = Duration::from_millis(150);
/// The result of a piece of work. `execute::files` applies it to the window.
pub enum Outcome {
    /// A file was read that becomes a document of its own.
    Opened {
        /// The path of the file.
        path: PathBuf,
        /// The document.
        opened: Opened,
        /// The command that says something about it.
        note: Option<Box<Command>>,
    },
    /// A file was read that becomes a part of the document.
    Read {
        /// The path of the file.
        path: PathBuf,
        /// The commands that use the contents of the file.
        commands: Vec<Command>,
    },
    /// A file was read that is not added to the recent files. The commands use its contents.
    PartRead(Vec<Command>),
    /// A file was not read.
    NotRead(String),
    /// Something was found for the document. The commands use it.
    Found(Vec<Command>),
    /// Nothing was found, for this reason.
    NotFound(String),
    /// An export ended, as it should or cancelled: a sentence about it.
    Exported(String),
    /// A file was not written. A window that was about to close stays open, so that the message is seen.
    NotWritten(String),
    /// This version of the document was saved.
    Saved {
        /// The place that was written.
        home: Home,
        /// The version.
        version: u64,
    },
    /// The document was not saved to this file, because this would be lost.
    NotReplaced(PathBuf, Loss),
    /// Saving was cancelled: a sentence about it.
    SavingCancelled(String),
    /// The document was not saved: a sentence about it.
    NotSaved(String),
}

impl Outcome {
    /// Reports that a file was not read, for this reason.
    pub fn not_read(problem: impl std::fmt::Display) -> Self {
        Self::NotRead(problem.to_string())
    }
}

/// The purpose of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// A file is read. Cancelled, it is forgotten at once.
    Read,
    /// Something is found for the document, without a file. Cancelled, it is forgotten at once.
    Find,
    /// A file is written that is not the document's.
    Export,
    /// This version of the document is saved.
    Save(u64),
}

impl Aim {
    /// Returns whether something is written.
    fn writes(self) -> bool {
        matches!(self, Self::Export | Self::Save(_))
    }

    fn kind(self) -> JobKind {
        if self.writes() { JobKind::Write } else { JobKind::Read }
    }

    fn doing(self) -> &'static str {
        match self {
            Self::Read => "Reading",
            Self::Find => "Finding",
            Self::Export => "Writing",
            Self::Save(_) => "Saving",
        }
    }
}

/// Identifies work as long as the window is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct WorkId(u64);

/// Work that ended.
pub struct Finished {
    /// The document that was open when it began.
    pub document: DocumentId,
    /// The name of its file.
    pub name: String,
    /// The result of the work.
    pub outcome: Outcome,
}

/// A file being read or written.
struct FileWork {
    id: WorkId,
    job: Job<Outcome>,
    aim: Aim,
    /// The name of the file.
    name: String,
    meter: Meter,
    busy: Busy,
}

/// The progress of one piece of work, as it is shown.
pub struct ProgressRow {
    /// Identifies the work.
    pub id: WorkId,
    /// Whether it is read.
    pub reads: bool,
    /// `Reading coast.geojson`.
    pub what: String,
    /// How far it is.
    pub meter: Meter,
}

/// All work on other threads.
pub struct Background {
    ctx: Context,
    jobs: Jobs,
    works: Vec<FileWork>,
    started: u64,
    /// Most threads of each.
    threads: NonZeroUsize,
}

impl Background {
    /// Returns the state without any work, for the window of `ctx`.
    pub fn new(ctx: &Context, jobs: &Jobs) -> Self {
        let (ctx, jobs) = (ctx.clone(), jobs.clone());
        Self { ctx, jobs, works: Vec::new(), started: 0, threads: Threads::most() }
    }

    /// Limits the threads of what is started from now on.
    pub fn limit_threads(&mut self, count: NonZeroUsize) {
        self.threads = count;
    }

    /// Starts work on a file. It checks its meter often; its outcome is applied, unless it only read and was
    /// cancelled.
    #[track_caller]
    pub fn start(&mut self, aim: Aim, path: &Path, work: impl FnOnce(&Meter) -> Outcome + Send + 'static) {
        let meter = Meter::default();
        let (watched, threads) = (meter.clone(), self.threads);
        let job = self.jobs.start(aim.kind(), move |output| {
            output.send(Threads::new(threads).run(|| work(&watched)));
        });
        self.enter(aim, path, meter, job);
    }

    /// Starts work as [`Self::start`] does, in slices: the first one makes a state, and the others are called
    /// until one returns the outcome. The meter only shows how far it is.
    #[track_caller]
    pub fn start_in_slices<S: Send + 'static>(
        &mut self,
        aim: Aim,
        path: &Path,
        begin: impl FnOnce() -> Option<S> + Send + 'static,
        mut slice: impl FnMut(&mut S, &Meter) -> Option<Outcome> + Send + 'static,
    ) {
        let meter = Meter::default();
        let watched = meter.clone();
        let job =
            self.jobs.start_in_slices(aim.kind(), begin, move |state, output| match slice(state, &watched) {
                Some(outcome) => {
                    output.send(outcome);
                    Progress::Done
                }
                None => Progress::More,
            });
        self.enter(aim, path, meter, job);
    }

    /// Enters the job of work on a file, and the meter that it checks.
    pub fn enter(&mut self, aim: Aim, path: &Path, meter: Meter, job: Job<Outcome>) {
        self.started += 1;
        let (id, name) = (WorkId(self.started), name_of(path));
        self.works.push(FileWork { id, job, aim, name, meter, busy: Busy::now() });
    }

    /// Removes one finished piece of work from the list, and returns it.
    pub fn take_finished(&mut self) -> Option<Finished> {
        for at in 0..self.works.len() {
            let work = &self.works[at];
            let outcome = match work.job.take_ready() {
                Taken::Working => continue,
                Taken::Value(outcome) => outcome,
                Taken::Ended => work.failed(),
            };
            let FileWork { job, name, .. } = self.works.remove(at);
            return Some(Finished { document: job.document(), name, outcome });
        }
        None
    }

    /// Cancels work. What was being read is forgotten at once; what is being written ends once nothing is
    /// left of it. Returns what it was for, and the name of its file.
    pub fn cancel(&mut self, id: WorkId) -> Option<(Aim, String)> {
        let at = self.works.iter().position(|work| work.id == id)?;
        let (aim, name) = (self.works[at].aim, self.works[at].name.clone());
        self.works[at].meter.cancel();
        if !aim.writes() {
            self.works.remove(at);
        }
        Some((aim, name))
    }

    /// Returns the names of files that are being written, without cancelled ones.
    pub fn being_written(&self) -> impl Iterator<Item = &str> {
        let wanted = |work: &&FileWork| work.aim.writes() && !work.meter.is_cancelled();
        self.works.iter().filter(wanted).map(|work| work.name.as_str())
    }

    /// Returns whether the document is being saved, including a cancelled save that has not ended yet.
    pub fn saves(&self) -> bool {
        self.works.iter().any(|work| matches!(work.aim, Aim::Save(_)))
    }

    /// Returns whether this version of the document that is open is being saved.
    pub fn saves_version(&self, version: u64) -> bool {
        let saves =
            |work: &FileWork| work.aim == Aim::Save(version) && work.job.document() == self.jobs.document();
        self.works.iter().any(|work| saves(work) && !work.meter.is_cancelled())
    }

    /// Returns the progress of work that takes longer than a moment, or of all work.
    pub fn rows(&self, all: bool) -> Vec<ProgressRow> {
        let shown = self.works.iter().filter(|work| all || work.busy.is_long());
        let row = |work: &FileWork| {
            let doing = if work.meter.is_cancelled() { "Cancelling" } else { work.aim.doing() };
            ProgressRow {
                id: work.id,
                reads: work.aim == Aim::Read,
                what: format!("{doing} {}", work.name),
                meter: work.meter.clone(),
            }
        };
        shown.map(row).collect()
    }

    /// Repaints the window at times while there is work.
    pub fn keep_awake(&self) {
        if !self.works.is_empty() {
            self.ctx.request_repaint_after(PACE);
        }
    }

    /// Waits until nothing is being written, or the time is over. Returns whether anything was: its
    /// outcome may begin the next save.
    pub fn wait_for_writing(&self, longest: Duration) -> bool {
        let writes = self.works.iter().any(|work| work.aim.writes());
        if writes {
            self.jobs.wait_for_writing(longest);
        }
        writes
    }
}

impl FileWork {
    /// Returns the outcome of work that panicked.
    fn failed(&self) -> Outcome {
        let (doing, name) = (self.aim.doing(), &self.name);
        Outcome::NotWritten(format!(
            "{doing} {name} failed because of a bug in Meshbrush. The document is unchanged."
        ))
    }
}

/// Returns the outcome of an export: `done` is a sentence about the file that was written.
pub fn exported(
    written: std::io::Result<()>,
    meter: &Meter,
    path: &Path,
    done: impl FnOnce() -> String,
) -> Outcome {
    match written {
        Ok(()) => Outcome::Exported(done()),
        Err(error) => not_exported(&error, meter, path),
    }
}

/// Returns the outcome of an export that was cancelled or failed.
pub fn not_exported(error: &std::io::Error, meter: &Meter, path: &Path) -> Outcome {
    if meter.is_cancelled() {
        return Outcome::Exported(cancelled(Aim::Export, path));
    }
    let problem = error.to_string();
    Outcome::NotWritten(format!(
        "{} could not be written: {}.",
        path.display(),
        problem.trim_end_matches('.')
    ))
}

/// Says that writing a file was cancelled.
pub fn cancelled(aim: Aim, path: &Path) -> String {
    let left =
        if io::exists(path) { "The file that was there is unchanged." } else { "No file was written." };
    format!("{} {} was cancelled. {left}", aim.doing(), name_of(path))
}

/// Returns the names of files, one after the other; of many only the first and the last one.
pub fn listed(files: &[PathBuf]) -> String {
    match files {
        [first, .., last] if files.len() > 5 => format!("{} … {}", first.display(), last.display()),
        _ => files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", "),
    }
}

/// Returns a file's name, without its folder.
pub fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

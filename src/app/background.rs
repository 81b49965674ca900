//! Files being read and written off the window's thread: how far each is, and how it is cancelled.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use eframe::egui::Context;

use super::App;
use super::busy::Busy;
use super::session::Notice;
use crate::io::{self, Meter};

/// How often a window that nothing else happens in shows how far the work is.
const PACE: Duration = Duration::from_millis(150);
/// How long a window that is taken away waits for what is being written.
const LAST_WAIT: Duration = Duration::from_secs(5);

/// What is to be done in the window once the work is over.
pub type Finish = Box<dyn FnOnce(&mut App) + Send>;

/// What work is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// A file is read. Cancelled, it is forgotten at once.
    Read,
    /// A file is written that is not the document's.
    Export,
    /// This version of the document is saved.
    Save(u64),
}

impl Aim {
    fn doing(self) -> &'static str {
        match self {
            Self::Read => "Reading",
            Self::Export => "Writing",
            Self::Save(_) => "Saving",
        }
    }
}

/// Names work as long as the window is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct WorkId(u64);

/// Work under way.
struct Work {
    id: WorkId,
    aim: Aim,
    /// Of the file.
    name: String,
    meter: Meter,
    busy: Busy,
}

/// How far work is, to be shown.
pub struct Row {
    pub id: WorkId,
    /// `Reading coast.geojson`.
    pub what: String,
    pub meter: Meter,
}

/// All work under way off the window's thread.
pub struct Background {
    ctx: Context,
    sender: Sender<(WorkId, Finish)>,
    receiver: Receiver<(WorkId, Finish)>,
    works: Vec<Work>,
    begun: u64,
}

impl Background {
    /// Nothing yet, in the window of `ctx`.
    pub fn new(ctx: &Context) -> Self {
        let (sender, receiver) = channel();
        Self { ctx: ctx.clone(), sender, receiver, works: Vec::new(), begun: 0 }
    }

    /// Begins work on a file. It looks at its meter often; what it returns is done in the window, unless it only read and was cancelled.
    pub fn start(&mut self, aim: Aim, path: &Path, work: impl FnOnce(&Meter) -> Finish + Send + 'static) {
        self.begun += 1;
        let (id, meter, name) = (WorkId(self.begun), Meter::default(), name_of(path));
        let (sender, ctx, watched) = (self.sender.clone(), self.ctx.clone(), meter.clone());
        let what = format!("{} {name}", aim.doing());
        self.works.push(Work { id, aim, name, meter, busy: Busy::default() });
        thread::spawn(move || {
            // A mistake of ours must not leave the window waiting for ever.
            let finish = catch_unwind(AssertUnwindSafe(|| work(&watched))).unwrap_or_else(|_| {
                let problem = format!("{what} failed by a mistake in Meshbrush. The document is as it was.");
                not_written(problem)
            });
            // The window may have closed in the meantime.
            let _ = sender.send((id, finish));
            ctx.request_repaint();
        });
    }

    /// Takes work that is over from the list, and returns what is to be done now.
    fn finished(&mut self) -> Option<Finish> {
        loop {
            let (id, finish) = self.receiver.try_recv().ok()?;
            if let Some(at) = self.works.iter().position(|work| work.id == id) {
                self.works.remove(at);
                return Some(finish);
            }
        }
    }

    /// Names of files that are being written and wanted.
    pub fn being_written(&self) -> impl Iterator<Item = &str> {
        let wanted = |work: &&Work| work.aim != Aim::Read && !work.meter.is_cancelled();
        self.works.iter().filter(wanted).map(|work| work.name.as_str())
    }

    /// Whether the document is being saved, even if that was cancelled and has not ended yet.
    pub fn saves(&self) -> bool {
        self.works.iter().any(|work| matches!(work.aim, Aim::Save(_)))
    }

    /// Whether this version of the document is being saved.
    pub fn saves_version(&self, version: u64) -> bool {
        self.works.iter().any(|work| work.aim == Aim::Save(version) && !work.meter.is_cancelled())
    }

    /// What to show of the work that takes longer than a moment, or of all. To be asked in every frame.
    pub fn rows(&mut self, all: bool) -> Vec<Row> {
        let mut rows = Vec::new();
        for Work { id, aim, name, meter, busy } in &mut self.works {
            if busy.is_long(true) || all {
                let doing = if meter.is_cancelled() { "Cancelling" } else { aim.doing() };
                rows.push(Row { id: *id, what: format!("{doing} {name}"), meter: meter.clone() });
            }
        }
        rows
    }

    /// Lets the window show how work gets on. Without any it rests.
    pub fn keep_awake(&self) {
        if !self.works.is_empty() {
            self.ctx.request_repaint_after(PACE);
        }
    }
}

impl App {
    /// Does in the window what is to be done after work that is over.
    pub(super) fn take_in_background(&mut self) {
        while let Some(finish) = self.background.finished() {
            finish(self);
        }
    }

    /// Gives work up. What was to be read is forgotten; of what is being written one hears once nothing is left of it.
    pub(super) fn cancel_work(&mut self, id: WorkId) {
        let works = &mut self.background.works;
        let Some(at) = works.iter().position(|work| work.id == id) else { return };
        works[at].meter.cancel();
        match works[at].aim {
            Aim::Read => {
                let name = works.remove(at).name;
                let text = format!("Reading {name} was cancelled. The document is as it was.");
                self.session.set_notice(Some(Notice { failed: false, text }));
                self.project.keep_edits();
            }
            Aim::Export => {}
            Aim::Save(_) => self.project.give_saving_up(),
        }
    }

    /// Waits for what is being written, when the window is gone already.
    pub(super) fn wait_for_writing(&mut self) {
        let start = Instant::now();
        while self.background.works.iter().any(|work| work.aim != Aim::Read) && start.elapsed() < LAST_WAIT {
            self.take_in_background();
            thread::sleep(Duration::from_millis(5));
        }
    }
}

/// Shows a sentence.
pub fn told(text: String) -> Finish {
    Box::new(|app| app.session.set_notice(Some(Notice { failed: false, text })))
}

/// Says why a file was not read. Edits that were to go for it are still there, and are asked about again.
pub fn not_read(problem: impl std::fmt::Display) -> Finish {
    let problem = problem.to_string();
    Box::new(|app| {
        app.project.keep_edits();
        app.session.report(problem);
    })
}

/// Says why a file was not written. A window that was to close stays open, so that it is seen.
pub fn not_written(problem: impl std::fmt::Display) -> Finish {
    let problem = problem.to_string();
    Box::new(|app| {
        app.project.stay();
        app.session.report(problem);
    })
}

/// What to say of a file that was not written because somebody cancelled that.
pub fn cancelled(aim: Aim, path: &Path) -> String {
    let left =
        if io::exists(path) { "The file that was there is as it was." } else { "No file was written." };
    format!("{} {} was cancelled. {left}", aim.doing(), name_of(path))
}

/// A file's name, without its folder.
pub fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

//! Unsaved work, kept in the storage of the browser while one paints, and offered after a reload or a crash.
//!
//! Each tab keeps the whole document under a name of its own, a moment after the last edit. Writing goes on
//! beside the frames; a storage that is full or forbidden is reported once.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use eframe::egui::Context;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::spawn_local;

use meshbrush_io::io::project::{self, Project, ProjectPacking};
use meshbrush_kit::kit::EditRecorder;
use meshbrush_kit::kit::clock::{Duration, Instant};
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs, Output, Taken};
use meshbrush_kit::kit::project::ProjectFile;
use meshbrush_kit::kit::recovery::{self, now};
use meshbrush_kit::kit::session::Session;
use meshbrush_mesh::mesh::Progress;
use meshbrush_ui::widgets::ConfirmAnswer;

#[wasm_bindgen(module = "/web/storage.js")]
extern "C" {
    fn live();
    #[wasm_bindgen(catch)]
    async fn keep(bytes: Uint8Array, home: Option<String>, time: f64) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(catch)]
    async fn forget(tab: Option<String>) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(catch)]
    async fn left() -> Result<JsValue, JsValue>;
}

/// How long after an edit the document is kept, so that several edits are kept at once.
const PAUSE: Duration = Duration::from_millis(500);
/// So many bytes are packed between two frames: some milliseconds.
const SLICE: usize = 100_000;

/// The work that a tab left behind.
#[derive(Clone)]
pub struct Abandoned {
    /// The document.
    pub project: Project,
    /// The name of its file.
    pub home: Option<PathBuf>,
    tab: String,
    time: u64,
}

/// What comes from the storage, sooner or later.
#[derive(Default)]
struct Came {
    left: Vec<Abandoned>,
    /// Work that cannot be read, and why nothing can be kept: sentences.
    problems: Vec<String>,
    /// Whether the storage takes nothing. Nothing is tried again.
    is_broken: bool,
}

/// Keeps the document.
pub struct JournalKeeper {
    came: Rc<RefCell<Came>>,
    jobs: Jobs,
    /// The work that the user is asked about.
    offered: Option<Abandoned>,
    /// Tabs whose work was restored here: it is forgotten once this tab keeps it.
    restored: Vec<String>,
    /// The first edit that is not kept yet.
    edited: Option<Instant>,
    /// Packs the document, and the name of its file.
    packing: Option<(Job<Vec<u8>>, Option<String>)>,
}

impl JournalKeeper {
    /// Begins to keep work, and looks for what earlier tabs left behind.
    pub fn new(_folder: PathBuf, jobs: &Jobs) -> Self {
        live();
        let came = Rc::new(RefCell::<Came>::default());
        let (to, waker) = (came.clone(), jobs.expect::<()>().1);
        spawn_local(async move {
            match left().await {
                Ok(found) => Array::from(&found).iter().for_each(|work| to.borrow_mut().take(&work)),
                Err(problem) => to.borrow_mut().fail(&problem),
            }
            waker.wake();
        });
        Self { came, jobs: jobs.clone(), offered: None, restored: Vec::new(), edited: None, packing: None }
    }

    /// Returns whether the user is being asked about the work of an earlier tab.
    pub fn is_asking(&self) -> bool {
        self.offered.is_some()
    }

    /// Offers the next work that a tab left behind. Returns a sentence about a problem.
    pub fn offer_next(&mut self) -> Option<String> {
        let mut came = self.came.borrow_mut();
        if self.offered.is_none() {
            self.offered = came.left.pop();
        }
        came.problems.pop()
    }

    /// Takes the answer about the work of an earlier tab, and returns the command to run now.
    pub fn answer(&mut self, answer: ConfirmAnswer) -> Option<Command> {
        let (command, forgotten) = recovery::take_answer(&mut self.offered, answer);
        forget_of(forgotten.map(|left| left.tab));
        command
    }

    /// Takes the work that is offered, to restore it.
    pub fn take_offered(&mut self) -> Option<Abandoned> {
        self.offered.take()
    }

    /// Forgets what an earlier tab left behind and this one has restored, once this tab keeps it.
    pub fn forget(&mut self, left: Abandoned) {
        // What is being packed is the document before.
        self.packing = None;
        self.restored.push(left.tab);
    }

    /// Forgets the work of this tab: nothing is unsaved.
    pub fn note_saved(&mut self, _: &ProjectFile) {
        (self.edited, self.packing) = (None, None);
        self.forget_own();
    }

    fn forget_own(&mut self) {
        spawn_local(async { _ = forget(None).await });
        forget_of(std::mem::take(&mut self.restored));
    }

    /// Completes what is being packed, or forgets the work of this tab.
    pub fn end(&mut self, remove: bool, jobs: &Jobs) {
        if let Some((job, home)) = self.packing.take().filter(|_| !remove) {
            if let Taken::Value(bytes) = job.take_ready() {
                self.write(bytes, home);
            }
            jobs.wait_for_end(&job);
        } else if remove {
            self.forget_own();
        }
    }

    /// Keeps the document a moment after its last edit.
    fn advance(&mut self, session: &Session, project: &ProjectFile) {
        if let Some((job, home)) = self.packing.take() {
            match job.take_ready() {
                Taken::Working => self.packing = Some((job, home)),
                Taken::Value(bytes) => self.write(bytes, home),
                Taken::Ended => {}
            }
            return;
        }
        let Some(since) = self.edited.filter(|_| !self.came.borrow().is_broken) else { return };
        if let Some(left) = PAUSE.checked_sub(since.elapsed()) {
            return self.jobs.wake_after(left.as_secs_f64());
        }
        self.edited = None;
        let packed = Project::of(session.document());
        let pack = |packing: &mut ProjectPacking, output: &Output<Vec<u8>>| match packing.advance(SLICE) {
            Ok(None) => Progress::More,
            Ok(Some(bytes)) => {
                output.send(bytes);
                Progress::Done
            }
            Err(_) => Progress::Done,
        };
        let job = self.jobs.start_in_slices(JobKind::Write, || Some(ProjectPacking::new(packed)), pack);
        self.packing = Some((job, project.path().map(|path| path.to_string_lossy().into_owned())));
    }

    fn write(&mut self, bytes: Vec<u8>, home: Option<String>) {
        let (came, waker) = (self.came.clone(), self.jobs.expect::<()>().1);
        let (bytes, restored) = (Uint8Array::from(&*bytes), std::mem::take(&mut self.restored));
        spawn_local(async move {
            match keep(bytes, home, now() as f64).await {
                Ok(_) => forget_of(restored),
                Err(problem) => {
                    came.borrow_mut().fail(&problem);
                    waker.wake();
                }
            }
        });
    }
}

/// Forgets the work of some other tabs.
fn forget_of(tabs: impl IntoIterator<Item = String>) {
    tabs.into_iter().for_each(|tab| spawn_local(async move { _ = forget(Some(tab)).await }));
}

impl Came {
    /// Takes [tab, bytes, home, time].
    fn take(&mut self, work: &JsValue) {
        let parts = Array::from(work);
        let home = parts.get(2).as_string().map(PathBuf::from);
        let (tab, bytes) = (parts.get(0).as_string().unwrap_or_default(), Uint8Array::new(&parts.get(1)));
        let name = home.clone().unwrap_or_else(|| "Unsaved work".into());
        match project::from_bytes(&bytes.to_vec(), &name) {
            Ok(project) => {
                let time = parts.get(3).as_f64().unwrap_or_default() as u64;
                self.left.push(Abandoned { project, home, tab, time });
            }
            Err(problem) => {
                self.problems.push(format!("Unsaved work of an earlier tab cannot be read. {problem}"))
            }
        }
    }

    fn fail(&mut self, problem: &JsValue) {
        if !std::mem::replace(&mut self.is_broken, true) {
            let reason =
                js_sys::Reflect::get(problem, &"message".into()).ok().and_then(|text| text.as_string());
            let reason = reason.unwrap_or_else(|| "it is full or forbidden".into());
            self.problems.push(format!(
                "Unsaved work is not kept in the storage of the browser ({}). Save the project from time to time.",
                reason.trim_end_matches('.')
            ));
        }
    }
}

impl EditRecorder for JournalKeeper {
    fn record(&mut self, session: &mut Session, project: &ProjectFile) {
        if session.document().is_in_gesture() {
            return;
        }
        if !session.document_mut().take_edits().is_empty() {
            if project.is_edited(session) {
                self.edited.get_or_insert_with(Instant::now);
            } else {
                self.note_saved(project);
            }
        }
        self.advance(session, project);
    }
}

/// Asks whether to restore what an earlier tab left behind.
pub fn question(ctx: &Context, keeper: &JournalKeeper, project: &ProjectFile, commands: &mut Vec<Command>) {
    if let Some(Abandoned { project: left, home, time, .. }) = &keeper.offered {
        recovery::question(ctx, (left, home.as_deref().map(Path::new), *time), project, commands);
    }
}

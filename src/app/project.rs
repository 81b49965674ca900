//! The file that the document belongs to: opening it, saving it, and asking before something would be lost.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use eframe::egui::{Context, ViewportCommand};

use super::App;
use super::command::Command;
use super::files::{FileRequest, listed};
use super::session::Notice;
use super::widgets::{Answer, ConfirmDialog};
use crate::document::Document;
use crate::io;
use crate::io::project::{ENDING, Project};
use crate::render::export::ExportFormat;

/// Most files that are remembered.
const MOST_RECENT: usize = 8;
/// Names under which the window's own storage keeps things.
const RECENT_KEY: &str = "recent files";

/// What came of work off the thread.
enum Outcome {
    Opened(PathBuf, Box<Document>),
    Saved(PathBuf, u64),
    /// Saving failed; the sentence says why.
    NotSaved(String),
    /// Opening failed.
    NotOpened(String),
}

/// The document's file, and what of the document is saved.
pub struct ProjectFile {
    sender: Sender<Outcome>,
    receiver: Receiver<Outcome>,
    path: Option<PathBuf>,
    /// The versions of the document that were opened, or saved last.
    unedited: Vec<u64>,
    recent: Vec<PathBuf>,
    /// The command that would lose edits, while it is asked what to do with them.
    leaving: Option<Command>,
    /// The command that waits until the document is saved.
    after_saving: Option<Command>,
    /// The version that may be lost: somebody said so.
    given_up: Option<u64>,
    /// Files that are there already, while it is asked whether they are to be replaced, and the command that does it.
    replacing: Option<(Vec<PathBuf>, Command)>,
    saving: bool,
    /// Where to save once more when the present saving is done.
    save_again: Option<PathBuf>,
    /// The version over which a file is being opened.
    opening: Option<u64>,
    window_title: String,
}

impl ProjectFile {
    /// No file; `version` of the document was opened.
    pub fn new(version: u64) -> Self {
        let (sender, receiver) = channel();
        Self {
            sender,
            receiver,
            path: None,
            unedited: vec![version],
            recent: Vec::new(),
            leaving: None,
            after_saving: None,
            given_up: None,
            replacing: None,
            saving: false,
            save_again: None,
            opening: None,
            window_title: String::new(),
        }
    }

    /// Where the document was saved or opened.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Files opened or saved, the last first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    /// Whether a question is on the screen.
    pub fn is_asking(&self) -> bool {
        self.leaving.is_some() || self.replacing.is_some()
    }

    /// Takes the list of files from where the window keeps it.
    pub fn remember(&mut self, storage: &dyn eframe::Storage) {
        self.recent = eframe::get_value(storage, RECENT_KEY).unwrap_or_default();
        self.recent.truncate(MOST_RECENT);
    }

    /// Puts it there.
    pub fn store(&self, storage: &mut dyn eframe::Storage) {
        // What has no text cannot be stored; the others are.
        let named: Vec<&PathBuf> = self.recent.iter().filter(|path| path.to_str().is_some()).collect();
        eframe::set_value(storage, RECENT_KEY, &named);
    }

    /// The document is another one now, or belongs to another file. `saved` tells that the file has that version.
    pub(super) fn belongs_to(&mut self, path: Option<PathBuf>, version: u64, saved: bool) {
        if path.is_some() {
            self.unedited.clear();
        }
        if saved {
            self.unedited.push(version);
        }
        if let Some(path) = &path {
            self.recent.retain(|other| other != path);
            self.recent.insert(0, path.clone());
            self.recent.truncate(MOST_RECENT);
        }
        self.path = path;
    }

    fn run(&self, ctx: &Context, work: impl FnOnce() -> Outcome + Send + 'static) {
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        thread::spawn(move || {
            // The window may have closed in the meantime.
            let _ = sender.send(work());
            ctx.request_repaint();
        });
    }
}

/// What opening a file means, by its ending.
///
/// # Errors
/// A sentence, when files with that ending cannot be opened.
pub fn open_command(path: PathBuf) -> Result<Command, String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match ending.as_str() {
        ENDING => Ok(Command::OpenProject(path)),
        "png" => Ok(Command::OpenImage(path)),
        "geojson" | "json" => Ok(Command::OpenDomain(path)),
        _ => Err(format!(
            "{} cannot be opened: a project ends in .{ENDING}, a domain of polygons in .geojson, a greyscale picture of risk in .png.",
            path.display()
        )),
    }
}

impl App {
    /// Whether something would be lost if the document went now.
    pub(super) fn is_edited(&self) -> bool {
        let document = self.session.document();
        document.stroke().is_some()
            || !self.cutter.is_idle()
            || !self.project.unedited.contains(&document.version())
    }

    pub(super) fn may_leave(&self) -> bool {
        !self.is_edited() || self.project.given_up == Some(self.session.document().version())
    }

    /// The command, unless it is to be asked first what becomes of unsaved edits.
    pub(super) fn asked_before_leaving(&mut self, command: Command) -> Option<Command> {
        let leaves = matches!(
            command,
            Command::New
                | Command::OpenExample(_)
                | Command::OpenProject(_)
                | Command::OpenDomain(_)
                | Command::Quit
        );
        if leaves && !self.may_leave() {
            self.project.leaving = Some(command);
            return None;
        }
        Some(command)
    }

    /// Name of the document: that of its file, if it has one.
    pub(super) fn document_name(&self) -> String {
        match self.project.path().and_then(Path::file_stem) {
            Some(stem) => stem.to_string_lossy().into_owned(),
            None => self.session.document().settings().name.clone(),
        }
    }

    /// Everything about files that goes on from frame to frame.
    pub(super) fn project_ui(&mut self, ctx: &Context) {
        self.take_in_project_work();
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        self.commands.extend(dropped.iter().map(|file| Command::Open(file.path().to_owned())));
        if ctx.input(|input| input.viewport().close_requested()) && !self.may_leave() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.project.leaving = Some(Command::Quit);
        }
        if !self.project.saving && !self.files.is_asking() && self.project.replacing.is_none() {
            // Nobody saved after all.
            self.project.after_saving = None;
        }
        self.leaving_ui(ctx);
        self.replacing_ui(ctx);
        let mark = if self.is_edited() { "• " } else { "" };
        let title = format!("{mark}{} — Meshbrush", self.document_name());
        if title != self.project.window_title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.project.window_title = title;
        }
    }

    fn leaving_ui(&mut self, ctx: &Context) {
        let Some(command) = self.project.leaving.clone() else { return };
        if self.project.replacing.is_some() || self.files.is_asking() {
            return;
        }
        let question = format!("Save changes to “{}”?", self.document_name());
        let dialog = ConfirmDialog::new(&question, "What is not saved will be lost.", "Save");
        let Some(answer) = dialog.alternative("Do not save").show(ctx) else { return };
        self.project.leaving = None;
        match answer {
            Answer::Confirmed => {
                self.save(ctx);
                self.project.after_saving = Some(command);
            }
            Answer::Alternative => {
                self.session.document_mut().end_stroke();
                self.project.given_up = Some(self.session.document().version());
                self.commands.push(command);
            }
            Answer::Cancelled => {}
        }
    }

    fn replacing_ui(&mut self, ctx: &Context) {
        let Some((files, command)) = self.project.replacing.clone() else { return };
        let (question, body) = match &files[..] {
            [file] => {
                (format!("Replace {}?", file.display()), "What is in the file now will be lost.".into())
            }
            _ => (
                format!("Replace {} files?", files.len()),
                format!("What is in {} now will be lost.", listed(&files)),
            ),
        };
        let Some(answer) = ConfirmDialog::new(&question, &body, "Replace").danger().show(ctx) else { return };
        self.project.replacing = None;
        if answer == Answer::Confirmed {
            self.execute(command, ctx);
        }
    }

    /// Opens any file that can be opened.
    pub(super) fn open_file(&mut self, path: PathBuf) {
        match open_command(path) {
            Ok(command) => self.commands.push(command),
            Err(problem) => self.session.report(problem),
        }
    }

    /// Reads a project; it is shown once it is read.
    pub(super) fn open_project(&mut self, path: PathBuf, ctx: &Context) {
        self.project.opening = Some(self.session.document().version());
        self.project.run(ctx, move || match io::project::read(&path) {
            Ok(document) => Outcome::Opened(path, Box::new(document)),
            Err(error) => Outcome::NotOpened(error.to_string()),
        });
    }

    /// Saves to the document's file, or asks where.
    pub(super) fn save(&mut self, ctx: &Context) {
        match self.project.path.clone() {
            Some(path) => self.save_to(path, ctx),
            None => self.files.ask(FileRequest::Save),
        }
    }

    /// Saves to a file that somebody typed: not over another one without a question.
    pub(super) fn save_as(&mut self, path: PathBuf, ctx: &Context) {
        let path = with_ending(path);
        if io::exists(&path) && self.project.path() != Some(&path) {
            self.project.replacing = Some((vec![path.clone()], Command::SaveTo(path)));
        } else {
            self.save_to(path, ctx);
        }
    }

    /// Exports to a file that somebody typed: not over others without a question.
    pub(super) fn export_as(&mut self, path: PathBuf, ctx: &Context) {
        let files = ExportFormat::of(&path).map_or(Vec::new(), |format| format.files(&path));
        let there: Vec<PathBuf> = files.into_iter().filter(|file| io::exists(file)).collect();
        if there.is_empty() || there.iter().any(|file| io::obstacle(file).is_some()) {
            self.execute(Command::Export(path), ctx);
        } else {
            self.project.replacing = Some((there, Command::Export(path)));
        }
    }

    /// Saves the document as it is now, while painting goes on.
    pub(super) fn save_to(&mut self, path: PathBuf, ctx: &Context) {
        let path = with_ending(path);
        if self.project.saving {
            self.project.save_again = Some(path);
            return;
        }
        self.project.saving = true;
        let document = self.session.document_mut();
        document.end_stroke();
        document.end_gesture();
        let (project, version) = (Project::of(document), document.version());
        self.project.run(ctx, move || {
            let write = || io::write_file(&path, |mut out| io::project::write(&mut out, &project));
            let written = io::obstacle(&path).map_or_else(|| write().map_err(|error| error.to_string()), Err);
            match written {
                Ok(()) => Outcome::Saved(path, version),
                Err(error) => Outcome::NotSaved(format!("{} could not be saved: {error}.", path.display())),
            }
        });
    }

    fn take_in_project_work(&mut self) {
        while let Ok(outcome) = self.project.receiver.try_recv() {
            match outcome {
                Outcome::Opened(path, document) => self.show_project(path, *document),
                Outcome::Saved(path, version) => self.note_saved(path, version),
                Outcome::NotSaved(problem) => {
                    self.project.saving = false;
                    self.project.save_again = None;
                    self.project.after_saving = None;
                    self.session.report(problem);
                }
                Outcome::NotOpened(problem) => {
                    // The edits are still here: they are asked about again.
                    self.project.given_up = None;
                    self.session.report(problem);
                }
            }
        }
    }

    fn show_project(&mut self, path: PathBuf, document: Document) {
        if self.project.opening.take() != Some(self.session.document().version()) {
            let problem = "was not opened, as the document was edited in the meantime. Open it again.";
            self.session.report(format!("{} {problem}", path.display()));
            return;
        }
        self.show_document("open project", document);
        // What was there before belongs to another file.
        self.session.document_mut().forget_history();
        self.project.belongs_to(Some(path), self.session.document().version(), true);
    }

    fn note_saved(&mut self, path: PathBuf, version: u64) {
        self.project.saving = false;
        let text = format!("Saved to {}.", path.display());
        self.project.belongs_to(Some(path), version, true);
        self.session.set_notice(Some(Notice { failed: false, text }));
        self.note_clean();
        if let Some(path) = self.project.save_again.take() {
            self.commands.push(Command::SaveTo(path));
        } else {
            // Edits made since are asked about again.
            self.commands.extend(self.project.after_saving.take());
        }
    }
}

fn with_ending(path: PathBuf) -> PathBuf {
    let has_it = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING));
    if has_it {
        return path;
    }
    let mut name = path.into_os_string();
    name.push(format!(".{ENDING}"));
    name.into()
}

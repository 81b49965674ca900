//! The file that the document belongs to: opening it, saving it, and asking before something would be lost.

use std::io::Write;
use std::path::{Path, PathBuf};

use eframe::egui::{Context, ViewportCommand};

use super::App;
use super::background::{Aim, cancelled, not_read};
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

/// The document's file, and what of the document is saved.
pub struct ProjectFile {
    path: Option<PathBuf>,
    /// The version of the document that was opened, or saved last; `None` if it is in no file.
    saved_version: Option<u64>,
    recent: Vec<PathBuf>,
    /// The command that would lose edits, while it is asked what to do with them.
    leaving: Option<Command>,
    /// The command that waits until the document is saved.
    after_saving: Option<Command>,
    /// The version that may be lost: somebody said so.
    given_up: Option<u64>,
    /// Files that are there already, while it is asked whether they are to be replaced, and the command that
    /// does it.
    replacing: Option<(Vec<PathBuf>, Command)>,
    /// Where to save once more when the present saving is done.
    save_again: Option<PathBuf>,
    /// The window closes once everything is written.
    closing: bool,
    window_title: String,
}

impl ProjectFile {
    /// No file; `version` of the document was opened.
    pub fn new(version: u64) -> Self {
        Self {
            path: None,
            saved_version: Some(version),
            recent: Vec::new(),
            leaving: None,
            after_saving: None,
            given_up: None,
            replacing: None,
            save_again: None,
            closing: false,
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

    /// The document is another one now, or belongs to another file. `saved` tells that the file has that
    /// version.
    pub(super) fn belongs_to(&mut self, path: Option<PathBuf>, version: u64, saved: bool) {
        self.saved_version = saved.then_some(version);
        if let Some(path) = &path {
            self.recent.retain(|other| other != path);
            self.recent.insert(0, path.clone());
            self.recent.truncate(MOST_RECENT);
        }
        self.path = path;
    }

    /// Whether the window, or the document, is left once something is written.
    pub fn is_leaving(&self) -> bool {
        self.closing || self.after_saving.is_some()
    }

    /// Edits that were given up are asked about again.
    pub(super) fn keep_edits(&mut self) {
        self.given_up = None;
    }

    /// Forgets that anybody wanted to leave: something went wrong on the way.
    pub(super) fn stay(&mut self) {
        self.keep_edits();
        self.after_saving = None;
        self.closing = false;
    }

    /// Forgets what was to come after saving, too.
    pub(super) fn give_saving_up(&mut self) {
        self.stay();
        self.save_again = None;
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
            || self.project.saved_version != Some(document.version())
    }

    /// Whether the document is being saved as it is now.
    fn is_being_saved(&self) -> bool {
        let document = self.session.document();
        document.stroke().is_none() && self.background.saves_version(document.version())
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
                | Command::NewWith(_)
                | Command::Restore
                | Command::Quit
        );
        if leaves && !self.may_leave() {
            if self.is_being_saved() {
                self.say_when_it_closes(&command);
                self.project.after_saving = Some(command);
            } else {
                self.project.leaving = Some(command);
            }
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
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        self.commands.extend(dropped.iter().map(|file| Command::Open(file.path().to_owned())));
        self.close_once_written(ctx);
        if !self.background.saves() && !self.files.is_asking() && self.project.replacing.is_none() {
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

    /// Keeps the window open until nothing would be lost with it.
    fn close_once_written(&mut self, ctx: &Context) {
        let writes = self.background.being_written().next().is_some();
        if !ctx.input(|input| input.viewport().close_requested()) {
            if self.project.closing && !writes {
                self.project.closing = false;
                self.commands.push(Command::Quit);
            }
        } else if !self.may_leave() || writes {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            if let Some(quit) = self.asked_before_leaving(Command::Quit) {
                self.say_when_it_closes(&quit);
                self.project.closing = true;
            }
        }
    }

    fn say_when_it_closes(&mut self, command: &Command) {
        if *command == Command::Quit {
            let names = self.background.being_written().collect::<Vec<_>>().join(", ");
            let text = format!("Meshbrush closes as soon as this is written: {names}.");
            self.session.set_notice(Some(Notice { failed: false, text }));
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
                self.save();
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
    pub(super) fn open_project(&mut self, path: PathBuf) {
        let (file, over) = (path.clone(), self.session.document().version());
        self.background.start(Aim::Read, &path, move |meter| match io::project::read_metered(&file, meter) {
            Ok(document) => Box::new(move |app| app.show_project(file, document, over)),
            Err(error) => not_read(error),
        });
    }

    /// Saves to the document's file, or asks where.
    pub(super) fn save(&mut self) {
        match self.project.path.clone() {
            Some(path) => self.save_to(path),
            None => self.files.ask(FileRequest::Save),
        }
    }

    /// Saves to a file that somebody typed: not over another one without a question.
    pub(super) fn save_as(&mut self, path: PathBuf) {
        let path = with_ending(path);
        if io::exists(&path) && self.project.path() != Some(&path) {
            self.project.replacing = Some((vec![path.clone()], Command::SaveTo(path)));
        } else {
            self.save_to(path);
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
    pub(super) fn save_to(&mut self, path: PathBuf) {
        let path = with_ending(path);
        if self.background.saves() {
            self.project.save_again = Some(path);
            return;
        }
        let document = self.session.document_mut();
        document.end_stroke();
        document.end_gesture();
        let (project, version) = (Project::of(document), document.version());
        let (aim, file) = (Aim::Save(version), path.clone());
        self.background.start(aim, &path, move |meter| {
            let write = |out: &mut dyn Write| io::project::write_metered(out, &project, meter);
            match io::write_file_metered(&file, meter, write) {
                Ok(()) => Box::new(move |app| app.note_saved(file, version)),
                Err(_) if meter.is_cancelled() => {
                    let text = cancelled(aim, &file);
                    Box::new(move |app| app.note_cancelled(text))
                }
                Err(error) => {
                    let problem = format!("{} could not be saved: {error}.", file.display());
                    Box::new(move |app| app.note_not_saved(problem))
                }
            }
        });
    }

    fn show_project(&mut self, path: PathBuf, document: Document, over: u64) {
        if over != self.session.document().version() {
            let problem = "was not opened, as the document was edited in the meantime. Open it again.";
            self.session.report(format!("{} {problem}", path.display()));
            return;
        }
        self.show_document(document);
        self.project.belongs_to(Some(path), self.session.document().version(), true);
    }

    fn note_saved(&mut self, path: PathBuf, version: u64) {
        let text = format!("Saved to {}.", path.display());
        self.project.belongs_to(Some(path), version, true);
        self.session.set_notice(Some(Notice { failed: false, text }));
        self.note_clean();
        self.save_again();
        if !self.background.saves() {
            // Edits made since are asked about again.
            self.commands.extend(self.project.after_saving.take());
        }
    }

    fn note_cancelled(&mut self, text: String) {
        self.session.set_notice(Some(Notice { failed: false, text }));
        // Asked for after the cancelling.
        self.save_again();
    }

    fn note_not_saved(&mut self, problem: String) {
        self.project.give_saving_up();
        self.session.report(problem);
    }

    fn save_again(&mut self) {
        if let Some(path) = self.project.save_again.take() {
            self.save_to(path);
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

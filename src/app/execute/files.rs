//! Commands about documents and their files, and what finished work on files does.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{Context, ViewportCommand};

use crate::app::App;
use crate::app::canvas::overlay_of_picture;
use crate::app::dialogs::Dialog;
use crate::app::features::plots::{PlotKind, PlotsCommand};
use crate::app::features::statistics::Statistics;
use crate::app::file_kinds::{ADD_DATA, SAVE_PROJECT, opened_kind};
use crate::app::host;
use crate::app::journal::JournalKeeper;
use crate::app::{files, link};
use meshbrush_core::document::{Document, Example};
use meshbrush_core::layers::DepthSurface;
use meshbrush_io::io::Meter;
use meshbrush_kit::kit::EditRecorder as _;
use meshbrush_kit::kit::background::{Aim, Finished, Outcome, WorkId, name_of};
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand, Opened};
use meshbrush_kit::kit::export_set::ExportSet;
use meshbrush_kit::kit::home::{self, Home, Loss};
use meshbrush_kit::kit::{FileRequest, look_at, raster_frame};
use meshbrush_render::render::export::ExportFormat;

impl App {
    /// Returns whether an export has files of lines beside those of the mesh.
    fn has_lines(&self) -> bool {
        !self.session.document().settings().lines.is_empty()
    }

    /// Exports to a path that was typed, after a question where files would be replaced.
    fn export_as(&mut self, path: PathBuf) {
        let has_lines = self.has_lines();
        self.commands.extend(self.project.export_as(path, has_lines));
    }

    /// Exports to all files again, after a question where foreign ones would be replaced.
    fn export_again(&mut self) {
        let has_lines = self.has_lines();
        self.commands.extend(self.project.export_again(has_lines));
    }

    /// Opens an example, and shows what it is about.
    fn open_example(&mut self, example: Example) {
        let missing = files::missing_for(example);
        if !missing.is_empty() {
            let open = Command::from(FileCommand::OpenExample(example));
            return self.fetch(missing, format!("The example “{}”", example.name()), vec![open]);
        }
        if self.jobs.is_without_threads() && !files::data_of(example).is_empty() {
            return files::open_example_in_slices(&mut self.background, example);
        }
        self.show_example(example, Arc::new(files::example(example)));
    }

    /// Shows the document of an example.
    fn show_example(&mut self, example: Example, document: Arc<Document>) {
        self.open(Arc::unwrap_or_clone(document));
        let layers = &self.session.document().settings().layers;
        self.view.show_depths(DepthSurface::of(layers).is_some());
        if example == Example::Heights {
            let surface = self.session.document().settings().surfaces().next().map(|(layer, _)| layer.id);
            if let Some(surface) = surface {
                self.send(Command::from(LayerCommand::Select(surface)));
            }
            self.send(Command::from(PlotsCommand::Show(PlotKind::Errors)));
        }
    }

    /// Fetches files that come with the program, and then sends commands. `what` needs them.
    pub(in crate::app) fn fetch(&mut self, files: Vec<&'static str>, what: String, then: Vec<Command>) {
        let Some(&first) = files.first() else { return };
        let outcome = move |fetched: Result<(), String>| match fetched {
            Ok(()) => Outcome::PartRead(then),
            Err(problem) => Outcome::NotRead(format!("{what} could not be loaded: {problem}")),
        };
        let job = host::fetch(files, outcome, &self.jobs);
        self.background.enter(Aim::Read, Path::new(first), Meter::default(), job);
    }

    pub(in crate::app) fn execute_on_files(&mut self, command: FileCommand, ctx: &Context) {
        match command {
            FileCommand::New => self.open(files::new_document()),
            FileCommand::NewFromPage => {
                self.open(files::new_document());
                self.dialogs.open(Dialog::Start);
            }
            FileCommand::OpenExample(example) => self.open_example(example),
            FileCommand::ShowExample(example, opened) => self.show_example(example, opened.document),
            FileCommand::CopyLink => self.copy_link(ctx),
            FileCommand::Ask(request) => self.ask_for_file(request),
            FileCommand::Open(path) => self.open_file(path, |kind| kind.command),
            FileCommand::OpenFirst(path) => self.open_file(path, |kind| kind.command_at_start),
            FileCommand::AddData(path) => self.add_data(path),
            FileCommand::OpenProject(path) => home::open(&mut self.background, &path),
            FileCommand::OpenRecipe(path) => files::open_recipe(&mut self.background, &path),
            FileCommand::Show(opened) => self.show_opened(opened),
            FileCommand::Fail(problem) => self.fail(problem),
            FileCommand::Save => match self.project.path() {
                Some(path) => self.send(Command::from(FileCommand::SaveTo(path.to_owned()))),
                None => self.ask_for_file(&SAVE_PROJECT),
            },
            FileCommand::SaveAs(path) => self.commands.extend(self.project.save_as(path)),
            FileCommand::SaveTo(path) => {
                self.project.save_to(path, &mut self.session, &mut self.background);
            }
            FileCommand::SaveOver(path) => {
                self.project.save_over(path, &mut self.session, &mut self.background);
            }
            FileCommand::SaveRecipeAs(path) => self.save_recipe_as(path),
            FileCommand::SaveRecipe(path) => {
                files::save_recipe(&self.session, &self.project.exports, &mut self.background, &path)
            }
            FileCommand::ExportTestAs(path) => self.commands.extend(self.project.export_test_as(path)),
            FileCommand::ExportTest(path) => {
                let started = files::export_test(&mut self.session, &mut self.background, &path);
                self.fail_on(started);
            }
            FileCommand::ExportAs(path) => self.export_as(path),
            FileCommand::Export(path) => self.export(&path),
            FileCommand::SetExports(outputs) => self.project.exports = ExportSet::of_recipe(outputs),
            FileCommand::ExportAgain => self.export_again(),
            FileCommand::ExportAll => self.export_all(),
            FileCommand::CancelWork(id) => self.cancel_work(id),
            FileCommand::Restore => self.restore(),
            FileCommand::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            FileCommand::AnswerLeaving(answer) => {
                self.commands.extend(self.project.answer_leaving(answer, &mut self.session));
            }
            FileCommand::AnswerReplacing(answer) => match self.project.answer_replacing(answer) {
                Some(command) => self.send(command),
                None => self.dialogs.resume(),
            },
            FileCommand::AnswerRecovery(answer) => {
                self.commands.extend(self.journal.as_mut().and_then(|keeper| keeper.answer(answer)));
            }
        }
    }

    /// Writes the mesh to a file, which joins those to write again.
    fn export(&mut self, path: &Path) {
        let is_picture = matches!(ExportFormat::from_path(path), Ok(ExportFormat::Png | ExportFormat::Svg));
        let courant = self.features.get::<Statistics>().courant();
        let overlay = is_picture.then(|| overlay_of_picture(&self.session, &self.view, courant)).flatten();
        let started = files::export(&self.session, &self.view, overlay, &mut self.background, path);
        if started.is_ok() {
            self.project.exports.note(path);
        }
        self.fail_on(started);
    }

    fn export_all(&mut self) {
        let paths: Vec<PathBuf> = self.project.exports.paths().map(Path::to_owned).collect();
        self.commands.extend(paths.into_iter().map(|path| Command::from(FileCommand::Export(path))));
    }

    /// Copies a link to the page of the program with the document in it.
    fn copy_link(&mut self, ctx: &Context) {
        match self.link() {
            Ok(link) => {
                let page = host::address();
                ctx.copy_text(format!("{page}#{link}"));
                let how = match page.is_empty() {
                    true => {
                        "Append it to the address of a page with Meshbrush, or open it with “meshbrush LINK”"
                    }
                    false => "Whoever opens it gets this document and this view",
                };
                self.session.tell(format!("The link was copied. {how}."));
            }
            Err(problem) => self.session.report(problem),
        }
    }

    /// Opens a link, or a file by a command of its kind.
    fn open_file(&mut self, path: PathBuf, command: fn(FileRequest) -> fn(PathBuf) -> Command) {
        match (link::part_of(&path), opened_kind(&path)) {
            (Some(link), _) => self.open_link(&link),
            (None, Ok(kind)) => self.send(command(kind)(path)),
            (None, Err(problem)) => self.fail(problem),
        }
    }

    /// Opens a file that is a document; reads any other one, and asks what it is to be.
    fn add_data(&mut self, path: PathBuf) {
        let name = path.file_name().unwrap_or_default();
        if ADD_DATA.takes(name) {
            let frame = raster_frame(&self.session);
            look_at(&mut self.background, &path, frame);
        } else {
            self.send(Command::from(FileCommand::Open(path)));
        }
    }

    fn save_recipe_as(&mut self, path: PathBuf) {
        let recipe = files::recipe_of(&self.session, &self.project.exports, &path);
        self.commands.extend(self.project.save_recipe_as(path, &recipe));
    }

    fn ask_for_file(&mut self, request: FileRequest) {
        let name = self.project.document_name(&self.session);
        // A document that was not saved yet is often made from the last file that was opened.
        let beside = self.project.path().or(self.project.recent().first().map(PathBuf::as_path));
        self.dialogs.ask(request, (self.session.document_id(), &name), beside, &self.jobs);
    }

    pub(super) fn fail_on(&mut self, started: Result<(), String>) {
        if let Err(problem) = started {
            self.fail(problem);
        }
    }

    /// Says that a file was not read or written: in the dialog that asked for it, or else on the canvas.
    pub(super) fn fail(&mut self, problem: String) {
        self.starts_with_file = false;
        if !self.dialogs.fail(&problem) {
            self.session.report(problem);
        }
    }

    pub(super) fn open(&mut self, document: Document) {
        self.show_document(document);
        self.project.open(None, self.session.document().version(), true);
    }

    fn show_opened(&mut self, opened: Opened) {
        self.show_document(Arc::unwrap_or_clone(opened.document));
        self.open_project_of(opened.home, true);
    }

    /// Notes the file of the document that was just opened, and says so if another window has it open.
    fn open_project_of(&mut self, home: Option<Home>, saved: bool) {
        if self.project.open(home, self.session.document().version(), saved) {
            let name = self.project.path().map(name_of).unwrap_or_default();
            self.session.report(format!(
                "{name} is open in another window of Meshbrush, too. Save this document under another name if you edit it \
                 in both."
            ));
        }
    }

    fn cancel_work(&mut self, id: WorkId) {
        match self.background.cancel(id) {
            Some((Aim::Read, name)) => {
                self.starts_with_file = false;
                self.session.tell(format!("Reading {name} was cancelled. The document is unchanged."));
                self.dialogs.resume();
            }
            Some((Aim::Find, name)) => {
                self.session.tell(format!("Finding {name} was cancelled. The document is unchanged."));
            }
            Some((Aim::Save(_), _)) => self.project.cancel_saving(),
            Some((Aim::Export, _)) | None => {}
        }
    }

    /// Opens the work of an earlier run that is offered, and records it in this run's journal from now on.
    fn restore(&mut self) {
        let Some(left) = self.journal.as_mut().and_then(JournalKeeper::take_offered) else { return };
        let document = match left.project.clone().into_document() {
            Ok(document) => document,
            Err(problem) => return self.session.report(problem),
        };
        self.show_document(document);
        // What was in the file at that time is not known: saving asks first.
        let home = left.home.clone().map(|path| Home { path, stamp: None });
        self.open_project_of(home, false);
        self.record_edits();
        if let Some(keeper) = &mut self.journal {
            keeper.forget(left);
        }
    }

    /// Hands finished gestures to the journal.
    pub(in crate::app) fn record_edits(&mut self) {
        if let Some(keeper) = &mut self.journal {
            keeper.record(&mut self.session, &self.project);
        }
    }

    /// Applies the outcome of the next work that ended on another thread. Returns whether there was any.
    pub(in crate::app) fn finish_next_work(&mut self) -> bool {
        let Some(finished) = self.background.take_finished() else { return false };
        if finished.document == self.session.document_id() {
            self.finish(finished.outcome);
        } else {
            self.finish_for_former_document(finished);
        }
        true
    }

    fn finish(&mut self, outcome: Outcome) {
        match outcome {
            Outcome::Opened { path, opened, note } => {
                let show = Command::from(FileCommand::Show(opened));
                self.finish_reading(path, [show].into_iter().chain(note.map(|note| *note)).collect());
            }
            Outcome::Read { path, commands } => self.finish_reading(path, commands),
            Outcome::PartRead(commands) => {
                self.dialogs.succeed(true);
                self.commands.extend(commands);
            }
            Outcome::NotRead(problem) => self.fail(problem),
            Outcome::Found(commands) => self.commands.extend(commands),
            Outcome::NotFound(problem) => self.session.report(problem),
            Outcome::Exported(text) => {
                self.dialogs.succeed(false);
                self.session.tell(text);
            }
            Outcome::NotWritten(problem) => {
                self.project.stay();
                self.fail(problem);
            }
            Outcome::Saved { home, version } => {
                self.dialogs.succeed(false);
                self.session.tell(format!("Saved to {}.", home.path.display()));
                self.project.belongs_to(Some(home), version, true);
                self.finish_saving();
            }
            Outcome::NotReplaced(path, loss) => {
                self.dialogs.succeed(false);
                self.project.ask_to_save_over(path, loss);
            }
            Outcome::SavingCancelled(text) => {
                self.dialogs.succeed(false);
                self.session.tell(text);
                self.project.save_again(&mut self.session, &mut self.background);
            }
            Outcome::NotSaved(problem) => {
                self.project.cancel_saving();
                self.fail(problem);
            }
        }
    }

    fn finish_reading(&mut self, path: PathBuf, commands: Vec<Command>) {
        self.project.note_recent(path);
        self.dialogs.succeed(true);
        self.session.notices_mut().dismiss();
        self.starts_with_file = false;
        self.commands.extend(commands);
    }

    /// Says what became of work for a document that is no longer open, and keeps it away from the one that
    /// is.
    fn finish_for_former_document(&mut self, Finished { name, outcome, .. }: Finished) {
        match outcome {
            // It is a document of its own.
            Outcome::Opened { .. } => return self.finish(outcome),
            Outcome::Read { .. } | Outcome::PartRead(_) => self.session.report(format!(
                "{name} was read for the document that was open before, so nothing was done with it. Open it again if it \
                 belongs here."
            )),
            // It is of no use without its document.
            Outcome::Found(_) | Outcome::NotFound(_) => {}
            Outcome::NotWritten(problem) => {
                self.project.stay();
                self.session.report(problem);
            }
            Outcome::NotRead(problem) | Outcome::NotSaved(problem) => self.session.report(problem),
            Outcome::Exported(text) | Outcome::SavingCancelled(text) => self.session.tell(text),
            Outcome::Saved { home, .. } => {
                let file = home.path.display().to_string();
                self.session.tell(format!("The document that was open before was saved to {file}."));
                self.project.note_recent(home.path);
            }
            Outcome::NotReplaced(path, loss) => {
                let reason = if loss == Loss::ReadOnly { "it is read-only" } else { "somebody else changed it" };
                let path = path.display();
                let text = format!("The document that was open before was not saved to {path}: {reason}.");
                self.session.report(text);
            }
        }
        self.project.save_again(&mut self.session, &mut self.background);
    }

    /// Takes the answer of the desktop's own file dialog. It is about the document that was open when it was
    /// asked for.
    pub(in crate::app) fn take_chosen_file(&mut self) {
        match self.dialogs.take_answer(self.session.document_id(), &self.jobs) {
            Ok(command) => self.commands.extend(command),
            Err(question) => self.session.report(format!(
                "“{question}” was asked for the document that was open before, so nothing was done."
            )),
        }
    }

    fn finish_saving(&mut self) {
        if let Some(keeper) = self.journal.as_mut().filter(|_| !self.project.is_edited(&self.session)) {
            keeper.note_saved(&self.project);
        }
        self.project.save_again(&mut self.session, &mut self.background);
        if !self.background.saves() {
            // It asks again about edits made since.
            self.commands.extend(self.project.take_after_saving());
        }
    }
}

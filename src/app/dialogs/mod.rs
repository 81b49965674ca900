//! The dialogs: the command palette, the page of a new document, the questions for a file, for what it is to
//! be, and for a place, About.

mod add_data;
mod endings;
mod export_figures;
mod file;
mod folders;
mod go_to;
mod pictures;
mod start;
mod system;

use std::collections::VecDeque;
use std::path::Path;
use std::sync::Arc;

use eframe::egui::Context;

use super::REPORT;
use super::catalog::{PLACES, catalog, words_of};
use super::host;
use endings::LastEndings;
pub use export_figures::ExportMeasurer;
pub use file::FileFacts;
use file::{FileAnswer, FileDialog};
use folders::LastFolders;
pub use go_to::fill_in_place;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::document_id::DocumentId;
use meshbrush_kit::kit::jobs::Jobs;
use meshbrush_kit::kit::{CatalogItem, DataFile, DockPlace, FileAct, FileRequest, FrameState};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_ui::widgets::{self, ActionButton, PaletteAnswer, PaletteItem, dialog, dialog_title};
pub use system::{SystemAnswer, SystemQuestion};

use system::SystemDialog;

/// Chooses the file dialog: `window` for the one in the window, `system` for the desktop's own.
const DIALOG_VARIABLE: &str = "MESHBRUSH_FILE_DIALOG";

/// A dialog over the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// The list of all commands.
    Palette,
    /// The dialog about the program and its licences.
    About,
    /// The question for a place on the canvas.
    GoTo,
    /// The choices for exported pictures.
    Pictures,
    /// The page of what a new document can start from.
    Start,
}

/// The open dialog, and the question for a file.
#[derive(Default)]
pub struct Dialogs {
    open: Option<Dialog>,
    file: Option<FileDialog>,
    /// Files of data that were read, and are asked about one after the other.
    data: VecDeque<Arc<DataFile>>,
    folders: LastFolders,
    endings: LastEndings,
    system: SystemDialog,
    /// Whether files are asked for in the desktop's own dialog.
    uses_system: bool,
}

impl Dialogs {
    /// Opens a dialog.
    pub fn open(&mut self, dialog: Dialog) {
        self.open = Some(dialog);
    }

    /// Closes it.
    pub fn close(&mut self) {
        if self.open.take().is_none() && self.file.take().is_none() {
            self.data.pop_front();
        }
    }

    /// Returns whether a dialog is open.
    pub fn is_open(&self) -> bool {
        self.open.is_some() || !self.data.is_empty() || self.file.as_ref().is_some_and(FileDialog::is_shown)
    }

    /// Asks what a file of data is to be, after those that are asked about already.
    pub fn ask_role(&mut self, file: Arc<DataFile>) {
        self.data.push_back(file);
    }

    /// Returns whether the question for a place is open.
    pub fn asks_for_place(&self) -> bool {
        self.open == Some(Dialog::GoTo)
    }

    /// Returns whether a file is being asked for.
    pub fn asks_for_file(&self) -> bool {
        self.file.is_some() || self.system.is_asking()
    }

    /// Returns the format of the mesh that is asked for a file for.
    pub fn export_format(&self) -> Option<ExportFormat> {
        self.file.as_ref()?.export_format()
    }

    /// Asks for files in the desktop's own dialog from now on, unless the environment says otherwise.
    pub fn use_system(&mut self) {
        self.uses_system = std::env::var_os(DIALOG_VARIABLE).is_none_or(|choice| choice != "window");
    }

    /// Loads the folders of earlier runs from the window's own storage.
    pub fn load(&mut self, storage: &dyn eframe::Storage) {
        self.folders.load(storage);
    }

    /// Stores them there.
    pub fn store(&self, storage: &mut dyn eframe::Storage) {
        self.folders.store(storage);
    }

    /// Asks for a file for a document with a name without an ending: beside the file `beside`, where no
    /// folder for such files is known.
    pub fn ask(
        &mut self,
        request: FileRequest,
        (document, name): (DocumentId, &str),
        beside: Option<&Path>,
        jobs: &Jobs,
    ) {
        let folder = self.folders.of(request, beside);
        let name = request.proposed_name(name, self.endings.of(request, document));
        let question = SystemQuestion { request, document, folder, name };
        if self.uses_system && host::has_dialog(request) {
            self.system.ask(question, jobs);
        } else {
            self.open_file_dialog(&question, jobs);
        }
    }

    fn open_file_dialog(&mut self, question: &SystemQuestion, jobs: &Jobs) {
        self.open = None;
        self.file = Some(FileDialog::new(question, jobs));
    }

    /// Takes the answer of the desktop's own dialog, and returns the command to run. Where there is no such
    /// dialog, the one in the window opens, now and from then on.
    ///
    /// # Errors
    /// Fails with the title of the dialog if it was about another document than the one that is open.
    pub fn take_answer(
        &mut self,
        document: DocumentId,
        jobs: &Jobs,
    ) -> Result<Option<Command>, &'static str> {
        self.system.take().map_or(Ok(None), |answered| self.command_after(answered, document, jobs))
    }

    fn command_after(
        &mut self,
        (question, answer): (SystemQuestion, SystemAnswer),
        document: DocumentId,
        jobs: &Jobs,
    ) -> Result<Option<Command>, &'static str> {
        let request = question.request;
        match answer {
            SystemAnswer::Chosen(path) => {
                self.folders.note(request, path.parent());
                self.endings.note(request, question.document, &path);
                if question.document != document && request.act != FileAct::OpenDocument {
                    return Err(request.title);
                }
                Ok(Some((request.command_after_browsing)(path)))
            }
            SystemAnswer::Cancelled => Ok(None),
            SystemAnswer::NoDialog => {
                self.uses_system = false;
                self.open_file_dialog(&question, jobs);
                Ok(None)
            }
        }
    }

    /// Shows a problem with the file that was given in the dialog. Returns whether there is such a dialog.
    pub fn fail(&mut self, problem: &str) -> bool {
        let waiting = self.file.as_mut().filter(|file| file.is_waiting());
        waiting.map(|file| file.fail(problem.to_owned())).is_some()
    }

    /// Closes the file dialog if it waits for a file that is read (`true`) or written.
    pub fn succeed(&mut self, reads: bool) {
        self.file.take_if(|file| file.is_waiting() && file.request().writes() != reads);
    }

    /// Lets the user edit the file dialog again, after its answer was cancelled.
    pub fn resume(&mut self) {
        if let Some(file) = &mut self.file {
            file.resume();
        }
    }

    /// Shows the open dialog.
    pub fn show(&self, ctx: &Context, state: &FrameState<'_>, commands: &mut Vec<Command>) {
        match self.open {
            Some(Dialog::Palette) => palette(ctx, &catalog(state), commands),
            Some(Dialog::About) => about(ctx, commands),
            Some(Dialog::GoTo) => go_to::ask(ctx, state, commands),
            Some(Dialog::Pictures) => pictures::ask(ctx, state, commands),
            Some(Dialog::Start) => start::show(ctx, state, commands),
            None => {
                if let Some(file) = self.data.front() {
                    add_data::ask(ctx, state, file, commands);
                }
            }
        }
    }

    /// Shows the question for a file.
    pub fn show_file(&mut self, ctx: &Context, facts: &FileFacts<'_>, commands: &mut Vec<Command>) {
        let Some(file) = self.file.as_mut().filter(|file| file.is_shown()) else { return };
        match file.show(ctx, facts, commands) {
            FileAnswer::Open => {}
            FileAnswer::Closed => commands.push(Command::from(ShellCommand::CloseDialog)),
            FileAnswer::CancelWork(id) => commands.push(Command::from(FileCommand::CancelWork(id))),
            FileAnswer::Chosen(path) => {
                self.folders.note(file.request(), path.parent());
                self.endings.note(file.request(), file.document(), &path);
                commands.push((file.request().command)(path));
            }
        }
    }
}

fn palette(ctx: &Context, catalog: &[CatalogItem], commands: &mut Vec<Command>) {
    let keys: Vec<String> = catalog.iter().map(CatalogItem::keys_text).collect();
    let commands_of_catalog = (catalog.iter().zip(&keys)).map(|(item, keys)| {
        let words = words_of(&item.title);
        PaletteItem { title: &item.title, words, keys, enabled: item.enabled }
    });
    let titles: Vec<String> = PLACES.iter().map(DockPlace::title).collect();
    let places = (PLACES.iter().zip(&titles)).map(|(place, title)| PaletteItem {
        title,
        words: place.words,
        keys: "",
        enabled: true,
    });
    let items: Vec<_> = commands_of_catalog.chain(places).collect();
    match widgets::command_palette(ctx, &items) {
        PaletteAnswer::Open => {}
        PaletteAnswer::Closed => commands.push(Command::from(ShellCommand::CloseDialog)),
        PaletteAnswer::Chosen(index) => {
            let place =
                || PLACES.get(index - catalog.len()).map(|place| Command::from(ViewCommand::Reveal(place)));
            let command = catalog.get(index).map(|item| item.command.clone()).or_else(place);
            commands.push(Command::from(ShellCommand::CloseDialog));
            commands.extend(command);
        }
    }
}

fn about(ctx: &Context, commands: &mut Vec<Command>) {
    let shown = dialog(ctx, "about", |ui| {
        ui.set_width(380.0);
        dialog_title(ui, "Meshbrush");
        ui.label(concat!("Version ", env!("CARGO_PKG_VERSION")));
        ui.add_space(8.0);
        ui.label(
            "Paint where detail matters; the mesh follows the brush. Local bisection refinement of triangulated grids by \
             Maubach's method: always conforming, always right-angled.",
        );
        ui.add_space(8.0);
        ui.label(format!("The report that the method is from: “{REPORT}”."));
        ui.add_space(8.0);
        ui.add(ActionButton::new("Close")).clicked()
    });
    if shown.inner || shown.should_close() {
        commands.push(Command::from(ShellCommand::CloseDialog));
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::super::file_kinds::{EXPORT_MESH, OPEN_ANY};
    use super::*;

    #[test]
    fn an_answer_about_another_document_opens_one_and_does_nothing_else() {
        let jobs = Jobs::new(&Context::default());
        let mut dialogs = Dialogs::default();
        let [asked, other] = [DocumentId::default(), DocumentId::default().next()];
        let mut answered = |request: FileRequest, answer: SystemAnswer, open: DocumentId| {
            let question =
                SystemQuestion { request, document: asked, folder: PathBuf::new(), name: "a".into() };
            dialogs.command_after((question, answer), open, &jobs).map(|command| command.is_some())
        };
        let chosen = || SystemAnswer::Chosen(PathBuf::from("a.vtu"));
        assert_eq!(answered(&EXPORT_MESH, chosen(), asked), Ok(true));
        assert_eq!(answered(&EXPORT_MESH, chosen(), other), Err(EXPORT_MESH.title));
        assert_eq!(answered(&OPEN_ANY, chosen(), other), Ok(true));
        assert_eq!(answered(&EXPORT_MESH, SystemAnswer::Cancelled, other), Ok(false));
    }
}

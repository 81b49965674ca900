//! The file that the document belongs to: opening it, saving it, and asking before edits would be lost.

use std::path::{Path, PathBuf};

use egui::{Context, ViewportCommand};

use super::background::Background;
use super::command::{Command, FileCommand};
use super::export_set::ExportSet;
use super::home::{self, Claims, Expected, Home, Loss};
use super::session::Session;
use meshbrush_io::io;
use meshbrush_io::io::project::{ENDING, Project};
use meshbrush_io::io::recipe::RecipeFiles;
use meshbrush_io::io::recording;
use meshbrush_render::render::export::ExportFormat;
use meshbrush_ui::widgets::ConfirmAnswer;

/// Most files that are remembered.
const MOST_RECENT: usize = 8;

/// The document's file, and what of the document is saved.
pub struct ProjectFile {
    home: Option<Home>,
    claims: Claims,
    /// The version of the document that was opened or saved last; `None` if no file has it.
    saved_version: Option<u64>,
    recent: Vec<PathBuf>,
    /// The command that would lose edits, while the user is asked about them.
    pub leaving: Option<Command>,
    /// The command that waits until the document is saved.
    after_saving: Option<Command>,
    /// The version whose edits the user agreed to lose.
    given_up: Option<u64>,
    /// Existing files, while the user is asked whether to replace them.
    pub replacing: Option<Replacing>,
    /// The file to save to again after the current save.
    save_again: Option<PathBuf>,
    /// The files that the mesh is exported to.
    pub exports: ExportSet,
    /// The window closes once everything is written.
    closing: bool,
    /// The title that the desktop was given.
    window_title: String,
}

impl ProjectFile {
    /// Returns the state of a document without a file; `version` of the document was opened.
    pub fn new(version: u64) -> Self {
        Self {
            home: None,
            claims: Claims::default(),
            saved_version: Some(version),
            recent: Vec::new(),
            leaving: None,
            after_saving: None,
            given_up: None,
            replacing: None,
            save_again: None,
            exports: ExportSet::default(),
            closing: false,
            window_title: String::new(),
        }
    }

    /// Returns the file that the document was opened from or saved to.
    pub fn path(&self) -> Option<&Path> {
        self.home.as_ref().map(|home| &*home.path)
    }

    /// Tells other windows which project is open, with locks in a folder.
    pub fn keep_claims_in(&mut self, folder: PathBuf) {
        self.claims.keep_in(folder);
    }

    /// Files of every kind that were opened or saved, the last first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    /// Returns whether a question is on the screen.
    pub fn is_asking(&self) -> bool {
        self.leaving.is_some() || self.replacing.is_some()
    }

    /// Takes the list of recent files of an earlier run.
    pub fn set_recent(&mut self, recent: Vec<PathBuf>) {
        self.recent = recent;
        self.recent.truncate(MOST_RECENT);
    }

    /// Puts a file at the top of the recent ones.
    pub fn note_recent(&mut self, path: PathBuf) {
        // A later run may have another working folder.
        let path = std::path::absolute(&path).unwrap_or(path);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(MOST_RECENT);
    }

    /// Another document was opened: from a file, if it has one, which has this version if it is `saved`. What
    /// was to be done with the former document is forgotten. Returns whether another window has the file
    /// open.
    pub fn open(&mut self, home: Option<Home>, version: u64, saved: bool) -> bool {
        (self.leaving, self.after_saving, self.given_up) = (None, None, None);
        (self.replacing, self.save_again) = (None, None);
        self.exports = ExportSet::default();
        self.belongs_to(home, version, saved)
    }

    /// Notes that the document belongs to a file, which has this version if it is `saved`. Returns whether
    /// another window has the file open.
    pub fn belongs_to(&mut self, home: Option<Home>, version: u64, saved: bool) -> bool {
        self.saved_version = saved.then_some(version);
        if let Some(home) = &home {
            self.note_recent(home.path.clone());
        }
        self.home = home;
        self.claims.hold(self.home.as_ref().map(|home| &*home.path))
    }

    /// Returns whether the window or the document closes once something is written.
    pub fn is_leaving(&self) -> bool {
        self.closing || self.after_saving.is_some()
    }

    /// Asks again about edits that the user agreed to lose.
    fn keep_edits(&mut self) {
        self.given_up = None;
    }

    /// Keeps the window and the document open: something failed.
    pub fn stay(&mut self) {
        self.keep_edits();
        self.after_saving = None;
        self.closing = false;
    }

    /// Keeps them open, and does not save again.
    pub fn cancel_saving(&mut self) {
        self.stay();
        self.save_again = None;
    }

    /// Returns whether edits would be lost if the document closed now.
    pub fn is_edited(&self, session: &Session) -> bool {
        let document = session.document();
        document.stroke().is_some() || session.is_cutting() || self.saved_version != Some(document.version())
    }

    /// Returns whether the document may close: it has no unsaved edits, or the user agreed to lose them.
    pub fn may_leave(&self, session: &Session) -> bool {
        !self.is_edited(session) || self.given_up == Some(session.document().version())
    }

    /// Returns the command, unless the user must be asked first about unsaved edits.
    pub fn ask_before_leaving(
        &mut self,
        command: Command,
        session: &mut Session,
        background: &Background,
    ) -> Option<Command> {
        if !command.closes_document() || self.may_leave(session) {
            return Some(command);
        }
        let document = session.document();
        let saving = document.stroke().is_none() && background.saves_version(document.version());
        if saving {
            announce_closing(&command, session, background);
            self.after_saving = Some(command);
        } else {
            self.leaving = Some(command);
        }
        None
    }

    /// Returns the name of the document: that of its file, if it has one.
    pub fn document_name(&self, session: &Session) -> String {
        match self.path().and_then(Path::file_stem) {
            Some(stem) => stem.to_string_lossy().into_owned(),
            None => session.document().settings().name.clone(),
        }
    }

    /// Returns the document's name, for the menu bar.
    pub fn title(&self, session: &Session) -> String {
        let edited = if self.is_edited(session) { " — edited" } else { "" };
        format!("{}{edited}", self.document_name(session))
    }

    /// Keeps the window's title up to date.
    pub fn set_window_title(&mut self, session: &Session, ctx: &Context) {
        let mark = if self.is_edited(session) { "• " } else { "" };
        let title = format!("{mark}{} — Meshbrush", self.document_name(session));
        if title != self.window_title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.window_title = title;
        }
    }

    /// Keeps the window open as long as something would be lost with it. Returns the command that closes it,
    /// once it may.
    pub fn handle_close_request(
        &mut self,
        session: &mut Session,
        background: &Background,
        ctx: &Context,
    ) -> Option<Command> {
        let writes = background.being_written().next().is_some();
        if !ctx.input(|input| input.viewport().close_requested()) {
            let closes = self.closing && !writes;
            self.closing &= !closes;
            return closes.then_some(Command::from(FileCommand::Quit));
        }
        if !self.may_leave(session) || writes {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            if let Some(quit) = self.ask_before_leaving(Command::from(FileCommand::Quit), session, background)
            {
                announce_closing(&quit, session, background);
                self.closing = true;
            }
        }
        None
    }

    /// Forgets what was to follow saving, where nothing is being saved.
    pub fn forget_saving(&mut self, background: &Background, asks_for_file: bool) {
        if !background.saves() && !asks_for_file && self.replacing.is_none() {
            self.after_saving = None;
        }
    }

    /// Takes the answer about unsaved edits, and returns the command to run now.
    pub fn answer_leaving(&mut self, answer: ConfirmAnswer, session: &mut Session) -> Option<Command> {
        let command = self.leaving.take()?;
        match answer {
            ConfirmAnswer::Confirmed => {
                self.after_saving = Some(command);
                Some(Command::from(FileCommand::Save))
            }
            ConfirmAnswer::Alternative => {
                session.document_mut().end_stroke();
                self.given_up = Some(session.document().version());
                Some(command)
            }
            ConfirmAnswer::Cancelled => None,
        }
    }

    /// Takes the answer about existing files, and returns the command to run now.
    pub fn answer_replacing(&mut self, answer: ConfirmAnswer) -> Option<Command> {
        let replacing = self.replacing.take()?;
        (answer == ConfirmAnswer::Confirmed).then_some(replacing.command)
    }

    /// Returns the command that saves to a path that was typed. Asks before it replaces another file.
    pub fn save_as(&mut self, path: PathBuf) -> Option<Command> {
        let path = with_ending(path);
        if io::exists(&path) && self.path() != Some(&path) {
            self.ask(vec![path.clone()], Loss::Contents, Command::from(FileCommand::SaveTo(path)));
            return None;
        }
        Some(Command::from(FileCommand::SaveTo(path)))
    }

    /// Returns the command that exports to a path that was typed a document with lines, or one without them.
    /// Asks before it replaces other files.
    pub fn export_as(&mut self, path: PathBuf, has_lines: bool) -> Option<Command> {
        let files = ExportFormat::from_path(&path);
        let files = files.map_or(Vec::new(), |format| format.files_of(&path, has_lines));
        self.ask_to_replace(files, Command::from(FileCommand::Export(path)))
    }

    /// Returns the command that exports a document with lines, or one without them, to all files again. Asks
    /// before it replaces one that this window has not written.
    pub fn export_again(&mut self, has_lines: bool) -> Option<Command> {
        self.ask_to_replace(self.exports.foreign_files(has_lines), Command::from(FileCommand::ExportAll))
    }

    /// Returns the command that writes files. Asks before it replaces any.
    pub fn ask_to_replace(&mut self, files: Vec<PathBuf>, command: Command) -> Option<Command> {
        let existing: Vec<PathBuf> = files.into_iter().filter(|file| io::exists(file)).collect();
        if existing.is_empty() || existing.iter().any(|file| io::obstacle(file).is_some()) {
            return Some(command);
        }
        self.ask(existing, Loss::Contents, command);
        None
    }

    /// Returns the command that writes a table to a path that was typed. Asks before it replaces a file.
    pub fn save_table_as(&mut self, path: PathBuf, save: fn(PathBuf) -> Command) -> Option<Command> {
        let path = if path.extension().is_none() { path.with_extension("csv") } else { path };
        if !io::exists(&path) || io::obstacle(&path).is_some() {
            return Some(save(path));
        }
        self.ask(vec![path.clone()], Loss::Contents, save(path));
        None
    }

    /// Returns the command that writes a test to a path that was typed. Asks before it replaces a file.
    pub fn export_test_as(&mut self, path: PathBuf) -> Option<Command> {
        let path = if path.extension().is_none() { path.with_extension(recording::ENDING) } else { path };
        if !io::exists(&path) || io::obstacle(&path).is_some() {
            return Some(Command::from(FileCommand::ExportTest(path)));
        }
        self.ask(vec![path.clone()], Loss::Contents, Command::from(FileCommand::ExportTest(path)));
        None
    }

    /// Returns the command that writes a recipe to a path that was typed. Asks before it replaces other
    /// files.
    pub fn save_recipe_as(&mut self, path: PathBuf, recipe: &RecipeFiles) -> Option<Command> {
        self.ask_to_replace(
            recipe.paths().map(Path::to_owned).collect(),
            Command::from(FileCommand::SaveRecipe(path)),
        )
    }

    fn ask(&mut self, files: Vec<PathBuf>, loss: Loss, command: Command) {
        self.replacing = Some(Replacing { files, loss, command });
    }

    /// Asks whether to replace a file although this is lost.
    pub fn ask_to_save_over(&mut self, path: PathBuf, loss: Loss) {
        self.save_again = None;
        self.ask(vec![path.clone()], loss, Command::from(FileCommand::SaveOver(path)));
    }

    /// Saves the document, unless somebody else saved to the same file, or may do so, or it is read-only:
    /// then the user is asked.
    pub fn save_to(&mut self, path: PathBuf, session: &mut Session, background: &mut Background) {
        let path = with_ending(path);
        if self.claims.is_open_elsewhere(&path) {
            return self.ask(
                vec![path.clone()],
                Loss::OtherWindow,
                Command::from(FileCommand::SaveOver(path)),
            );
        }
        let own = self.home.as_ref().filter(|home| home.path == path);
        let expected = own.map_or(Expected::Writable, |home| Expected::Contents(home.stamp));
        self.save(path, expected, session, background);
    }

    /// Saves the document, whatever is in the file.
    pub fn save_over(&mut self, path: PathBuf, session: &mut Session, background: &mut Background) {
        self.claims.share(&path);
        self.save(path, Expected::Anything, session, background);
    }

    /// Saves the document as it is now, on another thread.
    fn save(
        &mut self,
        path: PathBuf,
        expected: Expected,
        session: &mut Session,
        background: &mut Background,
    ) {
        if background.saves() {
            self.save_again = Some(path);
            return;
        }
        let document = session.document_mut();
        document.end_stroke();
        document.end_gesture();
        let (project, version) = (Project::of(document), document.version());
        home::write(path, project, version, expected, background);
    }

    /// Starts the save that was asked for during the last one.
    pub fn save_again(&mut self, session: &mut Session, background: &mut Background) {
        if let Some(path) = self.save_again.take() {
            self.save_to(path, session, background);
        }
    }

    /// Returns the command that waited until the document is saved.
    pub fn take_after_saving(&mut self) -> Option<Command> {
        self.after_saving.take()
    }
}

/// Files that would be replaced.
pub struct Replacing {
    /// The files, which exist.
    pub files: Vec<PathBuf>,
    /// The loss if the file is replaced.
    pub loss: Loss,
    /// The command that replaces them.
    pub command: Command,
}

/// Says that the window stays open until the files are written.
fn announce_closing(command: &Command, session: &mut Session, background: &Background) {
    if *command == Command::from(FileCommand::Quit) {
        let names = background.being_written().collect::<Vec<_>>().join(", ");
        session.tell(format!("Meshbrush closes as soon as this is written: {names}."));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recent_files_are_found_from_any_folder() {
        let mut project = ProjectFile::new(0);
        for name in ["coast.meshbrush", "./coast.meshbrush", "other.toml"] {
            project.note_recent(name.into());
        }
        let folder = std::env::current_dir().unwrap();
        assert_eq!(project.recent(), [folder.join("other.toml"), folder.join("coast.meshbrush")]);
    }
}

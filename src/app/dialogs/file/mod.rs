//! The file dialog in the window, for desktops without one of their own.
//!
//! The list shows the folder that the text is about, and narrows as a name is typed; Tab completes it. A
//! problem with the file is shown below the text, which stays.

mod export_doubts;
mod listing;
mod view;

use std::path::{Path, PathBuf};

use super::SystemQuestion;
use crate::app::file_kinds::EXPORT_MESH;
use listing::{Contents, Listing};
use meshbrush_io::io::{self, FolderEntry};
use meshbrush_kit::kit::FileRequest;
use meshbrush_kit::kit::busy::Busy;
use meshbrush_kit::kit::document_id::DocumentId;
use meshbrush_kit::kit::jobs::Jobs;
use meshbrush_render::render::export::ExportFormat;
pub use view::{FileAnswer, FileFacts};

/// The state of the dialog.
pub struct FileDialog {
    request: FileRequest,
    document: DocumentId,
    /// The folder that a relative path begins at.
    folder: PathBuf,
    home: Option<PathBuf>,
    text: String,
    /// Whether the text was typed, and not chosen from the list: then it narrows the list.
    is_typed: bool,
    /// The row of the list that the keyboard or a click selected.
    selected: Option<usize>,
    listing: Listing,
    /// The default ending of the chosen format, without the dot.
    ending: &'static str,
    problem: Option<String>,
    /// Set from the answer until its outcome is known.
    waits: Option<Busy>,
    /// The text is selected in the next frame, so that typing replaces it.
    selects_text: bool,
}

impl FileDialog {
    /// Asks for a file in a folder, with the name that is proposed.
    pub fn new(question: &SystemQuestion, jobs: &Jobs) -> Self {
        let SystemQuestion { request, document, folder, name } = question;
        Self {
            request,
            document: *document,
            folder: folder.clone(),
            home: std::env::home_dir(),
            text: name.clone(),
            is_typed: false,
            selected: None,
            listing: Listing::of(folder, jobs),
            ending: format_of(request, name).unwrap_or_else(|| (request.endings)()[0]),
            problem: None,
            waits: None,
            selects_text: true,
        }
    }

    /// Returns the document that was open when the dialog opened.
    pub fn document(&self) -> DocumentId {
        self.document
    }

    /// Returns the request that the dialog answers.
    pub fn request(&self) -> FileRequest {
        self.request
    }

    /// Returns the format in which the mesh is to be written, if it is.
    pub fn export_format(&self) -> Option<ExportFormat> {
        ExportFormat::from_ending(self.ending).filter(|_| self.request == &EXPORT_MESH)
    }

    /// Returns whether the answer is being tried.
    pub fn is_waiting(&self) -> bool {
        self.waits.is_some()
    }

    /// Returns whether the dialog covers the window. It makes way for a file that takes long to write.
    pub fn is_shown(&self) -> bool {
        !(self.request.writes() && self.waits.is_some_and(|since| since.is_long()))
    }

    /// Shows why the file could not be read or written. The text stays.
    pub fn fail(&mut self, problem: String) {
        (self.problem, self.waits) = (Some(problem), None);
        self.listing.read_again();
    }

    /// Stops waiting for the outcome: the answer was cancelled.
    pub fn resume(&mut self) {
        self.waits = None;
    }

    /// Returns the path that the text means.
    fn path(&self) -> PathBuf {
        let path = io::resolve(&self.text, &self.folder, self.home.as_deref());
        let asks_for_format = !(self.request.formats)().is_empty() && path.extension().is_none();
        if asks_for_format { path.with_extension(self.ending) } else { path }
    }

    /// Returns the folder and the beginning of a name that a typed text asks for.
    fn typed(&self) -> (PathBuf, String) {
        if !self.is_typed {
            return (self.folder.clone(), String::new());
        }
        let (folder, name) = match self.text.rfind('/') {
            Some(at) => self.text.split_at(at + 1),
            None if self.text.trim() == "~" => (self.text.as_str(), ""),
            None => ("", self.text.as_str()),
        };
        (io::resolve(folder, &self.folder, self.home.as_deref()), name.trim_start().to_owned())
    }

    /// Returns the entries that the list shows.
    fn rows(&self) -> Vec<FolderEntry> {
        let Contents::Read(listing) = self.listing.contents() else { return Vec::new() };
        let beginning = self.typed().1.to_lowercase();
        let fits = |entry: &&FolderEntry| {
            let name = entry.name.to_string_lossy().to_lowercase();
            let hidden = name.starts_with('.') && !beginning.starts_with('.');
            name.starts_with(&beginning) && !hidden && (entry.is_folder || self.request.takes(&entry.name))
        };
        listing.entries.iter().filter(fits).cloned().collect()
    }

    /// Goes to a folder. A name to write to stays.
    fn enter(&mut self, folder: PathBuf) {
        let name = self.text.rsplit('/').next().unwrap_or_default();
        let keeps =
            self.request.writes() && !(self.is_typed && folder.file_name().is_some_and(|f| f == name));
        self.text = if keeps { name.to_owned() } else { String::new() };
        (self.folder, self.is_typed, self.selected, self.problem) = (folder, false, None, None);
    }

    /// Takes a row of the list: goes to the folder, or puts the name of the file into the text.
    fn choose(&mut self, entry: &FolderEntry) {
        let path = self.typed().0.join(&entry.name);
        if entry.is_folder {
            return self.enter(path);
        }
        let name = entry.name.to_string_lossy().into_owned();
        if let Some(folder) = path.parent() {
            self.folder = folder.to_owned();
        }
        (self.text, self.is_typed, self.problem) = (name, false, None);
        self.follow_ending();
    }

    /// Completes a typed name as far as the list allows. Returns whether anything was added.
    fn complete(&mut self, rows: &[FolderEntry]) -> bool {
        if !self.is_typed || rows.is_empty() {
            return false;
        }
        if self.text.trim() == "~" {
            self.text = "~/".into();
            return true;
        }
        let beginning = self.typed().1;
        let completed = common_beginning(rows);
        if completed == beginning {
            return false;
        }
        self.text.truncate(self.text.len() - beginning.len());
        self.text.push_str(&completed);
        self.follow_ending();
        true
    }

    /// Returns the path to read or write. If it is a folder, the dialog enters it instead.
    fn accept(&mut self) -> Option<PathBuf> {
        let path = self.path();
        if io::is_folder(&path) {
            self.enter(path);
            return None;
        }
        if !self.request.writes() && !io::exists(&path) {
            self.problem = Some(format!("There is no file {}.", path.display()));
            return None;
        }
        (self.problem, self.waits) = (None, Some(Busy::now()));
        Some(path)
    }

    /// The format follows the ending of the text.
    fn follow_ending(&mut self) {
        if let Some(ending) = format_of(self.request, self.text.trim()) {
            self.ending = ending;
        }
    }

    /// The ending of the text follows the format.
    fn follow_format(&mut self) {
        let path = Path::new(&self.text);
        let has_format = self.request.takes(path.file_name().unwrap_or_default());
        let stem = if has_format { path.with_extension("") } else { path.to_owned() };
        let name = stem.to_string_lossy().into_owned();
        self.text = if name.is_empty() { name } else { format!("{name}.{}", self.ending) };
        (self.is_typed, self.problem) = (false, None);
    }
}

/// Returns the default ending of the format that the name of a file to write chooses; `None` where it chooses
/// none.
fn format_of(request: FileRequest, name: &str) -> Option<&'static str> {
    let ending = Path::new(name).extension()?.to_string_lossy().to_ascii_lowercase();
    if request == &EXPORT_MESH {
        // A format of meshes has more than one ending.
        return ExportFormat::from_ending(&ending).map(ExportFormat::ending);
    }
    (request.formats)().into_iter().map(|(own, _)| own).find(|own| *own == ending)
}

/// Returns the common beginning of the names of all rows, in the capitals of the first one. If there is only
/// one row and it is a folder, a slash follows.
fn common_beginning(rows: &[FolderEntry]) -> String {
    let names: Vec<String> = rows.iter().map(|row| row.name.to_string_lossy().into_owned()).collect();
    let lower: Vec<Vec<char>> = names.iter().map(|name| name.to_lowercase().chars().collect()).collect();
    let is_common = |at: &usize| lower.iter().all(|name| name.get(*at) == lower[0].get(*at));
    let length = (0..lower[0].len()).take_while(is_common).count();
    let common: String = names[0].chars().take(length).collect();
    if let [only] = rows
        && only.is_folder
    {
        return common + "/";
    }
    common
}

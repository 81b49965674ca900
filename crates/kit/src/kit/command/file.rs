//! Commands about documents and their files.

use std::path::PathBuf;
use std::sync::Arc;

use super::CommandSet;
use crate::kit::FileRequest;
use crate::kit::background::WorkId;
use crate::kit::home::Home;
use meshbrush_core::document::{Document, Example};
use meshbrush_io::io::settings::SavedOutput;
use meshbrush_ui::widgets::ConfirmAnswer;

/// One thing to do with documents and their files.
#[derive(Clone, Debug, PartialEq)]
pub enum FileCommand {
    /// Opens an empty document.
    New,
    /// Opens an empty document, and the page of what it can start from.
    NewFromPage,
    /// Opens one of the documents that come with the program.
    OpenExample(Example),
    /// Opens the document that was made of an example.
    ShowExample(Example, Opened),
    /// Copy a link to the page of the program with the document in it.
    CopyLink,
    /// Asks for a file.
    Ask(FileRequest),
    /// Opens a file; its ending says what it is.
    Open(PathBuf),
    /// Opens the file that the program was started with, without a question about it.
    OpenFirst(PathBuf),
    /// Opens a project or a recipe; reads any other file, and asks what it is to be.
    AddData(PathBuf),
    /// Reads a project, and opens it in place of the document.
    OpenProject(PathBuf),
    /// Reads a recipe, and opens a new document with its mesh.
    OpenRecipe(PathBuf),
    /// Opens a document that was read.
    Show(Opened),
    /// Says that a file was not read or written: in the dialog that asked for it, or else on the canvas.
    Fail(String),
    /// Saves the document to its file, or asks where.
    Save,
    /// Saves it to a file, and asks before another one is replaced.
    SaveAs(PathBuf),
    /// Saves it to a file.
    SaveTo(PathBuf),
    /// Saves to a path, whatever is there.
    SaveOver(PathBuf),
    /// Writes the document as a recipe, and asks before other files are replaced.
    SaveRecipeAs(PathBuf),
    /// Writes the document as a recipe, with the files that it names beside it.
    SaveRecipe(PathBuf),
    /// Writes what was done since the document was opened, and asks before another file is replaced.
    ExportTestAs(PathBuf),
    /// Writes what was done since the document was opened, with the fingerprint after each edit.
    ExportTest(PathBuf),
    /// Writes the mesh to a file, and asks before another one is replaced.
    ExportAs(PathBuf),
    /// Writes the mesh; the ending chooses the format.
    Export(PathBuf),
    /// Takes the files that a recipe names as those that the mesh is exported to.
    SetExports(Vec<SavedOutput>),
    /// Writes the mesh to all files that it is exported to, and asks before others are replaced.
    ExportAgain,
    /// Writes the mesh to all files that it is exported to.
    ExportAll,
    /// Cancels the reading or writing of a file.
    CancelWork(WorkId),
    /// Opens the unsaved work that an earlier run left behind and that is offered now.
    Restore,
    /// Closes the window.
    Quit,
    /// Answers whether to save edits before they would be lost.
    AnswerLeaving(ConfirmAnswer),
    /// Answers whether to replace files.
    AnswerReplacing(ConfirmAnswer),
    /// Answers whether to restore unsaved work of an earlier run.
    AnswerRecovery(ConfirmAnswer),
}

impl CommandSet for FileCommand {
    fn closes_document(&self) -> bool {
        matches!(
            self,
            Self::New
                | Self::NewFromPage
                | Self::OpenExample(_)
                | Self::ShowExample(..)
                | Self::Show(_)
                | Self::Restore
                | Self::Quit
        )
    }
}

/// A document that was read and not shown yet.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The document that was read.
    pub document: Arc<Document>,
    /// The project file that it belongs to, if it is from one.
    pub home: Option<Home>,
}

impl PartialEq for Opened {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.document, &other.document) && self.home == other.home
    }
}

//! The file dialog of the system: of the desktop, or of the browser.

use std::path::PathBuf;

use super::DocumentId;
use crate::app::host;
use meshbrush_kit::kit::FileRequest;
use meshbrush_kit::kit::jobs::{Job, Jobs, Taken};

/// A request that is shown in a dialog of the system.
#[derive(Clone, Debug)]
pub struct SystemQuestion {
    /// The purpose of the file.
    pub request: FileRequest,
    /// The document that was open then.
    pub document: DocumentId,
    /// The folder that the dialog shows first.
    pub folder: PathBuf,
    /// The proposed name, with its ending.
    pub name: String,
}

/// How a [`SystemQuestion`] was answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SystemAnswer {
    /// A path was chosen.
    Chosen(PathBuf),
    /// The dialog was closed without a choice.
    Cancelled,
    /// The desktop has no such dialog.
    NoDialog,
}

/// Asks one question at a time.
#[derive(Default)]
pub struct SystemDialog(Option<Job<(SystemQuestion, SystemAnswer)>>);

impl SystemDialog {
    /// Returns whether a question has not been answered yet.
    pub fn is_asking(&self) -> bool {
        self.0.is_some()
    }

    /// Asks a question, unless another one is open.
    pub fn ask(&mut self, question: SystemQuestion, jobs: &Jobs) {
        if self.is_asking() {
            return;
        }
        self.0 = Some(host::ask(question, jobs));
    }

    /// Returns the answer, once it is there.
    pub fn take(&mut self) -> Option<(SystemQuestion, SystemAnswer)> {
        let taken = self.0.as_ref()?.take_ready();
        if matches!(taken, Taken::Working) {
            return None;
        }
        self.0 = None;
        if let Taken::Value(answer) = taken { Some(answer) } else { None }
    }
}

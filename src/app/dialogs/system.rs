//! The desktop's own file dialog, on another thread.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::DocumentId;
use crate::app::jobs::{Job, Jobs, Kind, Taken};
use crate::app::kit::FileRequest;

/// A dialog that is answered faster than this has not opened.
const FASTEST_CANCEL: Duration = Duration::from_millis(150);

/// A request that is shown in a dialog of the system.
#[derive(Clone, Debug)]
pub struct Question {
    /// The purpose of the file.
    pub request: FileRequest,
    /// The document that was open then.
    pub document: DocumentId,
    /// The folder that the dialog shows first.
    pub folder: PathBuf,
    /// The proposed name, with its ending.
    pub name: String,
}

/// How a [`Question`] was answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// A path was chosen.
    Chosen(PathBuf),
    /// The dialog was closed without a choice.
    Cancelled,
    /// The desktop has no such dialog.
    NoDialog,
}

/// Asks one question at a time.
#[derive(Default)]
pub struct SystemDialog(Option<Job<(Question, Answer)>>);

impl SystemDialog {
    /// Returns whether a question has not been answered yet.
    pub fn is_asking(&self) -> bool {
        self.0.is_some()
    }

    /// Asks a question, unless another one is open.
    pub fn ask(&mut self, question: Question, jobs: &Jobs) {
        if self.is_asking() {
            return;
        }
        self.0 = Some(jobs.start(Kind::Ask, move |output| {
            let answer = answer(&question);
            output.send((question, answer));
        }));
    }

    /// Returns the answer, once it is there.
    pub fn take(&mut self) -> Option<(Question, Answer)> {
        let taken = self.0.as_ref()?.take_ready();
        if matches!(taken, Taken::Working) {
            return None;
        }
        self.0 = None;
        if let Taken::Value(answer) = taken { Some(answer) } else { None }
    }
}

/// Shows the dialog, and waits for the answer.
fn answer(question: &Question) -> Answer {
    if !is_there() {
        return Answer::NoDialog;
    }
    let request = question.request;
    let began = Instant::now();
    let dialog = rfd::FileDialog::new()
        .set_title(request.title)
        .set_directory(&question.folder)
        .add_filter(request.contents, &(request.endings)());
    let path =
        if request.writes() { dialog.set_file_name(&question.name).save_file() } else { dialog.pick_file() };
    match path {
        Some(path) => Answer::Chosen(path),
        None if began.elapsed() < FASTEST_CANCEL => Answer::NoDialog,
        None => Answer::Cancelled,
    }
}

/// Systems that always have a file dialog.
#[cfg(any(windows, target_vendor = "apple"))]
fn is_there() -> bool {
    true
}

/// Returns whether the desktop has a file dialog. `rfd` answers a missing dialog and a cancelled one in the
/// same way.
#[cfg(not(any(windows, target_vendor = "apple")))]
fn is_there() -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let has_zenity = std::env::split_paths(&folders).any(|folder| folder.join("zenity").is_file());
    has_zenity || pollster::block_on(portal_version()).is_ok()
}

/// Asks the desktop portal for the version of its file dialog: it offers one only if there is a program that
/// shows it.
#[cfg(not(any(windows, target_vendor = "apple")))]
async fn portal_version() -> zbus::Result<zbus::Message> {
    let patience = Duration::from_secs(2);
    let bus = zbus::connection::Builder::session()?.method_timeout(patience).build().await?;
    let (portal, path) = ("org.freedesktop.portal.Desktop", "/org/freedesktop/portal/desktop");
    let asked = ("org.freedesktop.portal.FileChooser", "version");
    bus.call_method(Some(portal), path, Some("org.freedesktop.DBus.Properties"), "Get", &asked).await
}

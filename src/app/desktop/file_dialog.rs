//! The desktop's own file dialog, on another thread.

use crate::app::dialogs::{SystemAnswer, SystemQuestion};
use meshbrush_kit::kit::FileRequest;
use meshbrush_kit::kit::clock::{Duration, Instant};
use meshbrush_kit::kit::jobs::{Job, JobKind, Jobs};

/// A dialog that is answered faster than this has not opened.
const FASTEST_CANCEL: Duration = Duration::from_millis(150);

/// Returns whether there may be a dialog for a file.
pub fn has_dialog(_: FileRequest) -> bool {
    true
}

/// Asks a question on another thread.
pub fn ask(question: SystemQuestion, jobs: &Jobs) -> Job<(SystemQuestion, SystemAnswer)> {
    jobs.start(JobKind::Ask, move |output| {
        let answer = answer(&question);
        output.send((question, answer));
    })
}

/// Shows the dialog, and waits for the answer.
fn answer(question: &SystemQuestion) -> SystemAnswer {
    if !is_there() {
        return SystemAnswer::NoDialog;
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
        Some(path) => SystemAnswer::Chosen(path),
        None if began.elapsed() < FASTEST_CANCEL => SystemAnswer::NoDialog,
        None => SystemAnswer::Cancelled,
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

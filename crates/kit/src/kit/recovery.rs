//! The question whether to restore unsaved work of an earlier run.

use std::path::Path;

use egui::Context;

use super::clock::{SystemTime, UNIX_EPOCH};
use super::command::{Command, FileCommand};
use super::project::ProjectFile;
use meshbrush_io::io::project::Project;
use meshbrush_ui::widgets::{ConfirmAnswer, ConfirmDialog};

/// Returns the seconds since 1970.
pub fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// Asks whether to restore work that an earlier run left behind: the document, its file, and the second of
/// its last edit since 1970.
pub fn question(
    ctx: &Context,
    (left, home, time): (&Project, Option<&Path>, u64),
    project: &ProjectFile,
    commands: &mut Vec<Command>,
) {
    if project.is_asking() || project.is_leaving() {
        // The user chose to restore, and decides first about the current document.
        return;
    }
    let name = &left.settings.name;
    let home = home.and_then(Path::file_name);
    let name = home.map_or(name.clone(), |home| home.to_string_lossy().into_owned());
    let ago = ago(now().saturating_sub(time));
    let body = format!("“{name}” was not saved when Meshbrush ended unexpectedly, {ago}.");
    let dialog = ConfirmDialog::new("Restore unsaved work?", &body, "Restore");
    commands.extend(
        dialog
            .alternative("Discard")
            .cancel("Later")
            .show(ctx)
            .map(|answer| Command::from(FileCommand::AnswerRecovery(answer))),
    );
}

/// Takes the answer about the work that is offered. Returns the command to run now, and the work if it is to
/// be forgotten.
pub fn take_answer<T>(offered: &mut Option<T>, answer: ConfirmAnswer) -> (Option<Command>, Option<T>) {
    if answer == ConfirmAnswer::Confirmed {
        // It stays offered: the user may still decide to keep the current document.
        return (offered.as_ref().map(|_| Command::from(FileCommand::Restore)), None);
    }
    (None, offered.take().filter(|_| answer == ConfirmAnswer::Alternative))
}

/// Returns a time in the past, in words.
fn ago(seconds: u64) -> String {
    let units = [(86_400, "day"), (3600, "hour"), (60, "minute")];
    match units.into_iter().find(|&(length, _)| seconds >= length) {
        None => "less than a minute ago".into(),
        Some((length, unit)) => {
            let count = seconds / length;
            format!("{count} {unit}{} ago", if count == 1 { "" } else { "s" })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ago;

    #[test]
    fn a_time_is_given_in_its_largest_unit() {
        for (seconds, words) in [
            (0, "less than a minute ago"),
            (60, "1 minute ago"),
            (7199, "1 hour ago"),
            (7200, "2 hours ago"),
            (200_000, "2 days ago"),
        ] {
            assert_eq!(ago(seconds), words);
        }
    }
}

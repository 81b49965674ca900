//! The questions before something would be lost: edits of the document, or what is in a file.

use eframe::egui::Context;

use super::background::listed;
use super::command::{Command, FileCommand};
use super::home::Loss;
use super::project::Replacing;
use crate::app::kit::FrameState;
use meshbrush_ui::widgets::ConfirmDialog;

/// Asks about unsaved edits and existing files.
pub fn questions(ctx: &Context, state: &FrameState<'_>, asks_for_file: bool, commands: &mut Vec<Command>) {
    let project = state.project;
    if project.leaving.is_some() && project.replacing.is_none() && !asks_for_file {
        let question = format!("Save changes to “{}”?", project.document_name(state.session));
        let dialog = ConfirmDialog::new(&question, "Unsaved changes will be lost.", "Save");
        commands.extend(
            dialog
                .alternative("Do not save")
                .show(ctx)
                .map(|answer| Command::from(FileCommand::AnswerLeaving(answer))),
        );
    }
    if let Some(replacing) = &project.replacing {
        let (question, body) = replacing.question();
        let dialog = ConfirmDialog::new(&question, &body, "Replace").danger();
        commands.extend(dialog.show(ctx).map(|answer| Command::from(FileCommand::AnswerReplacing(answer))));
    }
}

impl Replacing {
    /// Returns the question, and what would be lost.
    fn question(&self) -> (String, String) {
        let one = match &self.files[..] {
            [file] => file,
            files => {
                let body = format!("The present contents of {} will be lost.", listed(files));
                return (format!("Replace {} files?", files.len()), body);
            }
        };
        let body = match self.loss {
            Loss::Contents => "Its present contents will be lost.",
            Loss::OtherVersion => {
                "It is not as it was when this document was opened or saved: somebody else changed it. What they saved \
                 will be lost. Cancel, and save this document under another name to keep both."
            }
            Loss::ReadOnly => {
                "It is read-only, so somebody wants to keep it as it is. Its present contents will be lost. Cancel, and save \
                 this document under another name to keep both."
            }
            Loss::OtherWindow => {
                "It is open in another window of Meshbrush, too. What that window saved, or saves later, and what you save \
                 here replace each other. Cancel, and save this document under another name to keep both."
            }
        };
        (format!("Replace {}?", one.display()), body.into())
    }
}

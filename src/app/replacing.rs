//! The questions before something would be lost: edits of the document, or what is in a file.

use eframe::egui::Context;

use meshbrush_kit::kit::FrameState;
use meshbrush_kit::kit::background::listed;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::home::Loss;
use meshbrush_kit::kit::project::Replacing;
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
        let (question, body) = question(replacing);
        let dialog = ConfirmDialog::new(&question, &body, "Replace").danger();
        commands.extend(dialog.show(ctx).map(|answer| Command::from(FileCommand::AnswerReplacing(answer))));
    }
}

/// Returns the question, and what would be lost.
fn question(replacing: &Replacing) -> (String, String) {
    let one = match &replacing.files[..] {
        [file] => file,
        files => {
            let body = format!("The present contents of {} will be lost.", listed(files));
            return (format!("Replace {} files?", files.len()), body);
        }
    };
    let body = match replacing.loss {
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

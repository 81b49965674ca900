//! Tables of threats as files.

use crate::app::features::threats::ThreatsCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{DataContents, DataRole, FileAct, FileKind};

/// A table in place of the threats of a layer.
pub static OPEN_THREATS: FileKind = FileKind {
    title: "Open table of threats",
    endings: || vec!["csv"],
    contents: "Tables of threats",
    folder: "threats",
    ..FileKind::new(|path| Command::from(ThreatsCommand::Open(path)))
};

/// The threats of a layer as a table.
pub static SAVE_THREATS: FileKind = FileKind {
    title: "Save table of threats",
    act: FileAct::Save,
    endings: || vec!["csv"],
    contents: "Tables of threats",
    folder: "threats",
    suffix: " threats",
    command_after_browsing: |path| Command::from(ThreatsCommand::Save(path)),
    ..FileKind::new(|path| Command::from(ThreatsCommand::SaveAs(path)))
};

/// The use of a file that threats have.
pub static ROLES: [DataRole; 1] = [DataRole {
    place: 30,
    title: "Threats",
    sentence: "The threats of the selected layer are replaced, or a layer of threats is added.",
    kind: &OPEN_THREATS,
    is_for: |contents| matches!(contents, DataContents::Threats(_)),
    refusal: |_, _| None,
}];

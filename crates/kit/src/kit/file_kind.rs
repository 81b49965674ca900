//! Kinds of files: what is asked for, and what to do with the answer.

use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::kit::command::Command;

/// A kind of file that can be opened or written: a row in the `files.rs` of a feature.
pub struct FileKind {
    /// Title of the dialog, which no other kind has.
    pub title: &'static str,
    /// The action on the file.
    pub act: FileAct,
    /// The endings of such files, without the dot, the default one first.
    pub endings: fn() -> Vec<&'static str>,
    /// The formats to choose from where a file is written in one of several: the default ending of each,
    /// without the dot, and what the format is for.
    pub formats: fn() -> Vec<(&'static str, &'static str)>,
    /// The contents of such files, in the words of a filter.
    pub contents: &'static str,
    /// Names the folder that the dialog opens with: the last one of a kind with this name.
    pub folder: &'static str,
    /// The text after the document's name in the proposed name of a file to write.
    pub suffix: &'static str,
    /// The command for a path that was typed.
    pub command: fn(PathBuf) -> Command,
    /// The command for a path from the desktop's own dialog, in which the person has already confirmed to
    /// replace the file.
    pub command_after_browsing: fn(PathBuf) -> Command,
    /// The command for a file that the program was started with: nothing is asked about it.
    pub command_at_start: fn(PathBuf) -> Command,
    /// Whether the water beside what the file holds is meant, and not that itself.
    pub is_of_sea: bool,
}

/// A kind of file that is asked for.
pub type FileRequest = &'static FileKind;

/// An action on a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileAct {
    /// The file is read, and becomes a document of its own.
    OpenDocument,
    /// The file is read for the document.
    Open,
    /// The file is read, and added to a part of the document.
    Add,
    /// Data of the document are written to it.
    Save,
    /// A result of the document is written to the file.
    Export,
}

impl FileAct {
    /// Returns the word on the button.
    pub fn verb(self) -> &'static str {
        match self {
            Self::OpenDocument | Self::Open => "Open",
            Self::Add => "Add",
            Self::Save => "Save",
            Self::Export => "Export",
        }
    }
}

impl FileKind {
    /// Creates a kind that is read for the document, without the rest of its row.
    pub const fn new(command: fn(PathBuf) -> Command) -> Self {
        Self {
            title: "",
            act: FileAct::Open,
            endings: Vec::new,
            formats: Vec::new,
            contents: "",
            folder: "",
            suffix: "",
            command,
            command_after_browsing: command,
            command_at_start: command,
            is_of_sea: false,
        }
    }

    /// Returns the word on the button.
    pub fn verb(&self) -> &'static str {
        self.act.verb()
    }

    /// Returns whether a file is written.
    pub fn writes(&self) -> bool {
        matches!(self.act, FileAct::Save | FileAct::Export)
    }

    /// Returns whether a file with this name can be the answer.
    pub fn takes(&self, name: &OsStr) -> bool {
        let ending = Path::new(name).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        (self.endings)().contains(&ending.as_str())
    }

    /// Returns the name that a file to write is given first, with this ending; nothing for a file to read.
    pub fn proposed_name(&self, document: &str, ending: &str) -> String {
        if !self.writes() {
            return String::new();
        }
        // No file of some systems and drives has one of these letters.
        let is_possible = |c: char| !(c.is_control() || "/\\:*?\"<>|".contains(c));
        let name: String = document.chars().map(|c| if is_possible(c) { c } else { '-' }).collect();
        format!("{}{}.{ending}", name.trim_matches([' ', '.']), self.suffix)
    }
}

impl PartialEq for FileKind {
    fn eq(&self, other: &Self) -> bool {
        self.title == other.title
    }
}

impl fmt::Debug for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit::command::ShellCommand;

    #[test]
    fn a_name_that_is_proposed_is_one_on_every_system() {
        let kind = FileKind {
            act: FileAct::Export,
            suffix: "-mesh",
            ..FileKind::new(|_| ShellCommand::Palette.into())
        };
        for (document, name) in [
            ("Figure 3: halves", "Figure 3- halves-mesh.vtu"),
            ("a/b\\c*?\"<d>|", "a-b-c----d---mesh.vtu"),
            (" .hidden. ", "hidden-mesh.vtu"),
            ("Île", "Île-mesh.vtu"),
        ] {
            assert_eq!(kind.proposed_name(document, "vtu"), name);
        }
    }
}

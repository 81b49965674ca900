//! What files are asked for, and what to do with the answer.

use std::path::PathBuf;

use crate::app::command::Command;
use crate::render::export::ExportFormat;

/// Why a path is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileRequest {
    /// To open any file that can be opened.
    Open,
    /// To save the document.
    Save,
    /// To open a picture as risk.
    OpenImage,
    /// To open polygons as a domain.
    OpenDomain,
    /// To write the mesh.
    Export,
}

impl FileRequest {
    pub fn title(self) -> &'static str {
        match self {
            Self::Open => "Open",
            Self::Save => "Save project",
            Self::OpenImage => "Open picture as risk",
            Self::OpenDomain => "Open domain",
            Self::Export => "Export mesh",
        }
    }

    pub fn verb(self) -> &'static str {
        match self {
            Self::Open | Self::OpenImage | Self::OpenDomain => "Open",
            Self::Save => "Save",
            Self::Export => "Export",
        }
    }

    pub fn hint(self) -> String {
        match self {
            Self::Open => "path of a .meshbrush, a .geojson or a greyscale .png".into(),
            Self::Save => "path ending in .meshbrush".into(),
            Self::OpenImage => "path of a greyscale .png".into(),
            Self::OpenDomain => "path of a .geojson with polygons".into(),
            Self::Export => {
                let endings: Vec<String> =
                    ExportFormat::endings().map(|ending| format!(".{ending}")).collect();
                format!("ending in {}", endings.join(" "))
            }
        }
    }

    /// What to do with a path that was typed.
    pub fn command(self, path: PathBuf) -> Command {
        match self {
            Self::Open => Command::Open(path),
            Self::Save => Command::SaveAs(path),
            Self::OpenImage => Command::OpenImage(path),
            Self::OpenDomain => Command::OpenDomain(path),
            Self::Export => Command::ExportAs(path),
        }
    }

    /// What to do with a path from the desktop's own dialog, which has asked already whether to replace the
    /// file.
    pub fn command_after_browsing(self, path: PathBuf) -> Command {
        // It has not asked about the files beside it.
        let alone = ExportFormat::of(&path).is_ok_and(|format| format.files(&path).len() == 1);
        match self {
            Self::Save => Command::SaveTo(path),
            Self::Export if alone => Command::Export(path),
            _ => self.command(path),
        }
    }
}

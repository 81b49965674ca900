//! The part of the window that a feature sees and changes.

use std::time::Duration;

use egui::Context;

use super::LayerKinds;
use crate::kit::background::Background;
use crate::kit::command::{Command, FileCommand};
use crate::kit::jobs::Jobs;
use crate::kit::mesh_export::OverlayMaker;
use crate::kit::project::ProjectFile;
use crate::kit::session::Session;
use crate::kit::tools::Tools;
use crate::kit::view::View;

/// As much time as the work takes, for pictures that must be the same every time.
pub const NO_LIMIT: Duration = Duration::from_secs(3600);

/// Keeps unsaved work.
pub trait EditRecorder {
    /// Keeps finished gestures.
    fn record(&mut self, session: &mut Session, project: &ProjectFile);
}

/// Knows the overlay that exported pictures show in place of levels.
#[derive(Clone, Copy)]
pub struct PictureOverlays {
    /// Returns what makes the overlay, with time steps of a Courant number; `None` where pictures show
    /// levels.
    pub maker: fn(&Session, &View, f64) -> Option<OverlayMaker>,
    /// The Courant number of the person.
    pub courant: f64,
}

/// The data that a feature may read and change while it runs a command, besides its own state.
pub struct Ctx<'a> {
    /// The document and its mesh.
    pub session: &'a mut Session,
    /// The settings of the view.
    pub view: &'a mut View,
    /// The selected tool, and settings of tools.
    pub tools: &'a mut Tools,
    /// The document's file.
    pub project: &'a mut ProjectFile,
    /// Keeps unsaved work. Absent in tests and screenshots.
    pub journal: Option<&'a mut dyn EditRecorder>,
    /// Work on files.
    pub background: &'a mut Background,
    /// The kinds of layers of all features.
    pub layer_kinds: LayerKinds,
    /// Work that takes longer than a frame.
    pub jobs: &'a Jobs,
    /// Commands that are run after this one, in the same frame.
    pub commands: &'a mut Vec<Command>,
    /// The clipboard and the frame.
    pub egui: &'a Context,
    /// The overlay of exported pictures.
    pub picture_overlay: PictureOverlays,
    /// Whether to leave out what differs from run to run.
    pub reproducible: bool,
}

impl Ctx<'_> {
    /// Sends a command, to be run after this one.
    pub fn send(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Returns what makes the overlay of exported pictures, if they show one.
    pub fn picture_overlay(&self) -> Option<OverlayMaker> {
        (self.picture_overlay.maker)(self.session, self.view, self.picture_overlay.courant)
    }

    /// Hands finished gestures to the journal.
    pub fn record_edits(&mut self) {
        if let Some(keeper) = &mut self.journal {
            keeper.record(self.session, self.project);
        }
    }

    /// Says that a file was not read or written: in the dialog that asked for it, or else on the canvas.
    pub fn fail(&mut self, problem: String) {
        self.send(Command::from(FileCommand::Fail(problem)));
    }
}

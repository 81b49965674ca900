//! What a feature sees of the window.

use eframe::egui::Context;
use glam::DVec2;

use super::App;
use super::background::Background;
use super::command::Command;
use super::features::Features;
use super::jobs::Jobs;
use super::project::ProjectFile;
use super::session::Session;
use super::tools::Tools;
use super::view::View;

/// A feature of the window: a folder under `features` with its state, its commands and what they do, its
/// panel, its marks on the canvas, its entries in menus, its kinds of files and its tests.
pub trait Feature: Default {
    /// What people want of it.
    type Command;

    /// Runs one command.
    fn execute(&mut self, command: Self::Command, ctx: &mut Ctx<'_>);

    /// Forgets what belongs to the document: another one was opened.
    fn forget_document(&mut self) {}
}

/// What a feature may read and change while it runs a command, besides its own state.
pub struct Ctx<'a> {
    /// The document and its mesh.
    pub session: &'a mut Session,
    /// What is shown, and how.
    pub view: &'a mut View,
    /// The selected tool, and settings of tools.
    pub tools: &'a mut Tools,
    /// The document's file.
    pub project: &'a mut ProjectFile,
    /// Work on files.
    pub background: &'a mut Background,
    /// Work that takes longer than a frame.
    pub jobs: &'a Jobs,
    /// Commands that are run after this one, in the same frame.
    pub commands: &'a mut Vec<Command>,
    /// The clipboard and the frame.
    pub egui: &'a Context,
    /// Whether to leave out what differs from run to run.
    pub reproducible: bool,
}

impl Ctx<'_> {
    /// Sends a command, to be run after this one.
    pub fn send(&mut self, command: Command) {
        self.commands.push(command);
    }

    /// Queries a point or none. The trail to the former one ends.
    pub fn ask(&mut self, point: Option<DVec2>) {
        self.tools.query(point, self.session);
    }
}

impl App {
    /// The features, and what they see.
    pub(super) fn features<'a>(&'a mut self, egui: &'a Context) -> (&'a mut Features, Ctx<'a>) {
        let ctx = Ctx {
            session: &mut self.session,
            view: &mut self.view,
            project: &mut self.project,
            background: &mut self.background,
            jobs: &self.jobs,
            commands: &mut self.commands,
            egui,
            reproducible: self.reproducible,
            tools: &mut self.tools,
        };
        (&mut self.features, ctx)
    }
}

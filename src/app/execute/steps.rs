//! Commands of the mode that steps through the refinement.

use std::path::{Path, PathBuf};

use eframe::egui::Context;

use crate::app::App;
use crate::app::command::Command;
use crate::app::stepping::{StepCommand, Stepping};

impl App {
    /// Runs a command of the mode.
    pub(super) fn execute_on_steps(&mut self, command: StepCommand, ctx: &Context) {
        if command == StepCommand::Begin {
            self.session.query(None);
            self.stepping = Some(Stepping::new(&self.session, &self.tools));
            return;
        }
        let Some(stepping) = &mut self.stepping else { return };
        match command {
            StepCommand::Begin => {}
            StepCommand::ExportAs(path) => return self.export_steps_as(path),
            StepCommand::Export(path) => return self.export_steps(&path),
            StepCommand::Leave => self.stepping = None,
            StepCommand::GoTo(position) => stepping.go_to(position),
            StepCommand::Move(steps) => stepping.go_by(steps),
            StepCommand::TogglePlay => stepping.toggle_play(ctx),
            StepCommand::Speed(speed) => stepping.set_speed(speed),
            StepCommand::ExportRange(first, last) => stepping.set_export_range(first, last),
        }
        if let Some(place) = self.stepping.as_ref().and_then(Stepping::place) {
            self.view.reveal(place);
        }
    }

    /// Writes the chosen steps, and asks before other files are replaced.
    fn export_steps_as(&mut self, path: PathBuf) {
        let Some(stepping) = &self.stepping else { return };
        match stepping.files(&path) {
            Ok(files) => self
                .commands
                .extend(self.project.ask_to_replace(files, Command::Steps(StepCommand::Export(path)))),
            Err(problem) => self.fail(problem),
        }
    }

    /// Writes the chosen steps.
    fn export_steps(&mut self, path: &Path) {
        let Some(stepping) = &self.stepping else { return };
        if let Err(problem) = stepping.export(path, &self.session, &self.view, &mut self.background) {
            self.fail(problem);
        }
    }

    /// Records or plays steps. The mode ends when the document is edited. Returns whether anything is being
    /// recorded.
    pub(in crate::app) fn advance_steps(&mut self, ctx: &Context) -> bool {
        let Some(stepping) = &mut self.stepping else { return false };
        if !stepping.belongs_to(&self.session) {
            self.stepping = None;
            self.session.tell("The document was edited, so that its mesh is shown again.".into());
            return false;
        }
        stepping.advance(&self.session, &self.jobs, ctx).unwrap_or_else(|problem| {
            self.stepping = None;
            self.session.report(problem);
            false
        })
    }
}

//! Commands of the mode that steps through the refinement.

use std::time::Duration;

use eframe::egui::Context;

use crate::app::App;
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
            StepCommand::Leave => self.stepping = None,
            StepCommand::GoTo(position) => stepping.go_to(position),
            StepCommand::Move(steps) => stepping.go_by(steps),
            StepCommand::TogglePlay => stepping.toggle_play(ctx),
            StepCommand::Speed(speed) => stepping.set_speed(speed),
        }
        if let Some(place) = self.stepping.as_ref().and_then(Stepping::place) {
            self.view.reveal(place);
        }
    }

    /// Records or plays steps. The mode ends when the document is edited. Returns whether anything is being
    /// recorded.
    pub(in crate::app) fn advance_steps(&mut self, patience: Duration, ctx: &Context) -> bool {
        let Some(stepping) = &mut self.stepping else { return false };
        if !stepping.belongs_to(&self.session) {
            self.stepping = None;
            self.session.tell("The document was edited, so that its mesh is shown again.".into());
            return false;
        }
        stepping.advance(&self.session, patience, ctx).unwrap_or_else(|problem| {
            self.stepping = None;
            self.session.report(problem);
            false
        })
    }
}

//! What the commands of the mode do.

use std::path::PathBuf;

use super::entries::entries;
use super::{StepCommand, Stepping, Steps};
use crate::app::command::Command;
use crate::app::kit::{Ctx, Feature, Row};

impl Feature for Stepping {
    type Command = StepCommand;
    const ROW: Row = Row { entries, ..Row::EMPTY };

    fn execute(&mut self, command: StepCommand, ctx: &mut Ctx<'_>) {
        if let StepCommand::Begin(figure) = command {
            if figure.is_none() {
                ctx.session.query(None);
            }
            ctx.tools.only_move_view(true);
            self.steps = Some(Steps::new(ctx.session, figure));
            return;
        }
        let Some(steps) = &mut self.steps else { return };
        match command {
            StepCommand::Begin(_) => {}
            StepCommand::ExportAs(path) => return export_as(steps, path, ctx),
            StepCommand::Export(path) => {
                let started = steps.export(&path, ctx.session, ctx.view, ctx.background);
                return started.unwrap_or_else(|problem| ctx.fail(problem));
            }
            StepCommand::Leave => _ = self.leave(ctx.tools),
            StepCommand::GoTo(position) => steps.go_to(position),
            StepCommand::Move(count) => steps.go_by(count),
            StepCommand::TogglePlay => steps.toggle_play(ctx.egui),
            StepCommand::Speed(speed) => steps.set_speed(speed),
            StepCommand::ExportRange(first, last) => steps.set_export_range(first, last),
        }
        if let Some(place) = self.steps().and_then(Steps::place) {
            ctx.view.reveal(place);
        }
    }

    /// Records or plays steps. The mode ends when the document is edited.
    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        let Some(steps) = &mut self.steps else { return false };
        if !steps.belongs_to(ctx.session) {
            self.leave(ctx.tools);
            ctx.session.tell("The document was edited, so that its mesh is shown again.".into());
            return false;
        }
        steps.advance(ctx.session, ctx.jobs, ctx.egui).unwrap_or_else(|problem| {
            self.leave(ctx.tools);
            ctx.session.report(problem);
            false
        })
    }
}

/// Writes the chosen steps, and asks before other files are replaced.
fn export_as(steps: &Steps, path: PathBuf, ctx: &mut Ctx<'_>) {
    match steps.files(&path) {
        Ok(files) => {
            let export = Command::Steps(StepCommand::Export(path));
            ctx.commands.extend(ctx.project.ask_to_replace(files, export));
        }
        Err(problem) => ctx.fail(problem),
    }
}

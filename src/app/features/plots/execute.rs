//! What the commands about plots do.

use super::{PlotKind, Plots, PlotsCommand};
use crate::app::command::{Command, StepCommand};
use crate::app::ctx::{Ctx, Feature};

impl Feature for Plots {
    type Command = PlotsCommand;

    fn execute(&mut self, command: PlotsCommand, ctx: &mut Ctx<'_>) {
        match command {
            PlotsCommand::Show(kind) => self.show(kind, ctx),
            PlotsCommand::Choose(kind) => self.choose(kind),
            PlotsCommand::Compute => self.compute(ctx.session, ctx.jobs),
            PlotsCommand::SetUp { last_level, runs } => (self.last_level, self.runs) = (last_level, runs),
            PlotsCommand::Measure => {
                if !self.kind.is_of_experiment() {
                    self.show(PlotKind::Time, ctx);
                }
                self.measure(ctx.jobs);
            }
            PlotsCommand::CancelMeasuring => self.cancel(),
            PlotsCommand::Copy => {
                if let Some(text) = self.text(ctx.session) {
                    ctx.egui.copy_text(text);
                    ctx.session.tell("Copied: the numbers of the plot.".into());
                }
            }
            PlotsCommand::ExportAs(path) => {
                let path = if path.extension().is_none() { path.with_extension("svg") } else { path };
                let export = |path| Command::Plots(PlotsCommand::Export(path));
                ctx.commands.extend(ctx.project.save_table_as(path, export));
            }
            PlotsCommand::Export(path) => self.export(ctx.session, ctx.background, &path),
        }
    }
}

impl Plots {
    /// Opens the panel with a plot, also while steps are shown or the panels are hidden.
    fn show(&mut self, kind: PlotKind, ctx: &mut Ctx<'_>) {
        ctx.send(Command::Steps(StepCommand::Leave));
        ctx.view.panels = true;
        self.choose(kind);
        self.reveal(true);
    }
}

//! Runs the commands about plots.

use super::error_curve::take_point;
use super::{PLOTS, PlotKind, Plots, PlotsCommand, entries};
use crate::app::features::stepping::StepCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{Ctx, Feature, Row};

impl Feature for Plots {
    type Command = PlotsCommand;
    const ROW: Row = Row { panels: &[&PLOTS], entries, ..Row::EMPTY };

    /// Measurements of time are about no document.
    fn for_next_document(self) -> Self {
        let Self { kind, experiment, measuring, runs_done, last_level, runs, .. } = self;
        Self { kind, experiment, measuring, runs_done, last_level, runs, ..Self::default() }
    }

    fn execute(&mut self, command: PlotsCommand, ctx: &mut Ctx<'_>) {
        match command {
            PlotsCommand::Show(kind) => self.show(kind, ctx),
            PlotsCommand::Choose(kind) => self.choose(kind),
            PlotsCommand::Compute => self.compute(ctx.session, ctx.jobs),
            PlotsCommand::TakeError(point) => take_point(point, ctx),
            PlotsCommand::SetUp { last_level, runs } => (self.last_level, self.runs) = (last_level, runs),
            PlotsCommand::Measure => {
                if !self.kind.is_of_experiment() {
                    self.show(PlotKind::Time, ctx);
                }
                self.measure(ctx.jobs);
            }
            PlotsCommand::MeasureOnce => {
                if self.experiment.meshes.is_empty() {
                    self.measure(ctx.jobs);
                }
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
                let export = |path| Command::from(PlotsCommand::Export(path));
                ctx.commands.extend(ctx.project.save_table_as(path, export));
            }
            PlotsCommand::Export(path) => self.export(ctx.session, ctx.background, &path),
        }
    }

    fn follow(&mut self, ctx: &mut Ctx<'_>) -> bool {
        self.take(ctx.session, ctx.jobs).unwrap_or_else(|problem| {
            ctx.session.report(problem);
            false
        })
    }
}

impl Plots {
    /// Opens the panel with a plot, also while steps are shown or the panels are hidden.
    fn show(&mut self, kind: PlotKind, ctx: &mut Ctx<'_>) {
        ctx.send(Command::from(StepCommand::Leave));
        ctx.view.panels = true;
        self.choose(kind);
        ctx.view.revealed_panel = Some(PLOTS.name);
    }
}

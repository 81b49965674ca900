//! Commands about plots.

use eframe::egui::Context;

use crate::app::App;
use crate::app::command::Command;
use crate::app::plots::{PlotKind, PlotsCommand};

impl App {
    pub(super) fn execute_on_plots(&mut self, command: PlotsCommand, ctx: &Context) {
        match command {
            PlotsCommand::Show(kind) => self.show_plot(kind),
            PlotsCommand::Choose(kind) => self.plots.choose(kind),
            PlotsCommand::Compute => self.plots.compute(&self.session, &self.jobs),
            PlotsCommand::SetUp { last_level, runs } => {
                (self.plots.last_level, self.plots.runs) = (last_level, runs);
            }
            PlotsCommand::Measure => {
                if !self.plots.kind().is_of_experiment() {
                    self.show_plot(PlotKind::Time);
                }
                self.plots.measure(&self.jobs);
            }
            PlotsCommand::CancelMeasuring => self.plots.cancel(),
            PlotsCommand::Copy => {
                if let Some(text) = self.plots.text(&self.session) {
                    ctx.copy_text(text);
                    self.session.tell("Copied: the numbers of the plot.".into());
                }
            }
            PlotsCommand::ExportAs(path) => {
                let path = if path.extension().is_none() { path.with_extension("svg") } else { path };
                let export = |path| Command::Plots(PlotsCommand::Export(path));
                self.commands.extend(self.project.save_table_as(path, export));
            }
            PlotsCommand::Export(path) => self.plots.export(&self.session, &mut self.background, &path),
        }
    }

    /// Takes what was computed for plots. Returns whether some is being computed.
    pub(in crate::app) fn take_plots(&mut self) -> bool {
        self.plots.take(&self.jobs).unwrap_or_else(|problem| {
            self.session.report(problem);
            false
        })
    }

    /// Opens the panel with a plot, also while steps are shown or the panels are hidden.
    fn show_plot(&mut self, kind: PlotKind) {
        self.stepping = None;
        self.view.panels = true;
        self.plots.choose(kind);
        self.plots.reveal(true);
    }
}

//! Commands about the figures of the report.

use eframe::egui::Context;

use crate::app::App;
use crate::app::command::{Command, StepCommand};
use crate::app::features::inspection::QUERY;
use crate::app::features::plots::PlotKind;
use crate::app::report::{FigureCommand, ShownFigure};
use meshbrush_study::report::ReportFigure;

impl App {
    pub(in crate::app) fn execute_on_report(&mut self, command: FigureCommand, ctx: &Context) {
        match command {
            FigureCommand::Open(figure) => self.open_figure(figure),
            FigureCommand::Close => self.report = None,
            FigureCommand::Copy(text) => {
                ctx.copy_text(text);
                self.session.tell("Copied: the figure with its numbers.".into());
            }
        }
    }

    /// Opens the document of a figure, and shows of it what the figure shows.
    fn open_figure(&mut self, figure: ReportFigure) {
        self.features.stepping.leave(&mut self.tools);
        self.open(figure.document());
        self.report = Some(ShownFigure::new(figure, &self.session));
        self.view.panels = true;
        if figure.is_step() {
            self.send(Command::Steps(StepCommand::Begin(Some(figure))));
        }
        if let Some(point) = figure.query() {
            self.use_tool(&QUERY);
            self.view.aids.walk = true;
            self.session.query(Some(point));
        }
        if figure.is_about_time() {
            self.features.plots.choose(PlotKind::Figure5);
        }
        // Its entry says that the meshes are made; Figure 5 waits for its button.
        if figure == ReportFigure::Experiment {
            self.features.plots.measure(&self.jobs);
        }
    }
}

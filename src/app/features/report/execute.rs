//! Runs the commands about the figures of the report.

use std::sync::Arc;

use super::{FIGURE, FigureCommand, Report, entries};
use crate::app::features::plots::{PlotKind, PlotsCommand};
use crate::app::features::stepping::StepCommand;
use meshbrush_kit::kit::command::{Command, FileCommand, Opened, ShellCommand, ViewCommand};
use meshbrush_kit::kit::{Ctx, Feature, Row, Tab};
use meshbrush_study::report::ReportFigure;

impl Feature for Report {
    type Command = FigureCommand;
    const ROW: Row = Row { panels: &[&FIGURE], entries: entries::entries, ..Row::EMPTY };

    fn execute(&mut self, command: FigureCommand, ctx: &mut Ctx<'_>) {
        match command {
            FigureCommand::Open(figure) => open(figure, ctx),
            FigureCommand::Show(figure) => self.show(figure, ctx),
            FigureCommand::Close => {
                self.shown = None;
                ctx.view.dock.leave(Tab::Method);
            }
            FigureCommand::Copy(text) => {
                ctx.egui.copy_text(text);
                ctx.session.tell("Copied: the figure with its numbers.".into());
            }
        }
    }
}

/// Opens the document of a figure, and then shows the figure.
fn open(figure: ReportFigure, ctx: &mut Ctx<'_>) {
    let opened = Opened { document: Arc::new(figure.document()), home: None };
    ctx.send(Command::from(StepCommand::Leave));
    ctx.send(Command::from(FileCommand::Show(opened)));
    ctx.send(Command::from(FigureCommand::Show(figure)));
}

impl Report {
    /// Shows of the document what a figure shows.
    fn show(&mut self, figure: ReportFigure, ctx: &mut Ctx<'_>) {
        self.shown = Some(figure);
        ctx.view.panels = true;
        ctx.view.revealed_panel = Some(FIGURE.name);
        if figure.is_step() {
            ctx.send(Command::from(StepCommand::Begin(Some(figure))));
        }
        if let Some(point) = figure.query() {
            let tool = ctx.tools.all().iter().find(|tool| tool.queries).copied();
            ctx.commands.extend(tool.map(|tool| Command::from(ShellCommand::Use(tool))));
            ctx.view.aids.walk = true;
            ctx.session.query(Some(point));
        }
        if let Some(area) = figure.area() {
            let bounds = ctx.session.document().settings().domain.bounds;
            ctx.send(Command::from(ViewCommand::ShowAreaOf(bounds, area)));
        }
        // The meshes are made at once: the small ones and the plot are there in a moment.
        if figure.is_about_time() {
            ctx.send(Command::from(PlotsCommand::Choose(PlotKind::Figure5)));
            let is_new = figure == ReportFigure::Experiment;
            let measure = if is_new { PlotsCommand::Measure } else { PlotsCommand::MeasureOnce };
            ctx.send(Command::from(measure));
        }
    }
}

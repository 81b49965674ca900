//! A figure of the report: what it shows, and its numbers beside ours.

use eframe::egui::{Align, Grid, Layout, RichText, Ui};

use super::{FigureCommand, as_text, comparisons};
use crate::app::features::plots::{self, PlotKind, Plots};
use crate::app::features::report::Report;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark};
use meshbrush_study::report::{ABOUT_EXPONENT, Comparison, ReportFigure};
use meshbrush_ui::theme::{font, tokens};
use meshbrush_ui::widgets::{ActionButton, plot_view, tips};

/// The figure that is shown.
pub static FIGURE: Panel = Panel { name: "figure", tab: Tab::Method, place: 0, show: section };

/// Draws the figure that is shown, also beside its steps.
pub fn section(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let Some(figure) = state.feature::<Report>().shown else { return };
    ui.add_space(10.0);
    title(ui, figure, commands);
    let experiment = state.feature::<Plots>().experiment();
    // The figure itself comes first: in a low window the rest is below it.
    if figure == ReportFigure::Times && !experiment.meshes.is_empty() {
        plot_view(ui, PlotKind::Figure5.name(), &experiment.figure_5(), plots::HEIGHT);
    }
    ui.label(RichText::new(figure.text()).font(font::body()).color(tokens(ui).text));
    ui.add_space(6.0);
    if figure.is_about_time() {
        plots::measuring(ui, state.feature::<Plots>(), commands);
        if !experiment.meshes.is_empty() {
            remark(ui, ABOUT_EXPONENT);
        }
    }
    let rows = comparisons(figure, state);
    if rows.is_empty() {
        if let Some(why) = nothing_to_compare(figure) {
            remark(ui, why);
        }
    } else {
        table(ui, &rows);
        ui.add_space(4.0);
        let copy = Command::from(FigureCommand::Copy(as_text(figure, &rows)));
        button_rows(ui, [vec![("Copy the comparison", true, copy)]], commands);
    }
    ui.add_space(6.0);
    ui.separator();
}

fn title(ui: &mut Ui, figure: ReportFigure, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let title = RichText::new(format!("The report, {}", figure.name())).font(font::strong());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let close = ui.add(ActionButton::new("Close").named("Close the figure"));
            if tips::explain(ui, close, tips::sentence("Close the figure")).clicked() {
                commands.push(Command::from(FigureCommand::Close));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(eframe::egui::Label::new(title.color(tokens(ui).value)).wrap());
            });
        });
    });
    ui.add_space(4.0);
}

fn nothing_to_compare(figure: ReportFigure) -> Option<&'static str> {
    Some(match figure {
        ReportFigure::CoarseGrid => {
            "Go to the first step to compare the numbers[: {step-through-the-refinement} shows the steps][, {first-step} goes \
             to the first]."
        }
        ReportFigure::Descendants | ReportFigure::Neighbours => {
            "This is another step. Open the figure again to compare the numbers."
        }
        ReportFigure::Orientation => "Query a point of the mesh to see its walk.",
        _ => return None,
    })
}

/// A row for each number, with the report's before ours.
fn table(ui: &mut Ui, rows: &[Comparison]) {
    let t = *tokens(ui);
    let head = |text: &str| RichText::new(text).font(font::caption()).color(t.label);
    let value = |text: &str| RichText::new(text).font(font::small_value()).color(t.value);
    Grid::new("numbers of the report").num_columns(3).spacing([14.0, 4.0]).show(ui, |ui| {
        for text in ["", "report", "here"] {
            ui.label(head(text));
        }
        ui.end_row();
        for Comparison { what, report, ours } in rows {
            ui.label(head(what));
            ui.label(value(report));
            ui.label(value(ours));
            ui.end_row();
        }
    });
}

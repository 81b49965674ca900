//! Plots of the mesh by level, and the experiment of Section 5.4 of the report.

use eframe::egui::Ui;

use super::files::EXPORT_PLOT;
use super::{PlotKind, Plots, PlotsCommand};
use meshbrush_core::surface::CurvePoint;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{FrameState, Panel, Tab, button_rows, remark};
use meshbrush_study::plot::Plot;
use meshbrush_study::report::Experiment;
use meshbrush_ui::widgets::{
    ActionButton, NumberRow, Section, dropdown_row, format, plot_picker, plot_view, value_row,
};

/// A chosen plot, and what it takes to measure those of time.
pub static PLOTS: Panel = Panel { name: "plots", tab: Tab::Mesh, place: 3, show };

/// Height of a plot, in points.
pub const HEIGHT: f32 = 210.0;
/// Height of legend and note, in points.
const ROOM_AROUND: f32 = 56.0;
const HOW_TO_MEASURE: &str = "Measure makes the meshes of Section 5.4 of the report on this machine, on one thread, up to the \
                              deepest level above. Level 5 has 9,560 triangles, and level 13 has 2,113,944: each further \
                              level has about twice as many. Each run makes all meshes in turn.";
/// The least deepest level that gives a line of best fit, and most runs.
const LEAST_LEVEL: u32 = 6;
const MOST_RUNS: u32 = 100;

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let plots = &state.feature::<Plots>();
    Section::new("Plots").closed().reveal(PLOTS.is_revealed(state)).show(ui, |ui| {
        let mut kind = plots.kind();
        if dropdown_row(ui, "Plot", &mut kind, &PlotKind::ALL).changed() {
            commands.push(Command::from(PlotsCommand::Choose(kind)));
        }
        if kind.is_of_experiment() {
            measuring(ui, plots, commands);
        } else if plots.is_due(state.session) {
            // The figures are computed only while they are shown.
            commands.push(Command::from(PlotsCommand::Compute));
        }
        ui.add_space(6.0);
        let known = plots.plot(state.session);
        ui.scope(|ui| {
            // The same room before the plot is known: nothing jumps.
            ui.set_min_height(HEIGHT + ROOM_AROUND);
            let obstacle = plots.obstacle(state.session);
            match &known {
                _ if obstacle.is_some() => remark(ui, &obstacle.unwrap_or_default()),
                None if kind.is_of_experiment() => remark(ui, HOW_TO_MEASURE),
                None if kind == PlotKind::Errors => remark(ui, "The curve is being traced."),
                None => remark(ui, "The mesh is being measured."),
                Some((plot, is_current)) => {
                    // The former plot stays until the next one is known.
                    if !is_current {
                        ui.set_opacity(0.5);
                    }
                    if kind == PlotKind::Errors {
                        error_curve(ui, plot, commands);
                    } else {
                        plot_view(ui, kind.name(), plot, HEIGHT);
                    }
                }
            }
        });
        let is_known = known.is_some();
        let copy = Command::from(PlotsCommand::Copy);
        let export = Command::from(FileCommand::Ask(&EXPORT_PLOT));
        button_rows(
            ui,
            [vec![("Export plot…", is_known, export), ("Copy numbers", is_known, copy)]],
            commands,
        );
    });
}

/// Shows the curve of errors, whose points can be taken.
fn error_curve(ui: &mut Ui, plot: &Plot, commands: &mut Vec<Command>) {
    let Some(least) = plot.series.first() else { return };
    let point_at = |number: usize| {
        let [triangles, error] = least.points[number];
        CurvePoint { triangles: triangles as usize, error }
    };
    let tip = |number| {
        let CurvePoint { triangles, error } = point_at(number);
        let (count, error) = (format::count(triangles as u64), format::digits(error, 4));
        format!("{count} triangles, {} {error}\nA click makes this mesh.", plot.y.label)
    };
    let picked = plot_picker(ui, PlotKind::Errors.name(), plot, HEIGHT, tip);
    if let Some(picked) = picked.filter(|picked| picked.is_clicked) {
        commands.push(Command::from(PlotsCommand::TakeError(point_at(picked.point))));
    }
}

/// How the experiment is measured, and the button that begins it; or its progress.
pub fn measuring(ui: &mut Ui, plots: &Plots, commands: &mut Vec<Command>) {
    if plots.is_measuring() {
        let (round, level) = plots.run_in_progress().unwrap_or((plots.runs, plots.last_level));
        let (runs, levels) = (plots.runs, plots.last_level);
        value_row(ui, "Measuring", &format!("run {} of {runs}, level {level} of {levels}", round.max(1)));
        if ui.add(ActionButton::new("Cancel measuring").vanishing()).clicked() {
            commands.push(Command::from(PlotsCommand::CancelMeasuring));
        }
        return;
    }
    let (mut level, mut runs) = (f64::from(plots.last_level), f64::from(plots.runs));
    let levels = f64::from(LEAST_LEVEL)..=f64::from(Experiment::LAST_LEVEL);
    let deepest = NumberRow::new("Deepest level", &mut level).range(levels).integer().show(ui);
    let often = NumberRow::new("Runs", &mut runs).range(1.0..=f64::from(MOST_RUNS)).integer().show(ui);
    if deepest.changed() || often.changed() {
        commands.push(Command::from(PlotsCommand::SetUp { last_level: level as u32, runs: runs as u32 }));
    }
    if ui.add(ActionButton::new("Measure")).clicked() {
        commands.push(Command::from(PlotsCommand::Measure));
    }
}

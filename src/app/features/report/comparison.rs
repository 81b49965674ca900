//! The numbers of a figure of the report beside ours.

use crate::app::features::plots::Plots;
use crate::app::features::stepping::{Stepping, Steps};
use meshbrush_kit::kit::FrameState;
use meshbrush_study::report::{Comparison, Experiment, ReportFigure};
use meshbrush_ui::widgets::format;

/// Returns the numbers of the report beside those on the screen.
pub fn comparisons(figure: ReportFigure, state: &FrameState<'_>) -> Vec<Comparison> {
    if figure.is_step() {
        let player = state.feature::<Stepping>().steps().and_then(Steps::player);
        return player.map_or_else(Vec::new, |player| figure.compare_step(player));
    }
    if figure.is_about_time() {
        return of_experiment(figure, state.feature::<Plots>().experiment());
    }
    figure.compare_mesh(state.session.mesh(), state.session.queried())
}

/// Returns the triangles of each mesh, and the gradient of the line of best fit, which is the exponent of the
/// power law.
fn of_experiment(figure: ReportFigure, experiment: &Experiment) -> Vec<Comparison> {
    let count = |count: usize| format::count(count as u64);
    let row = |mesh: &meshbrush_study::report::ExperimentMesh| {
        let stated = mesh.triangles_in_report.map_or_else(|| "–".into(), count);
        let ours = format!("{} in {}", count(mesh.triangles), format::time(mesh.seconds()));
        Comparison::new(format!("Level {}", mesh.level), stated, ours)
    };
    let meshes = experiment.meshes.iter().filter(|_| figure == ReportFigure::Experiment);
    let mut rows: Vec<Comparison> = meshes.map(row).collect();
    if let Some(law) = experiment.power_law() {
        let stated = format::fixed(Experiment::STATED_GRADIENT, 2);
        rows.push(Comparison::new("Gradient", stated, law.exponent_in_words()));
    }
    rows
}

/// Returns the name, text and numbers of a figure, to be copied.
pub fn as_text(figure: ReportFigure, rows: &[Comparison]) -> String {
    let mut text = format!("{}\n{}\n\twhat the report says\there\n", figure.name(), figure.text());
    for Comparison { what, report, ours } in rows {
        text += &format!("{what}\t{report}\t{ours}\n");
    }
    text
}

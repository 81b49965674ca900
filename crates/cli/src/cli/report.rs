//! `meshbrush report`: the experiment of Section 5.4 of the report on this machine.

use std::io::Write;
use std::time::Instant;

use serde::Serialize;

use super::failure::Failure;
use super::more_args::ReportArguments;
use super::terminal::Terminal;
use meshbrush_study::report::{Experiment, ExperimentMesh};

/// The numbers of the experiment; its JSON is the answer of `--json`.
#[derive(Serialize)]
struct Answer<'a> {
    meshes: &'a [ExperimentMesh],
    /// The gradient of time over triangles, both in proportion to the mesh of level 5, from that level on.
    gradient: f64,
    /// The gradient of the logarithms of time over triangles, from the mesh of level 5 on.
    logarithmic_gradient: f64,
    gradient_in_report: f64,
}

/// Runs the command. `out` is standard output.
///
/// # Errors
/// Fails when there is not enough memory, or standard output is closed.
pub fn run(typed: &ReportArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let start = Instant::now();
    let mut experiment = Experiment::default();
    for level in 1..=typed.level {
        terminal.progress(start, || format!("level {level} of {}", typed.level));
        let clock = || start.elapsed().as_secs_f64();
        experiment.meshes.extend(ExperimentMesh::measure(level, typed.runs, clock, || true)?);
    }
    terminal.clear();
    let text = if typed.json { json(&experiment) } else { experiment.table(typed.runs) };
    writeln!(out, "{text}").map_err(Failure::Print)
}

fn json(experiment: &Experiment) -> String {
    let [gradient, logarithmic_gradient] = experiment.gradients().unwrap_or([f64::NAN; 2]);
    let meshes = &experiment.meshes;
    let gradient_in_report = Experiment::STATED_GRADIENT;
    let answer = Answer { meshes, gradient, logarithmic_gradient, gradient_in_report };
    serde_json::to_string(&answer).expect("numbers are valid JSON")
}

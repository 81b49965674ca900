//! `meshbrush report`: the experiment of Section 5.4 of the report on this machine.

use std::io::Write;
use std::time::Instant;

use serde::Serialize;

use super::args::ReportArguments;
use super::failure::Failure;
use super::run_clock::RunClock;
use super::terminal::Terminal;
use meshbrush_study::report::{Experiment, ExperimentMesh, ExperimentRun};

/// The numbers of the experiment; its JSON is the answer of `--json`.
#[derive(Serialize)]
struct ReportAnswer<'a> {
    meshes: Vec<MeshAnswer<'a>>,
    /// The exponent of the power law of time over triangles, from the mesh of level 5 on: the gradient of the
    /// line of best fit in Figure 5.
    exponent: Option<f64>,
    /// How far the exponent may be off, in 95 % of all measurements.
    exponent_uncertainty: Option<f64>,
    gradient_in_report: f64,
    /// Whether most runs of a mesh were disturbed by other work.
    is_disturbed: bool,
}

/// A mesh, with the least time of its runs.
#[derive(Serialize)]
struct MeshAnswer<'a> {
    #[serde(flatten)]
    mesh: &'a ExperimentMesh,
    seconds: f64,
}

impl<'a> MeshAnswer<'a> {
    fn of(mesh: &'a ExperimentMesh) -> Self {
        Self { mesh, seconds: mesh.seconds() }
    }
}

/// Runs the command. `out` is standard output.
///
/// # Errors
/// Fails when there is not enough memory, or standard output is closed.
pub fn run(typed: &ReportArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let start = Instant::now();
    let mut experiment = Experiment::default();
    for (round, level) in Experiment::order(typed.level, typed.runs) {
        terminal.progress(start, || {
            format!("round {} of {}, level {level} of {}", round.max(1), typed.runs, typed.level)
        });
        let clock = RunClock::start();
        let run = ExperimentRun::measure(level, || clock.now(), || true)?;
        run.into_iter().for_each(|run| experiment.add(round, run));
    }
    terminal.clear();
    let text = if typed.json { json(&experiment) } else { experiment.table() };
    writeln!(out, "{text}").map_err(Failure::Print)
}

fn json(experiment: &Experiment) -> String {
    let law = experiment.power_law();
    let answer = ReportAnswer {
        meshes: experiment.meshes.iter().map(MeshAnswer::of).collect(),
        exponent: law.map(|law| law.exponent),
        exponent_uncertainty: law.map(|law| law.uncertainty).filter(|value| value.is_finite()),
        gradient_in_report: Experiment::STATED_GRADIENT,
        is_disturbed: experiment.is_disturbed(),
    };
    serde_json::to_string(&answer).expect("numbers are valid JSON")
}

//! `meshbrush report`: the experiment of Section 5.4 of the report on this machine.

use std::io::Write;
use std::time::Instant;

use serde::Serialize;

use super::failure::Failure;
use super::more_args::ReportArguments;
use super::terminal::Terminal;
use crate::build::MeshBuilder;
use crate::document::{Example, Settings};
use crate::field::Formula;
use crate::layers::{Layer, LayerKind};
use crate::mesh::{Progress, bisection_edge_length};
use crate::text::Grouped;

/// The level of the smallest mesh of the report: all its times are in proportion to that.
const FIRST_LEVEL: u32 = 5;
/// The numbers of triangles that the report states, by level: its smallest and its largest mesh.
const STATED_TRIANGLES: [(u32, usize); 2] = [(FIRST_LEVEL, 9_560), (13, 2_113_944)];
/// The gradient of the line of best fit in Figure 5.
const STATED_GRADIENT: f64 = 1.01;

/// The numbers of the experiment; its JSON is the answer of `--json`.
#[derive(Serialize)]
struct Experiment {
    meshes: Vec<Row>,
    /// Of time over triangles, both in proportion to the mesh of level 5, from that level on.
    gradient: f64,
    /// Of the logarithms of the same.
    logarithmic_gradient: f64,
    gradient_in_report: f64,
}

#[derive(Serialize)]
struct Row {
    level: u32,
    triangles: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    triangles_in_report: Option<usize>,
    /// Mean of all runs.
    seconds: f64,
}

/// Runs the command. `out` is standard output.
///
/// # Errors
/// When there is not enough memory, or standard output is closed.
pub fn run(typed: &ReportArguments, out: &mut dyn Write, terminal: &mut Terminal) -> Result<(), Failure> {
    let start = Instant::now();
    let mut meshes = Vec::new();
    for level in 1..=typed.level {
        terminal.progress(start, || format!("level {level} of {}", typed.level));
        meshes.push(measured(level, typed.runs)?);
    }
    terminal.clear();
    let points = scaled(&meshes);
    let logarithms: Vec<_> = points.iter().map(|point| point.map(libm::log)).collect();
    let (gradient, logarithmic_gradient) = (gradient(&points), gradient(&logarithms));
    let experiment =
        Experiment { meshes, gradient, logarithmic_gradient, gradient_in_report: STATED_GRADIENT };
    let text = match typed.json {
        true => serde_json::to_string(&experiment).expect("numbers are valid JSON"),
        false => table(&experiment, typed.runs),
    };
    writeln!(out, "{text}").map_err(Failure::Print)
}

/// The diamond of Figure 1 with a target diameter that needs `level` levels.
fn settings(level: u32) -> Settings {
    let document = Example::Diamond.document(|| unreachable!("no raster"), || unreachable!("no polygons"));
    let mut settings = document.settings().clone();
    // A hair above the diameter of the level, which is irrational at even levels.
    let target = bisection_edge_length(settings.spacing, level) * (1.0 + 1e-12);
    let formula = format!("if(abs(x) + abs(y) < 8, {target:?}, 20)");
    settings.layers = Layer::stack([LayerKind::target(Formula::parse(&formula).expect("a valid formula"))]);
    settings.transfer.h_min = 0.5 * target;
    settings
}

fn measured(level: u32, runs: u32) -> Result<Row, Failure> {
    let settings = settings(level);
    let (mut triangles, mut seconds) = (0, 0.0);
    for _ in 0..runs {
        let spec = settings.mesh_spec().map_err(|error| Failure::Work(error.to_string()))?;
        let start = Instant::now();
        let mut builder = MeshBuilder::new(spec);
        while builder.advance(None, usize::MAX)? == Progress::More {}
        seconds += start.elapsed().as_secs_f64();
        triangles = builder.finish().mesh.triangle_count();
    }
    let stated = STATED_TRIANGLES.iter().find(|(other, _)| *other == level);
    let triangles_in_report = stated.map(|(_, triangles)| *triangles);
    Ok(Row { level, triangles, triangles_in_report, seconds: seconds / f64::from(runs) })
}

/// Triangles and time in proportion to the smallest mesh of the report, from that mesh on.
fn scaled(meshes: &[Row]) -> Vec<[f64; 2]> {
    let from = meshes.partition_point(|row| row.level < FIRST_LEVEL);
    let rows = &meshes[from..];
    let scaled = |row: &Row| [row.triangles as f64 / rows[0].triangles as f64, row.seconds / rows[0].seconds];
    rows.iter().map(scaled).collect()
}

/// The gradient of the least-squares line through points.
fn gradient(points: &[[f64; 2]]) -> f64 {
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let product = |f: fn([f64; 2]) -> f64| points.iter().map(|&[px, py]| f([px - x, py - y])).sum::<f64>();
    product(|[dx, dy]| dx * dy) / product(|[dx, _]| dx * dx)
}

fn table(experiment: &Experiment, runs: u32) -> String {
    let mut lines = vec![
        format!("Section 5.4: the mesh of Figure 1, mean of {runs} runs."),
        format!(
            "{:>5} {:>12} {:>12} {:>12} {:>14}",
            "level", "triangles", "report", "seconds", "ns/triangle"
        ),
    ];
    for row in &experiment.meshes {
        let stated = row.triangles_in_report.map_or_else(|| "–".into(), |count| Grouped(count).to_string());
        let each = 1e9 * row.seconds / row.triangles as f64;
        let triangles = Grouped(row.triangles).to_string();
        lines.push(format!(
            "{:>5} {triangles:>12} {stated:>12} {:>12.6} {each:>14.1}",
            row.level, row.seconds
        ));
    }
    lines.push(format!(
        "Gradient of the line of best fit from {} triangles on (Figure 5): {:.3}, and {:.3} on logarithmic axes; report: {}.",
        Grouped(STATED_TRIANGLES[0].1),
        experiment.gradient,
        experiment.logarithmic_gradient,
        experiment.gradient_in_report,
    ));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::gradient;

    #[test]
    fn the_gradient_of_points_on_a_line_is_that_of_the_line() {
        let on_line = [[1.0, 5.0], [2.0, 7.0], [4.0, 11.0]];
        assert_eq!(gradient(&on_line), 2.0);
        // By the normal equations: (3 · 21 − 6 · 9) / (3 · 14 − 36).
        assert_eq!(gradient(&[[1.0, 2.0], [2.0, 2.0], [3.0, 5.0]]), 1.5);
    }
}

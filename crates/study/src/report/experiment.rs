//! The experiment of Section 5.4 of the report: the mesh of Figure 1 with targets of several sizes, and how
//! the time to make it grows with the number of triangles (Figure 5).

use serde::Serialize;

use crate::build::{BuildError, MeshBuilder};
use crate::document::{Example, Settings};
use crate::field::{Formula, Transfer};
use crate::layers::{Layer, LayerKind};
use crate::mesh::{Mesh, Progress, bisection_edge_length};
use crate::plot::{Axis, Mark, Plot, Scale, Series};
use crate::text::Grouped;

/// The level of the smallest mesh of the report: all its times are in proportion to that.
const FIRST_LEVEL: u32 = 5;
/// The numbers of triangles that the report states, by level: its smallest and its largest mesh.
const STATED_TRIANGLES: [(u32, usize); 2] = [(FIRST_LEVEL, 9_560), (13, 2_113_944)];
/// Triangles between two looks at whether to go on.
const SLICE: usize = 1 << 16;

/// The measurements, the smallest mesh first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Experiment {
    /// A mesh for each level.
    pub meshes: Vec<ExperimentMesh>,
}

/// One mesh of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ExperimentMesh {
    /// The deepest level.
    pub level: u32,
    /// Number of triangles.
    pub triangles: usize,
    /// The number that the report states, if it does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triangles_in_report: Option<usize>,
    /// Mean time of all runs.
    pub seconds: f64,
}

impl ExperimentMesh {
    /// Makes the mesh of a level `runs` times, which must not be 0. `seconds` is a clock. `None` if `goes_on`
    /// said no, which is asked now and then.
    ///
    /// # Errors
    /// Fails when there is not enough memory.
    pub fn measure(
        level: u32,
        runs: u32,
        seconds: impl Fn() -> f64,
        goes_on: impl Fn() -> bool,
    ) -> Result<Option<Self>, BuildError> {
        let settings = settings(level);
        let (mut triangles, mut time) = (0, 0.0);
        for _ in 0..runs {
            let spec = settings.mesh_spec().expect("the settings of the experiment are valid");
            let start = seconds();
            let mut builder = MeshBuilder::new(spec);
            while builder.advance(None, SLICE)? == Progress::More {
                if !goes_on() {
                    return Ok(None);
                }
            }
            time += seconds() - start;
            triangles = Mesh::triangle_count(&builder.finish().mesh);
        }
        let stated = STATED_TRIANGLES.iter().find(|(other, _)| *other == level);
        let triangles_in_report = stated.map(|(_, triangles)| *triangles);
        Ok(Some(Self { level, triangles, triangles_in_report, seconds: time / f64::from(runs) }))
    }
}

/// Returns the diamond of Figure 1 with a target diameter that needs `level` levels.
fn settings(level: u32) -> Settings {
    let document = Example::Diamond.document(|| unreachable!("no raster"), || unreachable!("no polygons"));
    let mut settings = document.settings().clone();
    // A hair above the diameter of the level, which is irrational at even levels.
    let target = bisection_edge_length(settings.spacing, level) * (1.0 + 1e-12);
    let formula = format!("if(abs(x) + abs(y) < 8, {target:?}, 20)");
    settings.layers = Layer::stack([LayerKind::target(Formula::parse(&formula).expect("a valid formula"))]);
    settings.transfer = Transfer::between(0.5 * target, settings.transfer.h_max);
    settings
}

impl Experiment {
    /// The deepest level of the report.
    pub const LAST_LEVEL: u32 = 13;
    /// The gradient of the line of best fit in Figure 5.
    pub const STATED_GRADIENT: f64 = 1.01;

    /// Returns the gradient of the line of best fit from the smallest mesh of the report on: of times over
    /// triangles, both in proportion to that mesh, and of their logarithms. `None` with fewer than two
    /// meshes.
    pub fn gradients(&self) -> Option<[f64; 2]> {
        let points = self.scaled();
        let logarithms: Vec<_> = points.iter().map(|point| point.map(libm::log)).collect();
        Some([fitted_line(&points)?[1], fitted_line(&logarithms)?[1]])
    }

    /// Returns the triangles and time in proportion to the smallest mesh of the report, from that mesh on.
    fn scaled(&self) -> Vec<[f64; 2]> {
        let rows = &self.meshes[self.meshes.partition_point(|mesh| mesh.level < FIRST_LEVEL)..];
        let scaled = |mesh: &ExperimentMesh| {
            [mesh.triangles as f64 / rows[0].triangles as f64, mesh.seconds / rows[0].seconds]
        };
        rows.iter().map(scaled).collect()
    }

    /// Figure 5: time over triangles with the line of best fit, on logarithmic axes.
    pub fn figure_5(&self) -> Plot {
        let points = self.scaled();
        let mut series = vec![Series::new("Measured", Mark::Points, points.clone())];
        let mut note = String::new();
        let [first, last] = [points.first(), points.last()].map(|point| point.map_or(1.0, |point| point[0]));
        if let (Some([at_zero, gradient]), Some([_, logarithmic])) = (fitted_line(&points), self.gradients())
        {
            // A straight line is curved on logarithmic axes.
            let places = (0..=40).map(|i| first * libm::pow(last / first, f64::from(i) / 40.0));
            let fit = places.map(|x| [x, at_zero + gradient * x]).collect();
            series.insert(0, Series::new("Line of best fit", Mark::Line, fit));
            note = format!(
                "Gradient {gradient:.3}, of the logarithms {logarithmic:.3}; report: {}",
                Self::STATED_GRADIENT
            );
        }
        Plot {
            title: "Figure 5: running time over triangles".into(),
            x: Axis::new("triangles / 9,560", Scale::Logarithmic),
            y: Axis::new("time / time of 9,560", Scale::Logarithmic),
            series,
            note,
        }
    }

    /// Returns the time for one triangle over the number of triangles.
    pub fn time_per_triangle(&self) -> Plot {
        let each =
            |mesh: &ExperimentMesh| [mesh.triangles as f64, 1e9 * mesh.seconds / mesh.triangles as f64];
        let points = self.meshes.iter().map(each).collect();
        let gradient = self.gradients().map_or_else(String::new, |[gradient, _]| {
            format!("Gradient of Figure 5: {gradient:.3}; report: {}", Self::STATED_GRADIENT)
        });
        Plot {
            title: "Time per triangle".into(),
            x: Axis::new("triangles", Scale::Logarithmic),
            y: Axis::new("time per triangle", Scale::Linear).unit("ns"),
            series: vec![Series::new("Measured", Mark::Points, points)],
            note: gradient,
        }
    }

    /// Returns the meshes as a table in plain text. `runs` is how often each was made.
    pub fn table(&self, runs: u32) -> String {
        let runs = if runs == 1 { "one run".into() } else { format!("mean of {runs} runs") };
        let mut lines = vec![
            format!("Section 5.4: the mesh of Figure 1, {runs}."),
            format!(
                "{:>5} {:>12} {:>12} {:>12} {:>14}",
                "level", "triangles", "report", "seconds", "ns/triangle"
            ),
        ];
        for mesh in &self.meshes {
            let stated = mesh.triangles_in_report;
            let stated = stated.map_or_else(|| "–".into(), |count| Grouped(count).to_string());
            let each = 1e9 * mesh.seconds / mesh.triangles as f64;
            let triangles = Grouped(mesh.triangles).to_string();
            lines.push(format!(
                "{:>5} {triangles:>12} {stated:>12} {:>12.6} {each:>14.1}",
                mesh.level, mesh.seconds
            ));
        }
        if let Some([gradient, logarithmic]) = self.gradients() {
            lines.push(format!(
                "Gradient of the line of best fit from {} triangles on (Figure 5): {gradient:.3}, and {logarithmic:.3} on logarithmic axes; report: {}.",
                Grouped(STATED_TRIANGLES[0].1),
                Self::STATED_GRADIENT,
            ));
        }
        lines.join("\n")
    }
}

/// Returns the least-squares line through points: its value at 0, and its gradient. `None` where x does not
/// differ.
fn fitted_line(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let product = |f: fn([f64; 2]) -> f64| points.iter().map(|&[px, py]| f([px - x, py - y])).sum::<f64>();
    let gradient = product(|[dx, dy]| dx * dy) / product(|[dx, _]| dx * dx);
    gradient.is_finite().then_some([y - gradient * x, gradient])
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn the_gradient_of_points_on_a_line_is_that_of_the_line() {
        let on_line = [[1.0, 5.0], [2.0, 7.0], [4.0, 11.0]];
        assert_eq!(fitted_line(&on_line), Some([3.0, 2.0]));
        // By the normal equations: (3 · 21 − 6 · 9) / (3 · 14 − 36).
        let [_, gradient] = fitted_line(&[[1.0, 2.0], [2.0, 2.0], [3.0, 5.0]]).unwrap();
        assert_eq!(gradient, 1.5);
        assert_eq!(fitted_line(&[[1.0, 2.0]]), None);
        assert_eq!(fitted_line(&[]), None);
    }

    /// Returns a clock that goes one second further each time it is read.
    fn measured(level: u32) -> ExperimentMesh {
        let time = Cell::new(0.0);
        let clock = || {
            time.set(time.get() + 1.0);
            time.get()
        };
        ExperimentMesh::measure(level, 2, clock, || true).unwrap().unwrap()
    }

    #[test]
    fn meshes_have_the_triangles_of_the_report_and_plots_their_times() {
        let experiment = Experiment { meshes: [4, 5, 6, 7].map(measured).to_vec() };
        let smallest = experiment.meshes[1];
        assert_eq!((smallest.triangles, smallest.triangles_in_report), (9_560, Some(9_560)));
        assert_eq!(smallest.seconds, 1.0);
        assert_eq!(experiment.gradients(), Some([0.0, 0.0]));
        let figure = experiment.figure_5();
        let measured = &figure.series[1].points;
        assert_eq!(measured.len(), 3, "from the smallest mesh of the report on");
        assert_eq!(measured[0], [1.0, 1.0]);
        assert!(figure.note.contains("report: 1.01"), "{}", figure.note);
        let each = &experiment.time_per_triangle().series[0].points;
        assert_eq!(each[1], [9_560.0, 1e9 / 9_560.0]);
        let table = experiment.table(2);
        assert!(table.contains("mean of 2 runs") && table.contains("9,560        9,560"), "{table}");
    }

    #[test]
    fn measuring_ends_when_it_is_cancelled() {
        assert_eq!(ExperimentMesh::measure(9, 1, || 0.0, || false).unwrap(), None);
    }

    #[test]
    fn an_experiment_without_meshes_has_plots_without_points() {
        let experiment = Experiment::default();
        assert_eq!(experiment.gradients(), None);
        assert!(experiment.figure_5().series[0].points.is_empty());
        assert!(experiment.time_per_triangle().ranges()[0].low().is_finite());
    }
}

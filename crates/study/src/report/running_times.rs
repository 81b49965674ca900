//! The experiment of the report as plots and as a table.

use super::experiment::{Experiment, ExperimentMesh, STATED_TRIANGLES};
use super::power_law::PowerLaw;
use crate::plot::{Axis, Mark, Plot, Scale, Series};
use crate::text::{Grouped, fixed};

/// What moves the exponent away from 1, in sentences.
pub const ABOUT_EXPONENT: &str = "An exponent of 1 means that every triangle takes the same time. Caches raise it: the arrays of a \
                                  small mesh fit into them, those of a large one do not, and new pages of memory take time of \
                                  their own. Costs that every mesh has, whatever its size, lower it. A load on the machine adds \
                                  to single runs and takes a part of the caches: the least of several runs in turn counts, in \
                                  processor time of one thread where the platform has it.";
/// Added where runs were disturbed.
pub const DISTURBED: &str = "Runs were disturbed: other work had the processor, or their times are far apart. Measure again on a quiet machine.";

impl PowerLaw {
    /// Returns the exponent with its uncertainty.
    pub fn exponent_in_words(&self) -> String {
        let exponent = fixed(self.exponent, 3);
        if self.uncertainty.is_finite() {
            format!("{exponent} ± {} (95 %)", fixed(self.uncertainty, 3))
        } else {
            exponent
        }
    }
}

impl Experiment {
    /// Figure 5: time over triangles with the power law of best fit, on logarithmic axes, on which it is a
    /// straight line. Error bars go from the minimum to the maximum time of all runs.
    pub fn figure_5(&self) -> Plot {
        let points = self.scaled(ExperimentMesh::seconds);
        let greatest = self.scaled(|mesh| mesh.span()[1]);
        let spans = points.iter().zip(&greatest).map(|(least, greatest)| [least[1], greatest[1]]).collect();
        let mut series = Vec::new();
        if let (Some(law), [first, .., last]) = (self.power_law(), &points[..]) {
            let ends = [first[0], last[0]].map(|x| [x, law.at(x)]);
            series.push(Series::new("Power law of best fit", Mark::Line, ends.to_vec()));
        }
        series.push(Series::new("Least of all runs", Mark::Points, points).spans(spans));
        Plot {
            title: "Figure 5: running time over triangles".into(),
            x: Axis::new("triangles / 9,560", Scale::Logarithmic),
            y: Axis::new("time / time of 9,560", Scale::Logarithmic),
            series,
            note: self.exponent_beside_report("Exponent"),
        }
    }

    /// Returns the time for one triangle over the number of triangles.
    pub fn time_per_triangle(&self) -> Plot {
        let each = |mesh: &ExperimentMesh, seconds: f64| 1e9 * seconds / mesh.triangles as f64;
        let points = self.meshes.iter().map(|mesh| [mesh.triangles as f64, each(mesh, mesh.seconds())]);
        let spans = self.meshes.iter().map(|mesh| mesh.span().map(|seconds| each(mesh, seconds)));
        Plot {
            title: "Time per triangle".into(),
            x: Axis::new("triangles", Scale::Logarithmic),
            y: Axis::new("time per triangle", Scale::Linear).unit("ns"),
            series: vec![
                Series::new("Least of all runs", Mark::Points, points.collect()).spans(spans.collect()),
            ],
            note: self.exponent_beside_report("Exponent of Figure 5"),
        }
    }

    /// Returns the exponent beside that of the report, and whether runs were disturbed; empty without one.
    fn exponent_beside_report(&self, name: &str) -> String {
        let Some(law) = self.power_law() else { return String::new() };
        let disturbed = if self.is_disturbed() { format!(". {DISTURBED}") } else { String::new() };
        format!("{name} {}; report: {}{disturbed}", law.exponent_in_words(), Self::STATED_GRADIENT)
    }

    /// Returns the meshes as a table in plain text, with what moves the exponent.
    pub fn table(&self) -> String {
        let runs = match self.meshes.iter().map(|mesh| mesh.runs.len()).max() {
            Some(1) => "one run".into(),
            runs => format!("least of {} runs in turn", runs.unwrap_or_default()),
        };
        let is_of_processor =
            self.meshes.iter().flat_map(|mesh| &mesh.runs).all(|run| run.processor.is_some());
        let clock = if is_of_processor { "processor time" } else { "wall time" };
        let mut lines = vec![
            format!("Section 5.4: the mesh of Figure 1, {runs}, {clock} of one thread."),
            format!(
                "{:>5} {:>12} {:>12} {:>12} {:>12} {:>14}",
                "level", "triangles", "report", "seconds", "greatest", "ns/triangle"
            ),
        ];
        lines.extend(self.meshes.iter().map(row));
        if let Some(law) = self.power_law() {
            lines.push(format!(
                "Exponent of the power law of best fit from {} triangles on (Figure 5): {}; report: {}.",
                Grouped(STATED_TRIANGLES[0].1),
                law.exponent_in_words(),
                Self::STATED_GRADIENT,
            ));
            lines.push(ABOUT_EXPONENT.into());
        }
        lines.extend(self.is_disturbed().then(|| DISTURBED.into()));
        lines.join("\n")
    }
}

/// Returns a mesh as a row of the table.
fn row(mesh: &ExperimentMesh) -> String {
    let stated = mesh.triangles_in_report.map_or_else(|| "–".into(), |count| Grouped(count).to_string());
    let triangles = Grouped(mesh.triangles).to_string();
    let [least, greatest] = mesh.span();
    let each = 1e9 * least / mesh.triangles as f64;
    format!("{:>5} {triangles:>12} {stated:>12} {least:>12.6} {greatest:>12.6} {each:>14.1}", mesh.level)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{ExperimentRun, RunTime};

    /// Returns the meshes of levels 4 to 13 with times by a power law. Each has two runs; in the second one
    /// all take half as long again, and one level ten times as long.
    fn measured(exponent: f64, slow: u32) -> Experiment {
        let mut experiment = Experiment::default();
        for (round, level) in (1..=2_u32).flat_map(|round| (4..=13).map(move |level| (round, level))) {
            let triangles = 9_560 << u32::saturating_sub(level, 5);
            let exact = libm::pow(triangles as f64 / 9_560.0, exponent);
            let load = if round == 1 {
                1.0
            } else if level == slow {
                10.0
            } else {
                1.2
            };
            let wall = load * exact;
            experiment
                .add(round, ExperimentRun { level, triangles, time: RunTime { wall, processor: None } });
        }
        experiment
    }

    #[test]
    fn the_table_says_which_clock_was_read() {
        let mut experiment = measured(1.01, 5);
        assert!(experiment.table().contains("least of 2 runs in turn, wall time of one thread"));
        experiment
            .meshes
            .iter_mut()
            .flat_map(|mesh| &mut mesh.runs)
            .for_each(|run| run.processor = Some(1.0));
        assert!(experiment.table().contains("least of 2 runs in turn, processor time of one thread"));
    }

    #[test]
    fn the_line_of_figure_5_is_the_power_law_and_a_slow_run_does_not_move_it() {
        for slow in 5..=13 {
            let experiment = measured(1.01, slow);
            let law = experiment.power_law().unwrap();
            assert!((law.exponent - 1.01).abs() < 1e-9, "{law:?}");
            let figure = experiment.figure_5();
            let [line, points] = &figure.series[..] else { panic!("{figure:?}") };
            assert_eq!(points.points.len(), 9, "from the smallest mesh of the report on");
            assert_eq!(points.points[0], [1.0, 1.0]);
            let [[x, y], [to_x, to_y]] = line.points[..] else { panic!("{line:?}") };
            let gradient = libm::log(to_y / y) / libm::log(to_x / x);
            assert!((gradient - 1.01).abs() < 1e-9, "what is drawn is what is stated");
            assert!(
                figure.note.starts_with("Exponent 1.010 ± 0.000 (95 %); report: 1.01"),
                "{}",
                figure.note
            );
        }
    }

    #[test]
    fn error_bars_are_those_of_the_runs() {
        let experiment = measured(1.0, 7);
        for ([x, y], [least, greatest]) in
            experiment.figure_5().series[1].points.iter().zip(&experiment.figure_5().series[1].spans)
        {
            assert!((y / x - 1.0).abs() < 1e-12 && least == y);
            let load = if *x == 4.0 { 10.0 } else { 1.2 };
            assert!((greatest / least - load).abs() < 1e-9, "{x}: {least} to {greatest}");
        }
        let each = &experiment.time_per_triangle().series[0];
        assert_eq!(each.points.len(), 10);
        assert_eq!(each.points[1], [9_560.0, 1e9 / 9_560.0]);
        assert!((each.spans[1][1] / each.spans[1][0] - 1.2).abs() < 1e-9);
    }

    #[test]
    fn disturbed_runs_are_said() {
        let quiet = Experiment {
            meshes: measured(1.0, 0)
                .meshes
                .into_iter()
                .map(|mut mesh| {
                    mesh.runs.truncate(1);
                    mesh
                })
                .collect(),
        };
        assert!(!quiet.is_disturbed() && !quiet.table().contains(DISTURBED));
        assert!(quiet.table().contains("one run, wall time"), "{}", quiet.table());
        let disturbed = measured(1.0, 7);
        assert!(disturbed.is_disturbed() && disturbed.figure_5().note.ends_with(DISTURBED));
        let table = disturbed.table();
        assert!(table.contains("least of 2 runs") && table.contains("9,560        9,560"), "{table}");
        assert!(table.contains(ABOUT_EXPONENT) && table.ends_with(DISTURBED), "{table}");
    }

    #[test]
    fn an_experiment_without_meshes_has_plots_without_points() {
        let experiment = Experiment::default();
        assert_eq!(experiment.power_law(), None);
        assert!(experiment.figure_5().series[0].points.is_empty());
        assert!(experiment.time_per_triangle().ranges()[0].low().is_finite());
    }
}
